/// Arms written as files and read again; tables of measured rows.
#include "sinew/analysis/identify.hpp"
#include "sinew/io/table.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "io/document/parse.hpp"
#include "io/robots/arm_file.hpp"
#include "measured_arms.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::test {
namespace measured_arm_test {

Arm again(const Arm& arm) {
  const auto text = arm_text(arm);
  if (!text) throw std::runtime_error(to_string(text.error()));
  return read_arm(parse_yaml(*text, "again.yaml").value()).value();
}

/// All of it, but the ends of helices, which the file has as a difference: these to the last digit but one.
void expect_same(const Arm& arm, const Arm& other) {
  EXPECT_EQ(arm.name, other.name);
  EXPECT_EQ(arm.gravity, other.gravity);
  EXPECT_EQ(arm.tip_mass, other.tip_mass);
  EXPECT_EQ(arm.tip_mass_place, other.tip_mass_place);
  EXPECT_EQ(arm.geometry_inferred, other.geometry_inferred);
  EXPECT_EQ(arm.tolerance, other.tolerance);
  EXPECT_EQ(arm.measurement.value_or(MeasuringSetup{}), other.measurement.value_or(MeasuringSetup{}));
  ASSERT_EQ(arm.motor.has_value(), other.motor.has_value());
  if (arm.motor) {
    EXPECT_EQ(arm.motor->lead, other.motor->lead);
    EXPECT_EQ(arm.motor->counts, other.motor->counts);
    EXPECT_EQ(arm.motor->gear, other.motor->gear);
  }
  ASSERT_EQ(arm.sections.size(), other.sections.size());
  for (std::size_t m = 0; m < arm.sections.size(); ++m) {
    const ArmSection &a = arm.sections[m], &b = other.sections[m];
    EXPECT_EQ(a.length, b.length);
    EXPECT_EQ(a.start, b.start);
    EXPECT_EQ(a.end, b.end);
    EXPECT_EQ(a.round_taper, b.round_taper);
    EXPECT_EQ(a.curvature, b.curvature);
    EXPECT_EQ(a.discs.count, b.discs.count);
    EXPECT_EQ(a.discs.mass, b.discs.mass);
    EXPECT_EQ(a.discs.radius, b.discs.radius);
  }
  ASSERT_EQ(arm.tendons.size(), other.tendons.size());
  for (std::size_t i = 0; i < arm.tendons.size(); ++i) {
    const ArmTendon &a = arm.tendons[i], &b = other.tendons[i];
    EXPECT_EQ(a.compliance, b.compliance);
    EXPECT_EQ(a.friction, b.friction);
    EXPECT_EQ(a.outside, b.outside);
    EXPECT_EQ(a.pretension, b.pretension);
    ASSERT_EQ(a.routes.size(), b.routes.size());
    for (std::size_t m = 0; m < a.routes.size(); ++m) {
      EXPECT_EQ(a.routes[m].start_radius, b.routes[m].start_radius);
      EXPECT_EQ(a.routes[m].end_radius, b.routes[m].end_radius);
      EXPECT_EQ(a.routes[m].start_angle, b.routes[m].start_angle);
      EXPECT_NEAR(a.routes[m].end_angle, b.routes[m].end_angle,
                  4e-16 * (1 + std::abs(a.routes[m].start_angle)));
    }
  }
}

TEST(ArmText, ReadsBackAsTheArmsThatComeWithSinew) {
  int arms = 0;
  for (const std::string_view name : builtin_robot_names()) {
    const Robot robot = load(std::string(name)).value();
    if (!robot.arm()) continue;
    SCOPED_TRACE(name);
    expect_same(*robot.arm(), again(*robot.arm()));
    ++arms;
  }
  EXPECT_GE(arms, 4);
  const Arm shown = read_arm(parse_yaml(robot_template("arm"), "arm.yaml").value()).value();
  expect_same(shown, again(shown));
}

TEST(ArmText, ReadsBackAsAnyArm) {
  std::mt19937 gen(7);
  const auto random = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(gen);
  };
  const auto often = [&] { return random(0, 1) < 0.7; };
  for (int trial = 0; trial < 300; ++trial) {
    Arm arm;
    arm.name = trial % 3 == 0 ? "an \"arm\": #1 \\ [x]" : "arm";
    arm.tolerance = random(0, 1e-3);
    arm.geometry_inferred = often();
    if (often()) arm.gravity = {random(-10, 10), random(-10, 10), random(-10, 10)};
    if (often()) arm.tip_mass = random(0, 0.1);
    if (often()) arm.tip_mass_place = {random(-1, 1), random(-1, 1), random(-1, 1)};
    if (often()) arm.motor = TendonMotor{.lead = random(1e-4, 1e-2), .counts = 4096, .gear = random(1, 9)};
    const int sections = static_cast<int>(random(1, 5.99));
    for (int m = 0; m < sections; ++m) {
      ArmSection section;
      section.length = random(0.01, 0.5);
      const auto cross = [&] {
        return CrossSection{random(1e-4, 1), random(1e-4, 1), random(1e-4, 1),
                            random(1, 1e6),  random(1, 1e6),  random(0, 1)};
      };
      section.start = section.end = cross();
      if (often()) section.end = cross();
      if (often()) section.start.bending_y = section.start.bending_x;
      if (often()) section.start.stretch = section.end.stretch = 0;
      if (often()) section.start.shear = section.end.shear = 0;
      section.round_taper = often() && section.end != section.start;
      if (often()) section.curvature = {random(-9, 9), random(-9, 9), random(-9, 9)};
      if (often())
        section.discs = {.count = static_cast<int>(random(8, 20)),
                         .mass = random(0, 0.01),
                         .radius = often() ? 0.02 : 0.0};
      arm.sections.push_back(section);
      const int tendons = m == 0 ? 1 : static_cast<int>(random(0, 4.99));
      for (int i = 0; i < tendons; ++i) {
        ArmTendon tendon;
        const bool is_parallel = often();
        const TendonRoute own{0.015, is_parallel ? 0.015 : random(1e-3, 0.02), random(-9, 9), 0};
        for (int s = 0; s <= m; ++s) {
          TendonRoute route = own;
          route.end_angle = route.start_angle;
          if (!is_parallel) {
            route = {random(1e-3, 0.02), random(1e-3, 0.02), random(-9, 9), 0};
            route.end_angle = route.start_angle + random(-9, 9);
          }
          tendon.routes.push_back(route);
        }
        tendon.compliance = often() ? random(0, 1e-3) : 0;
        tendon.friction = often() ? random(0, 1) : 0;
        tendon.outside = often() ? random(0, 1) : 0;
        tendon.pretension = often() ? random(0, 9) : 0;
        arm.tendons.push_back(tendon);
      }
    }
    const auto of_each = [&](double low, double high) {
      std::vector<double> values;
      if (often())
        for (std::size_t i = 0; i < arm.tendons.size(); ++i) values.push_back(random(low, high));
      return values;
    };
    if (often())
      arm.measurement = MeasuringSetup{{.gain = of_each(0.5, 2),
                                        .offset = of_each(-0.01, 0.01),
                                        .toe = of_each(0, 0.01),
                                        .lag = often() ? random(0, 1) : 0,
                                        .play = often() ? random(0, 0.01) : 0},
                                       {.place = {random(-1, 1), 0, random(-1, 1)},
                                        .base = {0, random(-1, 1), 0},
                                        .tilt = {0, 0, random(-3, 3)}}};
    SCOPED_TRACE(trial);
    expect_same(arm, again(arm));
    if (HasFailure()) FAIL() << arm_text(arm).value();
  }
}

