/// Targets of arms, forces felt by them, and their several equilibria.
#include <gtest/gtest.h>

#include <chrono>
#include <random>

#include "arms.hpp"

namespace sinew::test {
namespace arm_inverse_test {

std::vector<double> some_tensions(std::mt19937& gen, std::size_t count) {
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<double> values(count);
  for (double& value : values) value = std::max(0.0, 3.5 * share(gen) - 0.8);
  return values;
}

/// Where tensions took the tip, tensions take it: no more of them than those.
TEST(ArmInverse, FindsPlacesThatForwardReached) {
  const Arm arm = two_sections(10, 1e-4);
  std::mt19937 gen(3);
  int found = 0, asked = 0;
  for (int round = 0; round < 40; ++round) {
    const auto given = some_tensions(gen, 6);
    ArmLoad load;
    load.wrench[0] = 0.05 * (round % 3);
    load.gravity = {0, 0, -9.81};
    ArmWorkspace work(arm);
    const ArmOptions options{.accuracy = 0};
    const ArmState there = arm_forward(arm, tensions(given), load, options, work);
    ASSERT_TRUE(there.report.ok());
    ArmTarget target;
    target.position = {there.tip.p[0], there.tip.p[1], there.tip.p[2]};
    const Vec3<double> z = there.tip.rotate({0, 0, 1});
    if (round % 2 == 1) target.direction = {z[0], z[1], z[2]};
    ArmWorkspace other(arm);
    const ArmInverse back = arm_inverse(arm, target, load, {.arm = options}, other);
    ++asked;
    if (!back.report.ok()) continue;
    ++found;
    EXPECT_LT((back.state.tip.p - there.tip.p).norm(), 1e-6);
    double before = 0, now = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_GE(back.state.tensions[i], 0);
      before += given[i] * given[i];
      now += back.state.tensions[i] * back.state.tensions[i];
    }
    if (!target.direction) {
      EXPECT_LT(now, before * (1 + 1e-6)) << round;
    }
    // its changes, held, give the same
    ArmWorkspace third(arm);
    const ArmState again = arm_forward(arm, changes(back.state.changes), load, options, third);
    ASSERT_TRUE(again.report.ok()) << to_string(again.report);
    EXPECT_LT((again.tip.p - there.tip.p).norm(), 1e-6);
  }
  EXPECT_GE(found, asked - 1);
}

TEST(ArmInverse, SaysWhatCannotBeReached) {
  const Arm arm = two_sections();
  ArmWorkspace work(arm);
  const ArmInverse beyond = arm_inverse(arm, {.position = std::array{0.5, 0.0, 0.3}}, {},
                                        {.arm = {.accuracy = 0}, .starts = 3}, work);
  EXPECT_EQ(beyond.report.status, Status::unreachable) << to_string(beyond.report);
  EXPECT_EQ(arm_inverse(arm, {}, {}, {}, work).report.status, Status::bad_input);
  EXPECT_EQ(arm_inverse(arm, {.direction = std::array{0.0, 0.0, 0.0}}, {}, {}, work).report.status,
            Status::bad_input);
}

// Hard ones once took minutes, and told the tip of another equilibrium than that of their tensions.
TEST(ArmInverse, WhatComesNearestIsWhatItsTensionsGive) {
  const Arm arm = two_sections();
  std::mt19937 gen(9);
  std::uniform_real_distribution<double> share(-1, 1);
  for (int round = 0; round < 4; ++round) {
    ArmLoad load;
    load.following = {-2 * share(gen), 0, 0, 0, 0.1 * share(gen), 0};
    const ArmTarget target{.position = std::array{0.05 * share(gen), 0.05 * share(gen), 0.15},
                           .quaternion = std::array{1.0, 0.4 * share(gen), 0.1 * share(gen), 0.0}};
    ArmWorkspace work(arm);
    const ArmInverse nearest = arm_inverse(arm, target, load, {.starts = 3}, work);
    EXPECT_LT(nearest.report.iterations, 700) << round;
    if (!nearest.report.is_solved() && nearest.report.status != Status::unreachable) continue;
    if (nearest.report.message.view().ends_with("do not confirm")) continue;
    const ArmState& again =
        arm_forward(arm, tensions(nearest.state.tensions), load, {.from_last = true}, work);
    EXPECT_LT((again.tip.p - nearest.state.tip.p).norm(), 1e-7) << round;
  }
}

TEST(ArmSense, FindsTheForceFromTensionsAndTip) {
  const Arm arm = two_sections(10, 1e-4);
  std::mt19937 gen(5);
  std::uniform_real_distribution<double> share(-1, 1);
  for (int round = 0; round < 20; ++round) {
    const bool moment = round % 2 == 1;
    ArmMeasurement measured;
    for (int i = 0; i < 6; ++i) measured.held.push_back({TendonHeld::change, -0.0012 + 0.0008 * share(gen)});
    ArmLoad load, true_load;
    true_load.wrench = {0.06 * share(gen), 0.06 * share(gen), 0.1 * share(gen)};
    if (moment) true_load.wrench[4] = 0.003 * share(gen);
    const ArmOptions options{.accuracy = 0};
    ArmWorkspace work(arm);
    const ArmState there = arm_forward(arm, measured.held, true_load, options, work);
    ASSERT_TRUE(there.report.ok()) << to_string(there.report);
    measured.answers = there.tensions;
    measured.tip = {there.tip.p[0], there.tip.p[1], there.tip.p[2]};
    const ArmSensed felt = arm_sense(arm, measured, load, !moment, options, work);
    ASSERT_TRUE(felt.report.ok()) << to_string(felt.report) << round;
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(felt.wrench[i], true_load.wrench[i], 1e-6) << round;
    EXPECT_LT(felt.misfit, 1e-4);
  }
}

TEST(ArmSense, RefusesWhatIsNoMeasurement) {
  const Arm arm = two_sections(10, 1e-4);
  ArmWorkspace work(arm);
  ArmMeasurement good;
  good.held.assign(6, {TendonHeld::change, -0.001});
  good.answers.assign(6, 1.0);
  good.tip = {0.01, 0, 0.18};
  constexpr double endless = std::numeric_limits<double>::infinity();
  std::vector<ArmMeasurement> wrong(7, good);
  wrong[0].answers[2] = endless;
  (*wrong[1].tip)[1] = std::nan("");
  wrong[2].tension_deviation = 0;
  wrong[3].tip_deviation = -1e-3;
  wrong[4].change_deviation = endless;
  wrong[5].answers.pop_back();
  wrong[6].held.pop_back();
  for (const ArmMeasurement& measured : wrong) {
    const ArmSensed felt = arm_sense(arm, measured, {}, false, {}, work);
    EXPECT_EQ(felt.report.status, Status::bad_input);
    EXPECT_FALSE(felt.report.message.empty());
  }
}

/// Tendons that are held by tension tell little of a force, and the tip of a slender arm is where it can be
/// only after it has bent: an undamped step asks for a hundred newtons along the arm.
TEST(ArmSense, FindsTheForceFromTheTipAlone) {
  const Arm arm = two_sections();
  std::mt19937 gen(7);
  std::uniform_real_distribution<double> share(-1, 1);
  const ArmOptions options{.accuracy = 0};
  int found = 0;
  for (int round = 0; round < 20; ++round) {
    ArmMeasurement measured;
    for (int i = 0; i < 6; ++i) measured.held.push_back({TendonHeld::tension, std::max(0.0, 3 * share(gen))});
    ArmLoad true_load;
    true_load.wrench = {0.05 * share(gen), 0.05 * share(gen), 0.05 * share(gen)};
    ArmWorkspace work(arm);
    const ArmState there = arm_forward(arm, measured.held, true_load, options, work);
    ASSERT_TRUE(there.report.ok()) << to_string(there.report);
    measured.tip = {there.tip.p[0], there.tip.p[1], there.tip.p[2]};
    ArmWorkspace other(arm);  // which begins at rest
    const ArmSensed felt = arm_sense(arm, measured, {}, true, options, other);
    if (felt.misfit > 1e-3) continue;  // the least that is near, and it says how far off
    ++found;
    EXPECT_TRUE(felt.report.ok()) << to_string(felt.report);
    EXPECT_LT((felt.state.tip.p - there.tip.p).norm(), 1e-6) << round;
    ArmLoad sensed;
    sensed.wrench = felt.wrench;
    const ArmState again = arm_forward(arm, measured.held, sensed, options, other);
    EXPECT_LT((again.tip.p - there.tip.p).norm(), 1e-6) << round;
    for (std::size_t i = 0; i < 3; ++i) EXPECT_GT(felt.covariance[7 * i], 0) << round;
  }
  EXPECT_GE(found, 18);
}

/// A column of Euler's buckles at π²/4 EI/L²: beyond, the straight one does not hold.
TEST(ArmEquilibria, BuckledColumn) {
  CrossSection section;
  section.bending_x = 1, section.bending_y = 1.5, section.torsion = 1;  // it buckles about x
  const Arm arm = cantilever(1, section);
  const double critical = std::numbers::pi * std::numbers::pi / 4;
  ArmWorkspace work(arm);
  for (const double factor : {0.99, 1.01, 1.3}) {
    ArmLoad load;
    load.wrench[2] = -factor * critical;
    const auto found = arm_equilibria(arm, {}, load, {.model = ArmModel::rod}, 12, work);
    ASSERT_FALSE(found.empty());
    EXPECT_TRUE(found.front().state.report.ok());
    if (factor < 1) {
      EXPECT_EQ(found.size(), 1U);
      EXPECT_NEAR(found.front().state.tip.p.z(), 1, 1e-9);
    } else {
      ASSERT_EQ(found.size(), 2U);  // to both sides
      EXPECT_NEAR(found[0].state.tip.p.y(), -found[1].state.tip.p.y(), 1e-5);
      EXPECT_GT(std::abs(found[0].state.tip.p.y()), 0.1);
    }
    for (const ArmEquilibrium& one : found) {
      EXPECT_FALSE(one.continuum);
      ArmWorkspace anew(arm);
      const ArmState again =
          arm_forward(arm, {}, load, {.model = ArmModel::rod, .from_curvatures = one.curvatures}, anew);
      EXPECT_TRUE(again.report.ok());
      EXPECT_LT((again.tip.p - one.state.tip.p).norm(), 1e-5) << factor;
    }
  }
  // the margin falls to 0 where it buckles
  ArmLoad load;
  load.wrench[2] = -critical * (1 - 1e-4);
  ASSERT_TRUE(arm_forward(arm, {}, load, {.model = ArmModel::rod}, work).report.ok());
  EXPECT_NEAR(arm_rates(arm, work).margin, 1e-4, 2e-5);
}

/// A round column may buckle to any side: of that continuum one is told. All models begin at a shape.
TEST(ArmEquilibria, BeginAtShapesAndTellAContinuumOnce) {
  for (const ArmModel model :
       {ArmModel::rod, ArmModel::subsegment_rod, ArmModel::subsegment_cc, ArmModel::cc, ArmModel::prb}) {
    SCOPED_TRACE(static_cast<int>(model));
    const Arm arm = test::two_sections();
    const std::vector<TendonCommand> loose(arm.tendons.size());
    ArmLoad load;
    load.wrench[2] = -8;
    ArmWorkspace work(arm);
    const ArmOptions options{.model = model};
    const auto found = arm_equilibria(arm, loose, load, options, 20, work);
    ASSERT_FALSE(found.empty());
    EXPECT_LE(found.size(), 4U);
    for (const ArmEquilibrium& one : found) {
      ASSERT_TRUE(one.state.report.ok());
      EXPECT_TRUE(one.continuum);
      ArmWorkspace anew(arm);
      ArmOptions from = options;
      from.from_curvatures = one.curvatures;
      const ArmState again = arm_forward(arm, loose, load, from, anew);
      EXPECT_TRUE(again.report.ok());
      EXPECT_NEAR(again.energy, one.state.energy, 1e-6 * std::abs(one.state.energy));  // as refined
    }
  }
}

}  // namespace arm_inverse_test
}  // namespace sinew::test
