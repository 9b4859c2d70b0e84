/// A platform on arms, beyond forward: warm starts, rates, held poses, inputs for a pose, forces from
/// tensions, paths. Each is put against forward, which tests of its own put against arms alone.
#include <gtest/gtest.h>

#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>
#include <thread>

#include "tripods.hpp"
#include "uniform.hpp"

namespace sinew::test::arm_legs_questions_test {

using namespace tripods;

const ArmOptions sharp{.accuracy = 0, .tolerance = 1e-12};

Vec<double, 6> twist_from(const SE3<double>& from, const SE3<double>& to) {
  Vec<double, 6> twist;
  twist << to.p - from.p, to.R.compose(from.R.inverse()).log();
  return twist;
}
SE3<double> moved(const SE3<double>& from, const Vec<double, 6>& by) {
  return {from.p + by.head<3>(), SO3<double>::exp(Vec3<double>(by.tail<3>())).compose(from.R)};
}
std::vector<TendonCommand> any_tensions(std::mt19937& random, double most, std::size_t count = 18) {
  std::vector<TendonCommand> commands;
  for (std::size_t i = 0; i < count; ++i)
    commands.push_back({TendonHeld::tension, std::max(0.0, uniform(random, -0.5 * most, most))});
  return commands;
}
std::vector<TendonCommand> as_held(const std::vector<double>& values, TendonHeld held) {
  std::vector<TendonCommand> commands;
  for (const double value : values) commands.push_back({held, value});
  return commands;
}
double norm_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum);
}
ArmTarget pose_of(const SE3<double>& pose) {
  return {.position = std::array<double, 3>{pose.p[0], pose.p[1], pose.p[2]},
          .quaternion = spatial_pose(pose).quaternion};
}

TEST(ArmLegsWarm, WalksMeetWhatTheRestGrowsIntoAndAreCheaper) {
  for (const bool is_clamped : {false, true}) {
    const ArmLegs robot = tripod(is_clamped);
    std::mt19937 random(3);
    ArmLegsWorkspace walking(robot), fresh(robot);
    auto commands = mixed();
    ArmOptions warm;
    warm.from_last = true;
    int warm_steps = 0, cold_steps = 0;
    for (int k = 0; k < 30; ++k) {
      for (TendonCommand& command : commands) {
        const double size = command.held == TendonHeld::tension ? 0.05 : 2e-4;
        command.value += uniform(random, -size, size);
        if (command.held == TendonHeld::tension) command.value = std::max(0.0, command.value);
      }
      ArmLegsLoad load = pushed;
      load.wrench[0] += 0.01 * k;
      const ArmLegsState a = arm_legs_forward(robot, commands, load, warm, walking),
                         b = arm_legs_forward(robot, commands, load, {}, fresh);
      ASSERT_TRUE(a.report.ok() && b.report.ok()) << a.report.message.view();
      EXPECT_LT(distance(a.platform, b.platform), 2e-6);
      EXPECT_LE(a.resolution, 1e-6 * 0.2);
      if (k == 0) continue;
      warm_steps += a.report.iterations;
      cold_steps += b.report.iterations;
    }
    EXPECT_LT(warm_steps, 0.7 * cold_steps);
    // what holds a tendon may change: its change is held now, the state stays
    const ArmLegsState before = arm_legs_forward(robot, commands, {}, warm, walking);
    const ArmLegsState after =
        arm_legs_forward(robot, as_held(before.changes, TendonHeld::change), {}, warm, walking);
    ASSERT_TRUE(after.report.ok());
    EXPECT_LT(distance(before.platform, after.platform), 1e-7);
  }
}

TEST(ArmLegsWarm, WhereTheWayGivesWayTheRestIsTakenAndThatIsSaid) {
  const ArmLegs robot = upright(false, false);
  ArmLegsWorkspace work(robot), fresh(robot);
  const std::vector<TendonCommand> loose(18);
  ArmOptions warm;
  warm.from_last = true;
  // bent by forces aside, and pressed: from there to one that bends it the other way there is none between
  const ArmLegsLoad left{.wrench = {0.2, 0, -2.0, 0, 0, 0}}, right{.wrench = {-0.2, 0, -2.0, 0, 0, 0}};
  ASSERT_TRUE(arm_legs_forward(robot, loose, left, {}, work).report.ok());
  const ArmLegsState there = arm_legs_forward(robot, loose, right, warm, work);
  const ArmLegsState cold = arm_legs_forward(robot, loose, right, {}, fresh);
  ASSERT_TRUE(there.report.ok() && cold.report.ok()) << there.report.message.view();
  EXPECT_FALSE(there.report.message.empty());
  EXPECT_LT(distance(there.platform, cold.platform), 1e-6);
  // nothing to go on from: as without
  ArmLegsWorkspace empty(robot);
  const ArmLegsState first = arm_legs_forward(robot, loose, left, warm, empty);
  EXPECT_TRUE(first.report.ok());
  EXPECT_TRUE(first.report.message.empty());
}

