/// Slip along a tendon, and what Newton's method makes of it (docs/theory/tendon_friction.md).
#include "strain/friction/capstan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "arms.hpp"
#include "robot/arms/arm_model.hpp"
#include "strain/friction/friction_rod.hpp"

namespace sinew::test {
namespace capstan_test {

using strain::CapstanSpans;
using strain::CapstanTensions;
using strain::Grip;

CapstanSpans any_spans(std::mt19937& gen) {
  std::uniform_real_distribution<double> any(0, 1);
  CapstanSpans spans;
  spans.held = gen() % 2 == 0;
  spans.tension = 3 * any(gen);
  const auto count = 1 + gen() % 9;
  for (std::size_t k = 0; k < count; ++k) {
    spans.stretch.push_back(2 * any(gen) - 0.6);
    spans.compliance.push_back(0.1 + any(gen));
    if (k > 0) spans.grip.push_back(gen() % 4 == 0 ? 0 : 0.5 * any(gen));
  }
  return spans;
}

TEST(Capstan, ATendonSlipsWhereItMustAndOnlyThere) {
  std::mt19937 gen(3);
  for (int round = 0; round < 2000; ++round) {
    const CapstanSpans spans = any_spans(gen);
    CapstanTensions found;
    found.find(spans);
    double sum = 0;
    for (const double e : spans.stretch) sum += e;
    if (!spans.held && sum <= 0) {
      for (const double T : found.tension) EXPECT_EQ(T, 0);
      continue;
    }
    double slip = 0;  // what moved outward at a guide, from the fixed end
    for (std::size_t k = spans.stretch.size(); k-- > 1;) {
      slip -= spans.stretch[k] - spans.compliance[k] * found.tension[k];
      const double b = spans.grip[k - 1], ratio = std::log(found.tension[k - 1] / found.tension[k]);
      EXPECT_LE(std::abs(ratio), b + 1e-13);
      if (b == 0) continue;
      if (found.grips[k - 1] == Grip::sticks) {
        EXPECT_NEAR(slip, 0, 1e-13);
      } else {
        const double sign = static_cast<double>(found.grips[k - 1]);
        EXPECT_NEAR(ratio, sign * b, 1e-13);
        EXPECT_GE(sign * slip, -1e-13);
      }
    }
    if (!spans.held) {
      EXPECT_NEAR(spans.stretch[0] - spans.compliance[0] * found.tension[0], slip, 1e-13);
    }
  }
}

TEST(Capstan, DerivativesMatchDifferences) {
  std::mt19937 gen(5);
  constexpr double h = 1e-7;
  for (int round = 0; round < 500; ++round) {
    const CapstanSpans spans = any_spans(gen);
    CapstanTensions found, after, before;
    found.find(spans);
    if (!(found.tension.back() > 0)) continue;
    const std::size_t n = spans.stretch.size();
    std::vector<double> by_stretch, by_grip;
    found.derivatives(spans, by_stretch, by_grip);
    const auto check = [&](double& x, const double* column, std::size_t stride, const CapstanSpans& moved) {
      const double at = x;
      x = at + h;
      after.find(moved);
      x = at - h;
      before.find(moved);
      x = at;
      if (after.grips != found.grips || before.grips != found.grips) return;
      for (std::size_t k = 0; k < n; ++k)
        EXPECT_NEAR((after.tension[k] - before.tension[k]) / (2 * h), column[k * stride],
                    1e-7 * (1 + std::abs(column[k * stride])));
    };
    CapstanSpans moved = spans;
    for (std::size_t j = 0; j < n; ++j) check(moved.stretch[j], by_stretch.data() + j, n, moved);
    for (std::size_t j = 0; j + 1 < n; ++j)
      if (moved.grip[j] > h) check(moved.grip[j], by_grip.data() + j, n - 1, moved);
  }
}

/// Solved with the difference of residuals along a direction, Newton's equations give the direction.
TEST(FrictionRod, JacobianMatchesDifferences) {
  std::mt19937 gen(5);
  std::uniform_real_distribution<double> side(-1, 1);
  for (const ArmModel model :
       {ArmModel::rod, ArmModel::subsegment_rod, ArmModel::subsegment_cc, ArmModel::cc, ArmModel::prb})
    for (const bool helix : {false, true}) {
      Arm arm = two_sections(4, 1e-4);
      if (helix)
        for (ArmTendon& tendon : arm.tendons)
          for (TendonRoute& route : tendon.routes) route.end_angle += 0.7, route.end_radius = 0.008;
      const strain::RodModel made = make_rod(arm, {model});
      std::vector<strain::RubbingTendon> tendons(6, {0.3, 0.8e-4, 0.2e-4, 2});
      tendons[3].friction = 0;
      tendons[2].outside = 0;
      strain::FrictionRod rod(made, tendons);
      std::vector<strain::TendonInput> inputs(6);
      for (std::size_t i = 0; i < 6; ++i) {
        inputs[i].by_tension = i % 3 == 1;
        inputs[i].value = inputs[i].by_tension ? 2 + side(gen) : 0.001 + 0.003 * side(gen);
      }
      std::vector<strain::NodeLoad> loads(static_cast<std::size_t>(made.nodes()));
      loads.back().force[0] = 0.2;
      loads.back().following[1] = 0.1;
      std::vector<double> y(static_cast<std::size_t>(made.size)), direction(y.size());
      for (double& x : y) x = 0.05 * side(gen);
      for (double& x : direction) x = side(gen);
      constexpr double h = 1e-7;
      const auto residual = [&](double by) {
        std::vector<double> moved = y;
        for (std::size_t i = 0; i < y.size(); ++i) moved[i] += by * direction[i];
        rod.put(moved, inputs, loads);
        return rod.work().gradient;
      };
      std::vector<double> change = residual(h);
      const std::vector<double> before = residual(-h);
      for (std::size_t i = 0; i < y.size(); ++i) change[i] = (change[i] - before[i]) / (2 * h);
      residual(0);
      ASSERT_TRUE(rod.solve_newton(change));
      for (std::size_t i = 0; i < y.size(); ++i) EXPECT_NEAR(change[i], direction[i], 2e-6);
    }
}

}  // namespace capstan_test
}  // namespace sinew::test
