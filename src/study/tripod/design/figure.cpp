/// The figure of 3pfs/design: curves over the pair angle, and over the diameter under load.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "study/tripod/design/parts.hpp"

namespace sinew::inline v1::tripod {
namespace {

constexpr std::array colours{Colour::blue, Colour::vermillion, Colour::green, Colour::orange, Colour::purple};
constexpr double compared_height = 400;  // [mm], where base radii are drawn

std::vector<double> times(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

Panel over_angle(std::string title, Axis y, Legend legend) {
  return {
      .title = std::move(title),
      .x =
          {.label = "half-angle of the pairs ψ", .unit = "deg", .log = true, .low = 1, .high = 50, .step = 2},
      .y = std::move(y),
      .series = {},
      .legend = legend};
}

/// A curve for each height, low ones first.
void add_heights(Panel& panel, const Designs& made, double radius, Measure measure) {
  for (std::size_t h = 0; h < made.heights.size(); ++h)
    panel.series.push_back({.label = fmt::format("h = {:g} mm", made.heights[h]),
                            .x = made.angles,
                            .y = times(made.over_angle(index_of(made.radii, radius), h, measure), 1e3),
                            .mark = Mark::line_points,
                            .colour = colours[h % colours.size()]});
}

/// A curve for each base radius, wide ones first.
void add_radii(Panel& panel, const Designs& made, double height, Measure measure) {
  for (std::size_t i = made.radii.size(); i-- > 0;)
    panel.series.push_back({.label = fmt::format("r_A = {:g} mm", made.radii[i]),
                            .x = made.angles,
                            .y = times(made.over_angle(i, index_of(made.heights, height), measure), 1e3),
                            .mark = Mark::line_points,
                            .colour = colours[i % colours.size()]});
}

void add_rigid(Panel& panel, const Designs& made, const char* label) {
  const double rigid = 1e3 * made.all.front().rigid;
  panel.series.push_back({.label = label,
                          .x = {made.angles.front(), made.angles.back()},
                          .y = {rigid, rigid},
                          .mark = Mark::dashed,
                          .colour = Colour::black,
                          .width = 1.5});
}

/// Loads on G2 as lines, on G1 dashed.
Panel by_diameter(const char* title, Axis y, std::span<const Loaded> presets, Measure measure,
                  Legend legend) {
  Panel panel{.title = title,
              .x = {.label = "diameter of the rods", .unit = "mm", .low = 1.8, .high = 6.2, .step = 1},
              .y = std::move(y),
              .series = {},
              .legend = legend};
  for (const Loaded& preset : presets) {
    const bool solid = preset.name == "G2";
    for (std::size_t load = 0; load < std::size(load_names); ++load)
      panel.series.push_back({.label = solid ? load_names[load] : "",
                              .x = preset.diameters,
                              .y = times(preset.over_diameter(load, measure), 1e3),
                              .mark = solid ? Mark::line_points : Mark::dashed,
                              .colour = load == 0 ? Colour::black : colours[load - 1]});
  }
  return panel;
}

Panel turn_of(const Designs& made, double radius) {
  Panel panel = over_angle(fmt::format("turn, r_A = {:g} mm", radius),
                           {.label = "rms e₃", .unit = "10⁻³", .log = true, .low = 0.01, .high = 10},
                           Legend::bottom_left);
  add_heights(panel, made, radius, &Measures::turn);
  return panel;
}

const Axis distance{.label = "distance from rigid", .unit = "mm", .log = true, .low = 0.04, .high = 60};

Panel distance_of(const Designs& made, double radius) {
  Panel panel = over_angle(fmt::format("distance, r_A = {:g} mm", radius), distance, Legend::bottom_left);
  add_heights(panel, made, radius, &Measures::distance);
  add_rigid(panel, made, "rigid 3PRS");
  return panel;
}

/// Base radii compared at one height.
Panel radii_of(const Designs& made, const char* what, Axis y, Measure measure, Legend legend) {
  Panel panel = over_angle(fmt::format("{}, h = {:g} mm", what, compared_height), std::move(y), legend);
  add_radii(panel, made, compared_height, measure);
  add_rigid(panel, made, "rigid 3PRS");
  return panel;
}

}  // namespace

Figure design_figure(const Designs& made, std::span<const Loaded> presets) {
  const Axis turn{.label = "rms e₃", .unit = "10⁻³", .log = true, .low = 0.05, .high = 200};
  const Axis shift{.label = "rms (x, y)", .unit = "mm", .log = true, .low = 1, .high = 40, .step = 2};
  return {
      .title = "",
      .panels = {turn_of(made, 250), turn_of(made, 175),
                 radii_of(made, "shift", shift, &Measures::shift, Legend::top_right),
                 by_diameter("turn under load, G1 dashed", turn, presets, &Measures::turn, Legend::top_right),
                 distance_of(made, 250), distance_of(made, 175),
                 radii_of(made, "distance", distance, &Measures::distance, Legend::none),
                 by_diameter("distance under load, G1 dashed", distance, presets, &Measures::distance,
                             Legend::none)},
      .columns = 4,
      .width = 1800,
      .height = 800,
      .comments = {
          fmt::format("sinew {}, study 3pfs/design: root mean squares over tilts to 20 degrees", version()),
          "distance from rigid: of (x, y) from that of the 3PRS, Altuzarra et al. 2023, (10); "
          "rigid 3PRS: what that one is itself"}};
}

}  // namespace sinew::inline v1::tripod
