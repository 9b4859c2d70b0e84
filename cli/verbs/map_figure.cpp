#include "map_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "figure/quantity_name.hpp"
#include "sinew/base/numbers.hpp"
#include "text_table.hpp"

namespace sinew::cli {
namespace {

constexpr int max_panels = 9;

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

std::size_t stride(const PoseGrid& grid, std::size_t axis) {
  std::size_t product = 1;
  for (std::size_t a = 0; a < axis; ++a) product *= static_cast<std::size_t>(grid.axes[a].count);
  return product;
}

/// A plane of the map: two of its axes, and where on the others.
struct Slice {
  const SingularityMap& map;
  const Probe& probe;
  std::size_t x, y, offset;

  std::size_t columns() const { return static_cast<std::size_t>(map.grid.axes[x].count); }
  std::size_t rows() const { return static_cast<std::size_t>(map.grid.axes[y].count); }
  std::size_t index(std::size_t i, std::size_t j) const {
    return offset + i * stride(map.grid, x) + j * stride(map.grid, y);
  }
  const MapSample& at(std::size_t i, std::size_t j) const { return map.samples[index(i, j)]; }
};

/// What vanishes at a type II: 0 there, whatever rounding left of it.
double signed_volume(const MapSample& sample) { return sample.is_type_2 ? 0 : sample.determinant; }

/// How far from pose a to pose b of the map the determinant goes through zero; missing where it only jumps,
/// because the legs' branch does.
double zero_between(const Slice& slice, std::size_t a, std::size_t b) {
  const PoseGrid& grid = slice.map.grid;
  const double start = signed_volume(slice.map.samples[a]), end = signed_volume(slice.map.samples[b]);
  if (start == 0 || end == 0) return start == 0 ? 0 : 1;
  const auto from = grid.coordinates(a), to = grid.coordinates(b);
  double low = 0, high = 1, condition = 1;
  for (int k = 0; k < 30; ++k) {
    const double middle = (low + high) / 2;
    std::array<double, 6> place;
    for (std::size_t c = 0; c < place.size(); ++c) place[c] = std::lerp(from[c], to[c], middle);
    const MapSample sample = slice.probe(grid.pose(place));
    condition = sample.inverse_condition_homogenised;
    ((signed_volume(sample) < 0) == (start < 0) ? low : high) = middle;
  }
  return condition < 1e-6 ? high : not_a_number;
}

/// The pieces of the curve of zero determinant in the cell from column i and row j.
void add_zeros(const Slice& slice, std::size_t i, std::size_t j, Series& curve) {
  constexpr std::array<std::array<std::size_t, 2>, 5> ring{{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}};
  const auto corner = [&](std::size_t c) { return slice.index(i + ring[c][0], j + ring[c][1]); };
  for (std::size_t c = 0; c < 4; ++c)
    if (std::isnan(signed_volume(slice.map.samples[corner(c)]))) return;
  std::vector<std::array<double, 2>> ends;
  for (std::size_t c = 0; c < 4; ++c) {
    const std::size_t a = corner(c), b = corner(c + 1);
    if ((signed_volume(slice.map.samples[a]) < 0) == (signed_volume(slice.map.samples[b]) < 0)) continue;
    const double part = zero_between(slice, a, b);
    if (std::isnan(part)) return;
    const auto from = slice.map.grid.coordinates(a), to = slice.map.grid.coordinates(b);
    ends.push_back(
        {std::lerp(from[slice.x], to[slice.x], part), std::lerp(from[slice.y], to[slice.y], part)});
  }
  for (std::size_t k = 0; k < ends.size(); ++k) {
    curve.x.push_back(ends[k][0]);
    curve.y.push_back(ends[k][1]);
    if (k % 2 == 0) continue;
    curve.x.push_back(not_a_number);
    curve.y.push_back(not_a_number);
  }
}

/// The curves of zero determinant in a slice, between reachable poses; in SI.
Series zero_curve(const Slice& slice) {
  Series curve{.label = {}, .x = {}, .y = {}, .colour = Colour::vermillion, .width = 3};
  for (std::size_t j = 0; j + 1 < slice.rows(); ++j)
    for (std::size_t i = 0; i + 1 < slice.columns(); ++i) add_zeros(slice, i, j, curve);
  return curve;
}

/// `φ = 30°`.
Text named(const Input& axis, double value) {
  const Shown human = shown(axis.unit);
  return place_name(axis.name, six_digits(value * human.factor, 1), human.unit, true);
}

/// `, φ = 30°`: where the axes that do not vary are.
Text fixed_axes(const PoseGrid& grid, const std::vector<Input>& axes) {
  Text text;
  for (std::size_t a = 0; a < axes.size(); ++a)
    if (grid.axes[a].count == 1) text += Text(", ") + named(axes[a], grid.axes[a].from);
  return text;
}

/// `type II throughout`, where there is no curve because all of the slice is one.
std::string remark(const Slice& slice) {
  std::size_t reachable = 0, singular = 0;
  for (std::size_t j = 0; j < slice.rows(); ++j)
    for (std::size_t i = 0; i < slice.columns(); ++i) {
      reachable += slice.at(i, j).is_reachable;
      singular += slice.at(i, j).is_type_2;
    }
  return reachable == 0 ? "not reachable" : singular == reachable ? "type II throughout" : "";
}

Axis axis_of(const Input& axis, const std::vector<double>& values, double max_tics) {
  const double span = std::abs(values.back() - values.front());
  return {.label = quantity_name(axis.name, true),
          .unit = std::string(shown(axis.unit).unit),
          .step = round_step(span, max_tics)};
}

/// So wide that with equal axes little of the page would be left to it.
bool is_wide(const HeatMap& map) {
  return std::abs(map.x.back() - map.x.front()) > 1.1 * std::abs(map.y.back() - map.y.front());
}

Panel panel(const Slice& slice, const std::vector<Input>& axes, double max_tics, double highest) {
  const Input &x = axes[slice.x], &y = axes[slice.y];
  HeatMap heat{.x = places(slice.map.grid.axes[slice.x], x.unit),
               .y = places(slice.map.grid.axes[slice.y], y.unit),
               .values = {},
               .label = "1 / condition number (homogenised)",
               .low = 0,
               .high = std::ceil(20 * highest - 1e-9) / 20};
  for (std::size_t j = 0; j < slice.rows(); ++j)
    for (std::size_t i = 0; i < slice.columns(); ++i)
      heat.values.push_back(slice.at(i, j).inverse_condition_homogenised);
  Panel result{.title = remark(slice),
               .x = axis_of(x, heat.x, max_tics),
               .y = axis_of(y, heat.y, max_tics),
               .series = {},
               .legend = Legend::none,
               .equal_aspect = x.unit == y.unit && !is_wide(heat),
               .map = std::move(heat)};
  Series curve = zero_curve(slice);
  for (double& value : curve.x) value *= shown(x.unit).factor;
  for (double& value : curve.y) value *= shown(y.unit).factor;
  if (!curve.x.empty()) result.series.push_back(std::move(curve));
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
  if (free.size() == 3 && grid.axes[free[2]].count > max_panels)
    return {{"too_many_panels", fmt::format("--{}", axes[free[2]].name),
             fmt::format("has {} values and a figure {} panels at most; give fewer, or write -o map.csv.",
                         grid.axes[free[2]].count, max_panels)}};
  return {};
}

Figure map_figure(const SingularityMap& map, const Probe& probe, const std::vector<Input>& axes,
                  std::string_view robot) {
  const auto free = varying(map.grid);
  const bool has_slices = free.size() == 3;
  const MapAxis third = has_slices ? map.grid.axes[free[2]] : MapAxis{};
  double highest = 0;
  for (const MapSample& sample : map.samples)
    if (sample.is_reachable) highest = std::max(highest, sample.inverse_condition_homogenised);
  Figure figure;
  for (int k = 0; k < third.count; ++k) {
    const std::size_t offset = has_slices ? static_cast<std::size_t>(k) * stride(map.grid, free[2]) : 0;
    Panel next =
        panel({map, probe, free[0], free[1], offset}, axes, has_slices ? 5 : 9, highest > 0 ? highest : 1);
    if (has_slices)
      next.title = named(axes[free[2]], third.at(k)) + (next.title.empty() ? "" : ": ") + next.title;
    figure.panels.push_back(std::move(next));
  }
  const bool has_curve = std::ranges::any_of(figure.panels, [](const Panel& p) { return !p.series.empty(); });
  figure.title = Text(robot) + fixed_axes(map.grid, axes);
  const auto reached = std::ranges::count_if(map.samples, &MapSample::is_reachable);
  const auto all = static_cast<std::ptrdiff_t>(map.samples.size());
  std::string remark;
  if (reached < all)  // the words of `plot`
    remark = fmt::format("{} of {} samples converged; not drawn: {} unreachable (white)", reached, all,
                         all - reached);
  if (has_curve) remark += fmt::format("{}red line: type II", remark.empty() ? "" : "; ");
  figure.remark = remark;
  figure.columns = std::min(3, third.count);
  figure.width = has_slices ? 480 * figure.columns : 760;
  figure.height = has_slices ? 400 * ((third.count + 2) / 3) + 40 : 640;
  return figure;
}

}  // namespace sinew::cli
