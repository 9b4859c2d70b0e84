#include "sinew/kinematics/inverse.hpp"

#include <gtest/gtest.h>

#include "base/limits.hpp"
#include "every_robot.hpp"
#include "math/linalg.hpp"

namespace sinew::test {
namespace track_test {

/// Smallest singular value of J with unit lines at where a track is.
double distance_from_type_2(const Robot& robot, const Track& track, Workspace& work) {
  const std::vector<double> coordinates = values(track.coordinates());
  const MatrixView lines = homogenise(robot, assemble(robot, track.pose(), coordinates, work), work);
  std::array<double, max_rows> sigma;
  singular_values(lines, sigma);
  return sigma[static_cast<std::size_t>(std::min(lines.rows(), lines.cols())) - 1];
}

class EveryRobotTracks : public testing::TestWithParam<std::string> {
 protected:
  Robot robot = load(GetParam()).value();
  Workspace work{robot};
  std::mt19937 random{11};
};

TEST_P(EveryRobotTracks, AClosedLoopAndComesBackToItsInputs) {  // @verifies TDPCR (41)
  for (int sample = 0; sample < 10; ++sample) {
    const AnyPose home_pose = home(robot), far = reachable_pose(robot, random, work);
    Track track(robot, {}, work);
    ASSERT_TRUE(track.advance(home_pose).ok());
    const std::vector<double> before = values(track.inputs());
    bool gets_there = true;
    for (int k = 1; gets_there && k <= 40; ++k) {
      const double part = k <= 20 ? k / 20.0 : (40 - k) / 20.0;
      const Report report =
          track.advance(part == 1 ? far : project_to_constraints(robot, between(home_pose, far, part)));
      gets_there = report.ok();
      EXPECT_LT(track.closure_error(), 1e-13);
    }
    if (!gets_there) continue;  // the straight way there need not be within reach
    EXPECT_LT(motion(home_pose, track.pose()).norm(), 1e-15);
    // one answer a pose; of a redundant leg up to what steps of this size leave of its null-space motion
    const double tolerance = has_redundant_leg(robot) ? 5e-3 : 1e-12;
    for (std::size_t k = 0; k < before.size(); ++k) EXPECT_NEAR(track.inputs()[k], before[k], tolerance);
  }
}

TEST_P(EveryRobotTracks, TheRatesOfTheDifferentialInverseKinematics) {
  const AnyPose pose = reachable_pose(robot, random, work);
  const AnyPose next =
      project_to_constraints(robot, moved(pose, Eigen::VectorXd::Constant(dof(robot), 1e-6)));
  const Eigen::VectorXd step = motion(pose, next);
  Track track(robot, {}, work);
  ASSERT_TRUE(track.advance(pose).ok());
  const std::vector<double> from = values(track.inputs()), coordinates = values(track.coordinates());
  ASSERT_TRUE(track.advance(next).ok());
  const Reduced at = assemble(robot, pose, coordinates, work);
  Eigen::VectorXd change(from.size());
  for (std::size_t k = 0; k < from.size(); ++k)
    change[static_cast<Eigen::Index>(k)] = track.inputs()[k] - from[k];
  const Eigen::VectorXd gap = Eigen::MatrixXd(at.J) * step - Eigen::MatrixXd(at.K) * change;
  EXPECT_LT(gap.norm(), 1e-4 * (Eigen::MatrixXd(at.J) * step).norm());
}

INSTANTIATE_TEST_SUITE_P(Builtin, EveryRobotTracks, testing::ValuesIn(builtin_robots(false)),
                         [](const auto& robot) { return "robot_" + std::to_string(robot.index); });

TEST(Track, FollowsTheTrajectoryOfTheExampleToItsSingularEnd) {  // TDPCR 5.1
  const Robot robot = load("3-rfr").value();
  Workspace work(robot), other(robot);
  const std::array<int, 3> bending{1, -1, 1};
  Track track(robot, {.branch = {.bending = bending}}, work);
  for (int k = 0; k <= 59; ++k) {
    const double eta = k / 59.0;
    const PlanarPose pose{0.03 * eta, 0, eta * std::numbers::pi / 3};
    ASSERT_TRUE(track.advance(pose).ok()) << k;
    const Inverse alone = inverse(robot, pose, {.bending = bending}, other);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(track.inputs()[i], alone.inputs[i], 1e-14) << k;
  }
}

TEST(Track, PassesStraightLegsOfTheFrrWithoutNotice) {
  const Robot robot = load("3-frr").value();
  Workspace work(robot);
  // κ of leg 0 is 0 at x = 0.03, y = −0.02368; the way leads through
  Track track(robot, {}, work);
  double last = 0;
  bool changed = false;
  for (int k = 0; k <= 40; ++k) {
    ASSERT_TRUE(track.advance(PlanarPose{0.03, -0.01 - 0.03 * k / 40, 0}).ok()) << k;
    const double curvature = track.coordinates()[0];
    if (k > 0) {
      EXPECT_LT(std::abs(curvature - last), 0.6);
      changed = changed || curvature * last < 0;
    }
    last = curvature;
  }
  EXPECT_TRUE(changed);
}

TEST(Track, SaysWhereAPathLeavesTheWorkspace) {
  const Robot robot = rfr_in_code();
  Workspace work(robot);
  Track track(robot, {}, work);
  ASSERT_TRUE(track.advance(PlanarPose{0, 0, 0}).ok());
  const Report report = track.advance(PlanarPose{0, -0.1, 0});
  EXPECT_EQ(report.status, Status::unreachable);
  EXPECT_NE(report.message.view().find("legs[0]"), std::string_view::npos) << report.message.view();
  // leg 0 from (0, 0.19) to b = (0.0433, 0.025) + p has its 0.2 m at y = 0.19 − 0.025 − √(0.2² − b_x²)
  const double b = 0.05 * std::cos(std::numbers::pi / 6);
  const double end = 0.19 - 0.025 - std::sqrt(0.04 - b * b);
  EXPECT_NEAR(track.progress(), end / -0.1, 1e-5);
  EXPECT_NEAR(std::get<PlanarPose>(track.pose()).y, end, 1e-6);
}

TEST(Track, MayEndExactlyAtTheWorkspaceBoundary) {
  const Robot robot = rfr_in_code();
  Workspace work(robot);
  const double b = 0.05 * std::cos(std::numbers::pi / 6);
  const PlanarPose edge{0, std::nextafter(0.19 - 0.025 - std::sqrt(0.04 - b * b), 1), 0};
  Track track(robot, {}, work);
  ASSERT_TRUE(track.advance(PlanarPose{}).ok());
  const Report report = track.advance(edge);
  EXPECT_TRUE(report.ok()) << to_string(report);
  EXPECT_NEAR(track.coordinates()[0], 0, 1e-4);
  EXPECT_TRUE(track.advance(PlanarPose{}).ok());
}

TEST(Track, OfTheStraightWayOverABranchThatEndsStops) {  // the other solution further away is not jumped to
  const Robot robot = load("3-frr").value();
  Workspace work(robot);
  const PlanarPose start{0.0, -0.10, 0};
  std::array<Vec<double, 1>, 8> roots;
  const FrrLeg leg = legs_of<FrrLeg>(robot).legs[0];
  ASSERT_EQ(leg.solutions_at(Planar::frame(start), {}, roots), 2);
  ParallelRobot<FrrLeg> alone({leg}, {}, 0.05);  // one leg of it
  const Robot one("one leg", alone);
  Workspace one_work(one);
  const std::array<double, 1> near{roots[1][0]};
  Track track(one, {.branch = {.curvature = near}}, one_work);
  ASSERT_TRUE(track.advance(start).ok());
  const Report report = track.advance(PlanarPose{0.0, -0.14, 0});
  EXPECT_EQ(report.status, Status::unreachable);
  EXPECT_NEAR(std::get<PlanarPose>(track.pose()).y, -0.11660045356481855, 1e-6);  // reference type I
}

TEST(Track, TurnsAsTheNumbersSayNotTheShortWay) {
  const Robot robot = rfr_in_code();
  Workspace work(robot);
  Track track(robot, {}, work);
  ASSERT_TRUE(track.advance(PlanarPose{0, 0, -0.5}).ok());
  EXPECT_EQ(track.advance(PlanarPose{0, 0, 5.7}).status, Status::unreachable);  // −0.583 is next door
  EXPECT_NEAR(std::get<PlanarPose>(track.pose()).phi, 2.6917, 1e-3);
}

class Redundant : public testing::Test {
 protected:
  Robot robot = load("3-rfrr").value();
  Workspace work{robot};
};

TEST_F(Redundant, GoesOnByItsMotorsWhereALinkCanBendNoFurther) {
  auto legs = legs_of<RfrrLeg>(robot);
  for (RfrrLeg& leg : legs.legs) leg.drive.tendons.offset = 0.1;  // 1/d = 10 1/m
  const Robot stiff("less bent", legs);
  Workspace memory(stiff);
  const std::array<double, 3> bent{9, 9, 9};
  Track track(stiff, {.branch = {.curvature = bent}}, memory);
  for (int k = 0; k <= 39; ++k) {
    const double eta = k / 39.0;
    ASSERT_TRUE(track.advance(PlanarPose{-0.05 * eta, 0.02 * eta, 0.1 * eta}).ok()) << k;
    for (const std::size_t j : {1U, 3U, 5U}) EXPECT_LT(std::abs(track.coordinates()[j]), 10);
  }
}

/// Inputs at a pose about the origin whose struts are turned by `beside` from the platform's radii. At 0 all
/// three meet in its centre: a type II singularity.
std::vector<double> beside_singular(const Robot& robot, const PlanarPose& pose, double beside) {
  std::vector<double> inputs;
  const auto platform = Planar::frame(pose);
  for (const RfrrLeg& leg : legs_of<RfrrLeg>(robot).legs) {
    const Vec2<double> out = platform.rotate(leg.platform_point).normalized();
    const Vec2<double> strut =
        SE2<double>::from(0.0, 0.0, beside).rotate(Vec2<double>(leg.closure.length * out));
    const Vec2<double> chord = platform.point(leg.platform_point) + strut - leg.base.p;
    const double curvature = leg.link.arc().curvature_from_chord(chord.norm());
    const double tangent = std::atan2(chord.y(), chord.x()) + curvature * leg.link.arc().length / 2;
    for (const double a : leg.inputs_of(Vec<double, 2>(tangent, curvature))) inputs.push_back(a);
  }
  return inputs;
}

TEST_F(Redundant, SelfMotionLeavesThePlatformAloneAndBettersTheObjective) {
  const PlanarPose pose{0, 0, 0.35};
  const std::vector<double> start = beside_singular(robot, pose, 0.2);
  for (const Objective objective : {Objective::limits, Objective::singularity}) {
    Track track(robot, {.branch = {.start = start}, .objective = objective}, work);
    ASSERT_TRUE(track.advance(pose).ok());
    const double at_start = distance_from_type_2(robot, track, work), bend = std::abs(track.coordinates()[1]);
    for (int k = 0; k < 80; ++k) {
      ASSERT_TRUE(track.advance(pose).ok());
      EXPECT_LT(track.closure_error(), 1e-13);
    }
    EXPECT_EQ(std::get<PlanarPose>(track.pose()).phi, pose.phi);
    if (objective == Objective::singularity) {
      EXPECT_LT(at_start, 0.4);
      EXPECT_GT(distance_from_type_2(robot, track, work),
                1.2);  // the most three unit lines can have is √(3/2)
    } else {
      EXPECT_LT(std::abs(track.coordinates()[1]), 0.5 * bend);
    }
  }
}

TEST_F(Redundant, AvoidsASingularityThatTheShortestMotionMeets) {
  const PlanarPose first{0, 0, 0.35};
  const std::vector<double> start = beside_singular(robot, first, 0.4);
  const auto worst_on_the_way = [&](Objective objective) {
    Track track(robot, {.branch = {.start = start}, .objective = objective}, work);
    double worst = 2;
    for (int k = 0; k <= 60; ++k) {
      EXPECT_TRUE(track.advance(PlanarPose{0, 0, 0.35 + 0.6 * k / 60}).ok()) << k;
      worst = std::min(worst, distance_from_type_2(robot, track, work));
    }
    return worst;
  };
  EXPECT_LT(worst_on_the_way(Objective::none), 0.02);
  EXPECT_GT(worst_on_the_way(Objective::singularity), 0.5);
}

TEST_F(Redundant, ChangesItsMotionNoMoreThanThePoseAsks) {  // no part of the change is along the null space
  const std::array<double, 3> bent{12, -14, 13};
  const auto idle_change = [&](Objective objective) {
    Track track(robot, {.branch = {.curvature = bent}, .objective = objective}, work);
    std::vector<std::vector<double>> path;
    double worst = 0;
    for (int k = 0; k <= 60; ++k) {
      const double t = 2 * std::numbers::pi * k / 60;
      EXPECT_TRUE(track.advance(PlanarPose{0.02 * std::cos(t), 0.02 * std::sin(t), 0.2 * std::sin(t)}).ok());
      path.push_back(values(track.coordinates()));
      if (k < 2) continue;
      const Reduced at = assemble(robot, track.pose(), path.back(), work);
      for (Eigen::Index leg = 0; leg < 3; ++leg) {
        const auto j = static_cast<std::size_t>(2 * leg), n = path.size();
        const auto change = [&](std::size_t c) {
          return path[n - 1][c] - 2 * path[n - 2][c] + path[n - 3][c];
        };
        const double length = 0.15, lambda = -1 / (0.005 * length);  // ∂κ/∂ℓ₁
        // scaled coordinates (θ, κℓ): the null direction is perpendicular to the row of K
        const Vec2<double> slope(at.K(leg, 2 * leg), at.K(leg, 2 * leg + 1) / (lambda * length));
        const Vec2<double> idle = perp(slope).normalized();
        worst = std::max(worst, std::abs(idle.x() * change(j) + idle.y() * length * change(j + 1)));
      }
    }
    return worst;
  };
  EXPECT_LT(idle_change(Objective::smooth), 0.1 * idle_change(Objective::none));
}

}  // namespace track_test
}  // namespace sinew::test