TEST(ArmLegsRates, WhatTendonsAnswerMatchesDifferences) {
  for (const bool is_clamped : {false, true}) {
    const ArmLegs robot = tripod(is_clamped);
    const auto commands = mixed();
    ArmLegsWorkspace work(robot), other(robot);
    const ArmLegsState at = arm_legs_forward(robot, commands, pushed, sharp, work);
    const ArmLegsRates rates = arm_legs_rates(robot, work);
    ASSERT_TRUE(rates.regular && rates.has_stiffness);
    const auto answer = [&](const ArmLegsState& state, std::size_t i) {
      return commands[i].held == TendonHeld::tension ? state.changes[i] : state.tensions[i];
    };
    const auto compare = [&](const ArmLegsState& up, const ArmLegsState& down, double by,
                             const std::vector<double>& twists, const std::vector<double>& answers,
                             std::size_t columns, std::size_t column) {
      const Vec<double, 6> twist = twist_from(down.platform, up.platform) / by;
      for (std::size_t j = 0; j < 6; ++j)
        EXPECT_NEAR(twists[j * columns + column], twist[static_cast<int>(j)], 1e-3 * twist.norm() + 1e-6);
      double largest = 1e-6;
      for (std::size_t i = 0; i < 18; ++i)
        largest = std::max(largest, std::abs(answer(up, i) - answer(down, i)) / by);
      for (std::size_t i = 0; i < 18; ++i)
        EXPECT_NEAR(answers[i * columns + column], (answer(up, i) - answer(down, i)) / by,
                    1e-3 * largest + 1e-6)
            << i << ' ' << column;
    };
    for (std::size_t k = 0; k < 18; ++k) {
      const bool by_tension = commands[k].held == TendonHeld::tension;
      if (by_tension && commands[k].value == 0) continue;
      const double h = by_tension ? 1e-4 : 1e-6;
      auto up = commands, down = commands;
      up[k].value += h, down[k].value -= h;
      const ArmLegsState a = arm_legs_forward(robot, up, pushed, sharp, other),
                         b = arm_legs_forward(robot, down, pushed, sharp, other);
      compare(a, b, 2 * h, rates.J, rates.answers, 18, k);
    }
    for (std::size_t k = 0; k < 6; ++k) {
      const double h = k < 3 ? 1e-4 : 1e-5;
      ArmLegsLoad up = pushed, down = pushed;
      up.wrench[k] += h, down.wrench[k] -= h;
      const ArmLegsState a = arm_legs_forward(robot, commands, up, sharp, other),
                         b = arm_legs_forward(robot, commands, down, sharp, other);
      compare(a, b, 2 * h, rates.compliance, rates.answers_by_wrench, 6, k);
    }
    EXPECT_LT(distance(at.platform, arm_legs_forward(robot, commands, pushed, sharp, other).platform), 1e-10);
  }
}

TEST(ArmLegsHold, HeldWhereForwardIsTakesTheWrenchThatForwardHad) {
  for (const bool is_clamped : {false, true}) {
    const ArmLegs robot = tripod(is_clamped);
    for (const auto& commands : {uneven, mixed()}) {
      ArmLegsWorkspace work(robot), other(robot);
      const ArmLegsState free = arm_legs_forward(robot, commands, pushed, sharp, work);
      const ArmLegsHeld held = arm_legs_hold(robot, free.platform, commands, {}, sharp, other);
      ASSERT_TRUE(held.state.report.ok()) << held.state.report.message.view();
      EXPECT_TRUE(held.state.stable);
      for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(held.wrench[i], pushed.wrench[i], 1e-6);
      for (std::size_t i = 0; i < 18; ++i) EXPECT_NEAR(held.state.tensions[i], free.tensions[i], 1e-6);
      // what acts on it already does not have to be brought
      const ArmLegsHeld less = arm_legs_hold(robot, free.platform, commands, pushed, sharp, other);
      for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(less.wrench[i], 0, 1e-6);
    }
  }
}

