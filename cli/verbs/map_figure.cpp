#include "map_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "text_table.hpp"

namespace sinew::cli {
namespace {

constexpr int most_panels = 9;
constexpr double missing = MapSample::absent;

std::vector<std::size_t> varying(const PoseGrid& grid) {
  std::vector<std::size_t> result;
  for (std::size_t a = 0; a < grid.axis_count(); ++a)
    if (grid.axes[a].count > 1) result.push_back(a);
  return result;
}

/// Values of an axis as people read them.
std::vector<double> places(const MapAxis& axis, std::string_view unit) {
  std::vector<double> values;
  for (int k = 0; k < axis.count; ++k) values.push_back(axis.at(k) * shown(unit).factor);
  return values;
}

/// A round distance between tics, so that there are few.
double tic_step(const std::vector<double>& values, double most) {
  const double least = std::abs(values.back() - values.front()) / most;
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * power >= least) return factor * power;
  return 10 * power;
}

/// The samples of a plane of the grid, by column and row.
class Slice {
 public:
  Slice(const SingularityMap& map, std::size_t x, std::size_t y, std::size_t offset)
      : map_(map),
        x_step_(stride(map.grid, x)),
        y_step_(stride(map.grid, y)),
        offset_(offset) {}

  static std::size_t stride(const PoseGrid& grid, std::size_t axis) {
    std::size_t product = 1;
    for (std::size_t a = 0; a < axis; ++a) product *= static_cast<std::size_t>(grid.axes[a].count);
    return product;
  }
  const MapSample& at(std::size_t i, std::size_t j) const {
    return map_.samples[offset_ + i * x_step_ + j * y_step_];
  }

 private:
  const SingularityMap& map_;
  std::size_t x_step_, y_step_, offset_;
};

/// Where the determinant vanishes: 0 at a type II, whatever rounding left of it.
double signed_volume(const MapSample& sample) { return sample.is_type_2 ? 0 : sample.determinant; }

/// The curves of zero determinant in a slice, cell by cell, between reachable poses.
Series zero_curve(const Slice& slice, const std::vector<double>& x, const std::vector<double>& y) {
  Series curve{.label = {}, .x = {}, .y = {}, .colour = Colour::vermillion, .width = 3};
  const auto add = [&](double px, double py) {
    curve.x.push_back(px);
    curve.y.push_back(py);
  };
  constexpr std::array<std::array<std::size_t, 2>, 5> ring{{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}};
  for (std::size_t j = 0; j + 1 < y.size(); ++j)
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
      std::array<double, 5> f;
      for (std::size_t c = 0; c < 5; ++c) f[c] = signed_volume(slice.at(i + ring[c][0], j + ring[c][1]));
      if (std::ranges::any_of(f, [](double value) { return std::isnan(value); })) continue;
      int ends = 0;
      for (std::size_t c = 0; c + 1 < 5; ++c) {
        if ((f[c] < 0) == (f[c + 1] < 0)) continue;
        const double part = f[c] / (f[c] - f[c + 1]);
        const auto [di, dj] = ring[c];
        const auto [ei, ej] = ring[c + 1];
        add(std::lerp(x[i + di], x[i + ei], part), std::lerp(y[j + dj], y[j + ej], part));
        if (++ends % 2 == 0) add(missing, missing);
      }
    }
  return curve;
}

/// `phi = 30 deg`.
std::string named(const Input& axis, double value) {
  const Shown human = shown(axis.unit);
  return fmt::format("{} = {} {}", axis.name, six_digits(value * human.factor, 1), human.unit);
}

/// `, phi = 30 deg`: where the axes that do not vary are.
std::string fixed_axes(const PoseGrid& grid, const std::vector<Input>& axes) {
  std::string text;
  for (std::size_t a = 0; a < axes.size(); ++a)
    if (grid.axes[a].count == 1) text += ", " + named(axes[a], grid.axes[a].from);
  return text;
}

