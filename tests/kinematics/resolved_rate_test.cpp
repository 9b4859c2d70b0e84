/// Rates of bends and tendons that move a serial robot's tip as commanded.
#include "sinew/kinematics/serial.hpp"

#include <gtest/gtest.h>

#include "math/linalg.hpp"
#include "serial_robots.hpp"

namespace sinew::test {
namespace resolved_rate_test {

using kernel::Backbone;

Vec3<double> any_vector(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> any(-size, size);
  return {any(random), any(random), any(random)};
}

class ResolvedRateOf : public testing::TestWithParam<Backbone> {
 protected:
  SerialRobot robot = nottingham(GetParam());
  SerialWorkspace work{robot};
  std::mt19937 random{3};

  std::vector<Bend> shape(double share = 0.7) {
    std::vector<Bend> bends = random_bends(robot, random);
    for (Bend& bend : bends) bend *= share;
    return bends;
  }
  TipTwist twist() { return {any_vector(random, 0.05), any_vector(random, 0.5)}; }

  /// Of the tip, in base axes, with the rates that stand in the workspace.
  Vec<double, 6> moved() const {
    return work.jacobian() *
           Eigen::Map<const Eigen::VectorXd>(work.bend_rates.data(), work.jacobian().cols());
  }
};

TEST_P(ResolvedRateOf, MovesTheTipAsCommanded) {
  for (int i = 0; i < 200; ++i) {
    const std::vector<Bend> bends = shape();
    const TipTwist wanted = twist();
    for (const TipFrame frame : {TipFrame::base, TipFrame::tip})
      for (const TipTask task : {TipTask::position, TipTask::axis, TipTask::whole}) {
        const ResolvedRate answer = resolved_rate(robot, bends, wanted, {.frame = frame, .task = task}, work);
        ASSERT_TRUE(answer.ok()) << answer.report.message.view();
        const SE3<double>& tip = work.ends.back();
        const Vec<double, 6> motion = moved();
        Vec3<double> linear = motion.head<3>(), angular = motion.tail<3>();
        if (frame == TipFrame::tip) {
          linear = tip.rotate_back(linear);
          angular = tip.rotate_back(angular);
        }
        EXPECT_LT((linear - wanted.linear).norm(), 1e-6 * 0.1);
        const Vec3<double> axis = frame == TipFrame::tip ? Vec3<double>(0, 0, 1)
                                                         : tip.rotate(Vec3<double>(0, 0, 1)),
                           missed = angular - wanted.angular;
        const double judged = task == TipTask::whole  ? missed.norm()
                              : task == TipTask::axis ? cross(axis, missed).norm()
                                                      : 0;
        EXPECT_LT(judged, 1e-5);
      }
  }
}

TEST_P(ResolvedRateOf, IsTheSlowestThatDoes) {  // as the pseudoinverse, in what sections turn by
  for (int i = 0; i < 50; ++i) {
    const std::vector<Bend> bends = shape(0.5);
    const TipTwist wanted = twist();
    ASSERT_TRUE(resolved_rate(robot, bends, wanted, {}, work).ok());
    const double count = robot.sections[0].is_twin() ? 4 : 1;
    Eigen::Matrix<double, 6, 10, Eigen::RowMajor> J = work.jacobian() / count;
    Vec<double, 6> t;
    t << wanted.linear, wanted.angular;
    J.topRows<3>() /= robot.length();
    t.head<3>() /= robot.length();
    std::array<double, 10> slowest;
    least_norm(MatrixView(J.data(), 6, 10), {t.data(), 6}, slowest);
    for (std::size_t j = 0; j < 10; ++j) EXPECT_NEAR(work.bend_rates[j], slowest[j] / count, 1e-5);
  }
}

TEST_P(ResolvedRateOf, NothingTurnsBeyondItsLimit) {
  int followed = 0, blocked = 0;
  for (int i = 0; i < 200; ++i) {
    std::vector<Bend> bends = shape(0.9);
    for (std::size_t m = 0; m < bends.size(); m += 2) {
      const double limit = robot.sections[m].limit;
      if (robot.sections[m].is_twin())
        bends[m].x() = std::copysign(limit, bends[m].x());
      else
        bends[m] *= limit / bends[m].norm();
    }
    const TipTwist wanted = twist();
    const ResolvedRate answer = resolved_rate(robot, bends, wanted, {.task = TipTask::axis}, work);
    (answer.ok() ? followed : blocked) += 1;
    EXPECT_EQ(answer.report.status, answer.ok() ? Status::converged : Status::left_domain);
    for (std::size_t m = 0; m < bends.size(); m += 2) {
      const Bend rate(work.bend_rates[2 * m], work.bend_rates[2 * m + 1]);
      EXPECT_LE(robot.sections[m].is_twin() ? rate.x() * bends[m].x() : rate.dot(bends[m]), 1e-12);
    }
  }
  EXPECT_GT(followed, 20);  // the free sections make up for the held ones
  EXPECT_GT(followed + blocked, 0);
}

TEST_P(ResolvedRateOf, FollowsAPathWhenIntegrated) {
  std::vector<Bend> bends = shape(0.4);
  section_ends(bends, work);
  const SE3<double> first = work.ends.back();
  const TipTwist wanted{Vec3<double>(0.004, -0.003, 0.002), Vec3<double>(0, 0, 0)};
  const double step = 0.01;
  const int steps = 100;
  const auto rate = [&](const std::vector<Bend>& at) {
    EXPECT_TRUE(resolved_rate(robot, at, wanted, {}, work).ok());
    std::vector<Bend> all;
    for (std::size_t m = 0; m < at.size(); ++m)
      all.emplace_back(work.bend_rates[2 * m], work.bend_rates[2 * m + 1]);
    return all;
  };
  for (int i = 0; i < steps; ++i) {
    std::vector<Bend> middle = bends;
    const std::vector<Bend> start = rate(bends);
    for (std::size_t m = 0; m < bends.size(); ++m) middle[m] += step / 2 * start[m];
    const std::vector<Bend> half_way = rate(middle);
    for (std::size_t m = 0; m < bends.size(); ++m) bends[m] += step * half_way[m];
  }
  section_ends(bends, work);
  EXPECT_LT((work.ends.back().p - (first.p + wanted.linear * (step * steps))).norm(), 1e-8);
  EXPECT_LT(work.ends.back().R.compose(first.R.inverse()).log().norm(), 1e-6);
}

TEST_P(ResolvedRateOf, TendonsMoveWithTheBends) {
  const std::vector<Bend> bends = shape();
  for (const kernel::Model model : {kernel::Model::exact, kernel::Model::linear}) {
    const ResolvedRate answer = resolved_rate(robot, bends, twist(), {.model = model}, work);
    const auto after = [&](double time) {
      std::vector<Bend> at = bends;
      for (std::size_t m = 0; m < at.size(); ++m)
        at[m] += time * Bend(answer.bends[2 * m], answer.bends[2 * m + 1]);
      tendon_changes(at, model, work);
      return work.changes;
    };
    const double time = 1e-5;
    const std::vector<double> ahead = after(time), behind = after(-time);
    for (std::size_t i = 0; i < ahead.size(); ++i)
      EXPECT_NEAR(answer.tendons[i], (ahead[i] - behind[i]) / (2 * time), 1e-10);
  }
}

TEST_P(ResolvedRateOf, AStraightRobotCannotGrow) {
  const std::vector<Bend> straight(5, Bend(0, 0));
  const TipTwist along{.linear = Vec3<double>(0, 0, 0.01)};
  const ResolvedRate answer = resolved_rate(robot, straight, along, {.task = TipTask::position}, work);
  EXPECT_EQ(answer.report.status, Status::singular);
  EXPECT_NEAR(answer.report.residual, 0.01, 1e-6);
  EXPECT_FALSE(answer.report.message.empty());
  for (const double rate : answer.bends) EXPECT_LT(std::abs(rate), 1e-6);
  const TipTwist across{.linear = Vec3<double>(0.01, 0, 0)};
  EXPECT_TRUE(resolved_rate(robot, straight, across, {.task = TipTask::position}, work).ok());
}

TEST_P(ResolvedRateOf, KeepsToTheFastestRate) {
  const std::vector<Bend> bends = shape(0.3);
  const TipTwist wanted{.linear = Vec3<double>(0.2, 0.1, 0)};
  const ResolvedRate answer =
      resolved_rate(robot, bends, wanted, {.task = TipTask::position, .fastest = 0.1}, work);
  EXPECT_EQ(answer.report.status, Status::left_domain);
  EXPECT_GT(answer.held, 0);
  const double count = robot.sections[0].is_twin() ? 4 : 1;
  for (std::size_t m = 0; m < 5; ++m)
    EXPECT_LE(count * std::hypot(answer.bends[2 * m], answer.bends[2 * m + 1]), 0.1 * std::sqrt(2.0) + 1e-12);
}

TEST_P(ResolvedRateOf, NoMotionTakesNone) {
  const ResolvedRate answer = resolved_rate(robot, shape(), {}, {}, work);
  EXPECT_TRUE(answer.ok());
  for (const double rate : answer.bends) EXPECT_EQ(rate, 0);
  for (const double rate : answer.tendons) EXPECT_EQ(rate, 0);
}

INSTANTIATE_TEST_SUITE_P(Backbones, ResolvedRateOf, testing::Values(Backbone::twin_pivot, Backbone::neutral));

}  // namespace resolved_rate_test
}  // namespace sinew::test
