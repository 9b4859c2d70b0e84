/// The load on a platform from what its rods pull at their guides.
#include "sinew/kinematics/equilibrium.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "rod_robots.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::test {
namespace force_sensing_test {

/// A platform under a load, and what its rods pull.
struct Loaded {
  explicit Loaded(const char* name) : robot(load(name).value()), work(robot) {}

  /// Lengths that hold it a little beside home without load.
  bool begin(RodRandom& random) {
    const SE3<double> home = SE3<double>::from(std::get<SpatialPose>(sinew::home(robot)));
    const Equilibrium held =
        input_count(robot) == 6
            ? inverse_equilibrium(robot, pose_of(random.near(home, 0.02, 0.1)), {}, work)
            : inverse_equilibrium(robot, IndependentPose{home.p[2] + 0.01, random.uniform(-0.05, 0.05), 0.03},
                                  {}, work);
    inputs.assign(held.inputs.begin(), held.inputs.end());
    return held.report.ok();
  }
  bool press(const SpatialWrench& wrench) {
    const Equilibrium found = equilibrium(robot, inputs, {.wrench = wrench}, work);
    pose = found.pose;
    axial.clear();
    const auto legs = legs_of<RodLeg>(robot).legs;
    const RodAnalysis analysis = analyse_equilibrium(robot, work);
    for (std::size_t k = 0; k < 6; ++k) axial.push_back(dot(legs[k].tangent(), analysis.rods[k].force_0));
    return found.report.ok();
  }

  Robot robot;
  Workspace work;
  std::vector<double> inputs, axial;
  SpatialPose pose;
};

const std::vector<double> deviations = {0.01, 0.02, 0.01, 0.03, 0.01, 0.02};

class ForceSensing : public testing::TestWithParam<const char*> {};

TEST_P(ForceSensing, FindsTheWrenchThatActs) {
  Loaded platform(GetParam());
  Workspace other(platform.robot);
  RodRandom random(3);
  int sensed = 0;
  for (int k = 0; k < 20; ++k) {
    if (!platform.begin(random)) continue;
    const SpatialWrench wrench = random.wrench(0.2, 0.01);
    if (!platform.press(wrench)) continue;
    const SensedWrench found =
        sense_wrench(platform.robot, platform.inputs, platform.axial, deviations, {}, other);
    ASSERT_TRUE(found.report.ok()) << found.report.message.view();
    EXPECT_LT(found.report.residual, 1e-12);
    // how well forces tell is in the sensitivity; stiff rods make forces of the last digits of places
    double size = 1;
    for (const double x : found.sensitivity) size = std::max(size, std::abs(x));
    EXPECT_LT((found.wrench - wrench).lpNorm<Eigen::Infinity>(), 2e-8 * size);
    EXPECT_LT((found.pose.position - platform.pose.position).norm(), 1e-9 * size);
    ++sensed;
  }
  EXPECT_GE(sensed, 15);
}

TEST_P(ForceSensing, SensitivityAndCovarianceAreThoseOfTheForces) {
  Loaded platform(GetParam());
  RodRandom random(5);
  ASSERT_TRUE(platform.begin(random));
  ASSERT_TRUE(platform.press(random.wrench(0.1, 0.005)));
  Workspace other(platform.robot);
  const SensedWrench at =
      sense_wrench(platform.robot, platform.inputs, platform.axial, deviations, {}, other);
  ASSERT_TRUE(at.report.ok());
  double size = 0;
  for (const double x : at.sensitivity) size = std::max(size, std::abs(x));
  Mat<double, 6, 6> sum = Mat<double, 6, 6>::Zero();
  for (std::size_t c = 0; c < 6; ++c) {
    const auto beside = [&](double h) {
      std::vector<double> axial = platform.axial;
      axial[c] += h;
      return sense_wrench(platform.robot, platform.inputs, axial, deviations, {}, other).wrench;
    };
    constexpr double h = 1e-4;
    const SpatialWrench slope = (8 * (beside(h) - beside(-h)) - (beside(2 * h) - beside(-2 * h))) / (12 * h);
    for (std::size_t r = 0; r < 6; ++r)
      EXPECT_NEAR(at.sensitivity[6 * r + c], slope[static_cast<Eigen::Index>(r)], 1e-5 * size);
    sum += deviations[c] * deviations[c] * slope * slope.transpose();
  }
  for (int r = 0; r < 6; ++r)
    for (int c = 0; c < 6; ++c)
      EXPECT_NEAR(at.covariance[std::size_t(6 * r + c)], sum(r, c), 1e-4 * sum.cwiseAbs().maxCoeff());
}

TEST_P(ForceSensing, SaysWhyNot) {
  Loaded platform(GetParam());
  RodRandom random(7);
  ASSERT_TRUE(platform.begin(random));
  ASSERT_TRUE(platform.press(SpatialWrench::Zero()));
  const auto status = [&](std::vector<double> axial) {
    const SensedWrench found =
        sense_wrench(platform.robot, platform.inputs, axial, deviations, {}, platform.work);
    EXPECT_FALSE(found.report.message.view().empty());
    return found.report.status;
  };
  const bool has_six = platform.robot.rod_count() == 6;
  EXPECT_EQ(status({1, 2, 3}), has_six ? Status::bad_input : Status::unsupported);
  EXPECT_EQ(status({1, 2, 3, 4, 5, std::nan("")}), has_six ? Status::bad_input : Status::unsupported);
  EXPECT_NE(status({-1e6, 1e6, -1e6, 1e6, -1e6, 1e6}), Status::converged);
}

INSTANTIATE_TEST_SUITE_P(Robots, ForceSensing,
                         testing::Values("hexapod", "hexapod-heavy", "hexapod-self-weight", "6pfs",
                                         "3pfs-g2"),
                         [](const auto& robot) {
                           std::string name = robot.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace force_sensing_test
}  // namespace sinew::test
