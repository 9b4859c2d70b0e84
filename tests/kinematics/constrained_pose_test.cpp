#include "sinew/kinematics/inverse.hpp"

#include <gtest/gtest.h>

#include "every_robot.hpp"

namespace sinew::test {
namespace constrained_pose_test {

using PrsLeg = Leg<Spatial, Rail, SlideDrive, HingedStrut>;

/// How far platform points are beside their planes.
double beside(const Robot& robot, const SpatialPose& pose) {
  double worst = 0;
  const SE3<double> platform = SE3<double>::from(pose);
  for (const PrsLeg& leg : legs_of<PrsLeg>(robot).legs)
    worst = std::max(worst, std::abs(dot(leg.base.rotate(Vec3<double>(1, 0, 0)),
                                         platform.point(leg.platform_point) - leg.base.p)));
  return worst;
}

TEST(ConstrainedPose, OfThe3PrsIsAsPrintedInBothModes) {  // @verifies 3PFS (2), (9)-(10)
  const Robot robot = load("3prs").value();
  std::mt19937 random{1};
  for (int sample = 0; sample < 500; ++sample) {
    const double e1 = uniform(random, -0.7, 0.7), e2 = uniform(random, -0.7, 0.7), z = uniform(random, 0, 1);
    for (const OperationMode mode : {OperationMode::tilt, OperationMode::half_turn}) {
      const ConstrainedPose found = constrained_pose(robot, {z, e1, e2}, mode);
      ASSERT_TRUE(found.ok()) << to_string(found.report);
      EXPECT_NEAR(found.pose.position[0], -2 * 0.125 * e1 * e2, 1e-15);
      EXPECT_NEAR(found.pose.position[1], -0.125 * (e1 * e1 - e2 * e2), 1e-15);
      EXPECT_EQ(found.pose.position[2], z);
      const auto& e = found.pose.quaternion;
      const double sign = (mode == OperationMode::tilt ? e[0] : e[3]) * (e1 * e[1] < 0 ? -1 : 1);
      EXPECT_NEAR(sign, std::sqrt(1 - e1 * e1 - e2 * e2), 1e-14);
      EXPECT_NEAR(mode == OperationMode::tilt ? e[3] : e[0], 0, 1e-15);
      EXPECT_NEAR(std::abs(e[1]), std::abs(e1), 1e-15);
      EXPECT_NEAR(std::abs(e[2]), std::abs(e2), 1e-15);
      EXPECT_LT(beside(robot, found.pose), 1e-15);
    }
  }
}

TEST(ConstrainedPose, OfThreePlanesOfAnyDirection) {
  std::mt19937 random{2};
  int solved = 0;
  for (int sample = 0; sample < 300; ++sample) {
    std::vector<PrsLeg> legs;
    for (int i = 0; i < 3; ++i) {  // a 3PRS, bent out of shape
      const double azimuth = (90 + 120 * i) * std::numbers::pi / 180 + uniform(random, -0.4, 0.4);
      PrsLeg leg{};
      const SO3<double> upright = SO3<double>::exp(Vec3<double>(0, 0, azimuth - std::numbers::pi / 2))
                                      .compose(SO3<double>::exp(Vec3<double>(std::numbers::pi / 2, 0, 0)));
      const auto any = [&] { return uniform(random, -0.2, 0.2); };
      leg.base = {Vec3<double>(0.25 * std::cos(azimuth) + any() / 5, 0.25 * std::sin(azimuth), any()),
                  SO3<double>::exp(Vec3<double>(any(), any(), any())).compose(upright)};
      leg.platform_point = Vec3<double>(0.12 * std::cos(azimuth), 0.12 * std::sin(azimuth), any() / 5);
      leg.closure.length = 0.35;
      legs.push_back(leg);
    }
    const Robot robot("bent 3-PRS", ParallelRobot<PrsLeg>(legs, {}, 0.12));
    const double e1 = uniform(random, -0.3, 0.3), e2 = uniform(random, -0.3, 0.3);
    const ConstrainedPose found = constrained_pose(robot, {0.5, e1, e2});
    if (!found.ok()) continue;
    ++solved;
    EXPECT_LT(beside(robot, found.pose), 1e-13);
    EXPECT_EQ(found.pose.position[2], 0.5);
    EXPECT_NEAR(found.pose.quaternion[1], e1, 1e-15);
    EXPECT_NEAR(found.pose.quaternion[2], e2, 1e-15);
    const ConstrainedPose turned = constrained_pose(robot, {0.5, e1, e2}, OperationMode::half_turn);
    if (turned.ok()) {
      EXPECT_LT(beside(robot, turned.pose), 1e-13);
    }
  }
  EXPECT_GT(solved, 290);
}

TEST(ConstrainedPose, WhatIsNoQuaternionOrNoTripodIsRefused) {
  const Robot robot = load("3prs").value();
  EXPECT_TRUE(constrained_pose(robot, {0.5, 1, 0}).ok());  // both modes in one: e₀ = e₃ = 0
  for (const IndependentPose& wrong :
       {IndependentPose{0.5, 0.8, 0.8}, IndependentPose{0.5, std::nan(""), 0},
        IndependentPose{0.5, 0, std::nan("")}, IndependentPose{std::nan(""), 0, 0}})
    EXPECT_EQ(constrained_pose(robot, wrong).report.status, Status::left_domain);
  EXPECT_EQ(constrained_pose(load("6-ufs").value(), {0.2, 0, 0}).report.status, Status::left_domain);
  EXPECT_EQ(constrained_pose(load("3-rfr").value(), {0.2, 0, 0}).report.status, Status::left_domain);
}

TEST(Settled, IsInThePlanesNearbyAndStaysThere) {
  const Robot robot = load("3prs").value();
  std::mt19937 random{3};
  for (int sample = 0; sample < 300; ++sample) {
    const AnyPose any = pose_near_home(robot, random), there = project_to_constraints(robot, any);
    EXPECT_LT(beside(robot, std::get<SpatialPose>(there)), 1e-14);
    EXPECT_LT(motion(there, project_to_constraints(robot, there)).norm(), 1e-14);
    EXPECT_LT(motion(any, there).norm(), 1.2);  // about as far as home, in the planes too, is from it
  }
  const Robot free = load("6-ufs").value();
  const AnyPose any = pose_near_home(free, random);
  EXPECT_EQ(motion(any, project_to_constraints(free, any)).norm(), 0);
}

}  // namespace constrained_pose_test
}  // namespace sinew::test
