/// Loads that grow until an arm buckles or snaps, against Euler's loads and equilibria found from many
/// starts.
#include "sinew/kinematics/arm.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "arms.hpp"

namespace sinew::test {
namespace arm_load_path_test {

/// EI = 1, L = 1, nearly without stretch and shear.
Arm column(double torsion = 1) {
  CrossSection section;
  section.bending_x = section.bending_y = 1;
  section.torsion = torsion;
  return cantilever(1, section);
}

constexpr double pi = std::numbers::pi;

/// Clamped below, free above: π²/4.
TEST(ArmLoadPath, AColumnBucklesAtEulersLoad) {
  for (const double unit : {1.0, 0.01, 30.0}) {
    const Arm arm = column();
    ArmWorkspace work(arm);
    const ArmLoadPath path = arm_follow_load(arm, {}, {}, {0, 0, -unit}, 1e6, {.model = ArmModel::rod}, work);
    EXPECT_EQ(path.end, LoadEnd::bifurcation) << to_string(path.end);
    EXPECT_NEAR(path.load * unit, pi * pi / 4, 5e-5);  // of the resolution: 3.7e-5
    EXPECT_LT(path.margin, 1e-5);
    EXPECT_TRUE(path.state.report.ok());
    EXPECT_LT(path.steps, 100);
  }
  const Arm arm = column();
  ArmWorkspace work(arm);
  const ArmLoadPath fine = arm_follow_load(arm, {}, {}, {0, 0, -1}, 1e6,
                                           {.model = ArmModel::rod, .order = 5, .elements = 32}, work);
  EXPECT_NEAR(fine.load, pi * pi / 4, 1e-6);
}

/// The stiffer direction does not matter, and the weaker one is that of the buckling load.
TEST(ArmLoadPath, AStripBucklesOverItsWeakSide) {
  Arm arm = column();
  arm.sections[0].start.bending_x = arm.sections[0].end.bending_x = 3;
  ArmWorkspace work(arm);
  const ArmLoadPath path = arm_follow_load(arm, {}, {}, {0, 0, -1}, 100, {.model = ArmModel::rod}, work);
  EXPECT_EQ(path.end, LoadEnd::bifurcation);
  EXPECT_NEAR(path.load, pi * pi / 4, 5e-5);
}

/// What does not buckle reaches the limit, at the equilibrium that forward finds.
TEST(ArmLoadPath, AnArmPulledSidewaysReachesTheLimit) {
  const Arm arm = two_sections();
  ArmWorkspace work(arm), other(arm);
  const auto held = tensions({2, 0.5, 0.5, 1, 0.5, 0.5});
  const ArmLoadPath path = arm_follow_load(arm, held, {}, {0.01, 0, 0}, 20, {}, work);
  EXPECT_EQ(path.end, LoadEnd::limit);
  EXPECT_EQ(path.load, 20);
  const ArmState& there = arm_forward(arm, held, {.wrench = {0.2}}, {}, other);
  EXPECT_LT((path.state.tip.p - there.tip.p).norm(), 1e-6);
  EXPECT_GT(path.margin, 0.1);
}

/// Bent over to one side and pushed back across: beyond a fold it snaps, and only the other side is left.
TEST(ArmLoadPath, ABuckledColumnSnapsThrough) {
  const Arm arm = column();
  ArmWorkspace work(arm);
  ArmLoad load{.wrench = {0.3, 0, -3}};  // beyond Euler's load, leaning to +x
  const ArmLoadPath path =
      arm_follow_load(arm, {}, load, {-0.05, 0, 0}, 1000, {.model = ArmModel::rod}, work);
  // In space it turns around instead of snapping: a strip that is stiff across has no way around.
  Arm strip = arm;
  strip.sections[0].start.bending_x = strip.sections[0].end.bending_x = 100;
  strip.sections[0].start.torsion = strip.sections[0].end.torsion = 100;
  ArmWorkspace narrow(strip);
  const ArmLoadPath snap =
      arm_follow_load(strip, {}, load, {-0.05, 0, 0}, 1000, {.model = ArmModel::rod}, narrow);
  EXPECT_EQ(snap.end, LoadEnd::fold) << to_string(snap.end);
  EXPECT_GT(snap.state.tip.p.x(), 0);
  EXPECT_GT(snap.load, 6);  // against its lean
  EXPECT_LE(path.load, snap.load + 1e-6);
  // Just beyond, an equilibrium is on the other side.
  ArmLoad beyond = load;
  beyond.wrench[0] -= 0.05 * snap.load * 1.001;
  ArmWorkspace after(strip);
  for (const ArmEquilibrium& one : arm_equilibria(strip, {}, beyond, {.model = ArmModel::rod}, 30, after))
    if (one.state.stable) {
      EXPECT_LT(one.state.tip.p.x(), 0);
    }
  beyond.wrench[0] += 0.05 * snap.load * 0.002;
  int both = 0;
  for (const ArmEquilibrium& one : arm_equilibria(strip, {}, beyond, {.model = ArmModel::rod}, 30, after))
    both += one.state.stable;
  EXPECT_EQ(both, 2);
}

/// A moment in base axes has no potential: the path says from where stiffness is not definite, and ends.
TEST(ArmLoadPath, MomentsEndHonestly) {
  const Arm arm = column(0.7);
  ArmWorkspace work(arm);
  const ArmLoadPath path =
      arm_follow_load(arm, {}, {}, {0, 0, -0.1, 0, 0, 0.5}, 60, {.model = ArmModel::rod}, work);
  EXPECT_TRUE(path.state.report.ok());
  EXPECT_GT(path.load, 1);
  EXPECT_GE(path.definite_until, 0);
}

TEST(ArmLoadPath, RefusesWhatIsNoLoad) {
  const Arm arm = column();
  ArmWorkspace work(arm);
  for (const double bad : {0.0, std::nan(""), 1e305}) {
    const ArmLoadPath path = arm_follow_load(arm, {}, {}, {bad}, 10, {}, work);
    EXPECT_EQ(path.end, LoadEnd::stalled);
    EXPECT_EQ(path.state.report.status, Status::bad_input);
  }
  EXPECT_EQ(arm_follow_load(arm, {}, {}, {1}, -1, {}, work).state.report.status, Status::bad_input);
}

}  // namespace arm_load_path_test
}  // namespace sinew::test
