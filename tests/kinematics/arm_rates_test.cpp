/// Rates of arms against differences of whole solves, at tensions, changes and both.
#include <gtest/gtest.h>

#include <random>

#include "arms.hpp"

namespace sinew::test {
namespace arm_rates_test {

/// Twist from one pose to another, base axes.
Vec<double, 6> between(const SE3<double>& a, const SE3<double>& b) {
  Vec<double, 6> twist;
  twist << Vec3<double>(b.p - a.p), b.R.compose(a.R.inverse()).log();
  return twist;
}

struct Case {
  ArmModel model;
  double compliance;
  bool following;
};
class Rates : public testing::TestWithParam<Case> {};

TEST_P(Rates, AgainstDifferences) {
  const auto [model, compliance, following] = GetParam();
  const Arm arm = two_sections(5, compliance);
  const double wide = compliance > 0 ? 1 : 4;  // tensions of tendons that do not stretch are less exact
  std::mt19937 gen(7);
  std::uniform_real_distribution<double> share(-1, 1);
  for (int round = 0; round < 6; ++round) {
    std::vector<TendonCommand> commands(6);
    for (std::size_t i = 0; i < 6; ++i) {
      const bool held = round % 3 == 0 || (round % 3 == 1 && i < 3) || (compliance == 0 && i % 3 > 0);
      commands[i] = held ? TendonCommand{TendonHeld::tension, 1.5 + share(gen)}
                         : TendonCommand{TendonHeld::change,
                                         compliance > 0 ? -0.003 + 0.002 * share(gen) : 0.001 * share(gen)};
    }
    ArmLoad load;
    for (std::size_t i = 0; i < 3; ++i) load.wrench[i] = 0.1 * share(gen);
    if (following)
      for (std::size_t i = 0; i < 6; ++i) load.following[i] = (i < 3 ? 0.1 : 0.005) * share(gen);
    const ArmOptions options{.model = model, .accuracy = 0, .tolerance = 1e-13, .from_last = true};
    ArmWorkspace work(arm);
    const ArmState here = arm_forward(arm, commands, load, options, work);
    ASSERT_TRUE(here.report.ok()) << to_string(here.report);
    const ArmRates rates = arm_rates(arm, work);
    ASSERT_TRUE(rates.regular);
    EXPECT_GT(rates.margin, 0);
    const auto held = [&](const ArmState& state, std::size_t i) {
      return commands[i].held == TendonHeld::tension ? state.changes[i] : state.tensions[i];
    };
    const auto check = [&](auto&& change, double step, const double* column, std::ptrdiff_t stride,
                           const double* answers, std::ptrdiff_t answer_stride) {
      const auto solve = [&](double by) {
        ArmWorkspace other(arm);
        arm_forward(arm, commands, load, options, other);
        auto moved = commands;
        ArmLoad pushed = load;
        change(moved, pushed, by);
        return arm_forward(arm, moved, pushed, options, other);
      };
      const ArmState after = solve(step), before = solve(-step);
      ASSERT_TRUE(after.report.ok() && before.report.ok())
          << to_string(after.report) << to_string(before.report);
      const Vec<double, 6> twist = between(before.tip, after.tip) / (2 * step);
      const double size = std::max(twist.norm(), 1e-3);
      for (int i = 0; i < 6; ++i) EXPECT_NEAR(twist[i], column[i * stride], 2e-5 * size) << i;
      for (std::size_t i = 0; i < 6; ++i) {
        const double rate = (held(after, i) - held(before, i)) / (2 * step);
        EXPECT_NEAR(rate, answers[static_cast<std::ptrdiff_t>(i) * answer_stride],
                    2e-4 * std::max(std::abs(rate), 0.01))
            << i;
      }
    };
    for (std::size_t k = 0; k < 6; ++k)
      check([k](auto& moved, ArmLoad&, double by) { moved[k].value += by; },
            commands[k].held == TendonHeld::tension ? wide * 1e-4 : 1e-7, rates.J.data() + k, 6,
            rates.answers.data() + k, 6);
    for (std::size_t k = 0; k < 6; ++k)
      check([k](auto&, ArmLoad& pushed, double by) { pushed.wrench[k] += by; }, wide * (k < 3 ? 1e-4 : 1e-5),
            rates.compliance.data() + k, 6, rates.answers_by_wrench.data() + k, 6);
  }
}
INSTANTIATE_TEST_SUITE_P(Arm, Rates,
                         testing::Values(Case{ArmModel::subsegment_rod, 1e-4, false},
                                         Case{ArmModel::rod, 1e-5, true},
                                         Case{ArmModel::subsegment_cc, 1e-4, true},
                                         Case{ArmModel::cc, 0, false}, Case{ArmModel::prb, 1e-4, false}));

/// Ten joints of a channel, and more: the rod's tip, nearer with the square of their number; by converging,
/// helical and precurved channels, too.
TEST(ArmRates, JointsInAChannelFeelTheTendon) {
  for (int kind = 0; kind < 3; ++kind) {
    Arm arm = tendon_rod(5e-5);
    for (CrossSection* end : {&arm.sections[0].start, &arm.sections[0].end})
      end->stretch = end->shear = 0;  // as links are
    if (kind > 0)
      for (ArmTendon& tendon : arm.tendons) {
        tendon.routes[0].end_radius *= 0.5;
        tendon.routes[0].end_angle += 1;
      }
    if (kind > 1) arm.sections[0].curvature = {1, -0.5, 0.8};
    const auto tip = [&](ArmModel model, int elements, double tension) {
      ArmWorkspace work(arm);
      const ArmState state = arm_forward(arm, tensions({tension, 0, 1, 0}), {},
                                         {.model = model, .elements = elements, .tolerance = 1e-13}, work);
      EXPECT_TRUE(state.report.ok()) << to_string(state.report);
      return state;
    };
    const ArmState rod = tip(ArmModel::rod, 40, 5);
    double before = 0;
    for (const int joints : {1, 2, 4}) {
      const ArmState chain = tip(ArmModel::prb, joints, 5);
      const double off = (chain.tip.p - rod.tip.p).norm();
      EXPECT_LT(off, 0.02 * arm.length()) << kind << " " << joints;
      for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(chain.changes[i], rod.changes[i], 1e-4 / (joints * joints)) << kind << " " << joints;
      if (before > 0) {
        EXPECT_NEAR(before / off, 4, 0.4) << kind << " " << joints;
      }
      before = off;
    }
    ArmWorkspace work(arm);
    ASSERT_TRUE(
        arm_forward(arm, tensions({5, 0, 1, 0}), {}, {.model = ArmModel::prb, .tolerance = 1e-13}, work)
            .report.ok());
    const ArmRates rates = arm_rates(arm, work);
    const Vec3<double> speed =
        (tip(ArmModel::prb, 0, 5.001).tip.p - tip(ArmModel::prb, 0, 4.999).tip.p) / 0.002;
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(rates.J[4 * i], speed[static_cast<Eigen::Index>(i)], 1e-6) << kind << " " << i;
  }
}

/// Without load the energy is the elastic one: the margin is 1 whatever the model, the order, the taper.
TEST(ArmRates, MarginIsOneAtRestAtAnyResolution) {
  for (const bool tapers : {false, true})
    for (const ArmModel model :
         {ArmModel::rod, ArmModel::subsegment_rod, ArmModel::subsegment_cc, ArmModel::cc, ArmModel::prb})
      for (const int order : {-1, 1, 2, 3, 5}) {
        Arm arm = two_sections(5, 1e-4);
        if (tapers)
          for (ArmSection& section : arm.sections)
            section.end = round_section({54e9, 54e9 / 2.6, 0}, 0.001), section.round_taper = true;
        ArmWorkspace work(arm);
        const ArmOptions options{.model = model, .order = order, .elements = 6, .accuracy = 0};
        ASSERT_TRUE(arm_forward(arm, tensions(std::vector<double>(6, 0.0)), {}, options, work).report.ok());
        EXPECT_NEAR(arm_rates(arm, work).margin, 1, 1e-9) << order << " " << static_cast<int>(model);
      }
}

/// Loaded, it does not jump where the resolution does.
TEST(ArmRates, MarginConvergesWithTheResolution) {
  const Arm arm = two_sections(5, 1e-4);
  ArmLoad load;
  load.wrench = {0.02, 0.01, -0.1};
  std::vector<double> margins;
  for (const auto& [order, elements] :
       {std::pair{3, 4}, std::pair{4, 4}, std::pair{4, 8}, std::pair{6, 12}}) {
    ArmWorkspace work(arm);
    const ArmOptions options{.order = order, .elements = elements, .accuracy = 0};
    ASSERT_TRUE(arm_forward(arm, tensions({2, 0, 1, 1, 0, 1}), load, options, work).report.ok());
    margins.push_back(arm_rates(arm, work).margin);
  }
  for (const double margin : margins) EXPECT_NEAR(margin, margins.back(), 2e-5);
  EXPECT_LT(margins.back(), 0.9);
}

/// A channel is not as long as the way between discs: what one model was asked does not change another's
/// answer.
TEST(ArmRates, ModelsDoNotShareLengthsAtRest) {
  Arm arm = two_sections(5, 1e-4);
  for (ArmTendon& tendon : arm.tendons) tendon.routes.back().end_angle += 1;
  const std::vector<TendonCommand> commands(6, {TendonHeld::change, -0.0005});
  ArmWorkspace fresh(arm), used(arm);
  const ArmState alone = arm_forward(arm, commands, {}, {.accuracy = 0}, fresh);
  ASSERT_TRUE(arm_forward(arm, commands, {}, {.model = ArmModel::rod, .accuracy = 0}, used).report.ok());
  const ArmState after = arm_forward(arm, commands, {}, {.accuracy = 0}, used);
  ASSERT_TRUE(alone.report.ok() && after.report.ok());
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(after.tensions[i], alone.tensions[i], 1e-6);
}

}  // namespace arm_rates_test
}  // namespace sinew::test
