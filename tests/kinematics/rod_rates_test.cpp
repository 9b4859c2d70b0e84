/// Velocities of a platform on rods by rates of its inputs, and the other way round.
#include "sinew/kinematics/equilibrium.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "rod_robots.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::test {
namespace rod_rates_test {

struct Place {
  std::string robot;
  std::vector<double> inputs;
  double spread;  ///< of the inputs
  SpatialWrench wrench = SpatialWrench::Zero();
  double tolerance = 1e-7;
};

SpatialWrench load(double fx, double fz, double mx) {
  SpatialWrench wrench = SpatialWrench::Zero();
  wrench[0] = fx, wrench[2] = fz, wrench[3] = mx;
  return wrench;
}

/// Random inputs, with and without load; rods as good as straight, pulled so, too.
std::vector<Place> places() {
  const std::vector<double> tripod(3, 0.43), hexapod(6, 0.41), mixed = {0.17, 0.17, 0.52};
  return {{"3pfs-g2", tripod, 0.02},
          {"3pfs-g2", tripod, 0.02, load(1, -5, 0.2)},
          {"3pfs-g2", tripod, 1e-8, load(0, 60, 0)},
          {"hexapod", hexapod, 0.01},
          {"hexapod", hexapod, 0.01, load(0.1, -0.5, 0.01)},
          {"hexapod", hexapod, 1e-8, load(0, 20, 0)},
          {"6pfs", std::vector<double>(6, 0.44), 0.01, load(0.5, -1, 0)},
          {"2prs-1pfs", mixed, 0.005, load(1, -2, 0)},
          {"hexapod-torsion", hexapod, 0.005, load(0.1, 0, 0.01), 1e-5}};
}

struct At {
  Robot robot;
  Workspace work;
  SpatialWrench wrench;
  std::vector<double> inputs;
  explicit At(const Place& place, RodRandom& random)
      : robot(v1::load(place.robot).value()),
        work(robot),
        wrench(place.wrench),
        inputs(place.inputs) {
    for (double& input : inputs) input += random.uniform(-place.spread, place.spread);
  }
  SpatialPose pose(const std::vector<double>& rates, double time) {
    std::vector<double> moved = inputs;
    for (std::size_t k = 0; k < moved.size(); ++k) moved[k] += time * rates[k];
    const Equilibrium found = equilibrium(robot, moved, {.wrench = wrench, .warm_start = true}, work);
    EXPECT_TRUE(found.is_solved()) << found.report.message.view();
    return found.pose;
  }
  RodAnalysis analysis() {
    EXPECT_TRUE(equilibrium(robot, inputs, {.wrench = wrench}, work).is_solved());
    return analyse_equilibrium(robot, work);
  }
};

std::vector<double> random_rates(RodRandom& random, std::size_t count) {
  std::vector<double> rates(count);
  for (double& rate : rates) rate = random.uniform(-1, 1);
  return rates;
}

TEST(RodRates, TwistIsWhatThePlatformDoes) {  // by central differences, extrapolated once
  RodRandom random(31);
  for (const Place& place : places())
    for (int k = 0; k < (place.robot == "hexapod-torsion" ? 1 : 5); ++k) {
      At at(place, random);
      const RodAnalysis analysis = at.analysis();
      const SpatialPose here = at.pose(std::vector<double>(at.inputs.size()), 0);
      const std::vector<double> rates = random_rates(random, at.inputs.size());
      std::array<double, 6> twist;
      ASSERT_TRUE(rod_twist(analysis, rates, twist).ok()) << place.robot;
      const auto difference = [&](double h) {
        const Vec<double, 6> ahead = twist_between(here, at.pose(rates, h)),
                             behind = twist_between(here, at.pose(rates, -h));
        return Vec<double, 6>((ahead - behind) / (2 * h));
      };
      constexpr double h = 2e-4;
      const Vec<double, 6> far = difference(h), near = difference(h / 2), expected = (4 * near - far) / 3;
      for (int i = 0; i < 6; ++i)
        EXPECT_NEAR(twist[static_cast<std::size_t>(i)], expected[i], place.tolerance * expected.norm())
            << place.robot << " " << i;
    }
}

TEST(RodRates, RatesAreThoseOfTheTwist) {
  RodRandom random(32);
  for (const Place& place : places()) {
    At at(place, random);
    const RodAnalysis analysis = at.analysis();
    const std::vector<double> rates = random_rates(random, at.inputs.size());
    std::array<double, 6> twist;
    ASSERT_TRUE(rod_twist(analysis, rates, twist).ok());
    std::vector<double> found(rates.size());
    const Report report = rod_rates(analysis, twist, found);
    ASSERT_TRUE(report.ok()) << place.robot << report.message.view();
    for (std::size_t k = 0; k < rates.size(); ++k) EXPECT_NEAR(found[k], rates[k], 1e-7) << place.robot;
    if (rates.size() != 3) continue;
    const std::array<double, 3> held = {twist[2], twist[3], twist[4]};
    ASSERT_TRUE(rod_rates(analysis, held, found).ok());
    for (std::size_t k = 0; k < rates.size(); ++k) EXPECT_NEAR(found[k], rates[k], 1e-9) << place.robot;
  }
}

/// Six inputs follow any twist; three only one in three parts, the rest of which follows.
TEST(RodRates, WhatCannotBeFollowedIsRefused) {
  RodRandom random(33);
  for (const Place& place : places()) {
    At at(place, random);
    const RodAnalysis analysis = at.analysis();
    std::vector<double> found(at.inputs.size());
    const std::array<double, 6> sideways = {1, 0, 0, 0, 0, 0};
    const Report report = rod_rates(analysis, sideways, found);
    if (found.size() == 6) {
      ASSERT_TRUE(report.ok()) << place.robot << report.message.view();
      std::array<double, 6> twist;
      ASSERT_TRUE(rod_twist(analysis, found, twist).ok());
      for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(twist[k], sideways[k], 1e-6) << place.robot;
    } else {
      EXPECT_EQ(report.status, Status::singular) << place.robot;
      EXPECT_NE(report.message.view().find("give three numbers"), std::string_view::npos);
    }
    const std::array<double, 4> four = {};
    EXPECT_EQ(rod_rates(analysis, four, found).status, Status::bad_input);
    EXPECT_EQ(rod_rates({}, sideways, found).status, Status::bad_input);
  }
}

/// Whether each rod holds by itself: an answer asks once.
class Counting : public v1::GeneralSystem {
 public:
  using v1::GeneralSystem::GeneralSystem;
  std::array<int, 2> unstable_with_tip_held(int limb) const override {
    ++asked;
    return v1::GeneralSystem::unstable_with_tip_held(limb);
  }
  mutable int asked = 0;
};

TEST(RodStability, IsCountedOnceAnAnswer) {
  const Robot robot = v1::load("hexapod-torsion").value();
  Workspace work(robot);
  auto counting = std::make_unique<Mechanism<Counting>>(*robot.spatial());
  const Counting& system = *counting;
  work.rods = std::make_unique<RodWork>(std::move(counting));
  const std::vector<double> inputs(6, 0.41), near(6, 0.4101);
  ASSERT_TRUE(equilibrium(robot, inputs, {}, work).is_solved());
  system.asked = 0;
  ASSERT_TRUE(equilibrium(robot, near, {.warm_start = true}, work).is_solved());
  const RodAnalysis counted = analyse_equilibrium(robot, work);
  EXPECT_EQ(system.asked, 6);
  EXPECT_EQ(counted.unstable_rods, analyse_equilibrium(robot, work).unstable_rods);
  EXPECT_EQ(system.asked, 6);
  const RodAnalysis anew = [&] {
    work.rods->signs.reset();
    return analyse_equilibrium(robot, work);
  }();
  EXPECT_EQ(system.asked, 12);
  EXPECT_EQ(counted.unstable_rods, anew.unstable_rods);
  EXPECT_EQ(counted.unstable_directions, anew.unstable_directions);
  const RodAnalysis read = read_rods(robot, work);
  EXPECT_EQ(system.asked, 12);
  EXPECT_EQ(read.energy, anew.energy);
  EXPECT_EQ(read.largest_strain, anew.largest_strain);
  EXPECT_EQ(read.rods.size(), anew.rods.size());
  EXPECT_TRUE(read.feed.empty());
}

}  // namespace rod_rates_test
}  // namespace sinew::test
