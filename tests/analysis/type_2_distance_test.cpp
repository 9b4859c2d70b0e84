#include "sinew/analysis/singularity.hpp"

#include <gtest/gtest.h>

#include "every_robot.hpp"
#include "sinew/analysis/velocity.hpp"

namespace sinew::test {
namespace type_2_distance_test {

constexpr double degree = std::numbers::pi / 180;

class OfTheRfr : public testing::Test {
 protected:
  TypeTwoDistance along(const PlanarPose& pose, Numbers direction, const TypeTwoSearch& search = {}) {
    return type_2_distance(robot, pose, direction, search, work);
  }
  Robot robot = rfr_in_code();
  Workspace work{robot};
};

/// det J = −(3√3/2) Rb Rp sin ψ (x² + y² − Rb² − Rp² + 2 Rb Rp cos ψ), ψ = φ − 60°.
double closed_form(const PlanarPose& pose, double base = 0.19, double platform = 0.05) {
  const double psi = pose.phi - 60 * degree;
  return -1.5 * std::sqrt(3) * base * platform * std::sin(psi) *
         (pose.x * pose.x + pose.y * pose.y - base * base - platform * platform +
          2 * base * platform * std::cos(psi));
}

TEST_F(OfTheRfr, DeterminantIsTheClosedFormEverywhere) {
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    const AnyPose pose = reachable_pose(robot, random, work);
    ASSERT_TRUE(inverse(robot, pose, {}, work).ok());
    const double found = velocity(robot, pose, values(work.coordinates), work).determinant;
    EXPECT_NEAR(found, closed_form(std::get<PlanarPose>(pose)), 1e-17);
  }
}

TEST_F(OfTheRfr, TurningFromHomeItIsAtSixtyDegrees) {
  const TypeTwoDistance found = along({0, 0, 0}, {0, 0, 1});
  ASSERT_TRUE(found.found) << to_string(found.report);
  EXPECT_NEAR(found.distance, 60 * degree, 1e-14);
  EXPECT_NEAR(std::get<PlanarPose>(found.pose).phi, 60 * degree, 1e-14);
  EXPECT_EQ(found.type_2.kind, LineClass::concurrent);
}

TEST_F(OfTheRfr, ADirectionMayHaveAnyLength) {  // 1e±300 was zero, or no number
  for (const double length : {1e-300, 1e-200, 3e-7, 1e200, 1e300}) {
    const std::array<double, 3> direction{0, 0, length};
    const TypeTwoDistance found = along({0, 0, 0}, direction);
    ASSERT_TRUE(found.found) << length << ' ' << to_string(found.report);
    EXPECT_NEAR(found.distance * length, 60 * degree, 1e-14) << length;
    EXPECT_FALSE(along({0, 0, 0}, direction, {.limit = 50 * degree / length}).found) << length;
  }
}

TEST_F(OfTheRfr, FromAnyPoseItIsAtSixtyDegrees) {  // the only surface within reach
  std::mt19937 random(5);
  int found_ones = 0;
  for (int i = 0; i < 40; ++i) {
    const auto pose = std::get<PlanarPose>(reachable_pose(robot, random, work));
    const std::array<double, 3> direction{uniform(random, -0.03, 0.03), uniform(random, -0.03, 0.03), 1.3};
    const TypeTwoDistance there = along(pose, direction);
    if (!there.found) continue;
    ++found_ones;
    EXPECT_NEAR(there.distance, (60 * degree - pose.phi) / 1.3, 1e-10);
  }
  EXPECT_GT(found_ones, 25);
}

TEST_F(OfTheRfr, TurningBackTheLegsAreStraightBefore) {  // ρ² = Rb² + Rp² − 2 Rb Rp cos ψ = ℓ²
  const double psi = std::acos((0.19 * 0.19 + 0.05 * 0.05 - 0.04) / (2 * 0.19 * 0.05));
  const TypeTwoDistance end = along({0, 0, 0}, {0, 0, -1});
  EXPECT_FALSE(end.found);
  EXPECT_EQ(end.report.status, Status::unreachable);
  EXPECT_TRUE(end.report.message.view().starts_with("legs[")) << end.report.message.view();
  EXPECT_NEAR(end.distance, psi - 60 * degree, 1e-7);
  EXPECT_FALSE(along({0, 0, 90 * degree}, {0, 0, 1}).found);
}

TEST_F(OfTheRfr, BothWaysTheNearerOneIsAnswered) {
  const TypeTwoDistance back = along({0, 0, 90 * degree}, {0, 0, 2}, {.both_ways = true});
  ASSERT_TRUE(back.found);
  EXPECT_NEAR(back.distance, -15 * degree, 1e-13);
  EXPECT_NEAR(along({0, 0, 0}, {0, 0, 1}, {.both_ways = true}).distance, 60 * degree, 1e-13);
}

TEST_F(OfTheRfr, ALimitEndsTheSearchUnlessItIsThere) {
  const TypeTwoDistance before = along({0, 0, 0}, {0, 0, 1}, {.limit = 1});
  EXPECT_FALSE(before.found);
  EXPECT_TRUE(before.report.ok());
  EXPECT_EQ(before.distance, 1);
  EXPECT_EQ(std::get<PlanarPose>(before.pose).phi, 1);
  const TypeTwoDistance there = along({0, 0, 0}, {0, 0, 1}, {.limit = 60 * degree});
  EXPECT_TRUE(there.found);
}

TEST_F(OfTheRfr, ASingularPoseIsAtNoDistance) {
  const TypeTwoDistance here = along({0.01, 0, 60 * degree}, {1, 0, 0});
  EXPECT_TRUE(here.found);
  EXPECT_EQ(here.distance, 0);
}

TEST_F(OfTheRfr, ADirectionOfZeroAndAPoseOutOfReachAreNamed) {
  EXPECT_EQ(along({0, 0, 0}, {0, 0, 0}).report.status, Status::left_domain);
  EXPECT_EQ(along({0, 0, 0}, {0, std::nan(""), 1}).report.status, Status::left_domain);
  const TypeTwoDistance outside = along({1, 0, 0}, {1, 0, 0});
  EXPECT_EQ(outside.report.status, Status::unreachable);
  EXPECT_FALSE(outside.found);
}

TEST(TypeTwoDistance, OfUfsTurningAboutZItIsAtNinetyDegrees) {  // Fichter
  const Robot robot = load("6-ufs").value();
  Workspace work(robot);
  for (const double side : {1.0, -1.0}) {
    const TypeTwoDistance there = type_2_distance(robot, home(robot), {0, 0, 0, 0, 0, side}, {}, work);
    ASSERT_TRUE(there.found) << to_string(there.report);
    EXPECT_NEAR(there.distance, 90 * degree, 1e-12);
    EXPECT_EQ(there.type_2.kind, LineClass::general_complex);
    EXPECT_NEAR(there.type_2.screw->pitch, -side * 0.037754, 1e-6);
  }
}

TEST(TypeTwoDistance, WhereTheDeterminantOnlyTouchesZero) {
  // (x, y) and φ that pass ψ = 0 and turn back exist only for curved paths; here a leg is there twice, so
  // that J has four rows and its volume never changes sign.
  std::vector<RfrLeg> legs = rfr_legs();
  legs.push_back(legs[2]);
  const Robot robot{"four legs", ParallelRobot<RfrLeg>(legs, {}, 0.05, {})};
  Workspace work(robot);
  const TypeTwoDistance there = type_2_distance(robot, PlanarPose{0.01, 0.005, 0.3}, {0, 0, 1}, {}, work);
  ASSERT_TRUE(there.found) << to_string(there.report);
  EXPECT_NEAR(there.distance, 60 * degree - 0.3, 1e-10);
}

TEST(TypeTwoDistance, OfEveryRobotIsTheFirstOneOnItsWay) {
  for (const std::string& name : builtin_robots(false)) {
    const Robot robot = load(name).value();
    Workspace work(robot);
    std::vector<double> turn(static_cast<std::size_t>(dof(robot)));
    (plane_count(robot) > 0 ? turn[4] : turn.back()) = 1;
    const TypeTwoDistance there = type_2_distance(robot, home(robot), turn, {}, work);
    EXPECT_EQ(there.found, there.type_2.singular) << name;
    Track track(robot, {}, work);  // regular until there
    const double end = there.distance - 1e-4;
    for (int k = 0; k <= 200; ++k) {
      const Eigen::VectorXd step =
          Eigen::Map<const Eigen::VectorXd>(turn.data(), std::ssize(turn)) * (end * k / 200);
      ASSERT_TRUE(track.advance(project_to_constraints(robot, moved(home(robot), step))).ok())
          << name << ' ' << k;
      EXPECT_FALSE(velocity(robot, track.pose(), track.coordinates(), work).type_2.singular) << name;
    }
  }
}

TEST(TypeTwoDistance, OfATripodIsWhereItsTiltIsAndNoneWhereItsHingesDoNotLetIt) {
  const Robot robot = load("3prs").value();
  Workspace work(robot);
  // about y: e = (cos, 0, sin, 0) of half the angle, and det (17) = 0 at e₂ = 0.536485
  const TypeTwoDistance there = type_2_distance(robot, home(robot), {0, 0, 0, 0, 1, 0}, {}, work);
  ASSERT_TRUE(there.found) << to_string(there.report);
  EXPECT_NEAR(std::sin(there.distance / 2), 0.536485, 1e-6);
  for (const int axis : {0, 1, 5}) {
    std::vector<double> held(6);
    held[static_cast<std::size_t>(axis)] = 1;
    const TypeTwoDistance none = type_2_distance(robot, home(robot), held, {}, work);
    EXPECT_FALSE(none.found);
    EXPECT_EQ(none.report.status, Status::unreachable);
  }
}

}  // namespace type_2_distance_test
}  // namespace sinew::test
