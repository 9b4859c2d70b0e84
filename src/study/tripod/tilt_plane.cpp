#include "study/tripod/tilt_plane.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "study/tripod/contour.hpp"
#include "study/tripod/example.hpp"

namespace sinew::inline v1::tripod {
namespace {

/// The grid of studies/3pfs-*-height.yaml.
constexpr double reach = 0.3;
constexpr int places_a_side = 31;

}  // namespace

Extent range_of(std::span<const double> values) {
  Extent found{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const double value : values)
    if (std::isfinite(value)) found = {std::min(found.low, value), std::max(found.high, value)};
  return found;
}

double largest_tilt(const Swept& study) {
  double most = 0;
  for (std::size_t k = 0; k < study.size(); ++k)
    if (const double size = std::hypot(study["e1"][k], study["e2"][k]); size > most) most = size;
  return tilt(std::min(1.0, most));
}

Panel tilt_panel(std::string title, double reach) {
  Panel panel = plane(std::move(title));
  for (Axis* axis : {&panel.x, &panel.y}) axis->low = -reach, axis->high = reach, axis->step = 0.1;
  return panel;
}

Series shaded(std::vector<double> e1, std::vector<double> e2, std::vector<double> values, double width) {
  return {.label = "",
          .x = std::move(e1),
          .y = std::move(e2),
          .mark = Mark::points,
          .width = width,
          .shades = std::move(values)};
}

HeatMap height_map(const Swept& study, double z, const std::vector<double>& values, std::string label) {
  HeatMap map{.x = {}, .y = {}, .values = {}, .label = std::move(label)};
  const double step = 2 * reach / (places_a_side - 1);
  for (int k = 0; k < places_a_side; ++k) map.x.push_back(-reach + k * step);
  map.y = map.x;
  map.values.assign(map.x.size() * map.y.size(), std::numeric_limits<double>::quiet_NaN());
  const auto place = [&](double e) { return static_cast<std::size_t>(std::lround((e + reach) / step)); };
  for (std::size_t k = 0; k < study.size(); ++k)
    if (study["h"][k] == z)
      map.values[place(study["e2"][k]) * map.x.size() + place(study["e1"][k])] = values[k];
  return contour::spread(std::move(map));
}

Series rim() { return circle(reach, Mark::outside, Colour::black, 1); }

}  // namespace sinew::inline v1::tripod
