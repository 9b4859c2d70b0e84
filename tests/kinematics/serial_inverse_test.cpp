/// Bends that bring a serial robot's tip to a target.
#include "sinew/kinematics/serial.hpp"

#include <gtest/gtest.h>

#include "kinematics/serial/bounded_step.hpp"
#include "reference_file.hpp"
#include "serial_robots.hpp"

namespace sinew::test {
namespace serial_inverse_test {

using kernel::Backbone;

enum class Task { position, direction, pose };

TipTarget target_of(const SE3<double>& tip, Task task) {
  TipTarget target{.position = tip.p};
  if (task == Task::direction) target.direction = tip.rotate(Vec3<double>(0, 0, 1));
  if (task == Task::pose) target.rotation = tip.R;
  return target;
}

SE3<double> tip(const SerialRobot& robot, std::span<const Bend> bends) {
  SerialWorkspace work(robot);
  section_ends(bends, work);
  return work.ends.back();
}

/// L = 1 m, one joint a section, no discs, no limits.
SerialRobot three_arcs() {
  SerialRobot robot;
  for (int m = 0; m < 3; ++m) {
    Section section;
    section.backbone = Backbone::neutral;
    section.segments = 1;
    section.joint = 1;
    section.tendon_radius = 0.01;
    robot.sections.push_back(section);
  }
  return robot;
}

/// What the answer says of itself is so.
void expect_holds(const SerialRobot& robot, const TipTarget& target, const SerialInverse& answer,
                  const SerialWorkspace& work) {
  EXPECT_TRUE(check_limits(robot, answer.bends).ok());
  const SE3<double> end = tip(robot, answer.bends);
  const double length = robot.length(), rounding = 1e-14;
  EXPECT_NEAR((end.p - target.position).norm(), answer.position_error, rounding * length);
  if (target.direction) {
    const Vec3<double> axis = end.rotate(Vec3<double>(0, 0, 1)), wanted = target.direction->normalized();
    EXPECT_NEAR(2 * std::asin(std::min(1.0, (axis - wanted).norm() / 2)), answer.angle_error, 1e-7);
    EXPECT_LT((axis - wanted).norm(), answer.angle_error + 10 * rounding);
  }
  if (target.rotation) {
    const Vec3<double> turn = target.rotation->compose(end.R.inverse()).log();
    EXPECT_NEAR(turn.norm(), answer.angle_error, 10 * rounding);
  }
  EXPECT_EQ(answer.report.residual, std::max(answer.position_error, length * answer.angle_error));
  EXPECT_EQ(answer.report.message.empty(), answer.ok());
  EXPECT_EQ(answer.report.residual <= 1e-12 * length, answer.ok());
  EXPECT_LT((work.ends.back().p - end.p).norm(), rounding * length);
  EXPECT_EQ(answer.bends.data(), work.bends.data());
}

struct Case {
  const char* name;
  SerialRobot robot;
};

class SerialInverseOf : public testing::TestWithParam<std::tuple<int, Task>> {
 protected:
  static Case any_case(int i) {
    switch (i) {
      case 0:
        return {"tpcj 5", nottingham()};
      case 1:
        return {"neutral 5", nottingham(Backbone::neutral)};
      case 2:
        return {"tpcj 3", nottingham(Backbone::twin_pivot, 3)};
      case 3:
        return {"neutral 2", nottingham(Backbone::neutral, 2)};
      case 4:
        return {"tpcj 1", nottingham(Backbone::twin_pivot, 1)};
      case 5:
        return {"tpcj 12", nottingham(Backbone::twin_pivot, 12)};
      case 6:
        return {"neutral 1", nottingham(Backbone::neutral, 1)};
      default:
        return {"arcs", three_arcs()};
    }
  }
  SerialRobot robot = any_case(std::get<0>(GetParam())).robot;
  Task task = std::get<1>(GetParam());
  SerialWorkspace work{robot};
  std::mt19937 random{5};
};

TEST_P(SerialInverseOf, ReachesWhatBendsReach) {
  for (int i = 0; i < 200; ++i) {
    const TipTarget target = target_of(tip(robot, random_bends(robot, random)), task);
    const SerialInverse answer = inverse(robot, target, {}, work);
    EXPECT_TRUE(answer.ok()) << i << ": " << answer.report.message.view();
    expect_holds(robot, target, answer, work);
  }
}

TEST_P(SerialInverseOf, ReachesTheLimitsThemselves) {
  if (std::isinf(robot.sections[0].limit))
    for (Section& section : robot.sections) section.limit = 2;
  for (int i = 0; i < 100; ++i) {
    std::vector<Bend> bends = random_bends(robot, random);
    for (std::size_t m = 0; m < bends.size(); ++m) {
      const double limit = robot.sections[m].limit;
      if (robot.sections[m].is_twin())
        bends[m][static_cast<Eigen::Index>(random() % 2)] = random() % 2 == 0 ? limit : -limit;
      else if (random() % 2 == 0)
        bends[m] *= limit / bends[m].norm();
    }
    const TipTarget target = target_of(tip(robot, bends), task);
    const SerialInverse answer = inverse(robot, target, {}, work);
    EXPECT_TRUE(answer.ok()) << i << ": " << answer.report.message.view();
    expect_holds(robot, target, answer, work);
  }
}

TEST_P(SerialInverseOf, FromTheAnswerNothingIsToBeDone) {
  const std::vector<Bend> bends = random_bends(robot, random);
  const SerialInverse answer = inverse(robot, target_of(tip(robot, bends), task), {.start = bends}, work);
  EXPECT_TRUE(answer.ok());
  EXPECT_EQ(answer.report.iterations, 0);
  EXPECT_EQ(answer.start, 0);
  for (std::size_t m = 0; m < bends.size(); ++m) EXPECT_LT((answer.bends[m] - bends[m]).norm(), 1e-15);
}

TEST_P(SerialInverseOf, StaysNearItsStartOnAPath) {
  std::vector<Bend> bends = random_bends(robot, random, 1.5), last;
  for (Bend& bend : bends) bend *= 0.6;
  SerialInverse answer = inverse(robot, target_of(tip(robot, bends), task), {.start = bends}, work);
  for (int step = 0; step < 50; ++step) {
    for (std::size_t m = 0; m < bends.size(); ++m)
      bends[m] *= 1 + 0.01 * std::cos(static_cast<double>(step) / 10 + static_cast<double>(m));
    last.assign(work.bends.begin(), work.bends.end());
    const TipTarget target = target_of(tip(robot, bends), task);
    answer = inverse(robot, target, {.start = work.bends}, work);
    ASSERT_TRUE(answer.ok()) << step;
    EXPECT_EQ(answer.start, 0) << step;
    EXPECT_LE(answer.report.iterations, 12) << step;
    for (std::size_t m = 0; m < bends.size(); ++m) EXPECT_LT((answer.bends[m] - last[m]).norm(), 0.2) << step;
  }
}

TEST_P(SerialInverseOf, FindsTheStraightRobotFromABentOne) {  // singular there: only just reachable
  const std::vector<Bend> straight(robot.sections.size(), Bend(0, 0));
  const TipTarget target = target_of(tip(robot, straight), task);
  for (int i = 0; i < 20; ++i) {
    const std::vector<Bend> start = random_bends(robot, random);
    const SerialInverse answer = inverse(robot, target, {.start = start}, work);
    EXPECT_TRUE(answer.ok()) << answer.report.message.view();
    expect_holds(robot, target, answer, work);
  }
}

TEST_P(SerialInverseOf, SaysHowFarATargetIsOutOfReach) {
  SE3<double> end = tip(robot, random_bends(robot, random));
  end.p = end.p.normalized() * (robot.length() * 1.5);
  const TipTarget target = target_of(end, task);
  const SerialInverse answer = inverse(robot, target, {}, work);
  EXPECT_EQ(answer.report.status, Status::unreachable);
  EXPECT_NE(answer.report.message.view().find("beyond what a robot of"), std::string_view::npos);
  EXPECT_GE(answer.position_error, 0.49 * robot.length());
  expect_holds(robot, target, answer, work);
}

TEST_P(SerialInverseOf, TheSameQuestionHasTheSameAnswer) {
  SerialWorkspace other(robot);
  for (int i = 0; i < 20; ++i) {
    const TipTarget target = target_of(tip(robot, random_bends(robot, random)), task);
    const SerialInverse once = inverse(robot, target, {}, work);
    const std::vector<Bend> bends(once.bends.begin(), once.bends.end());
    inverse(robot, target_of(tip(robot, random_bends(robot, random)), task), {}, other);  // leaves no trace
    const SerialInverse again = inverse(robot, target, {}, other);
    EXPECT_EQ(once.report.iterations, again.report.iterations);
    for (std::size_t m = 0; m < bends.size(); ++m) EXPECT_EQ(bends[m], again.bends[m]);
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, SerialInverseOf,
                         testing::Combine(testing::Range(0, 8),
                                          testing::Values(Task::position, Task::direction, Task::pose)));

TEST(SerialInverse, SaysHowNearItCameWhereNothingReaches) {
  const SerialRobot robot = nottingham(Backbone::twin_pivot, 2);
  SerialWorkspace work(robot);
  const TipTarget target{.position = {0, 0, -0.05}};  // behind the base: the limits forbid it
  const SerialInverse answer = inverse(robot, target, {}, work);
  EXPECT_TRUE(answer.report.status == Status::stalled || answer.report.status == Status::iteration_limit);
  EXPECT_GT(answer.position_error, 0.01);
  EXPECT_NE(answer.report.message.view().find("the nearest is"), std::string_view::npos);
  expect_holds(robot, target, answer, work);
}

TEST(SerialInverse, TheNearestIsNearestWhereItIsKnown) {
  const SerialRobot robot = nottingham(Backbone::neutral, 1);
  SerialWorkspace work(robot);
  const double turn = 1.0;
  const SE3<double> at = tip(robot, std::vector<Bend>{Bend(turn, 0)});
  const SE3<double> ahead = tip(robot, std::vector<Bend>{Bend(turn + 1e-6, 0)}),
                    behind = tip(robot, std::vector<Bend>{Bend(turn - 1e-6, 0)});
  const Vec3<double> along = (ahead.p - behind.p).normalized(), across(-along.z(), 0, along.x());
  const SerialInverse answer = inverse(robot, {.position = at.p + 1e-3 * across}, {}, work);
  EXPECT_EQ(answer.report.status, Status::stalled);
  EXPECT_NEAR(answer.position_error, 1e-3, 1e-7);
  EXPECT_NEAR(answer.bends[0].x(), turn, 1e-3);
}

TEST(SerialInverse, ALastDiscThatWouldHaveToBeLongerIsOutOfReach) {
  const SerialRobot robot = nottingham();
  SerialWorkspace work(robot);
  const TipTarget sideways{.position = {0, 0, 0.1749}, .direction = Vec3<double>(3, 0, 0)};
  EXPECT_EQ(inverse(robot, sideways, {}, work).report.status, Status::unreachable);
  EXPECT_NE(inverse(robot, {.position = sideways.position}, {}, work).report.status, Status::unreachable);
}

TEST(SerialInverse,
     TurnsTheTipBackToTheBase) {  // from the opposite direction, where no way round is the shortest
  const SerialRobot robot = nottingham();
  SerialWorkspace work(robot);
  const double bend = std::numbers::pi / 20;
  const SE3<double> end = tip(robot, std::vector<Bend>(5, Bend(bend, 0)));
  const TipTarget target{.position = end.p, .direction = Vec3<double>(0, 0, -1)};
  const SerialInverse answer = inverse(robot, target, {}, work);
  EXPECT_TRUE(answer.ok()) << answer.report.message.view();
  expect_holds(robot, target, answer, work);
}

TEST(SerialInverse, BringsAStartWithinTheLimits) {
  const SerialRobot robot = nottingham();
  SerialWorkspace work(robot);
  const std::vector<Bend> start(5, Bend(2, -3));
  const SerialInverse answer = inverse(robot, {.position = {0.05, 0.02, 0.12}}, {.start = start}, work);
  EXPECT_TRUE(answer.ok());
  EXPECT_TRUE(check_limits(robot, answer.bends).ok());
}

TEST(SerialInverse, FindsSolutionsOfTheReference) {  // every one of them, from starts near it
  const auto& file = test::reference_file("data/field/cc3_fk_and_all_ik.json");
  const auto& solutions = file["ik_all_solutions"]["solutions_xi"];
  const SerialRobot robot = three_arcs();
  SerialWorkspace work(robot);
  const double half = 15 * std::numbers::pi / 32;
  const TipTarget target{
      .position = {-0.4, 1.1, 0.8},
      .rotation =
          SO3<double>{std::cos(half), std::sin(half) * Vec3<double>(0.48, std::sqrt(3.0) / 10, -0.86)}};
  for (const auto& xi : solutions) {
    std::vector<Bend> expected, start;
    for (std::size_t m = 0; m < 3; ++m) {
      expected.emplace_back(xi[2 * m + 1].get<double>(), -xi[2 * m].get<double>());
      start.push_back(expected.back() + Bend(0.05, -0.05));
    }
    const SerialInverse answer = inverse(robot, target, {.start = start}, work);
    ASSERT_TRUE(answer.ok());
    for (std::size_t m = 0; m < 3; ++m) EXPECT_LT((answer.bends[m] - expected[m]).norm(), 2e-9);
  }
  EXPECT_TRUE(inverse(robot, target, {}, work).ok());
}

TEST(SerialInverse, EndsWithNumbersThatAreNone) {
  const SerialRobot robot = nottingham();
  SerialWorkspace work(robot);
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(inverse(robot, {.position = {none, 0, 0}}, {.starts = 4}, work).ok());
}

TEST(SerialInverse, NoDirectionIsNoQuestion) {
  const SerialRobot robot = nottingham();
  SerialWorkspace work(robot);
  const TipTarget target{.position = {0, 0, 0.1}, .direction = Vec3<double>(0, 0, 0)};
  EXPECT_EQ(inverse(robot, target, {.starts = 4}, work).report.status, Status::bad_input);
}

/// The gradient of |A d − r|² + μ|d|², halved.
std::array<double, 24> gradient(const BoundedStep& system, double damping) {
  std::array<double, 24> g{};
  for (int j = 0; j < system.columns; ++j) {
    g[static_cast<std::size_t>(j)] = damping * system.step[j];
    for (int i = 0; i < system.rows; ++i) {
      double missed = -system.r[i];
      for (int k = 0; k < system.columns; ++k) missed += system.A[i][k] * system.step[k];
      g[static_cast<std::size_t>(j)] += system.A[i][j] * missed;
    }
  }
  return g;
}

TEST(BoundedStep, IsTheBestWithinTheBounds) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> any(-1, 1);
  int optimal = 0, all = 0;
  for (const int rows : {3, 5, 6})
    for (int columns = 2; columns <= 24; columns += 2)
      for (int i = 0; i < 100; ++i) {
        BoundedStep system;
        system.rows = rows;
        system.columns = columns;
        for (int k = 0; k < rows; ++k) {
          system.r[k] = any(random);
          for (int j = 0; j < columns; ++j) system.A[k][j] = any(random);
        }
        for (int j = 0; j < columns; ++j) {
          system.low[j] = std::min(0.0, 0.3 * any(random));
          system.high[j] = std::max(0.0, 0.3 * any(random));
        }
        const double damping = 1e-3;
        ASSERT_TRUE(system.solve(damping));
        const auto g = gradient(system, damping);
        bool best = true;
        for (int j = 0; j < columns; ++j) {
          const double slope = g[static_cast<std::size_t>(j)];
          ASSERT_GE(system.step[j], system.low[j]);
          ASSERT_LE(system.step[j], system.high[j]);
          best = best && (system.step[j] == system.high[j] || slope > -1e-9) &&
                 (system.step[j] == system.low[j] || slope < 1e-9);
        }
        optimal += best;
        ++all;
      }
  EXPECT_GE(optimal, all * 99 / 100) << optimal << " of "
                                     << all;  // the others cycled, and are within the bounds
}

}  // namespace serial_inverse_test
}  // namespace sinew::test
