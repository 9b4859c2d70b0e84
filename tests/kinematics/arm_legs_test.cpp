/// A platform on arms: derivatives against differences, every leg alone as an arm under the force that its
/// tip bears, symmetry, stages that nest, and bad input.
#include "sinew/kinematics/arm_legs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kinematics/arm_legs/group/arm_group.hpp"
#include "kinematics/load_problem.hpp"
#include "tripods.hpp"

namespace sinew::test::arm_legs_test {

using namespace tripods;

/// A leg as an arm by itself, in its base's axes.
ArmState alone(const ArmLegs& robot, const ArmLegsState& state, std::size_t k,
               std::span<const TendonCommand> commands, const ArmOptions& options) {
  Arm arm = robot.legs[k].arm;
  const SE3<double>& base = robot.legs[k].base;
  const Vec3<double> g = base.rotate_back({robot.gravity[0], robot.gravity[1], robot.gravity[2]});
  arm.gravity = {g[0], g[1], g[2]};
  const auto& tip = state.tip_loads[k];
  const Vec3<double> force = base.rotate_back({tip[0], tip[1], tip[2]}),
                     moment = base.rotate_back({tip[3], tip[4], tip[5]});
  ArmWorkspace work(arm);
  ArmLoad load;
  load.wrench = {force[0], force[1], force[2], moment[0], moment[1], moment[2]};
  return arm_forward(arm, commands.subspan(6 * k, 6), load, options, work);
}

struct Case {
  bool is_clamped, by_length;
};
class ArmLegsCases : public testing::TestWithParam<Case> {};

TEST_P(ArmLegsCases, EveryLegAloneBearsWhatThePlatformExerts) {
  const auto [is_clamped, by_length] = GetParam();
  const ArmLegs robot = tripod(is_clamped);
  const auto commands = by_length ? mixed() : uneven;
  const ArmOptions options{.accuracy = 0};
  ArmLegsWorkspace work(robot);
  const ArmLegsState state = arm_legs_forward(robot, commands, pushed, options, work);
  ASSERT_TRUE(state.report.ok()) << state.report.message.view();
  EXPECT_LE(state.report.residual, 1e-10);
  Vec<double, 6> sum = Vec<double, 6>::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const ArmState arm = alone(robot, state, k, commands, options);
    ASSERT_TRUE(arm.report.ok()) << arm.report.message.view();
    const ArmLeg& leg = robot.legs[k];
    const SE3<double> tip = leg.base.compose(arm.tip);
    EXPECT_LT((tip.p - state.platform.point(leg.platform_point)).norm(), 1e-8);
    if (is_clamped) {
      EXPECT_LT(distance({tip.p, tip.R}, {tip.p, state.platform.R.compose(leg.mount)}), 1e-7);
    }
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_NEAR(arm.tensions[i], state.tensions[6 * k + i], 1e-6);
      EXPECT_NEAR(arm.changes[i], state.changes[6 * k + i], 1e-8);
      EXPECT_NEAR(arm.slack[i], state.slack[6 * k + i], 1e-8);
    }
    const Vec3<double> force(state.tip_loads[k][0], state.tip_loads[k][1], state.tip_loads[k][2]),
        moment(state.tip_loads[k][3], state.tip_loads[k][4], state.tip_loads[k][5]);
    sum.head<3>() += force;
    sum.tail<3>() += moment + cross(tip.p - state.platform.p, force);
  }
  for (int i = 0; i < 6; ++i)
    EXPECT_NEAR(sum[i],
                pushed.wrench[static_cast<std::size_t>(i)] + (i == 2 ? -9.81 * robot.platform_mass : 0),
                1e-8);
}

