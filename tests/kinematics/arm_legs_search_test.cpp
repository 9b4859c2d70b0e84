/// Searches for equilibria of platforms on arms: the bound on Newton's steps is of a whole search, and a path
/// that passes no fold leads back to where it began.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "tripods.hpp"
#include "uniform.hpp"

namespace sinew::test::arm_legs_search_test {

using namespace tripods;

/// The answer with a bound on iterations.
using Search = std::function<ArmLegsState(int most)>;

/// With as many iterations as a search takes, or more, its answer is the same to the bit; with fewer it says
/// that the bound was met, and has taken no more.
void expect_bound(const Search& search, int least_iterations) {
  const ArmLegsState whole = search(2000);
  const int taken = whole.report.iterations;
  ASSERT_TRUE(whole.report.is_solved()) << whole.report.message.view();
  ASSERT_GE(taken, least_iterations);
  std::vector<int> bounds{1, taken - 1, taken, taken + 1};
  for (int k = 0; k < 8; ++k) bounds.push_back(k * taken / 8);
  for (const int most : bounds) {
    const ArmLegsState state = search(most);
    EXPECT_LE(state.report.iterations, most);
    EXPECT_TRUE(state.platform.p.allFinite());
    if (most < taken) {
      EXPECT_EQ(state.report.status, Status::iteration_limit) << most << " of " << taken;
      EXPECT_FALSE(state.report.message.empty());
      continue;
    }
    EXPECT_EQ(state.report.status, whole.report.status) << most << " of " << taken;
    EXPECT_EQ(state.report.iterations, taken);
    EXPECT_EQ(state.report.residual, whole.report.residual);
    EXPECT_EQ(state.platform.p, whole.platform.p);
    EXPECT_EQ(state.platform.R.v, whole.platform.R.v);
    EXPECT_EQ(state.tensions, whole.tensions);
  }
}

TEST(ArmLegsIterations, AreBoundedFromTheRestAndAtAShape) {
  const ArmLegs robot = tripod(true);
  ArmLegsWorkspace work(robot);
  const ArmOptions fine{.accuracy = 1e-9};
  expect_bound(
      [&](int most) {
        ArmOptions options = fine;
        options.max_iterations = most;
        return arm_legs_forward(robot, mixed(), pushed, options, work);
      },
      8);
  const SE3<double> home = SE3<double>::from(robot.home);
  const ArmLegsStart start{home, {3, {{0, 0, 0}}}};
  expect_bound(
      [&](int most) {
        ArmOptions options = fine;
        options.max_iterations = most;
        return arm_legs_forward_from(robot, start, uneven, pushed, options, work);
      },
      5);
}

/// Grown from the rest with the platform free, then on the way to the pose; of heavy loads first without
/// them.
TEST(ArmLegsIterations, AreBoundedOnTheWayToAPose) {
  const ArmLegs robot = tripod(false);
  ArmLegsWorkspace work(robot), other(robot);
  ArmLegsLoad heavy;
  for (const std::size_t leg : {0U, 1U, 2U})
    heavy.points.push_back({leg, 0.1, {0.2, -0.1, leg == 1 ? -2.0 : -4.0}});
  const SE3<double> near = arm_legs_forward(robot, uneven, {}, {}, other).platform,
                    pose{near.p + Vec3<double>(4e-3, -3e-3, -2e-3), SO3<double>::exp({0.05, -0.05, 0.1})};
  const auto expect_bound_at = [&](const SE3<double>& at, const ArmLegsLoad& load, int least_iterations) {
    expect_bound(
        [&](int most) {
          return arm_legs_hold(robot, at, uneven, load, {.max_iterations = most}, work).state;
        },
        least_iterations);
  };
  expect_bound_at(pose, pushed, 10);
  expect_bound_at(near, heavy, 60);
}

/// Where the way from the last equilibrium gives way the rest is tried with what is left.
TEST(ArmLegsIterations, AreBoundedWhereAWayGivesWay) {
  const ArmLegs robot = upright(false, false);
  const std::vector<TendonCommand> loose(18);
  const ArmLegsLoad left{.wrench = {0.2, 0, -2.0, 0, 0, 0}}, right{.wrench = {-0.2, 0, -2.0, 0, 0, 0}};
  expect_bound(
      [&](int most) {
        ArmLegsWorkspace work(robot);
        EXPECT_TRUE(arm_legs_forward(robot, loose, left, {}, work).report.ok());
        return arm_legs_forward(robot, loose, right, {.max_iterations = most, .from_last = true}, work);
      },
      20);
}

TEST(ArmLegsIterations, AreBoundedOfEveryEquilibriumAndPointOfAPath) {
  const ArmLegs robot = tripod(false);
  ArmLegsWorkspace work(robot);
  std::vector<ArmLegsStep> steps(1);
  steps[0] = {.commands = mixed(), .load = pushed, .divisions = 3};
  for (int most = 0; most < 40; most += most < 12 ? 1 : 7) {
    const ArmOptions options{.max_iterations = most};
    for (const auto& one : arm_legs_equilibria(robot, uneven, pushed, options, 4, work))
      EXPECT_LE(one.state.report.iterations, most);
    const auto points = arm_legs_track(robot, steps, {.arm = options}, work);
    for (const ArmLegsState& point : points) EXPECT_LE(point.report.iterations, most);
    EXPECT_TRUE(points.back().report.ok() || points.back().report.status == Status::iteration_limit);
  }
}

ArmLegsLoad any_load(std::mt19937& random) {
  ArmLegsLoad load;
  for (std::size_t i = 0; i < 6; ++i) load.wrench[i] = uniform(random, -1, 1) * (i < 3 ? 0.3 : 0.01);
  for (double& x : load.following) x = uniform(random, -0.005, 0.005);
  for (double& x : load.along) x = uniform(random, -0.5, 0.5);
  return load;
}
double farthest(const std::vector<double>& a, const std::vector<double>& b) {
  double most = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; most < 1 && i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

/// Every point of the way back is the one of the way there. A fold would end the path, and none does.
TEST(ArmLegsPath, LeadsBackByTheSamePoints) {
  constexpr int parts = 6;
  std::mt19937 random(21);
  for (int k = 0; k < 6; ++k) {
    const ArmLegs robot = tripod(k % 2 == 0);
    ArmLegsWorkspace work(robot);
    const auto first = k < 3 ? mixed() : std::vector<TendonCommand>(18);
    std::vector<ArmLegsStep> steps(3);
    steps[0] = {.commands = first};
    steps[1] = {.commands = k < 3 ? first : uneven, .load = any_load(random), .divisions = parts};
    steps[2] = {.commands = first, .divisions = parts};
    const ArmOptions sharp{.accuracy = 0, .tolerance = 1e-12};
    const auto points = arm_legs_track(robot, steps, {.arm = sharp}, work);
    ASSERT_EQ(points.size(), 1U + 2 * parts) << points.back().report.message.view();
    EXPECT_GT(distance(points[0].platform, points[parts].platform), 1e-3) << k;
    for (std::size_t i = 0; i < parts; ++i) {
      const ArmLegsState &there = points[i], &back = points[2 * parts - i];
      EXPECT_TRUE(there.stable && back.stable);
      EXPECT_LT(distance(there.platform, back.platform), 1e-9) << k << ' ' << i;
      EXPECT_LT(farthest(there.tensions, back.tensions), 1e-7) << k << ' ' << i;
      EXPECT_LT(farthest(there.changes, back.changes), 1e-9) << k << ' ' << i;
    }
  }
}

/// To nearly where a growing load gives way, and from there back without it.
TEST(ArmLegsPath, LeadsBackFromShortOfAFold) {
  for (const bool is_clamped : {false, true}) {
    const ArmLegs robot = tripod(is_clamped);
    ArmLegsWorkspace work(robot);
    const auto first = [&] { return arm_legs_forward(robot, uneven, {}, {}, work); };
    const std::array<double, 6> down{0.1, 0.05, -1, 0, 0, 0};
    const ArmLegsState begun = first();
    const ArmLegsLoadPath whole = arm_legs_follow_load(robot, down, 1000, work);
    ASSERT_TRUE(whole.end == LoadEnd::fold || whole.end == LoadEnd::bifurcation);
    first();
    const ArmLegsLoadPath most = arm_legs_follow_load(robot, down, 0.9 * whole.load, work);
    ASSERT_EQ(most.end, LoadEnd::limit);
    EXPECT_GT(distance(begun.platform, most.state.platform), 0.01);
    const ArmLegsState back = arm_legs_forward(robot, uneven, {}, {.from_last = true}, work);
    ASSERT_TRUE(back.report.ok()) << back.report.message.view();
    EXPECT_TRUE(back.report.message.empty());
    EXPECT_LT(distance(begun.platform, back.platform), 2e-6);
    EXPECT_LT(farthest(begun.changes, back.changes), 2e-6);
  }
}

}  // namespace sinew::test::arm_legs_search_test