TEST(ArmLegsHold, AnotherPoseIsHeldByWhatForwardThenBears) {
  for (const bool is_clamped : {false, true}) {
    const ArmLegs robot = tripod(is_clamped);
    ArmLegsWorkspace work(robot), other(robot);
    const SE3<double> free = arm_legs_forward(robot, mixed(), {}, sharp, work).platform;
    Vec<double, 6> by;
    by << 1e-3, -1e-3, 0.5e-3, 0.01, -0.01, 0.02;
    const SE3<double> pose = moved(free, by);
    const ArmLegsHeld held = arm_legs_hold(robot, pose, mixed(), pushed, sharp, work);
    ASSERT_TRUE(held.state.report.ok()) << held.state.report.message.view();
    EXPECT_LT(distance(held.state.platform, pose), 1e-12);
    ArmLegsLoad all = pushed;
    for (std::size_t i = 0; i < 6; ++i) all.wrench[i] += held.wrench[i];
    ASSERT_TRUE(held.state.stable);
    const ArmLegsState borne = arm_legs_forward(robot, mixed(), all, sharp, other);
    ASSERT_TRUE(borne.report.ok()) << borne.report.message.view();
    EXPECT_LT(distance(borne.platform, pose), 1e-7);
    // its rate is the stiffness
    const ArmLegsRates rates = arm_legs_rates(robot, work);
    ASSERT_TRUE(rates.has_stiffness);
    for (int k = 0; k < 6; ++k) {
      Vec<double, 6> small = Vec<double, 6>::Zero();
      small[k] = 1e-6;
      const auto up = arm_legs_hold(robot, moved(pose, small), mixed(), pushed, sharp, other),
                 down = arm_legs_hold(robot, moved(pose, -small), mixed(), pushed, sharp, other);
      for (std::size_t i = 0; i < 6; ++i) {
        const double rate = rates.stiffness[6 * i + static_cast<std::size_t>(k)];
        EXPECT_NEAR((up.wrench[i] - down.wrench[i]) / 2e-6, rate, 1e-3 * std::abs(rate) + 2e-2) << i << k;
      }
    }
  }
}

/// The way to the pose begins with a free platform; where legs do not bear one under the loads, with less of
/// them, and the rest comes while the platform is held.
TEST(ArmLegsHold, LegsBearWhatAFreePlatformDoesNot) {
  const ArmLegs robot = tripod(false);
  ArmLegsLoad light, heavy;
  for (const std::size_t leg : {0U, 1U, 2U})
    heavy.points.push_back({leg, 0.1, {0.2, -0.1, leg == 1 ? -2.0 : -4.0}});
  ArmLegsWorkspace work(robot), other(robot);
  const SE3<double> pose = arm_legs_forward(robot, uneven, light, {}, work).platform;
  ArmOptions options;
  options.max_iterations = 2000;
  EXPECT_FALSE(arm_legs_forward(robot, uneven, heavy, options, other).report.ok());
  const ArmLegsHeld held = arm_legs_hold(robot, pose, uneven, heavy, options, other);
  ASSERT_TRUE(held.state.report.ok()) << held.state.report.message.view();
  Vec<double, 6> sum = Vec<double, 6>::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& tip = held.state.tip_loads[k];
    const Vec3<double> force(tip[0], tip[1], tip[2]);
    sum.head<3>() += force;
    sum.tail<3>() += cross(Vec3<double>(pose.rotate(robot.legs[k].platform_point)), force);
  }
  sum[2] += robot.platform_mass * 9.81;
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(held.wrench[i], sum[static_cast<int>(i)], 1e-9);
  // The same by way of a platform that is held there first, to which the loads come then.
  ASSERT_TRUE(arm_legs_hold(robot, pose, uneven, light, {}, work).state.report.ok());
  options.from_last = true;
  const ArmLegsHeld then = arm_legs_hold(robot, pose, uneven, heavy, options, work);
  ASSERT_TRUE(then.state.report.ok()) << then.state.report.message.view();
  EXPECT_TRUE(then.state.report.message.empty());
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(then.wrench[i], held.wrench[i], 2e-4);
}

