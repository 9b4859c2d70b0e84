/// Other equilibria of platforms on arms: each balances, is found again from its shape, and those of a column
/// that buckles are the mirror images and the elastica that they have to be.
#include <gtest/gtest.h>

#include <cmath>

#include "tripods.hpp"

namespace sinew::test::arm_legs_equilibria_test {

using namespace tripods;

/// A column in the plane, clamped at its foot, pushed by a tenth more than it bears upright.
TEST(ArmLegsEquilibria, AColumnThatBucklesStandsUprightOrToEitherSide) {
  ArmLegs robot;
  robot.name = "column";
  robot.is_planar = true;
  robot.home.position = {0, 0.2, 0};
  ArmLeg leg;
  leg.arm = leg_of_sections(1);
  leg.arm.tendons.clear();
  leg.arm.sections[0].length = 0.2;
  leg.arm.sections[0].start.stretch = leg.arm.sections[0].end.stretch = 1e9;
  leg.arm.sections[0].start.shear = leg.arm.sections[0].end.shear = 1e9;
  Mat<double, 3, 3> up;
  up << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  leg.base = {{0, 0, 0}, SO3<double>::from(up)};
  leg.mount = leg.base.R;
  leg.platform_point = {0, 0, 0};
  leg.is_clamped = true;
  robot.legs.push_back(leg);
  const double bending = robot.legs[0].arm.sections[0].start.bending_y,
               euler = std::pow(std::numbers::pi / 0.4, 2) * bending, push = 1.1 * euler;
  const ArmLegsLoad load{.wrench = {0, -push, 0, 0, 0, 0}};
  const ArmOptions options{.max_iterations = 2000};
  ArmLegsWorkspace work(robot), other(robot);
  EXPECT_FALSE(arm_legs_forward(robot, {}, load, options, work).report.ok());
  const auto found = arm_legs_equilibria(robot, {}, load, options, 20, work);
  ASSERT_EQ(found.size(), 3U);
  for (const ArmLegsEquilibrium& one : found) {
    EXPECT_LE(one.state.report.residual, 1e-9);
    const ArmLegsState again = arm_legs_forward_from(robot, one.start, {}, load, options, other);
    EXPECT_EQ(again.report.status, one.state.report.status) << again.report.message.view();
    EXPECT_LT(distance(again.platform, one.state.platform), 1e-6);
    double down = 0;
    for (const auto& tip : one.state.tip_loads) down += tip[1];
    EXPECT_NEAR(down, -push, 1e-8 * push);
  }
  const ArmLegsState &left = found[0].state, &right = found[1].state, &upright = found[2].state;
  EXPECT_TRUE(left.stable && right.stable);
  EXPECT_FALSE(upright.stable);
  EXPECT_EQ(upright.report.status, Status::unstable);
  EXPECT_LT((upright.platform.p - robot.home.position).norm(), 1e-9);
  EXPECT_GT(std::abs(left.platform.p[0]), 0.03);
  EXPECT_NEAR(left.platform.p[0], -right.platform.p[0], 1e-6);
  EXPECT_NEAR(left.platform.p[1], right.platform.p[1], 1e-6);
  EXPECT_NEAR(left.energy, right.energy, 1e-8);
  // The elastica: P/P_e = (2 K(sin(a/2))/π)², where a is the largest angle.
  double largest = 0, at = 0;
  const double end = robot.legs[0].arm.length();
  for (int k = 0; k <= 40; ++k) {
    const double places[] = {end * k / 40};
    arm_legs_forward_from(robot, found[0].start, {}, load, options, other);
    const SE3<double> frame = arm_frames(robot.legs[0].arm, places, arm_legs_shape(other, 0))[0];
    const Vec3<double> way = frame.rotate({0, 0, 1});
    if (const double angle = std::abs(std::atan2(way[0], way[1])); angle > largest)
      largest = angle, at = places[0];
  }
  EXPECT_GT(at, 0.4 * end);
  EXPECT_NEAR(std::pow(2 * std::comp_ellint_1(std::sin(largest / 2)) / std::numbers::pi, 2), 1.1, 2e-3);
}

TEST(ArmLegsEquilibria, WhatForwardFindsIsAmongThem) {
  for (const bool is_clamped : {false, true}) {
    const ArmLegs robot = tripod(is_clamped);
    ArmLegsWorkspace work(robot), other(robot);
    const ArmOptions options{.max_iterations = 2000};
    for (const auto& commands : {uneven, mixed()}) {
      const ArmLegsState one = arm_legs_forward(robot, commands, pushed, options, other);
      ASSERT_TRUE(one.report.ok());
      double nearest = 1;
      for (const auto& each : arm_legs_equilibria(robot, commands, pushed, options, 8, work)) {
        nearest = std::min(nearest, distance(each.state.platform, one.platform));
        const ArmLegsState again = arm_legs_forward_from(robot, each.start, commands, pushed, options, other);
        EXPECT_EQ(again.report.status, each.state.report.status);
        EXPECT_LT(distance(again.platform, each.state.platform), 1e-5);
      }
      EXPECT_LT(nearest, 1e-6);
    }
  }
}

TEST(ArmLegsEquilibria, BadStartsAndQuestionsAreRefused) {
  const ArmLegs robot = tripod(false);
  ArmLegsWorkspace work(robot);
  const double nan = std::nan("");
  const SE3<double> home = SE3<double>::from(robot.home);
  ArmLegsStart start{home, {{{0, 0, 0}}, {{0, 0, 0}}}};
  const auto status = [&] { return arm_legs_forward_from(robot, start, uneven, {}, {}, work).report.status; };
  EXPECT_EQ(status(), Status::bad_input);
  start.curvatures.emplace_back();
  EXPECT_EQ(status(), Status::bad_input);
  start.curvatures.back() = {{0, nan, 0}};
  EXPECT_EQ(status(), Status::bad_input);
  start.curvatures.back() = {{0, 0, 0}};
  EXPECT_EQ(status(), Status::converged);
  start.curvatures.back() = {{1e5, 0, 0}};
  const Status far = status();
  EXPECT_TRUE(far == Status::stalled || far == Status::converged || far == Status::unstable ||
              far == Status::singular || far == Status::left_domain);
  // Numbers that overflow are no equilibrium, whichever leg has them.
  start.curvatures = {{{1e200, 0, 0}}, {{0, 0, 0}}, {{0, 0, 0}}};
  const ArmLegsState beyond = arm_legs_forward_from(robot, start, uneven, {}, {}, work);
  EXPECT_FALSE(beyond.report.is_solved()) << to_string(beyond.report.status);
  start.platform.p[0] = nan;
  EXPECT_EQ(status(), Status::bad_input);
  const auto refused = arm_legs_equilibria(robot, std::vector<TendonCommand>(3), {}, {}, 5, work);
  ASSERT_EQ(refused.size(), 1U);
  EXPECT_EQ(refused[0].state.report.status, Status::bad_input);
}

TEST(ArmLegsEquilibria, ARefusedPathLeavesNoneToGoOnFrom) {
  const ArmLegs robot = tripod(false);
  ArmLegsWorkspace work(robot);
  ASSERT_TRUE(arm_legs_forward(robot, uneven, {}, {}, work).report.ok());
  const std::vector<ArmLegsStep> path(1);  // holds no tendon
  EXPECT_EQ(arm_legs_track(robot, path, {}, work).back().report.status, Status::bad_input);
  const ArmLegsLoadPath grown = arm_legs_follow_load(robot, {0, 0, 1, 0, 0, 0}, 1, work);
  EXPECT_EQ(grown.end, LoadEnd::stalled);
  EXPECT_EQ(grown.load, 0);
}

}  // namespace sinew::test::arm_legs_equilibria_test
