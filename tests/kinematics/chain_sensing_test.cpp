/// The load from tensions: put on, read, and sensed back.
#include "kinematics/chains/chain_sensing.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "chain_robots.hpp"

namespace sinew::test {
namespace chain_sensing_test {

template <class Space>
struct Case {
  ChainLegs<Space> robot;
  ChainState<Space> unloaded;  ///< lengths held
};

template <class Space>
Case<Space> case_of(const char* name, PrbDiscretisation model, const typename Space::Pose& pose) {
  const ChainsAt<Space> at = chains_at<Space>(name, model, pose);
  Case<Space> one{at.robot, {}};
  EXPECT_TRUE(unloaded_equilibrium(one.robot, pose, at.curvature, true, one.unloaded).ok());
  return one;
}

/// Of the first legs, as many as freedoms, or of the last.
template <class Space>
std::vector<MeasuredTension> read(const ChainState<Space>& state, bool of_the_last = false) {
  std::vector<MeasuredTension> measured;
  const std::size_t first = of_the_last ? state.legs.size() - static_cast<std::size_t>(Space::dof) : 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(Space::dof); ++k) {
    const std::size_t i = first + k;
    measured.push_back(
        {static_cast<int>(i), state.legs[i].tension[static_cast<std::size_t>(state.hold[i].length_of)]});
  }
  return measured;
}

template <class Space>
void expect_sensed(const Case<Space>& one, double size, std::mt19937& random) {
  constexpr int dof = Space::dof;
  using Wrench = Vec<double, dof>;
  std::uniform_real_distribution<double> part(-1, 1);
  Wrench wrench;
  for (int k = 0; k < dof; ++k) wrench[k] = size * part(random) * (k < Space::dimension ? 1 : 0.02);
  ChainWork work;
  ChainState<Space> loaded = one.unloaded;
  ASSERT_TRUE(is_equilibrium(equilibrium(one.robot, std::vector(loaded.hold), wrench, loaded, work)));
  for (const bool of_the_last : {false, true}) {
    const auto measured = read(loaded, of_the_last);
    ChainState<Space> state = one.unloaded;
    const auto sensed = sense_wrench(one.robot, measured, state, work);
    ASSERT_TRUE(is_equilibrium(sensed.report)) << to_string(sensed.report);
    EXPECT_LT((state.wrench - wrench).norm(), 1e-9 * std::max(1.0, wrench.norm()));
    EXPECT_LT(twist_between(state.pose, loaded.pose).norm(), 1e-10);
    for (int k = 0; k < dof; ++k) {
      Wrench ends[2];
      for (const int side : {0, 1}) {
        auto moved = measured;
        moved[static_cast<std::size_t>(k)].tension += side == 0 ? -1e-4 : 1e-4;
        ChainState<Space> there = state;
        ASSERT_TRUE(is_equilibrium(sense_wrench(one.robot, moved, there, work).report));
        ends[side] = there.wrench;
      }
      const Wrench slope = (ends[1] - ends[0]) / 2e-4;
      EXPECT_LT((sensed.sensitivity.col(k) - slope).norm(), 1e-6 * slope.norm());
    }
  }
}

TEST(ChainSensing, GivesBackTheLoadThatMadeTheTensions) {
  std::mt19937 random(3);
  for (const PrbDiscretisation model :
       {PrbDiscretisation::even, PrbDiscretisation::weighted, PrbDiscretisation::discs})
    for (const double size : {0.0, 0.01, 0.1}) {
      expect_sensed(case_of<Planar>("3-rfr", model, {0.01, 0, 0.3}), size, random);
      expect_sensed(case_of<Planar>("3-frr", model, {0, 0, 0.1}), 0.1 * size, random);
      expect_sensed(case_of<Spatial>("6-ufs", model, reached_by_6_ufs()), size, random);
    }
}

TEST(ChainSensing, TakesAsManyLegsAsAreMeasured) {
  std::mt19937 random(4);
  Case<Planar> one = case_of<Planar>("3-rfr", PrbDiscretisation::weighted, {0.01, 0, 0.3});
  auto leg = one.robot.legs[0];
  leg.base = SE2<double>::from(-0.15, 0.12, 0);
  leg.platform_point = Vec2<double>(-0.02, 0.05);
  one.robot.legs.push_back(leg);
  ASSERT_TRUE(
      unloaded_equilibrium(one.robot, {0.01, 0, 0.3}, std::vector{5.0, 5.0, 5.0, 5.0}, true, one.unloaded)
          .ok());
  expect_sensed(one, 0.05, random);
}

TEST(ChainSensing, RefusesWhatTellsNothing) {
  const Case<Planar> one = case_of<Planar>("3-rfr", PrbDiscretisation::weighted, {0.01, 0, 0.3});
  ChainWork work;
  const auto status = [&](std::vector<MeasuredTension> measured, ChainState<Planar> state) {
    return sense_wrench(one.robot, measured, state, work).report.status;
  };
  const auto good = read(one.unloaded);
  EXPECT_EQ(status(good, one.unloaded), Status::converged);
  auto bad = good;
  bad.pop_back();
  EXPECT_EQ(status(bad, one.unloaded), Status::bad_input);
  bad = good, bad[1].leg = 0;
  EXPECT_EQ(status(bad, one.unloaded), Status::bad_input);
  for (const int leg : {-1, 3}) {
    bad = good, bad[2].leg = leg;
    EXPECT_EQ(status(bad, one.unloaded), Status::bad_input);
  }
  bad = good, bad[0].tension = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(status(bad, one.unloaded), Status::bad_input);
  bad = good, bad[0].tension = 1e6;  // no load makes it
  EXPECT_EQ(status(bad, one.unloaded), Status::stalled);
  auto held = one.unloaded;
  held.hold[0].length_of = -1;
  EXPECT_EQ(status(good, held), Status::bad_input);
  held = one.unloaded, held.legs.pop_back();
  EXPECT_EQ(status(good, held), Status::bad_input);
}

}  // namespace chain_sensing_test
}  // namespace sinew::test