TEST(ArmLegsHold, WhyAPlatformIsNotHeldIsSaid) {
  const ArmLegs robot = tripod(false);
  ArmLegsWorkspace work(robot);
  const auto says = [&](const SE3<double>& pose, const ArmLegsLoad& load, ArmModel model) {
    ArmOptions options;
    options.model = model;
    options.max_iterations = 2000;
    const Report report =
        arm_legs_hold(robot, pose, std::vector<TendonCommand>(18), load, options, work).state.report;
    EXPECT_EQ(report.status, Status::stalled);
    return std::string(report.message.view());
  };
  const SE3<double> far = SE3<double>::from({{0.02, 0, 0.2}, {1, 0.1, 0, 0}});
  EXPECT_NE(
      says(far, {}, ArmModel::subsegment_rod).find("out of reach: from its base to the platform it is 0.2"),
      std::string::npos);
  ArmLegsLoad much;
  much.points = {{0, 0.1, {0, 0, -1e4}}};
  for (const std::string& message : {says({{0, 0, 0.18}, {}}, much, ArmModel::subsegment_rod),
                                     says({{0, 0, 0.18}, {}}, much, ArmModel::cc)}) {
    EXPECT_NE(message.find("of the way to the pose"), std::string::npos) << message;
    EXPECT_NE(message.find(": "), std::string::npos) << message;
  }
}

/// Loads that follow are named where not even the first of them is borne.
TEST(ArmLegsForward, LoadsWithoutAPotentialAreNamedAtTheBeginning) {
  const ArmLegs robot = tripod(false);
  ArmLegsWorkspace work(robot);
  ArmLegsLoad load;
  load.following_along = {1e5, 0, -1e6};
  ArmOptions options;
  options.max_iterations = 200;
  const Report report = arm_legs_forward(robot, std::vector<TendonCommand>(18), load, options, work).report;
  ASSERT_EQ(report.status, Status::stalled) << to_string(report);
  EXPECT_NE(report.message.view().find("no potential"), std::string_view::npos) << report.message.view();
}

/// A search that is stopped says so, wherever it is.
TEST(ArmLegsInverse, StopsWhereverItIs) {
  const ArmLegs robot = tripod(false);
  ArmTarget far;
  far.position = {0.5, 0, 0.1};
  for (int wait = 0; wait < 60; wait += 3) {
    ArmLegsWorkspace work(robot);
    std::atomic<bool> stop = false;
    work.stop = StopToken(stop);
    std::thread stopper([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(wait));
      stop = true;
    });
    const Report report = arm_legs_inverse(robot, far, {}, {}, work).report;
    const bool had_ended = !stop;
    stopper.join();
    EXPECT_TRUE(report.status == Status::stopped || had_ended) << wait << ": " << to_string(report);
  }
}

TEST(ArmLegsHold, WhatLegsDoNotReachIsSaid) {
  const ArmLegs robot = tripod(false);
  ArmLegsWorkspace work(robot);
  for (const double z : {0.4, -0.2, 1e6}) {
    const ArmLegsHeld held = arm_legs_hold(robot, {{0, 0, z}, {}}, uneven, {}, {}, work);
    EXPECT_FALSE(held.state.report.ok()) << z;
    EXPECT_FALSE(held.state.report.message.empty());
  }
  EXPECT_EQ(arm_legs_hold(robot, {{0, 0, std::nan("")}, {}}, uneven, {}, {}, work).state.report.status,
            Status::bad_input);
}

/// Least squares of T ≥ 0 that keep the pose: T = max(0, Jᵀλ) of some λ.
double off_least(const std::vector<double>& T, const std::vector<double>& J) {
  const auto m = static_cast<Eigen::Index>(T.size());
  const Eigen::Map<const Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>> rows(J.data(), 6, m);
  const double size = norm_of(T);
  std::vector<Eigen::Index> pull;
  for (Eigen::Index i = 0; i < m; ++i)
    if (T[static_cast<std::size_t>(i)] > 2e-3 * size) pull.push_back(i);
  Eigen::MatrixXd A(static_cast<Eigen::Index>(pull.size()), 6);
  Eigen::VectorXd b(A.rows());
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    A.row(i) = rows.col(pull[static_cast<std::size_t>(i)]).transpose();
    b[i] = T[static_cast<std::size_t>(pull[static_cast<std::size_t>(i)])];
  }
  const Eigen::VectorXd lambda = A.colPivHouseholderQr().solve(b);
  double off = 0;
  for (Eigen::Index i = 0; i < m; ++i) {
    const double least = std::max(0.0, rows.col(i).dot(lambda));
    off = std::max(off, std::abs(least - T[static_cast<std::size_t>(i)]) / size);
  }
  return off;
}

