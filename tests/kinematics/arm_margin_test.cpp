/// The margin to buckling where tendons are exactly at rest: they resist where they would be longer.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "arms.hpp"

namespace sinew::test {
namespace arm_margin_test {

constexpr double pi = std::numbers::pi;

/// EI = 1, L = 1, without stretch and shear; tendons of their own compliance at these angles.
Arm column(const std::vector<double>& angles, const std::vector<double>& compliances, int discs = 0) {
  CrossSection section;
  section.bending_x = section.bending_y = section.torsion = 1;
  Arm arm = cantilever(1, section);
  arm.sections[0].discs.count = discs;
  for (std::size_t i = 0; i < angles.size(); ++i)
    arm.tendons.push_back(tendon_at(0, 0.05, angles[i], compliances[i]));
  return arm;
}

struct Margin {
  double value;
  bool is_bound;
  ArmState state;
};
Margin margin_of(const Arm& arm, double load, const ArmOptions& options) {
  ArmWorkspace work(arm);
  const auto held = changes(std::vector<double>(arm.tendons.size(), 0.0));
  const ArmState state = arm_forward(arm, held, {.wrench = {0, 0, -load}}, options, work);
  const ArmRates rates = arm_rates(arm, work);
  return {rates.margin, rates.margin_is_bound, state};
}

/// One arc bends by b: ½ |b|² (1 − P/3) + ½ Σ ⟨r b·d⟩²/c, and twists by itself.
double of_one_arc(const std::vector<double>& angles, const std::vector<double>& compliances, double load) {
  double least = 1;  // of torsion
  for (int k = 0; k < 36000; ++k) {
    double sum = 1 - load / 3;
    for (std::size_t i = 0; i < angles.size(); ++i) {
      const double along = std::max(0.0, 0.05 * std::cos(2 * pi * k / 36000 - angles[i]));
      sum += along * along / compliances[i];
    }
    least = std::min(least, sum);
  }
  return least;
}

TEST(ArmMargin, OfOneArcAsAllDirectionsTell) {
  const ArmOptions arc{.model = ArmModel::cc};
  std::mt19937 gen(3);
  std::uniform_real_distribution<double> angle(0, 2 * pi), size(-1, 1), load(0.5, 4);
  int held = 0;
  for (int round = 0; round < 60; ++round) {
    std::vector<double> angles, compliances;
    for (int i = 0; i < 1 + round % 6; ++i)
      angles.push_back(angle(gen)), compliances.push_back(0.004 * std::pow(10, size(gen)));
    const double P = load(gen);
    const Margin found = margin_of(column(angles, compliances), P, arc);
    const double expected = of_one_arc(angles, compliances, P);
    if (expected < 1e-3) {  // it has left the straight shape
      EXPECT_GT(found.state.tip.p.head<2>().norm(), 1e-3) << round;
      continue;
    }
    held += P > 3 ? 1 : 0;
    EXPECT_EQ(found.state.report.status, Status::converged) << round;
    EXPECT_LT(found.state.tip.p.head<2>().norm(), 1e-7) << round;
    EXPECT_FALSE(found.is_bound);
    EXPECT_NEAR(found.value, expected, 1e-6) << round << " " << angles.size();
  }
  EXPECT_GT(held, 1);  // by their tendons alone
}

TEST(ArmMargin, KnownArrangements) {
  const ArmOptions arc{.model = ArmModel::cc};
  const auto around = [](int n) {
    std::vector<double> angles;
    for (int i = 0; i < n; ++i) angles.push_back(0.3 + 2 * pi * i / n);
    return angles;
  };
  const double P = 2.4, alone = 1 - P / 3, share = 0.05 * 0.05 / 0.01;
  const auto value = [&](int n, double compliance = 0.01) {
    return margin_of(column(around(n), std::vector<double>(static_cast<std::size_t>(n), compliance)), P, arc);
  };
  EXPECT_NEAR(value(1).value, alone, 1e-9);  // away from it
  EXPECT_NEAR(value(2).value, alone, 1e-9);  // across
  EXPECT_NEAR(value(3).value, alone + 0.5 * share, 1e-9);
  EXPECT_NEAR(value(4).value, alone + share, 1e-9);
  EXPECT_NEAR(value(6).value, alone + 1.5 * share, 1e-9);
  EXPECT_NEAR(value(7).value, alone, 1e-9);  // counted as slack
  EXPECT_TRUE(value(7).is_bound);
  EXPECT_FALSE(value(6).is_bound);
  // Tendons that do not stretch: no bend at all is left, or that across.
  EXPECT_NEAR(value(3, 0).value, 1, 1e-6);
  EXPECT_NEAR(value(2, 0).value, alone, 1e-6);
  // Held by tension, also 0, they resist nothing.
  const Arm arm = column(around(3), {0.01, 0.01, 0.01});
  ArmWorkspace work(arm);
  arm_forward(arm, tensions({0, 0, 0}), {.wrench = {0, 0, -P}}, arc, work);
  EXPECT_NEAR(arm_rates(arm, work).margin, alone, 1e-9);
}

/// Below the load where the margin is used up an arm pushed a little stays where it is, whatever the push;
/// above it leaves.
TEST(ArmMargin, IsUsedUpWhereTinyCommandsAndForcesThrowTheArmOver) {
  for (const bool stretches : {true, false})
    for (const int count : {1, 2, 3, 4}) {
      if (!stretches && count > 2) continue;  // what holds it there are shapes of other branches
      std::vector<double> angles{0.2, 1.9, 4.1, 5.0};
      angles.resize(static_cast<std::size_t>(count));
      const Arm arm = column(angles, std::vector<double>(angles.size(), stretches ? 0.004 : 0), 6);
      const ArmOptions options{.model = ArmModel::subsegment_cc};
      double low = 1, high = 30;
      while (high - low > 1e-3) {
        const double middle = 0.5 * (low + high);
        const Margin found = margin_of(arm, middle, options);
        const bool stays =
            found.state.report.ok() && found.state.tip.p.head<2>().norm() < 1e-6 && found.value > 0;
        (stays ? low : high) = middle;
      }
      if (count < 3) {
        EXPECT_NEAR(low, pi * pi / 4, 0.05) << count;  // some direction is free
      } else {
        EXPECT_GT(low, 1.1 * pi * pi / 4) << count;
      }
      EXPECT_NEAR(margin_of(arm, low - 2e-3, options).value, 0, 2e-3);
      const auto farthest = [&](double load) {
        double most = 0;
        for (int k = 0; k < 12; ++k) {
          ArmWorkspace work(arm);
          auto held = changes(std::vector<double>(angles.size(), 0.0));
          const double way = 2 * pi * k / 12;
          if (k % 3 == 0) held[static_cast<std::size_t>(k / 3) % held.size()].value = -1e-8;
          const ArmState state = arm_forward(
              arm, held, {.wrench = {1e-5 * std::cos(way), 1e-5 * std::sin(way), -load}}, options, work);
          EXPECT_TRUE(state.report.ok()) << count << " " << load << " " << to_string(state.report);
          most = std::max(most, state.tip.p.head<2>().norm());
        }
        return most;
      };
      EXPECT_LT(farthest(0.98 * low), 2e-3) << count << stretches;
      EXPECT_GT(farthest(1.03 * low), 1e-2) << count << stretches;
    }
}

}  // namespace arm_margin_test
}  // namespace sinew::test