/// `type II throughout`, where there is no curve because all of the slice is one.
std::string_view remark(const SingularityMap& map, const Slice& slice, std::size_t x, std::size_t y) {
  const auto columns = static_cast<std::size_t>(map.grid.axes[x].count);
  const auto rows = static_cast<std::size_t>(map.grid.axes[y].count);
  std::size_t reachable = 0, singular = 0;
  for (std::size_t k = 0; k < columns * rows; ++k) {
    const MapSample& sample = slice.at(k % columns, k / columns);
    reachable += sample.is_reachable;
    singular += sample.is_type_2;
  }
  return reachable == 0 ? "not reachable" : singular == reachable ? "type II throughout" : "";
}

Panel panel(const SingularityMap& map, const std::vector<Input>& axes, std::size_t x, std::size_t y,
            std::size_t offset, double most_tics) {
  const Slice slice(map, x, y, offset);
  Panel result{.title = std::string(remark(map, slice, x, y)),
               .x = {.label = axes[x].name, .unit = std::string(shown(axes[x].unit).unit)},
               .y = {.label = axes[y].name, .unit = std::string(shown(axes[y].unit).unit)},
               .series = {},
               .legend = Legend::none,
               .equal_aspect = axes[x].unit == axes[y].unit};
  HeatMap& heat = result.map.emplace();
  heat.x = places(map.grid.axes[x], axes[x].unit);
  heat.y = places(map.grid.axes[y], axes[y].unit);
  result.x.step = tic_step(heat.x, most_tics);
  result.y.step = tic_step(heat.y, most_tics);
  heat.label = "1 / condition number (homogenised)";
  for (std::size_t j = 0; j < heat.y.size(); ++j)
    for (std::size_t i = 0; i < heat.x.size(); ++i)
      heat.values.push_back(slice.at(i, j).inverse_condition_homogenised);
  result.series.push_back(zero_curve(slice, heat.x, heat.y));
  if (result.series[0].x.empty()) result.series.clear();
  return result;
}

}  // namespace

Errors refuse_to_draw(const PoseGrid& grid, const std::vector<Input>& axes) {
  const auto free = varying(grid);
  if (free.size() < 2 || free.size() > 3)
    return {{"no_heat_map", "--output",
             fmt::format("a heat map needs two axes with values FROM : TO : COUNT, or three; here {}. Write "
                         "-o map.csv, or change the axes.",
                         free.empty()       ? "there is none"
                         : free.size() == 1 ? "there is one"
                                            : fmt::format("there are {}", free.size()))}};
  if (free.size() == 3 && grid.axes[free[2]].count > most_panels)
    return {{"too_many_panels", fmt::format("--{}", axes[free[2]].name),
             fmt::format("has {} values and a figure {} panels at most; give fewer, or write -o map.csv.",
                         grid.axes[free[2]].count, most_panels)}};
  return {};
}

Figure map_figure(const SingularityMap& map, const std::vector<Input>& axes, std::string_view robot) {
  const auto free = varying(map.grid);
  const bool has_slices = free.size() == 3;
  const MapAxis third = has_slices ? map.grid.axes[free[2]] : MapAxis{};
  double highest = 0;
  for (const MapSample& sample : map.samples)
    if (sample.is_reachable) highest = std::max(highest, sample.inverse_condition_homogenised);
  Figure figure;
  for (int k = 0; k < third.count; ++k) {
    const std::size_t offset =
        has_slices ? static_cast<std::size_t>(k) * Slice::stride(map.grid, free[2]) : 0;
    Panel next = panel(map, axes, free[0], free[1], offset, has_slices ? 5 : 9);
    if (has_slices)
      next.title = named(axes[free[2]], third.at(k)) + (next.title.empty() ? "" : ": ") + next.title;
    next.map->low = 0;
    next.map->high = highest > 0 ? highest : 1;
    figure.panels.push_back(std::move(next));
  }
  const bool has_curve = std::ranges::any_of(figure.panels, [](const Panel& p) { return !p.series.empty(); });
  figure.title = fmt::format("{}{} (white: out of reach{})", robot, fixed_axes(map.grid, axes),
                             has_curve ? "; red line: type II" : "");
  figure.columns = std::min(3, third.count);
  figure.width = has_slices ? 480 * figure.columns : 760;
  figure.height = has_slices ? 400 * ((third.count + 2) / 3) + 40 : 640;
  return figure;
}

}  // namespace sinew::cli
