/// Arms whose tendons do not stretch and are held by their ends (docs/theory/strain_rod.md, Tendons).
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "arms.hpp"

namespace sinew::test {
namespace arm_rigid_test {

/// One section whose tendons run in channels: bent to an arc of fixed length, tendon i is r κ cos(φ − φᵢ)
/// shorter.
Arm arc(double compliance = 0) {
  Arm arm;
  ArmSection section;
  section.length = 0.2;
  section.start = section.end = round_section({54e9, 54e9 / 2.6, 0}, 0.0014);
  arm.sections = {section};
  for (const double degrees : {90.0, -30.0, 210.0})
    arm.tendons.push_back(tendon_at(0, 0.01, degrees * std::numbers::pi / 180, compliance));
  return arm;
}

/// Three tendons, 120° apart, on an arc: their changes sum up to 0, so there is a shape whose tendons are no
/// longer than asked exactly where the sum asked is at least 0.
TEST(ArmRigid, ThreeTendonsOnAnArcAreReachableWhereTheirSumIs) {
  const Arm arm = arc();
  std::mt19937 gen(5);
  std::uniform_real_distribution<double> any(-0.006, 0.006);
  int refused = 0;
  for (int round = 0; round < 60; ++round) {
    const std::vector<double> values{any(gen), any(gen), any(gen)};
    const double sum = values[0] + values[1] + values[2];
    ArmWorkspace work(arm);
    const ArmState state = arm_forward(arm, changes(values), {}, {.model = ArmModel::cc}, work);
    if (sum < 0) {
      ++refused;
      EXPECT_EQ(state.report.status, Status::unreachable) << sum << " " << to_string(state.report);
      EXPECT_NE(state.report.message.view().find("too short"), std::string_view::npos);
      continue;
    }
    ASSERT_TRUE(state.report.ok()) << round << " " << to_string(state.report);
    // The least bend that satisfies all: its distance from 0 in the plane of (κ cos φ, κ sin φ).
    double least = 0;
    for (int i = 0; i < 3; ++i) least = std::max(least, -values[static_cast<std::size_t>(i)]);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < i; ++j) {  // two at once: solve 2 × 2, keep if the third has room
        const double angles[]{90.0, -30.0, 210.0};
        const double a = angles[i] * std::numbers::pi / 180, b = angles[j] * std::numbers::pi / 180,
                     det = std::sin(b - a), x = (-values[i] * std::sin(b) + values[j] * std::sin(a)) / det,
                     y = (std::cos(a) * -values[j] + std::cos(b) * values[i]) / det;
        // both pull: (x, y) is between their directions
        if ((std::cos(a) * y - std::sin(a) * x) / det > 0 && (x * std::sin(b) - y * std::cos(b)) / det > 0)
          least = std::max(least, std::hypot(x, y));
      }
    const double bend = state.tip.R.log().norm();
    EXPECT_NEAR(bend, least / 0.01, 1e-8) << round;
    for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(state.tensions[i] == 0 || state.slack[i] < 1e-12);
  }
  EXPECT_GT(refused, 15);
}

/// The limit of tendons that hardly stretch.
TEST(ArmRigid, RandomArmsAreTheLimitOfStiffTendons) {
  std::mt19937 gen(11);
  std::uniform_real_distribution<double> side(-1, 1), any(0, 1);
  int found = 0;
  constexpr int rounds = 60;
  for (int round = 0; round < rounds; ++round) {
    Arm arm = two_sections(static_cast<int>(gen() % 6) + 3, 0);
    arm.gravity = {3 * side(gen), 3 * side(gen), -9.81};
    for (ArmTendon& tendon : arm.tendons)
      for (TendonRoute& route : tendon.routes) route.end_angle += 0.4 * side(gen);
    std::vector<double> values(6);
    for (double& value : values) value = 0.001 + 0.004 * side(gen);
    ArmLoad load;
    for (std::size_t i = 0; i < 3; ++i) load.wrench[i] = 0.2 * side(gen);
    if (round % 3 == 0) load.following = {0.1 * side(gen), 0, 0, 0, 0, 0.002 * side(gen)};
    const ArmOptions options{.model = round % 2 == 0 ? ArmModel::subsegment_rod : ArmModel::subsegment_cc,
                             .accuracy = 0};
    ArmWorkspace work(arm);
    const ArmState state = arm_forward(arm, changes(values), load, options, work);
    EXPECT_LT(state.report.iterations, 2000);
    if (!state.report.ok()) {
      EXPECT_FALSE(state.report.message.empty());
      continue;
    }
    ++found;
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_GE(state.tensions[i], 0);
      EXPECT_TRUE(state.tensions[i] == 0 || state.slack[i] < 1e-12) << round;
    }
    // with compliance the tip is off by about c T, and in proportion to c
    double last = 0;
    for (const double compliance : {1e-7, 1e-8}) {
      Arm next = arm;
      next.identity = std::make_shared<const char>();
      for (ArmTendon& tendon : next.tendons) tendon.compliance = compliance;
      ArmWorkspace other(next);
      const ArmState near = arm_forward(next, changes(values), load, options, other);
      if (!near.report.ok()) break;
      const double off = (near.tip.p - state.tip.p).norm();
      if (off > 0.01) break;  // another equilibrium
      if (compliance == 1e-7)
        last = off;
      else
        EXPECT_LT(off, 0.2 * last + 1e-8) << round;
    }
  }
  EXPECT_GE(found, rounds * 95 / 100);
}

