/// Arms under load against other people's codes, closed forms and published tables (docs/validation.md).
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

/// Rods of another code, rounded to 1e-4 m: world x is the rod's z.
class OtherRods : public testing::TestWithParam<const char*> {};
TEST_P(OtherRods, Shapes) {
  const Json& file = reference_file(std::string("data/outside/") + GetParam());
  const Json& rod = file["rod"];
  const double E = rod["E"].get<double>(), radius = rod["radius"].get<double>(),
               length = rod["length"].get<double>();
  const Arm arm = cantilever(
      length,
      round_section({E, E / 2 / (1 + rod["nu"].get<double>()), rod["rho"].get<double>()}, 2 * radius));
  const auto turned = [](const Json& v, std::size_t from = 0) {
    return std::array{-v[from + 2].get<double>(), v[from + 1].get<double>(), v[from].get<double>()};
  };
  std::vector<double> errors;
  const auto stations = rod["stations_of_each_half"].get<std::vector<double>>();
  for (const Json& c : file["cases"]) {
    ArmLoad load;
    load.gravity = turned(c["gravity"]);
    PointLoad middle;
    middle.place = length / 2;
    const auto put = [&](const Json& from, std::array<double, 6>& to) {
      const auto force = turned(from), moment = turned(from, 3);
      for (std::size_t i = 0; i < 3; ++i) to[i] = force[i], to[i + 3] = moment[i];
    };
    put(c["mid_wrench"], middle.wrench);
    put(c["tip_wrench"], load.wrench);
    load.points = {middle};
    ArmWorkspace work(arm);
    const ArmState& state = arm_forward(arm, {}, load, {.model = ArmModel::rod}, work);
    ASSERT_TRUE(state.report.ok()) << c["id"] << to_string(state.report);
    std::vector<double> places;
    for (const double half : {0.0, 0.5})
      for (const double s : stations) places.push_back(length * (half + s / 2));
    const auto frames = arm_frames(arm, places, work);
    double worst = 0;
    for (const std::size_t k : {6U, 13U}) {  // the middle and the tip
      const auto expected = turned(c["points"][k]);
      worst = std::max(worst, (frames[k].p - Vec3<double>(expected[0], expected[1], expected[2])).norm());
    }
    errors.push_back(worst);
  }
  std::ranges::sort(errors);
  EXPECT_LE(errors[errors.size() / 2], 0.15e-3);
  EXPECT_LE(errors.back(), 0.6e-3);
  RecordProperty("median_mm", std::to_string(1e3 * errors[errors.size() / 2]));
  RecordProperty("most_mm", std::to_string(1e3 * errors.back()));
}
INSTANTIATE_TEST_SUITE_P(ArmReference, OtherRods,
                         testing::Values("rod_statics_steel.json", "rod_statics_tpu.json"));

/// EI = 1, L = 1, neither stretch nor shear: the elastica.
Arm elastica() {
  CrossSection section;
  section.bending_x = section.bending_y = section.torsion = 1;
  return cantilever(1, section);
}

TEST(ArmTables, CantileverUnderTipForce) {
  const double table[][4] = {{1, 0.46135195, 0.30172077, 0.05643324},
                             {5, 1.21536812, 0.71379152, 0.38762836}};
  const Arm arm = elastica();
  for (const auto& [alpha, slope, deflection, shortening] : table) {
    ArmWorkspace work(arm);
    const ArmState& state =
        arm_forward(arm, {}, {.wrench = {alpha}}, {.model = ArmModel::rod, .accuracy = 1e-8}, work);
    ASSERT_TRUE(state.report.ok()) << to_string(state.report);
    EXPECT_NEAR(state.tip.p.x(), deflection, 1e-7);
    EXPECT_NEAR(1 - state.tip.p.z(), shortening, 1e-7);
    EXPECT_NEAR(state.tip.R.log().norm(), slope, 1e-7);
  }
}

TEST(ArmTables, UniformLoadDeadAndFollowing) {
  const Arm arm = elastica();
  ArmWorkspace work(arm);
  const ArmState dead =
      arm_forward(arm, {}, {.along = {5}}, {.model = ArmModel::rod, .accuracy = 1e-8}, work);
  ASSERT_TRUE(dead.report.ok()) << to_string(dead.report);
  EXPECT_NEAR(dead.tip.p.z(), 0.84666, 1e-5);
  EXPECT_NEAR(dead.tip.p.x(), 0.49591, 1e-5);
  const ArmState following =
      arm_forward(arm, {}, {.following_along = {5}}, {.model = ArmModel::rod, .accuracy = 1e-7}, work);
  ASSERT_TRUE(following.report.ok()) << to_string(following.report);
  EXPECT_NEAR(following.tip.p.z(), 0.79552, 1e-5);
  EXPECT_NEAR(following.tip.p.x(), 0.56042, 1e-5);
}

/// Bathe and Bolourchi's bend of 45°, radius 100, force 300 out of its plane.
TEST(ArmTables, BendOf45Degrees) {
  const double E = 1e7, G = E / 2;
  CrossSection section{E / 12, E / 12, G / 6, E, G * 5 / 6, 0};
  Arm arm = cantilever(100 * std::numbers::pi / 4, section);
  arm.sections[0].curvature = {0, 0.01, 0};  // from z towards x
  ArmWorkspace work(arm);
  const ArmState& state =
      arm_forward(arm, {}, {.wrench = {0, 300}}, {.model = ArmModel::rod, .accuracy = 1e-8}, work);
  ASSERT_TRUE(state.report.ok()) << to_string(state.report);
  // the table's axes: along, in the plane, out of it
  EXPECT_NEAR(state.tip.p.z(), 58.778897, 1e-5);
  EXPECT_NEAR(state.tip.p.x(), 22.244679, 1e-5);
  EXPECT_NEAR(state.tip.p.y(), 40.192392, 1e-5);
}

}  // namespace arm_reference_test
}  // namespace sinew::test
