#include "io/document/quantity.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace quantity_test {

using namespace sinew;
using std::numbers::pi;

double value(std::string_view text, Dimension dimension) {
  const auto result = parse_quantity(text, dimension);
  EXPECT_TRUE(result) << (result ? "" : to_string(result.error()));
  return result.value_or(std::numeric_limits<double>::quiet_NaN());
}

Error error(std::string_view text, Dimension dimension) {
  const auto result = parse_quantity(text, dimension);
  EXPECT_FALSE(result) << text;
  return result ? Error{} : result.error().front();
}

TEST(Quantity, EveryUnitIsTheSiNumber) {
  struct Row {
    const char* text;
    Dimension dimension;
    double si;
  };
  const Row rows[] = {
      {"3 m", Dimension::length, 3},
      {"175 mm", Dimension::length, 0.175},
      {"17.5 cm", Dimension::length, 0.175},
      {"5 um", Dimension::length, 5e-6},
      {"5 µm", Dimension::length, 5e-6},       // U+00B5
      {"5 \u03BCm", Dimension::length, 5e-6},  // U+03BC
      {"1/2 in", Dimension::length, 0.0127},
      {"3 in", Dimension::length, 0.0762},
      {"0.5 rad", Dimension::angle, 0.5},
      {"5 mrad", Dimension::angle, 0.005},
      {"45 deg", Dimension::angle, pi / 4},
      {"45°", Dimension::angle, pi / 4},
      {"5 1/m", Dimension::curvature, 5},
      {"5/m", Dimension::curvature, 5},
      {"1/m", Dimension::curvature, 1},
      {"1/2 1/m", Dimension::curvature, 0.5},
      {"0.005 1/mm", Dimension::curvature, 5},
      {"2 N", Dimension::force, 2},
      {"2 mN", Dimension::force, 0.002},
      {"2 kN", Dimension::force, 2000},
      {"2 N m", Dimension::moment, 2},
      {"2 N·m", Dimension::moment, 2},
      {"2 N*m", Dimension::moment, 2},
      {"2 Nm", Dimension::moment, 2},
      {"2 N mm", Dimension::moment, 0.002},
      {"2 mN m", Dimension::moment, 0.002},
      {"2 Pa", Dimension::pressure, 2},
      {"2 kPa", Dimension::pressure, 2000},
      {"2 MPa", Dimension::pressure, 2e6},
      {"60 GPa", Dimension::pressure, 6e10},
      {"2 kg", Dimension::mass, 2},
      {"2 g", Dimension::mass, 0.002},
      {"7850 kg/m^3", Dimension::density, 7850},
      {"7850 kg/m3", Dimension::density, 7850},
      {"7850 kg/m³", Dimension::density, 7850},
      {"7.85 g/cm^3", Dimension::density, 7850},
      {"7.85 g/cm3", Dimension::density, 7850},
      {"9.81 m/s^2", Dimension::acceleration, 9.81},
      {"9.81 m / s2", Dimension::acceleration, 9.81},
      {"0.5 N/m", Dimension::line_load, 0.5},
      {"500 mN / m", Dimension::line_load, 0.5},
      {"2 N/mm", Dimension::line_load, 2000},
      {"2 N m^2", Dimension::rigidity, 2},
      {"200 N·mm²", Dimension::rigidity, 2e-4},
      {"0.05 mm/N", Dimension::compliance, 5e-5},
      {"3 g/m", Dimension::line_mass, 0.003},
      {"2 s", Dimension::time, 2},
      {"5 mm/s", Dimension::speed, 0.005},
      {"0.5 rad/s", Dimension::angular_speed, 0.5},
      {"180 deg/s", Dimension::angular_speed, pi},
      {"180 deg/s^2", Dimension::angular_acceleration, pi},
      {"25 mm/s^2", Dimension::acceleration, 0.025},
      {"2 ms", Dimension::time, 0.002},
      {"2 us", Dimension::time, 2e-6},
      {"2 µs", Dimension::time, 2e-6},
      {"-1e-3", Dimension::number, -0.001},
      {"6", Dimension::count, 6},
  };
  for (const Row& row : rows) EXPECT_EQ(value(row.text, row.dimension), row.si) << row.text;
}

TEST(Quantity,
     DecimalUnitsRoundOnce) {  // 0.3 mm as 0.3/1000, and 83.1 GPa as 83.1*1e9, are one bit off for some
  for (int i = 1; i < 5000; ++i) {
    const std::string digits = std::to_string(i);
    EXPECT_EQ(value(digits + "e-1 mm", Dimension::length), std::stod(digits + "e-4"));
    EXPECT_EQ(value("0." + digits + "GPa", Dimension::pressure), std::stod("0." + digits + "e9"));
  }
}

TEST(Quantity, QuarterTurnsAreExact) {
  EXPECT_EQ(value("90 deg", Dimension::angle), pi / 2);
  EXPECT_EQ(value("180 deg", Dimension::angle), pi);
  EXPECT_EQ(value("270 deg", Dimension::angle), 1.5 * pi);
  EXPECT_EQ(value("360 deg", Dimension::angle), 2 * pi);
}