TEST(ArmLegsInverse, TensionsHoldThePoseAndAreTheLeast) {
  for (const bool is_clamped : {false, true}) {
    const ArmLegs robot = tripod(is_clamped);
    std::mt19937 random(5);
    int count = 0;
    for (int k = 0; k < 8; ++k) {
      ArmLegsWorkspace work(robot), other(robot);
      const auto commands = any_tensions(random, 1.2);
      const ArmLegsState asked = arm_legs_forward(robot, commands, pushed, {}, other);
      if (!asked.report.ok()) continue;
      ++count;
      const ArmLegsInverse found = arm_legs_inverse(robot, pose_of(asked.platform), pushed, {}, work);
      ASSERT_TRUE(found.report.ok()) << k << ' ' << found.report.message.view();
      EXPECT_LE(found.report.residual, 1e-7);
      EXPECT_LE(norm_of(found.state.tensions), norm_of(asked.tensions) * (1 + 1e-3)) << k;
      for (const double tension : found.state.tensions) EXPECT_GE(tension, 0);
      EXPECT_LT(off_least(found.state.tensions, arm_legs_rates(robot, work).J), 0.1) << k;
      // forward from rest, and with the changes held
      for (const TendonHeld held : {TendonHeld::tension, TendonHeld::change}) {
        const auto back =
            as_held(held == TendonHeld::tension ? found.state.tensions : found.state.changes, held);
        const ArmLegsState there = arm_legs_forward(robot, back, pushed, {}, other);
        ASSERT_TRUE(there.report.ok());
        EXPECT_LT(distance(there.platform, asked.platform), 2e-6) << k;
      }
    }
    EXPECT_GE(count, 6);
  }
}

TEST(ArmLegsInverse, WhatIsNotAskedIsFreeAndLimitsAreKept) {
  const ArmLegs robot = tripod(false);
  ArmLegsWorkspace work(robot);
  const ArmLegsState asked = arm_legs_forward(robot, uneven, {}, {}, work);
  const ArmTarget whole = pose_of(asked.platform);
  const ArmLegsInverse all = arm_legs_inverse(robot, whole, {}, {}, work),
                       some = arm_legs_inverse(robot, {.position = whole.position}, {}, {}, work);
  ASSERT_TRUE(all.report.ok() && some.report.ok()) << all.report.message.view();
  EXPECT_LT((some.state.platform.p - asked.platform.p).norm(), 1e-7);
  EXPECT_LT(norm_of(some.state.tensions), norm_of(all.state.tensions));
  ArmInverseOptions options;
  options.most_tension = 0.9 * *std::ranges::max_element(all.state.tensions);
  const ArmLegsInverse less = arm_legs_inverse(robot, whole, {}, options, work);
  ASSERT_TRUE(less.report.ok()) << less.report.message.view();
  EXPECT_LE(*std::ranges::max_element(less.state.tensions), options.most_tension * (1 + 1e-12));
  // from where it is
  options = {};
  options.arm.from_last = true;
  const ArmLegsInverse again = arm_legs_inverse(robot, whole, {}, options, work);
  EXPECT_TRUE(again.report.ok());
}

TEST(ArmLegsInverse, WhatIsOutOfReachIsSaidInTime) {
  const ArmLegs robot = tripod(false);
  ArmLegsWorkspace work(robot);
  for (const ArmTarget& target : {ArmTarget{.position = std::array<double, 3>{0, 0, 1}},
                                  ArmTarget{.position = std::array<double, 3>{0.2, 0, 0.2},
                                  .direction = std::array<double, 3>{0, 0, 1}},
                                  ArmTarget{.position = std::array<double, 3>{0, 0, 0.19},
                                  .quaternion = std::array<double, 4>{0, 0, 0, 1}}}) {
    const ArmLegsInverse found = arm_legs_inverse(robot, target, {}, {}, work);
    EXPECT_EQ(found.report.status, Status::unreachable) << found.report.message.view();
  }
  EXPECT_EQ(arm_legs_inverse(robot, {}, {}, {}, work).report.status, Status::bad_input);
}

