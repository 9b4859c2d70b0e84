#include "io/figure/contour.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace contour_test {

using namespace sinew;

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// f(x, y) over −1 … 1.
template <class F>
HeatMap map_of(const F& f) {
  HeatMap map{.x = {}, .y = {}, .values = {}, .label = "value"};
  for (int k = -50; k <= 50; ++k) map.x.push_back(k / 50.0);
  map.y = map.x;
  for (const double y : map.y)
    for (const double x : map.x) map.values.push_back(f(x, y));
  return map;
}

std::size_t pieces(const Series& line) {
  return static_cast<std::size_t>(std::ranges::count_if(line.x, [](double x) { return std::isnan(x); }));
}

TEST(Contour, ALineLiesWhereTheValueIsAndIsOneClosedPiece) {
  const Series line = contour_line(map_of([](double x, double y) { return x * x + 2 * y * y; }), 0.6);
  ASSERT_GT(line.x.size(), 200U);
  EXPECT_EQ(pieces(line), 1U);
  EXPECT_EQ(line.x.front(), line.x[line.x.size() - 2]);
  EXPECT_EQ(line.y.front(), line.y[line.y.size() - 2]);
  for (std::size_t k = 0; k + 1 < line.x.size(); ++k)
    EXPECT_NEAR(line.x[k] * line.x[k] + 2 * line.y[k] * line.y[k], 0.6, 3e-4);
}

TEST(Contour, WhereAllFourSidesAreCrossedTheCentreDecides) {
  const auto joined = [](double centre) {  // corners − + − +, about the centre of one cell
    const HeatMap map{.x = {0, 1}, .y = {0, 1}, .values = {-1 + centre, 1, 1, -1 + centre}, .label = {}};
    const Series line = contour_line(map, 0);
    EXPECT_EQ(line.x.size(), 6U);
    return line.x[0] + line.y[0] < 1 && line.x[1] + line.y[1] < 1;  // the first piece cuts off corner (0, 0)
  };
  EXPECT_TRUE(joined(0.1));    // the centre is positive: the negative corners are apart
  EXPECT_FALSE(joined(-0.1));  // negative: they are one region, and the first piece is not at (0, 0) alone
}

TEST(Contour, WhatIsNotANumberHasNoLine) {
  const auto holed = map_of([](double x, double y) { return x > 0 ? missing : x + 0 * y; });
  const Series line = contour_line(holed, -0.5);
  ASSERT_FALSE(line.x.empty());
  for (const double x : line.x) EXPECT_TRUE(std::isnan(x) || std::abs(x + 0.5) < 1e-15) << x;
  EXPECT_TRUE(contour_line(holed, 0.5).x.empty());
}

TEST(Contour, ALineEndsAtTheEdgeAndIsNotClosed) {
  const Series line = contour_line(map_of([](double x, double y) { return x + 0 * y; }), 0.01);
  EXPECT_EQ(pieces(line), 1U);
  EXPECT_EQ(line.x.size(), 102U);
  EXPECT_EQ(std::abs(line.y.front() - line.y[100]), 2);
}

TEST(Contour, LevelsAreRoundAndInside) {
  EXPECT_EQ(
      contour_levels(map_of([](double x, double y) { return 0.43 * x + 0 * y; })),
      (std::vector<double>{-0.4, -0.30000000000000004, -0.2, -0.1, 0, 0.1, 0.2, 0.30000000000000004, 0.4}));
  EXPECT_TRUE(contour_levels(map_of([](double, double) { return 3; })).empty());
  EXPECT_TRUE(contour_levels(map_of([](double, double) { return missing; })).empty());
}

TEST(Contour, LevelsOfALogarithmicMapAreOneTwoFiveUntilThereAreTooMany) {
  HeatMap map = map_of([](double x, double y) { return std::pow(10, 0.9 * x + 0 * y); });
  map.log = true;
  EXPECT_EQ(contour_levels(map), (std::vector<double>{0.2, 0.5, 1, 2, 5}));
  map = map_of([](double x, double y) { return std::pow(10, 20 * x + 0 * y); });
  map.log = true;
  const auto levels = contour_levels(map);
  EXPECT_LE(levels.size(), 12U);
  EXPECT_GE(levels.size(), 6U);
  for (const double level : levels) EXPECT_NEAR(std::log10(level), std::round(std::log10(level)), 1e-12);
}

Panel panel_of(HeatMap map) {
  return {.title = {},
          .x = {.label = "x", .unit = "mm"},
          .y = {.label = "y", .unit = "mm"},
          .series = {},
          .map = std::move(map)};
}

TEST(Contour, EachLineBearsItsValueAndLeavesRoomForIt) {
  Panel panel = panel_of(map_of([](double x, double y) { return x + 0 * y; }));
  add_contours(panel, {-0.5, 0.5}, 700, 600);
  ASSERT_EQ(panel.series.size(), 2U);
  ASSERT_EQ(panel.notes.size(), 2U);
  EXPECT_EQ(panel.notes[0].text, "−0.5");
  EXPECT_EQ(panel.notes[0].colour, Colour::white);  // on the dark
  EXPECT_EQ(panel.notes[1].colour, Colour::black);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(panel.notes[i].x, i == 0 ? -0.5 : 0.5, 1e-9);
    EXPECT_GE(pieces(panel.series[i]), 2U);
    for (const double y : panel.series[i].y)
      EXPECT_TRUE(std::isnan(y) || std::abs(y - panel.notes[i].y) > 0.03) << y;
  }
}

TEST(Contour, NoValueIsWrittenOverAnEmptyCellAndNoneOnASpeck) {
  Panel panel = panel_of(map_of([](double x, double y) { return std::abs(y) > 0.02 ? missing : x + 0 * y; }));
  add_contours(panel, {0.01}, 700, 600);
  EXPECT_TRUE(panel.notes.empty());
  Panel peak = panel_of(map_of([](double x, double y) { return -(x * x + y * y); }));
  add_contours(peak, {-1e-5}, 700, 600);
  ASSERT_EQ(peak.series.size(), 1U);
  EXPECT_TRUE(peak.series[0].x.empty());
}

TEST(RoundStep, IsOneTwoOrFive) {
  EXPECT_EQ(round_step(9, 9), 1);
  EXPECT_EQ(round_step(11, 10), 2);
  EXPECT_EQ(round_step(30, 10), 5);
  EXPECT_EQ(round_step(60, 10), 10);
  EXPECT_DOUBLE_EQ(round_step(0.003, 10), 0.0005);
}

}  // namespace contour_test