TEST_P(ArmLegsCases, StiffnessAndRatesMatchDifferences) {
  const auto [is_clamped, by_length] = GetParam();
  const ArmLegs robot = tripod(is_clamped);
  const auto commands = by_length ? mixed() : uneven;
  const ArmOptions options{.accuracy = 0, .tolerance = 1e-12};
  ArmLegsWorkspace work(robot);
  const SE3<double> at = arm_legs_forward(robot, commands, pushed, options, work).platform;
  const ArmLegsRates rates = arm_legs_rates(robot, work);
  ASSERT_TRUE(rates.regular);
  const auto twist_of = [&](const auto& changed) {
    const SE3<double> to = changed;
    Vec<double, 6> twist;
    twist << to.p - at.p, to.R.compose(at.R.inverse()).log();
    return twist;
  };
  const Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> S(rates.stiffness.data());
  for (std::size_t i = 0; i < 6; ++i) {
    const double h = i < 3 ? 1e-4 : 1e-5;
    ArmLegsLoad up = pushed, down = pushed;
    up.wrench[i] += h, down.wrench[i] -= h;
    ArmLegsWorkspace other(robot);
    const Vec<double, 6> a = twist_of(arm_legs_forward(robot, commands, up, options, other).platform),
                         b = twist_of(arm_legs_forward(robot, commands, down, options, other).platform);
    const Vec<double, 6> wrench = S * (a - b) / (2 * h);
    for (int j = 0; j < 6; ++j)
      EXPECT_NEAR(wrench[j] * (j < 3 ? 0.05 : 1) / (i < 3 ? 0.05 : 1), j == static_cast<int>(i), 2e-4)
          << i << ' ' << j;
  }
  const std::size_t count = commands.size();
  for (const std::size_t k : {0U, 1U, 2U, 4U, 9U, 15U}) {
    const double h = commands[k].held == TendonHeld::tension ? 1e-4 : 1e-6;
    auto up = commands, down = commands;
    up[k].value += h;
    if (down[k].held == TendonHeld::change || down[k].value > h) down[k].value -= h;
    ArmLegsWorkspace other(robot);
    const Vec<double, 6> a = twist_of(arm_legs_forward(robot, up, pushed, options, other).platform),
                         b = twist_of(arm_legs_forward(robot, down, pushed, options, other).platform);
    const double by = up[k].value - down[k].value;
    double largest = 1e-5;  // of a slack tendon only rounding is left
    for (int j = 0; j < 6; ++j) largest = std::max(largest, std::abs((a - b)[j] / by));
    for (int j = 0; j < 6; ++j)
      EXPECT_NEAR(rates.J[static_cast<std::size_t>(j) * count + k], (a - b)[j] / by, 1e-3 * largest);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ArmLegsCases,
                         testing::Values(Case{false, false}, Case{false, true}, Case{true, false},
                                         Case{true, true}));

TEST(ArmLegs, OneClampedLegIsTheArmUnderTheSameLoad) {
  ArmLegs robot = tripod(true, false);
  robot.legs.resize(1);
  robot.platform_mass = 0;
  robot.legs[0].base = {};
  robot.legs[0].mount = {};
  robot.legs[0].platform_point.setZero();
  const auto commands = std::span(uneven).first(6);
  const ArmLegsLoad load{.wrench = {0.05, 0.02, -0.05, 0.003, 0, 0.001}};
  const Arm& arm = robot.legs[0].arm;
  for (const ArmModel model :
       {ArmModel::subsegment_rod, ArmModel::rod, ArmModel::subsegment_cc, ArmModel::cc, ArmModel::prb}) {
    const ArmOptions options{.model = model, .accuracy = 1e-7};
    ArmWorkspace arm_work(arm);
    ArmLoad tip;
    tip.wrench = load.wrench;
    const ArmState one = arm_forward(arm, commands, tip, options, arm_work);
    ArmLegsWorkspace work(robot);
    const ArmLegsState state = arm_legs_forward(robot, commands, load, options, work);
    ASSERT_TRUE(one.report.ok() && state.report.ok()) << state.report.message.view();
    EXPECT_LT(distance(state.platform, one.tip), 2e-7) << static_cast<int>(model);
    EXPECT_NEAR(state.energy, one.energy, 1e-6 * std::abs(one.energy));
  }
}

TEST(ArmLegs, EqualPullsKeepTheTripodSymmetric) {
  for (const bool is_clamped : {false, true}) {
    const ArmLegs robot = tripod(is_clamped);
    std::vector<TendonCommand> commands;
    for (int leg = 0; leg < 3; ++leg)  // tendons aside of each leg pull alike: mirror images, too
      for (const double value : {.5, .1, .1, .2, .6, .6}) commands.push_back({TendonHeld::tension, value});
    ArmLegsWorkspace work(robot);
    const ArmLegsState& state = arm_legs_forward(robot, commands, {}, {}, work);
    ASSERT_TRUE(state.report.ok()) << state.report.message.view();
    EXPECT_LT(std::hypot(state.platform.p[0], state.platform.p[1]), 1e-8);
    EXPECT_LT(std::abs(state.platform.R.v[0]) + std::abs(state.platform.R.v[1]), 1e-8);
  }
}

TEST(ArmLegs, TwoSectionsThatPullAlikeAreOneOfTwiceTheLength) {
  ArmLegs two = tripod(true), one = tripod(true);
  for (ArmLeg& leg : one.legs) {
    Arm& arm = leg.arm = leg_of_sections(1);
    arm.sections[0].length = 0.2;
    arm.sections[0].discs.count = 10;
  }
  std::vector<TendonCommand> of_two, of_one;
  for (int leg = 0; leg < 3; ++leg) {
    const double pull = 0.4 + 0.3 * leg;
    for (const double value : {0., 0., 0., pull, 0.1, 0.}) of_two.push_back({TendonHeld::tension, value});
    for (const double value : {pull, 0.1, 0.}) of_one.push_back({TendonHeld::tension, value});
  }
  for (const ArmModel model : {ArmModel::subsegment_cc, ArmModel::subsegment_rod}) {
    const ArmOptions options{.model = model, .accuracy = 0};
    ArmLegsWorkspace work_two(two), work_one(one);
    const ArmLegsState &a = arm_legs_forward(two, of_two, pushed, options, work_two),
                       &b = arm_legs_forward(one, of_one, pushed, options, work_one);
    ASSERT_TRUE(a.report.ok() && b.report.ok()) << a.report.message.view() << b.report.message.view();
    EXPECT_LT(distance(a.platform, b.platform), 1e-8);
  }
}

/// Three straight columns under a load in their middle, which sway: with clamped tips each bears π² EI/L²,
/// with balls on top a quarter of that.
TEST(ArmLegs, ColumnsGiveWayAtEulersLoad) {
  for (const bool is_clamped : {false, true}) {
    ArmLegs robot = upright(is_clamped, false);
    for (ArmLeg& leg : robot.legs)
      for (ArmSection& section : leg.arm.sections)  // as stiff against stretch as makes it not count
        for (CrossSection* end : {&section.start, &section.end}) end->stretch = end->shear = 1e9;
    ArmGroup group(robot, {}, breaks_for(robot, {}));
    std::vector<TendonCommand> commands(18);
    group.set_problem(commands, ArmGroup::Wrench::Zero(), {});
    group.set_share(1);
    ASSERT_LT(group.evaluate(), 1e-12);
    ASSERT_TRUE(group.linearise());
    auto places = places_of<Spatial>(group);
    ArmGroup::Wrench down = ArmGroup::Wrench::Zero();
    down[2] = -1;
    const double euler =
        3 * std::pow(std::numbers::pi, 2) * group.stiffness(0) / (0.2 * 0.2) * (is_clamped ? 1 : 0.25);
    const GrownLoad grown = grow_load<Spatial>(group, places, down, 2 * euler, {}, {});
    EXPECT_EQ(grown.end, GrowthEnd::bifurcation);
    EXPECT_NEAR(grown.load / euler, 1, 2e-4);
  }
}

/// A backbone that does not stretch and is straight holds its tip along itself: no finite stiffness, and yet
/// an equilibrium.
TEST(ArmLegs, StraightLegsThatDoNotStretchAreSolved) {
  for (const bool is_clamped : {false, true}) {
    const ArmLegs robot = upright(is_clamped, true);
    for (const ArmModel model : {ArmModel::cc, ArmModel::subsegment_cc, ArmModel::prb}) {
      const ArmOptions options{.model = model, .accuracy = 0};
      ArmLegsWorkspace work(robot);
      const ArmLegsState rest = arm_legs_forward(robot, std::vector<TendonCommand>(18), {}, options, work);
      ASSERT_TRUE(rest.report.ok()) << rest.report.message.view();
      EXPECT_NEAR(rest.platform.p[2], 0.2, 1e-12);
      double held = 0;
      for (const auto& load : rest.tip_loads) held += load[2];
      EXPECT_NEAR(held, -9.81 * robot.platform_mass, 1e-9);
      const ArmLegsRates rates = arm_legs_rates(robot, work);
      EXPECT_TRUE(rates.regular);
      EXPECT_FALSE(rates.has_stiffness);
      EXPECT_NEAR(rates.compliance[14], 0, 1e-12);  // up and down it does not yield, aside it does
      EXPECT_GT(rates.compliance[0], 1e-4);
      EXPECT_TRUE(arm_legs_forward(robot, uneven, pushed, options, work).report.ok());
    }
  }
}

TEST(ArmLegs, TendonsThatDoNotStretchKeepTheirLengthsOrAreSlack) {
  ArmLegs robot = tripod(false);
  for (ArmLeg& leg : robot.legs)
    for (ArmTendon& tendon : leg.arm.tendons) tendon.compliance = 0;
  const auto commands = mixed();
  const ArmOptions options{.accuracy = 0};
  ArmLegsWorkspace work(robot);
  const ArmLegsState state = arm_legs_forward(robot, commands, pushed, options, work);
  ASSERT_TRUE(state.report.ok()) << state.report.message.view();
  EXPECT_GT(state.slack[1], 0);
  EXPECT_EQ(state.tensions[1], 0);
  for (std::size_t k = 0; k < 3; ++k) {
    const ArmState arm = alone(robot, state, k, commands, options);
    ASSERT_TRUE(arm.report.ok());
    const ArmLeg& leg = robot.legs[k];
    EXPECT_LT((leg.base.compose(arm.tip).p - state.platform.point(leg.platform_point)).norm(), 1e-7);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(arm.tensions[i], state.tensions[6 * k + i], 1e-4);
  }
}

TEST(ArmLegs, BadInputIsRefusedByName) {
  const ArmLegs robot = tripod(false);
  ArmLegsWorkspace work(robot);
  auto commands = uneven;
  commands.pop_back();
  EXPECT_EQ(arm_legs_forward(robot, commands, {}, {}, work).report.status, Status::bad_input);
  commands = uneven;
  commands[3].value = -1;
  EXPECT_EQ(arm_legs_forward(robot, commands, {}, {}, work).report.status, Status::bad_input);
  commands[3].value = std::nan("");
  EXPECT_EQ(arm_legs_forward(robot, commands, {}, {}, work).report.status, Status::bad_input);
  ArmOptions options;
  options.balance = ArmBalance::projected;
  EXPECT_EQ(arm_legs_forward(robot, uneven, {}, options, work).report.status, Status::unsupported);
  const ArmLegs other = tripod(false);
  EXPECT_EQ(arm_legs_forward(other, uneven, {}, {}, work).report.status, Status::bad_input);
  const ArmLegsLoad heavy{.wrench = {0, 0, -1e6, 0, 0, 0}};
  const ArmLegsState& crushed = arm_legs_forward(robot, uneven, heavy, {}, work);
  EXPECT_FALSE(crushed.report.ok());
  EXPECT_LT(crushed.reached, 1);
}

}  // namespace sinew::test::arm_legs_test
