#include "sinew/analysis/velocity.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "every_robot.hpp"
#include "sinew/analysis/shape.hpp"

namespace sinew::test {
namespace velocity_test {

class EveryRobotMoves : public testing::TestWithParam<std::string> {
 protected:
  Robot robot = load(GetParam()).value();
  Workspace work{robot};
  std::mt19937 random{7};
};

TEST_P(EveryRobotMoves, TheWayJAndKSay) {  // @verifies TDPCR (17), (19), (39), (59), (67)
  // @verifies 3PFS (17)-(18)
  int samples = 0;
  while (samples < 100) {
    const AnyPose pose = reachable_pose(robot, random, work);
    ASSERT_TRUE(inverse(robot, pose, {}, work).ok());
    const std::vector<double> inputs = values(work.inputs), coordinates = values(work.coordinates);
    const Velocity v = velocity(robot, pose, coordinates, work);
    if (v.indices.condition_homogenised > 20 || !v.type_1.empty()) continue;
    ++samples;
    const Eigen::MatrixXd U = v.U;
    // Independent: forward kinematics at moved inputs.
    for (std::size_t j = 0; j < inputs.size(); ++j) {
      const double h = 1e-5 / (1 + U.norm());  // the pose moves by 1e-5
      const auto at = [&](double step) {
        std::vector<double> stepped = inputs;
        stepped[j] += step;
        const Forward there = forward(robot, stepped, {.start = pose}, work);
        EXPECT_TRUE(there.ok());
        return motion(pose, there.pose);
      };
      const Eigen::VectorXd slope = (at(h) - at(-h)) / (2 * h);
      EXPECT_LT((slope - U.col(static_cast<Eigen::Index>(j))).norm(), 1e-7 * (1 + U.norm()));
    }
  }
}

TEST_P(EveryRobotMoves, WithTheRatesThatATwistNeeds) {  // @verifies TDPCR (41)
  const AnyPose pose = reachable_pose(robot, random, work);
  ASSERT_TRUE(inverse(robot, pose, {}, work).ok());
  const std::vector<double> coordinates = values(work.coordinates);
  const Velocity v = velocity(robot, pose, coordinates, work);
  std::vector<double> twist;
  for (int i = 0; i < dof(robot); ++i) twist.push_back(0.1 * (i % 2 ? -i : i + 1));
  if (plane_count(robot) > 0) {  // which hinges do not allow
    EXPECT_EQ(rates(v, twist, work).status, Status::singular);
    const Eigen::VectorXd possible = Eigen::MatrixXd(v.U) * Eigen::Vector3d(0.3, -0.2, 0.1);
    twist.assign(possible.begin(), possible.end());
  }
  ASSERT_TRUE(rates(v, twist, work).ok());
  const Eigen::Map<const Eigen::VectorXd> found(work.rates.data(), v.K.cols());
  const Eigen::VectorXd back = Eigen::MatrixXd(v.U) * found;
  for (std::size_t i = 0; i < twist.size(); ++i)
    EXPECT_NEAR(back[static_cast<Eigen::Index>(i)], twist[i], 1e-12);
  // none that does the same is shorter: what is left has no part in the null space of K
  const Eigen::MatrixXd K = Eigen::MatrixXd(v.K).topRows(v.K.rows() - plane_count(robot));
  const Eigen::VectorXd rest =
      found - K.transpose() * (K * K.transpose()).ldlt().solve(Eigen::VectorXd(K * found));
  EXPECT_LT(rest.norm(), 1e-9 * found.norm());
}

INSTANTIATE_TEST_SUITE_P(Builtin, EveryRobotMoves, testing::ValuesIn(builtin_robots(false)),
                         [](const auto& robot) { return "robot_" + std::to_string(robot.index); });

TEST(TypeTwo, LastPoseOfTheExampleIsConcurrentAtItsKnownPoint) {  // TDPCR 5.1
  const Robot robot = rfr_in_code();
  Workspace work(robot);
  const PlanarPose pose{0.03, 0, std::numbers::pi / 3};
  ASSERT_TRUE(inverse(robot, pose, {}, work).ok());
  const Velocity v = velocity(robot, pose, values(work.coordinates), work);
  EXPECT_EQ(v.report.status, Status::singular);
  EXPECT_TRUE(v.type_2.singular);
  EXPECT_EQ(v.type_2.rank, 2);
  EXPECT_EQ(v.type_2.kind, LineClass::concurrent);
  ASSERT_TRUE(v.type_2.point.has_value());
  EXPECT_NEAR(v.type_2.point->x(), 0.03 / (1 - 0.05 / 0.19), 1e-14);  // p/(1 − Rp/Rb)
  EXPECT_NEAR(v.type_2.point->y(), 0, 1e-14);
  EXPECT_EQ(v.U.rows(), 0);
}

TEST(Velocity, NotANumberIsNamed) {
  const Robot robot = rfr_in_code();
  Workspace work(robot);
  EXPECT_EQ(velocity(robot, PlanarPose{0, std::nan(""), 0}, {1, 2, 3}, work).report.status,
            Status::left_domain);
  EXPECT_EQ(velocity(robot, PlanarPose{0, 0, 0}, {1, std::nan(""), 3}, work).report.status,
            Status::left_domain);
}

TEST(TypeOne, AStraightLegOfTheRfrIsLostNotUndefined) {
  const Robot robot = rfr_in_code();
  Workspace work(robot);
  // Put the platform so that leg 1 is straight: forward with its tendon at the backbone's length.
  const Forward there = forward(robot, {0.19, 0.2, 0.19}, {}, work);
  ASSERT_TRUE(there.ok()) << to_string(there.report);
  const Velocity v = velocity(robot, there.pose, values(there.coordinates), work);
  ASSERT_EQ(v.type_1.size(), 1U);
  EXPECT_EQ(v.type_1[0], 1);
  EXPECT_EQ(v.K(1, 1), 0);
  EXPECT_EQ(rates(v, {1, 0, 0}, work).status, Status::singular);
  EXPECT_FALSE(v.type_2.singular);
}

TEST(TypeOne,
     OfAStrutIsWhereTwoSolutionsMergeNotWhereItIsStraight) {  // poses of an independent implementation
  const Robot robot = load("3-frr").value();
  Workspace work(robot);
  const std::array<std::array<double, 2>, 3> merging{
      {{-0.11660045356481855, 6.4429325505368045},
       {0.0834680089743687, 6.0593172943123985},
       {0.2560229770646485, 30.44513830878642}}};  // y, κ of leg 0
  for (const auto& [y, curvature] : merging) {
    const FrrLeg leg = legs_of<FrrLeg>(robot).legs[0];
    const auto at = leg.blocks<double>(Planar::frame({0, y, 0}), leg.link.tip(curvature));
    EXPECT_LT(std::abs(at.error), 1e-14);
    EXPECT_LT(std::abs(at.g_q[0]), 1e-10);
    const Velocity v =
        velocity(robot, PlanarPose{0, y, 0}, {curvature, 3, 3}, work);  // the other legs need not close
    ASSERT_GE(v.type_1.size(), 1U);
    EXPECT_EQ(v.type_1[0], 0);
  }
  const Velocity straight = velocity(robot, PlanarPose{0.03, -0.023680500207804295, 0},
                                     {0, 2.99398137534887, 0.34977812904474725}, work);
  EXPECT_TRUE(straight.type_1.empty());
  EXPECT_NEAR(straight.K(0, 0), -1.9484100091436105, 1e-11);
  EXPECT_LT(straight.report.residual, 1e-14);
}

TEST(Rates, OfTiedLegsAreRefusedWhereTheyWouldDiffer) {
  const Robot robot = rfr_in_code(std::array{-1, -1, 0});
  Workspace work(robot);
  const Forward at = forward(robot, {0.19, 0.19}, {}, work);
  ASSERT_TRUE(at.ok());
  const Velocity v = velocity(robot, at.pose, values(at.coordinates), work);
  EXPECT_EQ(rates(v, {1, 2, 3}, work).status, Status::singular);
  const Eigen::VectorXd possible = Eigen::MatrixXd(v.U) * Eigen::Vector2d(0.3, -0.2);
  ASSERT_TRUE(rates(v, {possible[0], possible[1], possible[2]}, work).ok());
  EXPECT_NEAR(work.rates[0], 0.3, 1e-12);
  EXPECT_NEAR(work.rates[1], -0.2, 1e-12);
}

TEST(Rates, OfLegsOfUnlikeSizeAreAllFollowed) {
  std::vector<RfrLeg> legs = rfr_legs();
  legs[2].link.length = 700;  // beside legs of 0.2 m
  legs[2].base.p = Vec2<double>(650, -100);
  const Robot robot("unlike", ParallelRobot<RfrLeg>(legs, {}, 0.05));
  Workspace work(robot);
  const PlanarPose pose{0.01, 0, 0.1};
  ASSERT_TRUE(inverse(robot, pose, {}, work).ok());
  const Velocity v = velocity(robot, pose, values(work.coordinates), work);
  const Eigen::Vector3d twist(0.1, 0.2, 0.3);
  ASSERT_TRUE(rates(v, {0.1, 0.2, 0.3}, work).ok());
  for (Eigen::Index i = 0; i < 3; ++i)
    EXPECT_NEAR(v.K(i, i) * work.rates[static_cast<std::size_t>(i)] / v.J.row(i).dot(twist), 1, 1e-12);
}

TEST(TypeOne, OfASwivelledLegIsWhereItAndItsStrutAreStraight) {  // whichever angle its motor commands
  const Robot robot = load("3-rfrr").value();
  Workspace work(robot);
  const RfrrLeg leg = legs_of<RfrrLeg>(robot).legs[0];
  const Vec2<double> head = leg.base.p + Vec2<double>(0, -0.23);  // link 150 mm and strut 80 mm in line
  const PlanarPose pose{head.x() - leg.platform_point.x(), head.y() - leg.platform_point.y(), 0};
  const double down = -std::numbers::pi / 2;
  const Velocity v = velocity(robot, pose, {down, 0, 0, 5, 0, 5}, work);  // the other legs need not close
  ASSERT_FALSE(v.type_1.empty());
  EXPECT_EQ(v.type_1[0], 0);
  EXPECT_LT(std::abs(v.K(0, 0)) + std::abs(v.K(0, 1)), 1e-15);
  const Velocity bent = velocity(robot, pose, {down, 1, 0, 5, 0, 5}, work);
  for (const int i : bent.type_1) EXPECT_NE(i, 0);
}

TEST(Velocity, OfTooFewLegsLeavesTheirFreedomOpen) {
  std::vector<RfrLeg> legs = rfr_legs();
  legs.pop_back();
  const Robot robot("2-RFR", ParallelRobot<RfrLeg>(legs, {}, 0.05));
  Workspace work(robot);
  const PlanarPose pose{0.01, 0, 0.1};
  ASSERT_TRUE(inverse(robot, pose, {}, work).ok());
  const std::vector<double> inputs = values(work.inputs), coordinates = values(work.coordinates);
  const Velocity v = velocity(robot, pose, coordinates, work);
  EXPECT_EQ(v.report.status, Status::singular);
  EXPECT_TRUE(v.type_2.singular);
  EXPECT_EQ(v.type_2.rank, 2);
  EXPECT_EQ(v.type_2.kind, LineClass::concurrent);
  EXPECT_EQ(v.J.rows(), 2);
  EXPECT_EQ(v.U.rows(), 0);
  const Forward there = forward(robot, inputs, {.start = PlanarPose{0.02, 0, 0}}, work);
  EXPECT_TRUE(there.ok());
  EXPECT_LT(there.report.residual, 1e-14);
  EXPECT_NE(there.report.message.view().find("2 of the platform's 3"), std::string_view::npos);
}

TEST(Shape, LegsRunFromTheirBaseToTheirPlatformPoint) {
  const Robot robot = rfr_in_code();
  Workspace work(robot);
  const PlanarPose pose{0.01, -0.01, 0.1};
  ASSERT_TRUE(inverse(robot, pose, {}, work).ok());
  const std::vector<double> coordinates = values(work.coordinates), inputs = values(work.inputs);
  const PlanarShape picture = shape(robot, pose, coordinates, 201);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT((picture.backbones[i].front() - picture.base[i]).norm(), 1e-15);
    EXPECT_LT((picture.backbones[i].back() - picture.platform[i]).norm(), 1e-14);
    double length = 0, tendon = 0;
    for (std::size_t k = 1; k < 201; ++k) {
      length += (picture.backbones[i][k] - picture.backbones[i][k - 1]).norm();
      tendon += (picture.tendons[i][0][k] - picture.tendons[i][0][k - 1]).norm();
    }
    EXPECT_NEAR(length, 0.2, 1e-5);
    EXPECT_NEAR(tendon, inputs[i], 1e-5);  // drawn where the model has it
  }
}

}  // namespace velocity_test
}  // namespace sinew::test
