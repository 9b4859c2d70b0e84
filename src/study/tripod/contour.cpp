#include "study/tripod/contour.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "io/figure/contour.hpp"
#include "sinew/base/numbers.hpp"

namespace sinew::inline v1::contour {
namespace {

/// A point in the units of the axes.
using Point = std::array<double, 2>;

double value(const HeatMap& map, std::size_t column, std::size_t row) {
  return map.values[row * map.x.size() + column];
}

/// Between the middles of four cells; NaN off the map.
double interpolated(const HeatMap& map, double x, double y) {
  const double across = (x - map.x.front()) / (map.x[1] - map.x[0]),
               up = (y - map.y.front()) / (map.y[1] - map.y[0]);
  const double column = std::floor(across), row = std::floor(up);
  if (!(column >= 0 && row >= 0 && column + 1 < static_cast<double>(map.x.size()) &&
        row + 1 < static_cast<double>(map.y.size())))
    return not_a_number;
  const auto i = static_cast<std::size_t>(column), j = static_cast<std::size_t>(row);
  const double low = std::lerp(value(map, i, j), value(map, i + 1, j), across - column);
  const double high = std::lerp(value(map, i, j + 1), value(map, i + 1, j + 1), across - column);
  return std::lerp(low, high, up - row);
}

/// Where the map first reaches the level along a ray from its middle; NaN where it does not.
Point first_on_ray(const HeatMap& map, double level, double direction) {
  constexpr int steps = 2000;
  const Point middle{0.5 * (map.x.front() + map.x.back()), 0.5 * (map.y.front() + map.y.back())};
  const double reach = 0.5 * std::hypot(map.x.back() - map.x.front(), map.y.back() - map.y.front());
  double before = not_a_number;
  for (int k = 0; k <= steps; ++k) {
    const double radius = reach * k / steps;
    const Point here{middle[0] + radius * std::cos(direction), middle[1] + radius * std::sin(direction)};
    const double off = interpolated(map, here[0], here[1]) - level;
    if (before * off <= 0 || std::abs(off) < 1e-12) return here;
    before = off;
  }
  return {not_a_number, not_a_number};
}

/// The level at a place of its line, which leaves room for it; nothing where the place is none.
void write_on(Panel& panel, Series& line, const Point& at, double level) {
  if (!std::isfinite(at[0])) return;
  std::string text = fmt::format("{:.4g}", std::abs(level));
  const HeatMap& map = *panel.map;
  const double width = map.x.back() - map.x.front(), height = map.y.back() - map.y.front();
  const double across = width * (0.006 + 0.0135 * static_cast<double>(text.size() + (level < 0))),
               up = 0.026 * height;
  for (std::size_t k = 0; k < line.x.size(); ++k)
    if (std::abs(line.x[k] - at[0]) < across && std::abs(line.y[k] - at[1]) < up) line.x[k] = not_a_number;
  if (level < 0) text.insert(0, "−");
  panel.notes.push_back({std::move(text), at[0], at[1], Note::Side::centre, line.colour});
}

}  // namespace

void add(Panel& panel, const std::vector<Levels>& all) {
  const HeatMap& map = *panel.map;
  for (const Levels& levels : all)
    for (const double level : levels.values) {
      Series curve = contour_line(map, level);
      for (const double direction : levels.directions)
        write_on(panel, curve, first_on_ray(map, level, direction * std::numbers::pi / 180), level);
      panel.series.push_back(std::move(curve));
    }
}

HeatMap spread(HeatMap map, int rings) {
  const std::size_t columns = map.x.size(), rows = map.y.size();
  for (int ring = 0; ring < rings; ++ring) {
    const HeatMap before = map;
    for (std::size_t k = 0; k < map.values.size(); ++k) {
      if (std::isfinite(before.values[k])) continue;
      const std::size_t i = k % columns, j = k / columns;
      double sum = 0;
      int count = 0;
      for (std::size_t row = j > 0 ? j - 1 : 0; row <= std::min(j + 1, rows - 1); ++row)
        for (std::size_t column = i > 0 ? i - 1 : 0; column <= std::min(i + 1, columns - 1); ++column)
          if (const double v = value(before, column, row); std::isfinite(v)) sum += v, ++count;
      if (count > 0) map.values[k] = sum / count;
    }
  }
  return map;
}

}  // namespace sinew::inline v1::contour
