#include "io/robots/arm_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "io/document/parse.hpp"
#include "io/robots/serial_file.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::test {
namespace arm_file_test {

constexpr std::string_view section =
    "{type: elastic, length: 100 mm, backbone: {diameter: 1 mm, material: {E: 50 GPa, poisson: 0.25}}, "
    "discs: {count: 5, radius: 6 mm}, tendons: {count: 3, radius: 5 mm, angle: 90 deg}}";

Expected<Arm> read(std::string_view sections, std::string_view more = {}) {
  return read_arm(parse_yaml(fmt::format("sinew: 1\nname: arm\nkind: serial\n{}sections: {}", more, sections),
                             "mine.yaml")
                      .value());
}

/// One section with a part of it replaced.
std::string changed(std::string_view from, std::string_view to) {
  std::string text(section);
  return text.replace(text.find(from), from.size(), to);
}

/// Code and message of the only error.
Error error(const std::string& sections, std::string_view more = {}) {
  const auto arm = read(sections, more);
  if (arm) return {"none", "", ""};
  EXPECT_EQ(arm.error().size(), 1U) << to_string(arm.error());
  return arm.error().front();
}
Error error_of(std::string_view from, std::string_view to) { return error("[" + changed(from, to) + "]"); }

#define EXPECT_ERROR(found, expected_code, part)                     \
  {                                                                  \
    const Error e = (found);                                         \
    EXPECT_EQ(e.code, expected_code) << e.message;                   \
    EXPECT_NE(e.message.find(part), std::string::npos) << e.message; \
  }

TEST(ArmFile, SectionsOfTwoSegments) {
  const Robot robot = load("two-segment").value();
  ASSERT_NE(robot.arm(), nullptr);
  const Arm& arm = *robot.arm();
  EXPECT_EQ(robot.serial(), nullptr);
  EXPECT_EQ(robot.name(), "two-segment");
  ASSERT_EQ(arm.sections.size(), 2U);
  ASSERT_EQ(arm.tendons.size(), 6U);
  EXPECT_EQ(arm.length(), 0.4);
  EXPECT_EQ(arm.gravity, (std::array<double, 3>{0, 0, 0}));
  for (const ArmSection& one : arm.sections) {
    EXPECT_EQ(one.start, round_section({54e9, 54e9 / 2.6, 0}, 1.4e-3));
    EXPECT_EQ(one.start, one.end);
    EXPECT_EQ(one.discs.count, 10);
  }
  for (std::size_t i = 0; i < 6; ++i) {
    const ArmTendon& tendon = arm.tendons[i];
    EXPECT_EQ(tendon.section(), static_cast<int>(i / 3));
    constexpr double degrees[] = {90, -30, 210};
    for (const TendonRoute& route : tendon.routes) {
      EXPECT_EQ(route.start_radius, 0.01);
      EXPECT_EQ(route.end_radius, 0.01);
      EXPECT_NEAR(route.start_angle, degrees[i % 3] * std::numbers::pi / 180, 1e-15);
      EXPECT_EQ(route.end_angle, route.start_angle);
    }
  }
}

TEST(ArmFile, ChannelsGravityAndComplianceOfTheTendonRod) {
  const Robot robot = load("tendon-rod").value();
  const Arm& arm = *robot.arm();
  EXPECT_EQ(arm.gravity, (std::array<double, 3>{9.81, 0, 0}));
  EXPECT_EQ(robot.weight().gravity.x(), 9.81);
  EXPECT_TRUE(has_weight(robot));
  EXPECT_EQ(arm.sections[0].discs.count, 0);
  EXPECT_EQ(arm.sections[0].start, round_section({200e9, 80e9, 8000}, 2e-3));
  EXPECT_EQ(arm.tendons[3].compliance, 5e-5);
  EXPECT_NEAR(arm.tendons[3].routes[0].start_angle, 1.5 * std::numbers::pi, 1e-15);
}

TEST(ArmFile, StiffnessMayBeAnotherAtTheEnd) {
  const auto backbone = [](std::string_view more) {
    return read("[" +
                changed("{diameter: 1 mm, material: {E: 50 GPa, poisson: 0.25}}",
                        fmt::format("{{bending: [2, 3], torsion: 4, stretch: 5, mass: 6{}}}", more)) +
                "]");
  };
  const Arm arm = backbone(", end: {bending: 1, mass: 7}, taper: round").value();
  EXPECT_EQ(arm.sections[0].start, (CrossSection{2, 3, 4, 5, 0, 6}));
  EXPECT_EQ(arm.sections[0].end, (CrossSection{1, 1, 4, 5, 0, 7}));
  EXPECT_TRUE(arm.sections[0].round_taper);
  EXPECT_FALSE(backbone(", end: {torsion: 1}")->sections[0].round_taper);
  EXPECT_FALSE(backbone(", end: {torsion: 1}, taper: linear")->sections[0].round_taper);
  EXPECT_EQ(backbone(", taper: round").error().front().code, "no_effect");
  EXPECT_EQ(backbone(", end: {bending: -1}").error().front().code, "out_of_range");
  EXPECT_EQ(backbone(", end: {diameter: 1 mm}").error().front().code, "unknown_key");
  EXPECT_EQ(backbone(", end: 3").error().front().code, "wrong_type");
  EXPECT_ERROR(error_of("diameter: 1 mm", "diameter: 1 mm, end: {bending: 1}"), "unknown_key", "end");
}

TEST(ArmFile, MeasuredArmsRead) {
  for (const char* name : {"ftdcr-v4", "ftdcr-v6"}) {
    const Robot robot = load(name).value();
    EXPECT_TRUE(robot.geometry_inferred());
    EXPECT_EQ(robot.arm()->tendons.size(), 9U);
    EXPECT_EQ(robot.arm()->tendons[8].routes.size(), 3U);
  }
}

TEST(ArmFile, TemplateOfArmsReads) {
  const Arm arm = read_arm(parse_yaml(robot_template("arm"), "arm.yaml").value()).value();
  EXPECT_EQ(arm.tendons.size(), 7U);
  EXPECT_EQ(arm.sections[1].discs.count, 0);
  EXPECT_TRUE(arm.sections[1].round_taper);
  EXPECT_NEAR(arm.tendons[0].compliance, 0.55 / 15e3, 1e-18);  // 150 mm in the arm, 400 mm outside
  EXPECT_EQ(arm.tendons[5].compliance, 5e-5);
}

TEST(ArmFile, RoutesConvergeTurnAndPassOtherSections) {
  const Arm arm =
      read(fmt::format("[{}, {}]", section,
                       changed("radius: 5 mm, angle: 90 deg",
                               "radius: 4 mm, angle: 60 deg, end_radius: 3 mm, turn: -30 deg, "
                               "through: [{radius: 5 mm, angle: 10 deg, end_radius: 4 mm, turn: 50 deg}]")))
          .value();
  const auto degrees = [](double angle) { return angle * 180 / std::numbers::pi; };
  const ArmTendon& second = arm.tendons[4];  // 120 deg after the first of the second section
  ASSERT_EQ(second.routes.size(), 2U);
  EXPECT_EQ(second.routes[0].start_radius, 5e-3);
  EXPECT_EQ(second.routes[0].end_radius, 4e-3);
  EXPECT_NEAR(degrees(second.routes[0].start_angle), 130, 1e-12);
  EXPECT_NEAR(degrees(second.routes[0].end_angle), 180, 1e-12);
  EXPECT_EQ(second.routes[1].end_radius, 3e-3);
  EXPECT_NEAR(degrees(second.routes[1].start_angle), 180, 1e-12);
  EXPECT_NEAR(degrees(second.routes[1].end_angle), 150, 1e-12);
}

TEST(ArmFile, AnglesOfPassagesMayBeLeftOut) {
  const Arm arm = read(fmt::format("[{}, {}]", section,
                                   changed("angle: 90 deg", "angle: 30 deg, through: [{radius: 2 mm}]")))
                      .value();
  EXPECT_EQ(arm.tendons[3].routes[0].start_radius, 2e-3);
  EXPECT_EQ(arm.tendons[3].routes[0].start_angle, arm.tendons[3].routes[1].start_angle);
}

TEST(ArmFile, ShortFormIsAListOfSections) {
  std::string shared(section);
  const Arm arm =
      read("{count: 3, " + shared.substr(1, shared.rfind("angle") - 1) + "angle: 20 deg each}}").value();
  ASSERT_EQ(arm.sections.size(), 3U);
  EXPECT_NEAR(arm.tendons[6].routes[2].start_angle, std::numbers::pi / 3, 1e-15);
  const Document document = read_robot_file("two-segment").value();
  const Document other = with(document, "sections[1].tendons[2].radius", make_node(0.008)).value();
  EXPECT_EQ(read_arm(other)->tendons[5].routes[1].start_radius, 0.008);
  EXPECT_EQ(read_arm(other)->tendons[2].routes[0].start_radius, 0.01);
}

TEST(ArmFile, SectionsWithoutTendonsOfTheirOwnArePassed) {
  const std::string bare = changed(", tendons: {count: 3, radius: 5 mm, angle: 90 deg}", "");
  const Arm arm = read(fmt::format("[{}, {}]", bare, section)).value();
  ASSERT_EQ(arm.tendons.size(), 3U);
  EXPECT_EQ(arm.tendons[0].section(), 1);
  EXPECT_ERROR(error("[" + bare + "]"), "no_tendon", "nothing drives the arm");
}

TEST(ArmFile, BackbonesTaperExactly) {
  const Arm wire =
      read("[" + changed("diameter: 1 mm", "diameter: 2 mm, hole: 1 mm, end_diameter: 1 mm") + "]").value();
  const Material material{50e9, 50e9 / 2.5, 0};
  EXPECT_TRUE(wire.sections[0].round_taper);
  EXPECT_EQ(wire.sections[0].start, round_section(material, 2e-3, 1e-3));
  EXPECT_EQ(wire.sections[0].end, round_section(material, 1e-3, 0.5e-3));
  const Arm softer = read("[" + changed("E: 50 GPa", "E: 50 GPa, end_E: 25 GPa") + "]").value();
  EXPECT_FALSE(softer.sections[0].round_taper);
  EXPECT_EQ(softer.sections[0].end.torsion, softer.sections[0].start.torsion / 2);
}

TEST(ArmFile, OtherBackbones) {
  const Arm strip =
      read("[" + changed("diameter: 1 mm", "width: 5 mm, height: 1 mm, law: kirchhoff") + "]").value();
  CrossSection expected = rectangular_section({50e9, 20e9, 0}, 5e-3, 1e-3);
  EXPECT_EQ(strip.sections[0].start.bending_x, expected.bending_x);
  EXPECT_EQ(strip.sections[0].start.stretch, 0);
  EXPECT_EQ(strip.sections[0].start.shear, 0);
  const Arm given = read("[" +
                         changed("{diameter: 1 mm, material: {E: 50 GPa, poisson: 0.25}}",
                                 "{bending: [0.02, 1000 N mm^2], torsion: 0.01 N m^2, stretch: 2 kN, "
                                 "mass: 5 g/m}") +
                         "]")
                        .value();
  EXPECT_EQ(given.sections[0].start, (CrossSection{0.02, 1e-3, 0.01, 2000, 0, 5e-3}));
}

TEST(ArmFile, TendonsGiveWay) {
  const std::string mine = changed("angle: 90 deg", "angle: 90 deg, friction: 0.1, pretension: 2 N");
  const Arm arm = read("[" + mine + "]", "stretch: {stiffness: 1 kN, outside: 300 mm}\n").value();
  EXPECT_DOUBLE_EQ(arm.tendons[1].compliance, 4e-4);
  EXPECT_DOUBLE_EQ(arm.tendons[1].outside, 0.75);  // 300 of 400 mm
  EXPECT_EQ(arm.tendons[1].friction, 0.1);
  EXPECT_EQ(arm.tendons[1].pretension, 2);
  const auto own = [](const char* what) { return "[" + changed("angle: 90 deg", what) + "]"; };
  EXPECT_EQ(
      read(own("angle: 1, compliance: 0.2 mm/N"), "stretch: {stiffness: 1 kN}\n")->tendons[0].compliance,
      2e-4);
  EXPECT_DOUBLE_EQ(read(own("angle: 1, stretch: {stiffness: 10 N}"))->tendons[0].compliance, 0.01);
  EXPECT_EQ(read(own("angle: 1, compliance: 1e-4, outside: 0.2"))->tendons[0].outside, 0.2);
  EXPECT_EQ(read(own("angle: 1, compliance: 1e-4, outside: 1"))->tendons[0].outside, 1);
  EXPECT_EQ(read(own("angle: 1, compliance: 1e-4"), "stretch: {stiffness: 1 kN, outside: 1 m}\n")
                ->tendons[0]
                .outside,
            0);
  EXPECT_EQ(read(own("angle: 1, stretch: {stiffness: 10 N}"))->tendons[0].outside, 0);
  // from disc to disc a helix is straight: 5 spans of 20 mm, each with a chord of 60 deg on 5 mm
  EXPECT_DOUBLE_EQ(read(own("angle: 0, turn: 300 deg, stretch: {stiffness: 1 N}"))->tendons[0].compliance,
                   5 * std::hypot(0.02, 0.005));
}

TEST(ArmFile, HeadOfAnArm) {
  const Arm arm = read(fmt::format("[{}]", section),
                       "geometry: inferred\ngravity: [0, 0, -9.81]\ntip: {mass: 5 g, place: [0, 0, 10 mm]}\n"
                       "tolerance: 0.1 mm\nmotor: {lead: 1 mm, counts: 1000}\n")
                      .value();
  EXPECT_TRUE(arm.geometry_inferred);
  EXPECT_EQ(arm.gravity[2], -9.81);
  EXPECT_EQ(arm.tip_mass, 5e-3);
  EXPECT_EQ(arm.tip_mass_place[2], 0.01);
  EXPECT_EQ(arm.tolerance, 1e-4);
  EXPECT_EQ(arm.motor->counts_per_length(), 1e6);
  EXPECT_NEAR(read(fmt::format("[{}]", section))->tolerance, 3e-5, 1e-18);  // as of other serial robots
}

TEST(ArmFile, SizesThatDoNotFitAreNamed) {
  EXPECT_EQ(error("[" + std::string(section) + "]").code, "none");
  EXPECT_ERROR(error_of("radius: 5 mm", "radius: 7 mm"), "out_of_range", "outside");
  EXPECT_ERROR(error_of("angle: 90 deg", "angle: 90 deg, end_radius: 7 mm"), "out_of_range", "end_radius");
  EXPECT_ERROR(error(fmt::format("[{}, {}]", changed("radius: 6 mm", "radius: 5 mm"),
                                 changed("radius: 5 mm", "radius: 5.5 mm"))),
               "out_of_range", "say where it runs there by through");
  EXPECT_ERROR(error_of("diameter: 1 mm", "diameter: 1 mm, hole: 1 mm"), "out_of_range", "hole");
  EXPECT_ERROR(error_of("diameter: 1 mm", "diameter: 1 mm, end_diameter: -1 mm"), "out_of_range",
               "must be positive");
  EXPECT_ERROR(error_of("angle: 90 deg", "angle: 90 deg, turn: 900 deg"), "out_of_range", "180 deg");
  EXPECT_ERROR(error_of("E: 50 GPa", "E: 0 GPa"), "out_of_range", "must be positive");
  EXPECT_ERROR(error_of("E: 50 GPa", "E: 1e200"), "out_of_range", "is a unit wrong?");
  EXPECT_ERROR(error_of("length: 100 mm", "length: 0"), "out_of_range", "must be positive");
  EXPECT_ERROR(error_of("count: 5", "count: 0"), "out_of_range", "discs.count");
  EXPECT_ERROR(error_of("angle: 90 deg", "angle: 90 deg, compliance: -1e-4"), "out_of_range", "compliance");
  EXPECT_ERROR(error_of("angle: 90 deg", "angle: 90 deg, friction: -0.1"), "out_of_range", "friction");
  EXPECT_ERROR(error_of("angle: 90 deg", "angle: 90 deg, pretension: -1 N"), "out_of_range", "pretension");
  for (const char* share : {"-0.1", "1.1"})
    EXPECT_ERROR(error_of("angle: 90 deg", fmt::format("angle: 90 deg, outside: {}", share)), "out_of_range",
                 "outside");
  EXPECT_ERROR(error_of("angle: 90 deg", "angle: 90 deg, outside: 50 mm"), "wrong_dimension", "outside");
  EXPECT_ERROR(error_of("angle: 90 deg", "angle: 90 deg, stretch: {stiffness: 1 kN}, outside: 0.5"),
               "ambiguous", "outside");
  EXPECT_ERROR(error_of("angle: 90 deg", "angle: 90 deg, stretch: {stiffness: 1e-300}"), "out_of_range",
               "softer");
  EXPECT_ERROR(error("[" + std::string(section) + "]", "tip: {mass: -1 g}\n"), "out_of_range", "tip.mass");
}

TEST(ArmFile, WrongUnitsAreNamed) {
  EXPECT_ERROR(error_of("radius: 5 mm", "radius: 5 deg"), "wrong_dimension", "is an angle");
  EXPECT_ERROR(error_of("E: 50 GPa", "E: 50 N"), "wrong_dimension", "is a force");
  EXPECT_ERROR(error_of("angle: 90 deg", "angle: 90 deg, compliance: 1 mm"), "wrong_dimension",
               "a compliance");
  EXPECT_ERROR(error_of("{diameter: 1 mm, material: {E: 50 GPa, poisson: 0.25}}",
                        "{bending: 1 N m, torsion: 1 N m^2}"),
               "wrong_dimension", "a rigidity");
}

TEST(ArmFile, TendonsBeyondTheirSectionAreNamed) {
  EXPECT_ERROR(error_of("angle: 90 deg", "angle: 90 deg, through: [{radius: 5 mm}]"), "guide_beyond_tip",
               "leave through out");
  EXPECT_ERROR(error(fmt::format(
                   "[{}, {}]", section,
                   changed("angle: 90 deg", "angle: 90 deg, through: [{radius: 5 mm}, {radius: 5 mm}]"))),
               "guide_beyond_tip", "list 1");
  EXPECT_ERROR(
      error(fmt::format("[{}, {}]", section, changed("angle: 90 deg", "angle: 90 deg, through: []"))),
      "missing_guide", "list one for each");
}

TEST(ArmFile, TooMuchAndTooLittleAreNamed) {
  EXPECT_ERROR(error_of("{count: 3, radius: 5 mm, angle: 90 deg}", "[]"), "no_tendon", "the list is empty");
  EXPECT_ERROR(error_of("count: 3", "count: 0"), "out_of_range", "tendons.count");
  EXPECT_ERROR(
      error(fmt::format("[{}, {}]", changed("count: 3", "count: 13"), changed("count: 3", "count: 12"))),
      "too_many_tendons", "25 tendons pass the first section");
  std::string many = "[";
  for (int m = 0; m < 13; ++m) many += (m ? ", " : "") + std::string(section);
  EXPECT_ERROR(error(many + "]"), "too_many_sections", "at most 12");
}

TEST(ArmFile, ChoicesAreMadeOnce) {
  EXPECT_ERROR(error_of("discs:", "guides: channel, discs:"), "ambiguous", "keep one");
  EXPECT_ERROR(error_of("discs: {count: 5, radius: 6 mm}, ", ""), "missing_key", "guides: channel");
  EXPECT_ERROR(error_of("diameter: 1 mm", "diameter: 1 mm, width: 1 mm"), "ambiguous", "width");
  EXPECT_ERROR(error_of("diameter: 1 mm", "bending: 1, torsion: 1"), "ambiguous", "keep one");
  EXPECT_ERROR(error_of("poisson: 0.25", "poisson: 0.25, G: 20 GPa"), "ambiguous", "keep one");
  EXPECT_ERROR(error_of(", poisson: 0.25", ""), "missing_key", "Poisson's ratio");
  EXPECT_ERROR(error_of("diameter: 1 mm, material: {E: 50 GPa",
                        "diameter: 1 mm, end_diameter: 2 mm, material: {E: 50 GPa, end_E: 60 GPa"),
               "not_available", "divide it");
  EXPECT_ERROR(error_of("angle: 90 deg", "angle: 0, compliance: 1e-4, stretch: {stiffness: 1 N}"),
               "ambiguous", "keep one");
}

TEST(ArmFile, KindsOfSectionsDoNotMix) {
  constexpr std::string_view neutral =
      "{type: neutral, segments: 8, joint: 2 mm, tendons: {radius: 2 mm, angle: 0 deg}}";
  EXPECT_ERROR(error(fmt::format("[{}, {}]", section, neutral)), "mixed_sections",
               "make every section elastic");
  EXPECT_ERROR(error(fmt::format("[{}, {}]", section, changed("type: elastic", "type: elastc"))),
               "unknown_choice", "did you mean \"elastic\"?");
  const Document arm = read_robot_file("two-segment").value();
  EXPECT_TRUE(is_serial(arm));
  EXPECT_TRUE(is_arm(arm));
  EXPECT_FALSE(is_arm(read_robot_file("nottingham-tpcj").value()));
  EXPECT_FALSE(is_arm(read_robot_file("3-rfr").value()));
  EXPECT_EQ(read_serial_robot(arm).error().front().code, "wrong_kind");
  EXPECT_EQ(load_serial("two-segment").error().front().code, "wrong_kind");
}

TEST(ArmFile, EveryErrorIsToldAtOnceAndSharedOnesOnce) {
  const auto arm = read(
      "{count: 4, type: elastic, length: -1, backbone: {diameter: 1 mm, material: 3}, "
      "discs: {count: 5}, tendons: [7, {radius: 1 kg, angle: 0}]}");
  ASSERT_FALSE(arm);
  EXPECT_EQ(arm.error().size(), 4U) << to_string(arm.error());
}

TEST(ArmFile, WeightOfAnArmCanBeChanged) {
  const Robot robot = load("tendon-rod").value();
  const Robot other = robot.under({.gravity = {0, 0, -1}});
  EXPECT_EQ(other.arm()->gravity[2], -1);
  EXPECT_NE(other.arm()->identity, robot.arm()->identity);
  EXPECT_FALSE(has_weight(load("two-segment").value()));
}

}  // namespace arm_file_test
}  // namespace sinew::test