TEST(ArmText, SaysWhatNoFileSays) {
  Arm arm = *load("ftdcr-v4")->arm();
  arm.sections[1].start.torsion = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(arm_text(arm));
  arm = *load("ftdcr-v4")->arm();
  arm.measurement->drive.gain = {1, 1};
  EXPECT_EQ(arm_text(arm).error().front().code, "wrong_tendon_count");
  arm = *load("ftdcr-v4")->arm();
  std::swap(arm.tendons[0], arm.tendons[8]);
  EXPECT_EQ(arm_text(arm).error().front().code, "not_available");
  arm.tendons[0].routes.clear();
  EXPECT_EQ(arm_text(arm).error().front().code, "wrong_size");
  const std::vector<std::string> comments{"two\nlines: {", ""};
  EXPECT_TRUE(arm_text(*load("ftdcr-v4")->arm(), comments)->starts_with("# two lines: {\n#\nsinew: 1\n"));
}

// ---------------------------------------------------------------- measurement

Expected<Arm> with_measurement(std::string_view measurement) {
  std::string text(read_robot_text("ftdcr-v4").value());
  const std::size_t begin = text.find("measurement:"), end = text.find("sections:");
  text.replace(begin, end - begin, fmt::format("measurement: {}\n", measurement));
  return read_arm(parse_yaml(text, "mine.yaml").value());
}