/// Where the way back from a step that failed gives way, too, what was found before still counts; where
/// nothing was, that is said.
TEST(ArmLegsInverse, WhereASearchBeginsIsNotLost) {
  const ArmLegs robot = tripod(false);
  ArmLegsWorkspace work(robot);
  ArmInverseOptions options;
  options.arm.max_iterations = 2000;
  const ArmTarget target{.position = std::array<double, 3>{0, 0, 0.19}};
  const ArmLegsInverse pressed =
      arm_legs_inverse(robot, target, {.wrench = {0, 0, -30, 0, 0, 0}}, options, work);
  EXPECT_EQ(pressed.report.status, Status::unreachable) << pressed.report.message.view();
  EXPECT_TRUE(pressed.state.report.ok());
  EXPECT_NEAR(pressed.state.tip_loads[0][2] + pressed.state.tip_loads[1][2] + pressed.state.tip_loads[2][2],
              -30 - 0.02 * 9.81, 1e-6);
  ArmLegsLoad much;
  much.points = {{0, 0.1, {0, 0, -1e9}}};
  const Report none = arm_legs_inverse(robot, target, much, options, work).report;
  EXPECT_EQ(none.status, Status::stalled);
  EXPECT_NE(none.message.view().find("nowhere to begin"), std::string_view::npos) << none.message.view();
}

TEST(ArmLegsSense, ForwardsWrenchIsFoundAgain) {
  for (const bool is_clamped : {false, true}) {
    const ArmLegs robot = tripod(is_clamped);
    ArmLegsWorkspace work(robot), other(robot);
    const ArmLegsState pulled = arm_legs_forward(robot, uneven, {}, {}, work);
    const auto held = as_held(pulled.changes, TendonHeld::change);
    const ArmLegsState state = arm_legs_forward(robot, held, pushed, {}, work);
    ASSERT_TRUE(state.report.ok());
    // by what tendons pull
    ArmLegsMeasurement measured{.held = held, .answers = state.tensions};
    const ArmLegsSensed by_tensions = arm_legs_sense(robot, measured, {}, false, {}, other);
    ASSERT_TRUE(by_tensions.report.ok()) << by_tensions.report.message.view();
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(by_tensions.wrench[i], pushed.wrench[i], 1e-4) << i;
    EXPECT_LT(by_tensions.misfit, 1e-3);
    EXPECT_GT(by_tensions.condition, 1);
    // by where the platform is
    const auto& p = state.platform.p;
    measured.answers.clear();
    measured.position = std::array<double, 3>{p[0], p[1], p[2]};
    measured.quaternion = spatial_pose(state.platform).quaternion;
    const ArmLegsSensed by_pose = arm_legs_sense(robot, measured, {}, false, {}, other);
    ASSERT_TRUE(by_pose.report.ok()) << by_pose.report.message.view();
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(by_pose.wrench[i], pushed.wrench[i], 1e-3) << i;
    // the force alone, where there is no moment, from all that is known, beside what is known to act
    ArmLegsLoad known{.wrench = {0, 0, -0.1, 0, 0, 0}}, force{.wrench = {0.05, -0.1, -0.2, 0, 0, 0}};
    const ArmLegsState forced = arm_legs_forward(robot, held, force, {}, work);
    measured = {.held = held, .answers = forced.tensions};
    const ArmLegsSensed alone = arm_legs_sense(robot, measured, known, true, {}, other);
    ASSERT_TRUE(alone.report.ok());
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(alone.wrench[i], force.wrench[i] - known.wrench[i], 1e-4);
    EXPECT_EQ(alone.wrench[4], 0);
  }
}

