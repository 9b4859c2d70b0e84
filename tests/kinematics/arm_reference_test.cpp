/// Arms under load against other people's codes (docs/validation.md); rods without tendons:
/// tests/study/truth_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>

#include "arms.hpp"
#include "reference_file.hpp"

namespace sinew::test {
namespace arm_reference_test {

using Json = nlohmann::json;

double distance(const Vec3<double>& a, const Json& b) {
  return std::max({std::abs(a[0] - b[0].get<double>()), std::abs(a[1] - b[1].get<double>()),
                   std::abs(a[2] - b[2].get<double>())});
}

TEST(ArmReference, TendonRodUnderTensions) {
  const Arm arm = tendon_rod();
  const Json& file = reference_file("data/field/tendon_rod_statics.json");
  for (const Json& c : file["cases"]) {
    ArmWorkspace work(arm);
    const auto tau = c["tau_N"].get<std::vector<double>>();
    const ArmState& state =
        arm_forward(arm, tensions(tau), {}, {.model = ArmModel::rod, .accuracy = 1e-9}, work);
    ASSERT_TRUE(state.report.ok()) << to_string(state.report);
    const double most = *std::ranges::max_element(tau) >= 45 ? 1e-7 : 1e-8;
    EXPECT_LT(distance(state.tip.p, c["pL"]), most) << c["tau_N"];
    const Mat<double, 3, 3> R = state.tip.R.matrix();
    for (int i = 0; i < 9; ++i)
      EXPECT_NEAR(R(i / 3, i % 3), c["RL_rowmajor"][static_cast<std::size_t>(i)].get<double>(), 2e-8);
  }
}

/// Also where the public code finds no answer: there by another model of the same arm, as fine as it gets.
TEST(ArmReference, TendonRodUnderDisplacements) {
  const Arm arm = tendon_rod(5e-5);  // 1e-4 1/N of a reference length of 0.5 m
  const Json& file = reference_file("data/field/tendon_rod_displacement_control.json");
  for (const Json& c : file["cases"]) {
    ArmWorkspace work(arm);
    std::vector<double> pulled = c["q_m"].get<std::vector<double>>();
    for (double& change : pulled) change = -change;
    const ArmState& state =
        arm_forward(arm, changes(pulled), {}, {.model = ArmModel::rod, .accuracy = 1e-9}, work);
    ASSERT_TRUE(state.report.ok()) << to_string(state.report);
    if (!c.contains("pL")) continue;
    EXPECT_LT(distance(state.tip.p, c["pL"]), 1e-7);
    for (std::size_t i = 0; i < 4; ++i) {
      const double expected = c["tau_N_or_minus_slack_m"][i].get<double>();
      if (expected > 0)
        EXPECT_NEAR(state.tensions[i], expected, 1e-4);
      else
        EXPECT_NEAR(state.slack[i], -expected, 1e-7) << i;
    }
  }
}

/// Channels and discs of the public two-section code. By energy the discs differ from it: it projects the
/// forces of tendons on discs (docs/theory/strain_rod.md).
TEST(ArmReference, TwoSections) {
  const Arm arm = two_sections();
  const Json& file = reference_file("data/field/tdcr_two_segment_models.json");
  for (const Json& c : file["cases"]) {
    ArmLoad load;
    for (std::size_t i = 0; i < 3; ++i) {
      load.wrench[i] = c["tip_force_N_base_frame"][i].get<double>();
      load.wrench[i + 3] = c["tip_moment_Nm_base_frame"][i].get<double>();
    }
    const auto check = [&](ArmModel model, const char* name, double most) {
      ArmWorkspace work(arm);
      const auto tau = c["tensions_N"].get<std::vector<double>>();
      const ArmState& state = arm_forward(arm, tensions(tau), load, {.model = model}, work);
      ASSERT_TRUE(state.report.ok()) << to_string(state.report);
      const Json& T = c["models"][name]["tip_T_rowmajor_3x4"];
      EXPECT_LT(distance(state.tip.p, {T[3], T[7], T[11]}), most) << name << c["tensions_N"];
    };
    check(ArmModel::subsegment_rod, "VCref_SubsegmentCosserat", 4e-4);
    // The public code leaves out the force of distal tendons at the end of the first section.
    check(ArmModel::rod, "VC_CosseratRod", 2e-3);
  }
}

}  // namespace arm_reference_test
}  // namespace sinew::test