/// A tendon that others let go follows however far, and one that all hold is refused in time.
TEST(ArmRigid, OnePulledTendonNeedsTheOthersLoose) {
  const Arm arm = two_sections(10, 0);
  for (const double pull : {0.0005, 0.001, 0.0018, 0.0025, 0.005, 0.01}) {
    ArmWorkspace work(arm);
    const ArmState loose = arm_forward(arm, changes({-pull, 0.02, 0.02, 0.02, 0.02, 0.02}), {}, {}, work);
    ASSERT_TRUE(loose.report.ok()) << pull << " " << to_string(loose.report);
    EXPECT_LT(loose.report.iterations, 40);
    EXPECT_GT(loose.tensions[0], 0);
    EXPECT_NEAR(loose.tensions[1], 0, 1e-12);
    const ArmState held = arm_forward(arm, changes({-pull, 0, 0, 0, 0, 0}), {}, {}, work);
    EXPECT_LT(held.report.iterations, 1500);
    EXPECT_TRUE(held.report.ok() || !held.report.message.empty());
  }
}

/// A straight arm whose tendons are locked is pushed along itself, to a thousand times the load at which it
/// would buckle without them: the gradient tells neither that it gives way nor which tendons become taut.
TEST(ArmRigid, LockedTendonsHoldAnArmThatIsPushed) {
  const Arm arm = two_sections(10, 0);
  const std::vector<TendonCommand> locked = changes(std::vector<double>(arm.tendons.size(), 0.0));
  for (const double force : {0.1, 0.5, 1.0, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0}) {
    SCOPED_TRACE(force);
    ArmLoad load;
    load.wrench[2] = -force;
    ArmWorkspace work(arm);
    const ArmState state = arm_forward(arm, locked, load, {}, work);
    ASSERT_TRUE(state.report.ok()) << to_string(state.report);
    EXPECT_TRUE(state.stable);
    EXPECT_LT(state.report.iterations, 400);
    EXPECT_LE(state.energy, force * arm.length());  // no more than straight
    if (force < 2.5) {
      EXPECT_GT(state.tip.p.z(), 0.99 * arm.length());  // braced near by, not fallen over
    }
    for (std::size_t i = 0; i < locked.size(); ++i)
      EXPECT_TRUE(state.tensions[i] == 0 || state.slack[i] < 1e-9);
    ArmWorkspace doubled(arm);  // an equilibrium with finer polynomials, too
    ArmOptions fine{.order = 5, .elements = 12, .accuracy = 0};
    const auto shape = arm_curvatures(arm, 40, work);
    fine.from_curvatures = shape;
    const ArmState again = arm_forward(arm, locked, load, fine, doubled);
    ASSERT_TRUE(again.report.ok()) << to_string(again.report);
    EXPECT_NEAR(again.energy, state.energy, 1e-5 * std::abs(state.energy));
  }
}

}  // namespace arm_rigid_test
}  // namespace sinew::test
