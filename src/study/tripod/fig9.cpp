/// 3PFS Fig. 9: from the joint space of the flexible tripod to its workspace. The paper draws both as clouds
/// of points and prints no number; a cube of inputs about home of either preset. Theory:
/// docs/theory/tripod_flexible.md
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/tripod/example.hpp"
#include "study/tripod/tilt_plane.hpp"

namespace sinew::inline v1 {
namespace {

using tripod::Preset, tripod::presets, tripod::Swept;

/// c₀ of e₃ = c₀ (e₂³ − 3 e₁² e₂), whatever the tilts, by least squares over the fifth of the poses that is
/// lowest, and that which is highest.
tripod::Extent turns_by_height(const Swept& study) {
  std::vector<double> z = study["z"];
  std::ranges::sort(z);
  const double low = z[z.size() / 5], high = z[z.size() - z.size() / 5];
  const auto turn = [&](auto&& wanted) {
    double products = 0, squares = 0;
    for (const std::size_t k : tripod::rows_where(study, wanted)) {
      const double e1 = study["e1"][k], e2 = study["e2"][k], term = e2 * e2 * e2 - 3 * e1 * e1 * e2;
      products += study["e3"][k] * term, squares += term * term;
    }
    return products / squares;
  };
  return {turn([&](std::size_t k) { return study["z"][k] < low; }),
          turn([&](std::size_t k) { return study["z"][k] > high; })};
}

void add_findings(std::vector<Finding>& findings, const Preset& preset, const Swept& study) {
  const auto [z_low, z_high] = tripod::range_of(study["z"]);
  const auto [low, high] = tripod::range_of(study["L1"]);
  findings.push_back({fmt::format("{}: inputs, each", preset.name), "drawn, not printed",
                      fmt::format("{:.1f} to {:.1f} mm, {} poses", 1e3 * low, 1e3 * high, study.size()), "",
                      "for information"});
  findings.push_back({fmt::format("{}: poses", preset.name), "drawn, not printed",
                      fmt::format("z {:.1f} to {:.1f} mm, tilts to {:.1f}°", 1e3 * z_low, 1e3 * z_high,
                                  tripod::largest_tilt(study)),
                      "", "for information"});
  findings.push_back(
      compare::claimed(fmt::format("{}: every set of inputs has a pose in equilibrium, stable", preset.name),
                       "drawn", fmt::format("{} of {}", study.converged(), study.size()),
                       static_cast<double>(study.size() - study.converged()), 0, "poses without"));
  const auto [lowest, highest] = turns_by_height(study);
  findings.push_back({fmt::format("{}: motion the same at every height", preset.name),
                      "workspace independent of z_p as in the 3PRS",
                      fmt::format("e₃ = c (e₂³ − 3 e₁² e₂) with c = {:.3f} over the lowest fifth of the "
                                  "poses, {:.3f} over the highest",
                                  lowest, highest),
                      fmt::format("factor {:.2f}", lowest / highest),
                      std::abs(lowest / highest - 1) < 0.05 ? "agrees" : "differs"});
}

std::vector<double> in_mm(std::vector<double> values) {
  for (double& value : values) value *= 1e3;
  return values;
}

Panel joint_space(const Preset& preset, const Swept& study) {
  const auto [low, high] = tripod::range_of(study["L1"]);
  const double middle = 500 * (low + high), half = 550 * (high - low);
  const auto axis = [&](const char* label) {
    return Axis{.label = label, .unit = "mm", .low = middle - half, .high = middle + half, .step = 50};
  };
  return {.title = fmt::format("inputs of the 3PFS {}", preset.name),
          .x = axis("L₁"),
          .y = axis("L₂"),
          .series = {{.label = "",
                      .x = in_mm(study["L1"]),
                      .y = in_mm(study["L2"]),
                      .mark = Mark::points,
                      .width = 2,
                      .z = in_mm(study["L3"]),
                      .shades = in_mm(study["z"])}},
          .legend = Legend::none,
          .scale = ColourScale{.label = "z_p [mm]"},
          .z = axis("L₃"),
          .eye = Eye{}};
}

Panel workspace(const Preset& preset, const Swept& study) {
  double reach = 0;
  for (std::size_t k = 0; k < study.size(); ++k)
    reach = std::max({reach, std::abs(study["e1"][k]), std::abs(study["e2"][k])});
  Panel panel = tripod::tilt_panel(fmt::format("poses of the 3PFS {}", preset.name), 1.05 * reach);
  panel.scale = ColourScale{.label = "z_p [mm]"};
  panel.series.push_back(tripod::shaded(study["e1"], study["e2"], in_mm(study["z"]), 3));
  return panel;
}

}  // namespace

Expected<ItemResult> tripod_fig9(const StudyItem&, const std::filesystem::path& folder) {
  ItemResult result;
  Figure figure{.title = "", .panels = {}, .columns = 2, .width = 1200, .height = 1060, .comments = {}};
  figure.comments = {fmt::format("sinew {}: joint space and workspace, [3PFS] Fig. 9", version())};
  for (const Preset& preset : presets) {
    const auto study = tripod::swept(preset.workspace, folder);
    if (!study) return tl::unexpected(study.error());
    result.swept.push_back(study->file);
    add_findings(result.findings, preset, *study);
    figure.panels.push_back(joint_space(preset, *study));
    figure.panels.push_back(workspace(preset, *study));
  }
  result.figures.emplace_back("fig9", figure);
  return result;
}

}  // namespace sinew::inline v1