TEST(ArmLegsSense, ErrorsSpreadAsTheCovarianceSays) {
  const ArmLegs robot = tripod(false);
  ArmLegsWorkspace work(robot);
  const ArmLegsState pulled = arm_legs_forward(robot, uneven, {}, {.accuracy = 0}, work);
  const auto held = as_held(pulled.changes, TendonHeld::change);
  const ArmLegsState state = arm_legs_forward(robot, held, pushed, {.accuracy = 0}, work);
  ASSERT_TRUE(state.report.ok());
  std::mt19937 random(8);
  std::normal_distribution<double> error(0, 1e-3);
  ArmLegsMeasurement measured{.held = held, .answers = state.tensions};
  measured.tension_deviation = 1e-3;
  ArmOptions options{.accuracy = 0};
  const ArmLegsSensed exact = arm_legs_sense(robot, measured, {}, false, options, work);
  options.from_last = true;
  std::array<double, 6> squares{};
  constexpr int tries = 100;
  for (int k = 0; k < tries; ++k) {
    for (std::size_t i = 0; i < 18; ++i)  // a slack tendon is known to be slack
      measured.answers[i] = state.tensions[i] + (state.tensions[i] > 0 ? error(random) : 0);
    const ArmLegsSensed sensed = arm_legs_sense(robot, measured, {}, false, options, work);
    ASSERT_TRUE(sensed.report.ok()) << sensed.report.message.view();
    for (std::size_t i = 0; i < 6; ++i)
      squares[i] += (sensed.wrench[i] - exact.wrench[i]) * (sensed.wrench[i] - exact.wrench[i]) / tries;
  }
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(std::sqrt(squares[i] / exact.covariance[7 * i]), 1, 0.25) << i;
}

TEST(ArmLegsSense, TooLittleIsRefused) {
  const ArmLegs robot = tripod(false);
  ArmLegsWorkspace work(robot);
  ArmLegsMeasurement measured{.held = uneven};
  const auto status = [&](bool force_alone = false) {
    return arm_legs_sense(robot, measured, {}, force_alone, {}, work).report.status;
  };
  EXPECT_EQ(status(), Status::bad_input);
  measured.position = std::array<double, 3>{0, 0, 0.19};
  EXPECT_EQ(status(), Status::bad_input);
  measured.quaternion = std::array<double, 4>{0, 0, 0, 0};
  EXPECT_EQ(status(), Status::bad_input);
  measured.quaternion.reset();
  measured.answers.assign(17, 0);
  EXPECT_EQ(status(), Status::bad_input);
  measured.answers.clear();
  measured.position_deviation = 0;
  EXPECT_EQ(status(true), Status::bad_input);
}

TEST(ArmLegsTrack, PathsOfInputsLoadsAndPosesArrive) {
  for (const bool is_clamped : {false, true}) {
    const ArmLegs robot = tripod(is_clamped);
    ArmLegsWorkspace work(robot), other(robot);
    const SE3<double> pose = arm_legs_forward(robot, uneven, {}, {}, other).platform;
    std::vector<ArmLegsStep> steps(4);
    steps[0] = {.commands = mixed(), .divisions = 4};
    steps[1] = {.commands = mixed(), .load = pushed, .divisions = 3};
    steps[2] = {.pose = pose, .divisions = 5};
    steps[3] = {.commands = uneven, .divisions = 2};
    const auto points = arm_legs_track(robot, steps, {}, work);
    ASSERT_EQ(points.size(), 14U) << points.back().report.message.view();
    const auto compare = [&](std::size_t at, const auto& commands, const ArmLegsLoad& load) {
      const ArmLegsState cold = arm_legs_forward(robot, commands, load, {}, other);
      ASSERT_TRUE(points[at].report.ok() && cold.report.ok());
      EXPECT_LT(distance(points[at].platform, cold.platform), 2e-6) << at;
    };
    compare(3, mixed(), {});
    compare(6, mixed(), pushed);
    compare(13, uneven, {});
    EXPECT_LT(distance(points[11].platform, pose), 1e-7);
    for (std::size_t k = 7; k < 12; ++k) {  // evenly, each held by tensions
      const double share = static_cast<double>(k - 6) / 5;
      const Vec3<double> p = (1 - share) * points[6].platform.p + share * pose.p;
      EXPECT_LT((points[k].platform.p - p).norm(), 1e-7);
      EXPECT_TRUE(points[k].report.ok());
    }
    // in two parts
    const auto first = arm_legs_track(robot, std::span(steps).first(2), {}, other);
    ArmInverseOptions on;
    on.arm.from_last = true;
    const auto second = arm_legs_track(robot, std::span(steps).subspan(2), on, other);
    ASSERT_EQ(second.size(), 7U);
    EXPECT_LT(distance(second.back().platform, points.back().platform), 1e-6);
  }
}

