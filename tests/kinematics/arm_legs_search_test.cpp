/// Searches for equilibria of platforms on arms: the bound on Newton's steps is of a whole search.
#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "tripods.hpp"

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

}  // namespace sinew::test::arm_legs_search_test