TEST(Measurement, IsReadForAllTendonsForEachOrBySections) {
  const Arm arm =
      with_measurement(
          "{drive: {gain: 1.5, offset: [1 mm, 2 mm, 3 mm, 4 mm, 5 mm, 6 mm, 7 mm, 8 mm, 9 mm], "
          "toe: [[1 mm, 2 mm, 3 mm], [4 mm, 5 mm, 6 mm], [7 mm, 8 mm, 9 mm]], lag: 50 ms, play: 0.2 mm}, "
          "marker: {place: [1 mm, 0, 2 mm], base: [0, 3 mm, 0], tilt: [0, 0, 90 deg]}}")
          .value();
  ASSERT_TRUE(arm.measurement);
  const auto& [drive, marker] = *arm.measurement;
  ASSERT_EQ(drive.gain.size(), 9U);
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(drive.gain[i], 1.5);
    EXPECT_NEAR(drive.offset[i], 1e-3 * static_cast<double>(i + 1), 1e-17);
    EXPECT_EQ(drive.toe[i], drive.offset[i]);
  }
  EXPECT_EQ(drive.lag, 0.05);
  EXPECT_EQ(drive.play, 2e-4);
  EXPECT_EQ(marker.place, (std::array<double, 3>{1e-3, 0, 2e-3}));
  EXPECT_EQ(marker.base, (std::array<double, 3>{0, 3e-3, 0}));
  EXPECT_NEAR(marker.tilt[2], std::acos(0.0), 1e-15);
  EXPECT_FALSE(load("two-segment")->arm()->measurement);
  EXPECT_EQ(measured(*load("two-segment")->arm()).drive, TendonDrive{});
}

TEST(Measurement, SaysWhatIsWrong) {
  const auto code = [](std::string_view measurement) {
    const auto arm = with_measurement(measurement);
    return arm ? std::string("none") : arm.error().front().code;
  };
  EXPECT_EQ(code("{}"), "none");
  EXPECT_EQ(code("{drive: {toe: [1 mm, 2 mm]}}"), "wrong_tendon_count");
  EXPECT_EQ(code("{drive: {toe: [[1 mm, 2 mm], [1 mm], []]}}"), "wrong_tendon_count");
  EXPECT_EQ(code("{drive: {toe: [[1 mm, 1 mm, 1 mm]]}}"), "wrong_tendon_count");
  EXPECT_EQ(code("{drive: {toe: -1 mm}}"), "out_of_range");
  EXPECT_EQ(code("{drive: {gain: 0}}"), "out_of_range");
  EXPECT_EQ(code("{drive: {offset: 1 kg}}"), "wrong_dimension");
  EXPECT_EQ(code("{drive: {lag: 3 mm}}"), "wrong_dimension");
  EXPECT_EQ(code("{drive: {friction: 0.1}}"), "unknown_key");
  EXPECT_EQ(code("{drive: 3}"), "wrong_type");
  EXPECT_EQ(code("{marker: {place: [1, 2]}}"), "wrong_length");
  EXPECT_EQ(code("{marker: {tilt: [0, 0, 1 mm]}}"), "wrong_dimension");
  EXPECT_EQ(code("5"), "wrong_type");
}

// ---------------------------------------------------------------- rows

const std::string heading =
    "sections[0].tendons[0][mm],sections[0].tendons[1][mm],sections[0].tendons[2][mm],sections[0].tendons[3]["
    "mm],"
    "x[mm],y[mm],z[mm]";

Expected<MeasuredRows> rows_of(const std::string& csv) {
  return parse_csv(csv, "rows.csv").and_then([](const Table& table) {
    return read_measured_rows(table, *load("tendon-rod")->arm(), "rows.csv");
  });
}