TEST(ArmLegsTrack, WhereAPathEndsIsSaid) {
  const ArmLegs robot = tripod(false);
  ArmLegsWorkspace work(robot);
  std::vector<ArmLegsStep> steps(2);
  steps[0] = {.commands = uneven, .divisions = 2};
  steps[1] = {.commands = uneven, .load = {.wrench = {0, 0, -100, 0, 0, 0}}, .divisions = 50};
  const auto points = arm_legs_track(robot, steps, {}, work);
  ASSERT_GT(points.size(), 2U);
  ASSERT_LT(points.size(), 52U);
  EXPECT_EQ(points.back().report.status, Status::stalled);
  steps[1] = {.pose = SE3<double>{{0, 0, 0.5}, {}}, .divisions = 10};
  const auto to_pose = arm_legs_track(robot, steps, {}, work);
  EXPECT_EQ(to_pose.back().report.status, Status::unreachable);
  steps[1] = {.commands = {}, .divisions = 1};
  EXPECT_EQ(arm_legs_track(robot, steps, {}, work).back().report.status, Status::bad_input);
  steps[1] = {.commands = uneven, .divisions = 0};
  EXPECT_EQ(arm_legs_track(robot, steps, {}, work).back().report.status, Status::bad_input);
  EXPECT_TRUE(arm_legs_track(robot, {}, {}, work).empty());
}

/// Anything finite or not: an answer with a status, in time.
TEST(ArmLegsAttack, AnyNumbersAreAnsweredWithAStatus) {
  std::mt19937 random(17);
  const auto any = [&](double usual) {
    constexpr std::array odd{0.0,
                             -1.0,
                             1e-300,
                             1e6,
                             1e300,
                             std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()};
    return uniform(random, 0, 1) < 0.03 ? odd[random() % odd.size()] : uniform(random, -usual, usual);
  };
  for (int k = 0; k < 18; ++k) {
    const ArmLegs robot = tripod(k % 2 == 0);
    ArmLegsWorkspace work(robot);
    ArmOptions options{.accuracy = k % 3 == 0 ? 1e-6 : 0, .max_iterations = 400};
    std::vector<TendonCommand> commands;
    const double size = std::pow(10, uniform(random, -1, 2));
    for (int i = 0; i < 18; ++i) {
      const bool by_tension = uniform(random, 0, 1) < 0.6;
      commands.push_back({by_tension ? TendonHeld::tension : TendonHeld::change,
                          by_tension ? std::abs(any(size)) : any(1e-3 * size)});
    }
    ArmLegsLoad load;
    for (double& x : load.wrench) x = any(0.1 * size);
    const auto put_loads = [&] {
      for (double& x : load.along) x = any(0.1 * size);
      load.points.resize(random() % 3);
      for (ArmLegsPointLoad& point : load.points) {
        point = {random() % 3, std::abs(any(0.19)), {any(0.1 * size), any(0.1 * size), any(0.1 * size)}};
        if (uniform(random, 0, 1) < 0.02) point.wrench[4] = any(1);
        if (uniform(random, 0, 1) < 0.02) point.leg = random();
      }
    };
    put_loads();
    const auto said = [](const Report& report) {
      EXPECT_TRUE(report.ok() || !report.message.empty()) << to_string(report.status);
    };
    said(arm_legs_forward(robot, commands, load, options, work).report);
    options.from_last = true;
    for (TendonCommand& command : commands) command.value = std::abs(any(size));
    put_loads();
    said(arm_legs_forward(robot, commands, load, options, work).report);
    const SE3<double> pose{{any(0.05), any(0.05), 0.19 + any(0.02)},
                           SO3<double>::exp({any(0.5), any(0.5), any(0.5)})};
    said(arm_legs_hold(robot, pose, commands, load, options, work).state.report);
    ArmLegsMeasurement measured{.held = commands, .answers = {}};
    for (int i = 0; i < 18; ++i) measured.answers.push_back(any(size));
    const ArmLegsSensed sensed = arm_legs_sense(robot, measured, load, k % 2 == 1, options, work);
    said(sensed.report);
    if (k % 6 == 0) {
      ArmTarget target{.position = std::array<double, 3>{pose.p[0], pose.p[1], pose.p[2]}};
      if (k % 12 == 0) target.quaternion = spatial_pose(pose).quaternion;
      said(arm_legs_inverse(robot, target, load, {.arm = options}, work).report);
    }
    std::vector<ArmLegsStep> steps(2);
    steps[0] = {.commands = commands, .load = load, .divisions = 2};
    steps[1] = {.commands = commands, .load = {}, .divisions = 1};
    for (const ArmLegsState& point : arm_legs_track(robot, steps, {.arm = options}, work)) said(point.report);
  }
}

}  // namespace sinew::test::arm_legs_questions_test