TEST(Quantity, NumbersMayBeWrittenInManyWays) {
  EXPECT_EQ(value("  +175mm ", Dimension::length), 0.175);
  EXPECT_EQ(value("1.75E2 mm", Dimension::length), 0.175);
  EXPECT_EQ(value("1.75e+02mm", Dimension::length), 0.175);
  EXPECT_EQ(value(".5 m", Dimension::length), 0.5);
  EXPECT_EQ(value("5. m", Dimension::length), 5.0);
  EXPECT_EQ(value("-1/4 m", Dimension::length), -0.25);
  EXPECT_EQ(value("3/8", Dimension::number), 0.375);
}

TEST(Quantity, WrongDimensionSaysWhatItIsAndWhatToGive) {
  const Error e = error("0.2 kg", Dimension::length);
  EXPECT_EQ(e.code, "wrong_dimension");
  EXPECT_EQ(e.message, R"("0.2 kg" is a mass; give a length ("0.2 m", "200 mm", or 0.2 for metres).)");
  EXPECT_EQ(error("5 mm", Dimension::number).message, R"("5 mm" is a length; give a plain number (0.5).)");
  EXPECT_EQ(error("5 N", Dimension::count).code, "wrong_dimension");
}

TEST(Quantity, UnknownUnitSuggestsAndLists) {
  const Error e = error("0.2 mn", Dimension::length);
  EXPECT_EQ(e.code, "unknown_unit");
  EXPECT_EQ(e.message,
            R"("0.2 mn" has the unknown unit "mn"; did you mean "m"? Units of a length: m, mm, cm, um, in.)");
  EXPECT_EQ(
      error("60 gpa", Dimension::pressure).message,
      R"("60 gpa" has the unknown unit "gpa"; did you mean "GPa"? Units of a pressure: Pa, kPa, MPa, GPa.)");
  EXPECT_EQ(error("2 furlongs", Dimension::length).message,
            R"("2 furlongs" has the unknown unit "furlongs". Units of a length: m, mm, cm, um, in.)");
  EXPECT_EQ(error("3 km", Dimension::length).code, "unknown_unit");
  EXPECT_EQ(error("5 apples", Dimension::number).message,
            R"("5 apples" has the unknown unit "apples"; give a plain number (0.5).)");
}

TEST(Quantity, WhatIsNoNumberIsRefused) {
  for (const char* text : {"", " ", "long", "mm", "-", ".", "+-1", "e5", "inf", "nan", "-inf m", ".5.5.",
                           "1/0", "1e999", "1e308 GPa", "1e99999999999", "--1", "\xC3"})
    EXPECT_NE(error(text, Dimension::pressure).code, "wrong_dimension") << text;
  EXPECT_EQ(error("long", Dimension::length).message,
            R"("long" is not a number; give a length ("0.2 m", "200 mm", or 0.2 for metres).)");
  EXPECT_EQ(error("nan", Dimension::number).code, "not_a_number");
  EXPECT_EQ(error("1/0", Dimension::number).code, "not_a_number");
  EXPECT_EQ(error("1e308 GPa", Dimension::pressure).code, "not_a_number");
  EXPECT_EQ(error("0x10", Dimension::number).code, "unknown_unit");
  EXPECT_EQ(error("2.5", Dimension::count).code, "not_whole");
}

TEST(Quantity, LongTextIsCutInMessages) {
  const Error e = error(std::string(10'000, 'x'), Dimension::length);
  EXPECT_LT(e.message.size(), 200U);
}

TEST(Quantity, ParseNumberTakesTheWholeText) {
  EXPECT_EQ(parse_number("+5"), 5.0);
  EXPECT_EQ(parse_number("1e3"), 1000.0);
  for (const char* text :
       {"", "5 ", " 5", "5m", "0x10", "inf", "nan", ".inf", "1_000", "1e999", "1/2", "+", "++1"})
    EXPECT_FALSE(parse_number(text)) << text;
}

TEST(Quantity, HumanTextIsInMillimetresAndDegrees) {
  EXPECT_EQ(human(0.175, Dimension::length), "175 mm");
  EXPECT_EQ(human(pi / 6, Dimension::angle), "30 deg");
  EXPECT_EQ(human(6e10, Dimension::pressure), "6e+10 Pa");
  EXPECT_EQ(human(5e-3, Dimension::speed), "5 mm/s");
  EXPECT_EQ(human(-0.0, Dimension::number), "0");
  EXPECT_EQ(human(0.123456789, Dimension::moment), "0.123457 N m");
}

TEST(Quantity, SiTextReadsBackTheSame) {
  EXPECT_EQ(si_text(0.1), "0.1");
  for (double x : {1.0 / 3, 6e10, 5e-324, 1.7976931348623157e308, -0.0})
    EXPECT_EQ(parse_number(si_text(x)), x);
}

TEST(Quantity, EveryDimensionHasItsWords) {
  EXPECT_EQ(unit(Dimension::moment), "N m");
  EXPECT_EQ(unit(Dimension::count), "");
  EXPECT_EQ(noun(Dimension::acceleration), "an acceleration");
  EXPECT_EQ(noun(Dimension::time), "a time");
  EXPECT_EQ(noun(Dimension::line_load), "a load by length");
  EXPECT_EQ(unit(Dimension::line_mass), "kg/m");
}

}  // namespace quantity_test