TEST(MeasuredRows, AreReadInAnyUnitAndOrder) {
  const auto rows = rows_of(
      "note,z[m],x[mm],y[cm],sections[0].tendons[3][mm],sections[0].tendons[1][m],sections[0].tendons[0][mm],"
      "sections[0].tendons[2][um],block,time[ms]\n7,0.5,1,2,4,2e-3,1,3000,5,1500\n8,0.5,1,2,4,2e-3,1,3000,5,"
      "1600\n");
  ASSERT_TRUE(rows) << to_string(rows.error());
  EXPECT_EQ(rows->size(), 2U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(rows->pulls[i], 1e-3 * static_cast<double>(i + 1), 1e-17);
  EXPECT_EQ(rows->markers[0], 1e-3);
  EXPECT_EQ(rows->markers[1], 2e-2);
  EXPECT_EQ(rows->markers[2], 0.5);
  EXPECT_EQ(rows->time, (std::vector<double>{1.5, 1.6}));
  EXPECT_EQ(rows->blocks, (std::vector<int>{5, 5}));
}

TEST(MeasuredRows, SayWhatIsWrong) {
  const auto error = [](const std::string& csv) {
    const auto rows = rows_of(csv);
    return rows ? Error{"none", "", ""} : rows.error().front();
  };
  const auto without = [](std::string text, const std::string& part, const std::string& other) {
    return text.replace(text.find(part), part.size(), other);
  };
  const std::string good = heading + "\n1,2,3,4,5,6,7\n";
  EXPECT_EQ(error(good).code, "none");
  EXPECT_EQ(error("").code, "no_heading");
  EXPECT_EQ(error(heading + "\n").code, "no_rows");
  EXPECT_EQ(error(without(good, "y[mm]", "w[mm]")).code, "missing_column");
  EXPECT_EQ(error(without(good, "sections[0].tendons[2]", "section[0].tendons[2]")).code, "missing_column");
  EXPECT_NE(error(without(good, "sections[0].tendons[2]", "section[0].tendons[2]")).message.find("is it"),
            std::string::npos);
  EXPECT_EQ(error(without(good, "y[mm]", "y")).code, "missing_unit");
  EXPECT_EQ(error(without(good, "tendons[1][mm]", "tendons[1]")).code, "missing_unit");
  EXPECT_EQ(error(without(good, "y[mm]", "y[kg]")).code, "wrong_dimension");
  EXPECT_EQ(error(without(good, "y[mm]", "y[furlong]")).code, "unknown_unit");
  EXPECT_EQ(error(without(good, "6,7", "nan,7")).code, "not_a_number");
  EXPECT_EQ(error(without(good, "6,7", ",7")).code, "not_a_number");
  EXPECT_EQ(error(without(good, "6,7", ",7")).where, "rows.csv: row 1");
  EXPECT_EQ(error(without(good, "6,7", "6,7,8")).code, "wrong_cell_count");
  EXPECT_EQ(error(without(good, "6,7", "6e9,7")).code, "out_of_range");
  EXPECT_EQ(error("sections[0].tendons[4][mm]," + heading + "\n1,1,2,3,4,5,6,7\n").code, "too_many_tendons");
  EXPECT_EQ(error("sections[1].tendons[0][mm]," + heading + "\n1,1,2,3,4,5,6,7\n").code, "too_many_tendons");
  EXPECT_EQ(error("block," + heading + "\n0.5,1,2,3,4,5,6,7\n").code, "not_whole");
  EXPECT_EQ(error("block," + heading + "\n1e12,1,2,3,4,5,6,7\n").code, "out_of_range");
  EXPECT_EQ(error("block[mm]," + heading + "\n1,1,2,3,4,5,6,7\n").code, "wrong_dimension");
  EXPECT_EQ(error("time," + heading + "\n1,1,2,3,4,5,6,7\n").code, "missing_unit");
  EXPECT_EQ(error("time[s]," + heading + "\n2,1,2,3,4,5,6,7\n1,1,2,3,4,5,6,7\n").code, "not_in_order");
  EXPECT_EQ(error("time[s],block," + heading + "\n2,1,1,2,3,4,5,6,7\n1,2,1,2,3,4,5,6,7\n").code, "none");
}

TEST(MeasuredRows, ReadBackAsWritten) {
  for (const char* name : {"ftdcr-v4", "ftdcr-v6"}) {
    const Arm arm = *load(name)->arm();
    const MeasuredRows rows = recording(name).rows;
    const std::string csv = to_csv(measured_table(rows, arm));
    const auto again = parse_csv(csv, "rows.csv").and_then([&](const Table& table) {
      return read_measured_rows(table, arm, "rows.csv");
    });
    ASSERT_TRUE(again) << to_string(again.error());
    EXPECT_EQ(again->time, rows.time);
    EXPECT_EQ(again->blocks, rows.blocks);
    ASSERT_EQ(again->pulls.size(), rows.pulls.size());
    for (std::size_t i = 0; i < rows.pulls.size(); ++i) EXPECT_NEAR(again->pulls[i], rows.pulls[i], 1e-17);
    for (std::size_t i = 0; i < rows.markers.size(); ++i)
      EXPECT_NEAR(again->markers[i], rows.markers[i], 1e-16);
  }
}

}  // namespace measured_arm_test
}  // namespace sinew::test
