#include "io/robots/serial_file.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/document/parse.hpp"
#include "serial_robots.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::test {
namespace serial_file_test {

constexpr std::string_view section =
    "{type: tpcj, segments: 8, joint: 2.375 mm, disc: {height: 2 mm, radius: 3 mm}, tendons: {radius: 2.45 "
    "mm, angle: 24 "
    "deg}}";

Expected<SerialRobot> read(const std::string& sections, const std::string& more = {}) {
  return read_serial_robot(
      parse_yaml("sinew: 1\nname: snake\nkind: serial\n" + more + "sections: " + sections, "mine.yaml")
          .value());
}

std::string error(const std::string& sections, const std::string& more = {}) {
  const auto robot = read(sections, more);
  return robot ? "good" : robot.error().front().message;
}

std::string changed(std::string_view from, std::string_view to) {
  std::string text(section);
  return "[" + text.replace(text.find(from), from.size(), to) + "]";
}

TEST(SerialFile, TheRobotOfThePaperIsThatOfItsTable) {
  const SerialRobot robot = load_serial("nottingham-tpcj").value(), expected = nottingham();
  ASSERT_EQ(robot.sections.size(), 5U);
  for (std::size_t m = 0; m < 5; ++m) {
    const Section &a = robot.sections[m], &b = expected.sections[m];
    EXPECT_EQ(a.segments, b.segments);
    EXPECT_EQ(a.joint, b.joint);
    EXPECT_EQ(a.disc_height, b.disc_height);
    EXPECT_EQ(a.tendon_radius, b.tendon_radius);
    EXPECT_NEAR(a.tendon_angle, b.tendon_angle, 1e-15);
    EXPECT_NEAR(a.limit, b.limit, 1e-16);
    EXPECT_EQ(a.backbone, b.backbone);
  }
  EXPECT_EQ(load_serial("four-tendon-neutral").value().sections[2].tendons, 4);
  EXPECT_EQ(load_serial("three-arcs").value().length(), 3.0);
}

TEST(SerialFile, TemplateOfSerialRobotsReads) {
  const std::string text(robot_template("serial"));
  const SerialRobot robot = read_serial_robot(parse_yaml(text, "serial.yaml").value()).value();
  EXPECT_EQ(robot.sections[1].backbone, kernel::Backbone::neutral);
  EXPECT_EQ(robot.motor->counts_per_length(), 2e6);
  EXPECT_EQ(robot.stretch->stiffness, 15e3);
}

TEST(SerialFile, EveryTemplateOfASerialRobotReads) {
  int count = 0;
  for (const std::string_view name : robot_template_names()) {
    const std::string text(robot_template(name));
    if (text.find("kind: serial") == text.npos || name == "arm") continue;
    const auto robot = read_serial_robot(parse_yaml(text, "serial.yaml").value());
    EXPECT_TRUE(robot) << name << ": " << to_string(robot.error());
    ++count;
  }
  EXPECT_EQ(count, 4);
}

TEST(SerialFile, AnglesMayBeListed) {
  const auto robot = read(
      "{count: 2, type: neutral, segments: 7, joint: 2 mm, tendons: {radius: 2 mm, angle: [10 deg, 50 "
      "deg]}}");
  EXPECT_NEAR(robot.value().sections[1].tendon_angle, degrees(50), 1e-16);
}

TEST(SerialFile, WhatIsWrongIsNamed) {
  EXPECT_EQ(error("[" + std::string(section) + "]"), "good");
  EXPECT_NE(error(changed("segments: 8", "segments: 7")).find("give an even number"), std::string::npos);
  EXPECT_NE(error(changed("2.45 mm", "3.5 mm")).find("outside"), std::string::npos);
  EXPECT_NE(error("[]").find("list at least one section"), std::string::npos);
  EXPECT_NE(error(changed("joint: 2.375 mm", "joint: 2.375 deg")).find("angle"), std::string::npos);
  EXPECT_NE(error(changed("24 deg", "24 deg each")), "good");
  EXPECT_NE(
      error("{count: 2, type: neutral, segments: 7, joint: 2 mm, tendons: {radius: 2 mm, angle: 24 deg}}")
          .find("24 deg each"),
      std::string::npos);
  EXPECT_NE(error("[" + std::string(section) + "]", "motor: {lead: 0 mm, counts: 10}\n"), "good");
  std::string many = "[";
  for (int m = 0; m < 13; ++m) many += (m ? ", " : "") + std::string(section);
  EXPECT_NE(error(many + "]").find("at most 12"), std::string::npos);
}

TEST(SerialFile, WithoutAToleranceAMicrometreIsNoSlack) {
  const std::string one = "[" + std::string(section) + "]";
  EXPECT_NEAR(read(one).value().tolerance, 3e-4 * read(one).value().length(), 1e-15);
  EXPECT_EQ(read(one, "tolerance: 0\n").value().tolerance, 0);
  EXPECT_EQ(read(one, "tolerance: ~\nmotor: {lead: 1 mm, counts: 2}\n").value().tolerance,
            0.5e-3);  // a count of it
}

TEST(SerialFile, LengthsThatVary) {
  const auto with_extension = [](const char* type, const char* extension) {
    return fmt::format(
        "[{{type: {}, segments: 8, joint: 2 mm, tendons: {{radius: 2 mm, angle: 0 deg}}, extension: {}}}]",
        type, extension);
  };
  const SerialRobot robot = read(with_extension("neutral", "[-5 mm, 20 mm]")).value();
  EXPECT_EQ(robot.sections[0].min_extension, -5e-3);
  EXPECT_EQ(robot.sections[0].max_extension, 20e-3);
  EXPECT_TRUE(robot.is_extensible());
  EXPECT_NEAR(robot.longest(), 36e-3, 1e-17);
  EXPECT_NE(error(with_extension("tpcj", "[-5 mm, 20 mm]")).find("twin pivots"), std::string::npos);
  EXPECT_NE(error(with_extension("neutral", "[5 mm, 20 mm]")).find("5 mm"), std::string::npos);
  EXPECT_NE(error(with_extension("neutral", "[0, -1 mm]")), "good");
  EXPECT_NE(error(with_extension("neutral", "[0, 0]")).find("remove it"), std::string::npos);
  EXPECT_NE(error(with_extension("neutral", "[-16 mm, 0]")).find("16 mm long"), std::string::npos);
  EXPECT_NE(error(with_extension("neutral", "20 mm")), "good");
  EXPECT_NE(error(with_extension("neutral", "[nan, 20 mm]")), "good");
}

TEST(SerialFile, ParallelAndSerialRobotsAreNotMistaken) {
  const Robot tpcj = load("nottingham-tpcj").value();
  ASSERT_NE(tpcj.serial(), nullptr);
  EXPECT_EQ(tpcj.serial()->sections.size(), 5u);
  EXPECT_EQ(tpcj.name(), load_serial("nottingham-tpcj")->name);
  EXPECT_EQ(load("3-rfr")->serial(), nullptr);
  EXPECT_NE(load_serial("3-rfr").error().front().message.find("no serial robot"), std::string::npos);
}

TEST(SerialFile, OneSectionOfManyCanBeChanged) {
  const Document document = read_robot_file("nottingham-tpcj").value();
  const auto other = with(document, "sections[1].segments", make_node(6.0));
  const SerialRobot robot = read_serial_robot(other.value()).value();
  EXPECT_EQ(robot.sections[1].segments, 6);
  EXPECT_EQ(robot.sections[2].segments, 8);
  EXPECT_NEAR(robot.sections[4].tendon_angle, degrees(120), 1e-15);
  const SerialRobot all =
      read_serial_robot(with(document, "sections.segments", make_node(6.0)).value()).value();
  EXPECT_EQ(all.sections[4].segments, 6);
}

}  // namespace serial_file_test
}  // namespace sinew::test
