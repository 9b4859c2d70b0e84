/// 3PFS Figs. 14 to 16: what a force along z, a moment about x and one about y do to the poses of the
/// flexible tripod. The paper draws clouds of points and prints no number of them; both presets are run,
/// rods of 3 mm of 83 GPa as for Table 1. Theory: docs/theory/tripod_loads.md
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "sinew/io/table.hpp"
#include "study/item.hpp"
#include "study/tripod/loads/claims.hpp"
#include "study/tripod/tilt_plane.hpp"

namespace sinew::inline v1 {
namespace {

using tripod::Load, tripod::LoadCase, tripod::LoadedPairs, tripod::Swept;

constexpr double reach = 0.37;  ///< of e₁ and e₂ drawn; the poses go to 0.33

struct PresetLoads {
  const char* name;
  Swept study;
  LoadCase at;                     ///< the largest load
  std::vector<std::size_t> layer;  ///< what is drawn of its pairs

  LoadedPairs drawn(std::string_view variable) const { return at_rows(pairs_of(study, at, variable), layer); }
};

std::vector<std::string> provenance(const StudyItem& item, Load load) {
  return {
      fmt::format("sinew {}, study {}: poses without a load and under {} = {} {}", version(), item.id,
                  tripod::name_of(load), tripod::value_of(load, tripod::load_steps), tripod::unit_of(load)),
      "rods of 3 mm, 83 GPa; of a cube of 9 x 9 x 9 lengths the layer of one sum"};
}

Table table_of(const StudyItem& item, Load load, const std::vector<PresetLoads>& presets) {
  Table table{"preset", "L1[m]", "L2[m]", "L3[m]"};
  table.comments = provenance(item, load);
  table.comments.push_back("preset: 1 G1, 2 G2");
  for (const char* state : {"unloaded", "loaded"})
    for (const char* heading : {"x[m]", "y[m]", "z[m]", "e1", "e2", "e3"}) {
      table.columns.push_back(Column::named(heading));
      table.columns.back().name += std::string("_") + state;
    }
  for (std::size_t p = 0; p < presets.size(); ++p) {
    const PresetLoads& preset = presets[p];
    std::vector<std::vector<double>> columns{
        std::vector<double>(preset.layer.size(), static_cast<double>(p + 1))};
    for (const char* length : {"L1", "L2", "L3"}) columns.push_back(preset.drawn(length).unloaded);
    for (const auto state : {&LoadedPairs::unloaded, &LoadedPairs::loaded})
      for (const char* variable : {"x", "y", "z", "e1", "e2", "e3"})
        columns.push_back(preset.drawn(variable).*state);
    for (std::size_t c = 0; c < columns.size(); ++c)
      table.columns[c].values.insert(table.columns[c].values.end(), columns[c].begin(), columns[c].end());
  }
  return table;
}

// ---------------------------------------------------------------- figure

/// The loaded poses over their e₁, e₂, shaded by the change of a variable.
Panel changes(const PresetLoads& preset, std::string title, const char* variable, double scale) {
  Panel panel = tripod::tilt_panel(std::move(title), reach);
  panel.x.step = panel.y.step = 0.2;
  std::vector<double> shades = preset.drawn(variable).change();
  for (double& shade : shades) shade *= scale;
  panel.series.push_back(
      tripod::shaded(preset.drawn("e1").loaded, preset.drawn("e2").loaded, std::move(shades), 6));
  panel.scale = ColourScale{};
  return panel;
}

/// With the unloaded poses as open circles, on which the loaded ones lie.
Panel outputs(const PresetLoads& preset) {
  Panel panel = changes(preset, "(a) change of zₚ [mm]", "z", 1e3);
  panel.series.front().width = 3;
  panel.series.insert(panel.series.begin(), {.label = "",
                                             .x = preset.drawn("e1").unloaded,
                                             .y = preset.drawn("e2").unloaded,
                                             .mark = Mark::circles,
                                             .colour = Colour::black,
                                             .width = 1});
  panel.notes.push_back({preset.name, -0.93 * reach, 0.86 * reach});
  return panel;
}

Figure figure_of(const StudyItem& item, Load load, const std::vector<PresetLoads>& presets) {
  Figure figure{.title = fmt::format("{} = {} {}; open circles: without it", tripod::name_of(load),
                                     tripod::value_of(load, tripod::load_steps), tripod::unit_of(load)),
                .panels = {},
                .columns = 4,
                .width = 1900,
                .height = 740,
                .comments = provenance(item, load)};
  for (const PresetLoads& preset : presets) {
    figure.panels.push_back(outputs(preset));
    figure.panels.push_back(changes(preset, "(b) change of 1000 e₃", "e3", 1e3));
    figure.panels.push_back(changes(preset, "(c) change of xₚ [mm]", "x", 1e3));
    figure.panels.push_back(changes(preset, "(d) change of yₚ [mm]", "y", 1e3));
  }
  return figure;
}

/// G1 and G2 run; their files go into the reproduction.
Expected<std::vector<PresetLoads>> presets_under(Load load, ItemResult& result,
                                                 const std::filesystem::path& folder) {
  std::vector<PresetLoads> presets;
  for (std::size_t p = 0; p < 2; ++p) {
    const tripod::LoadedGeometry& geometry = tripod::loaded_geometries[p];
    auto study = tripod::swept(geometry.study, folder);
    if (!study) return tl::unexpected(study.error());
    result.swept.push_back(study->file);
    std::vector<std::size_t> layer = tripod::middle_layer(*study);
    presets.push_back(
        {geometry.name, std::move(*study), {tripod::Rods::thin, load, tripod::load_steps}, layer});
  }
  return presets;
}

Expected<ItemResult> loaded_poses(const StudyItem& item, Load load, const std::filesystem::path& folder) {
  ItemResult result;
  const auto presets = presets_under(load, result, folder);
  if (!presets) return tl::unexpected(presets.error());
  for (const PresetLoads& preset : *presets)
    tripod::add_load_claims(result.findings, preset.name, preset.study, load);

  const std::string stem(item.id.substr(item.id.find('/') + 1));
  result.tables.emplace_back(stem, table_of(item, load, *presets));
  result.figures.emplace_back(stem, figure_of(item, load, *presets));
  return result;
}

}  // namespace

Expected<ItemResult> tripod_fig14(const StudyItem& item, const std::filesystem::path& folder) {
  return loaded_poses(item, Load::force_z, folder);
}

Expected<ItemResult> tripod_fig15(const StudyItem& item, const std::filesystem::path& folder) {
  return loaded_poses(item, Load::moment_x, folder);
}

Expected<ItemResult> tripod_fig16(const StudyItem& item, const std::filesystem::path& folder) {
  return loaded_poses(item, Load::moment_y, folder);
}

}  // namespace sinew::inline v1
