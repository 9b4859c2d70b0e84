/// 3PFS Fig. 10: the part of the joint space that keeps the platform's point at one height. Ours is exact:
/// inputs that hold z_p = h at each tilt. Theory: docs/theory/tripod_flexible.md
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/tripod/tilt_plane.hpp"

namespace sinew::inline v1 {
namespace {

using tripod::Preset, tripod::presets, tripod::heights, tripod::Swept;

struct PresetStudies {
  const Preset* preset;
  Swept exact, near;
};

/// Mean of the three inputs, less that of the level platform [m].
std::vector<double> common_feeds(const Swept& study, std::span<const std::size_t> rows) {
  double level = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> means;
  for (const std::size_t k : rows) {
    means.push_back((study["L1"][k] + study["L2"][k] + study["L3"][k]) / 3);
    if (std::hypot(study["e1"][k], study["e2"][k]) < 1e-9) level = means.back();
  }
  for (double& mean : means) mean -= level;
  return means;
}

std::vector<std::size_t> rows_at(const Swept& study, double height) {
  return tripod::rows_where(study, [&](std::size_t k) { return study["h"][k] == height; });
}

void add_findings(std::vector<Finding>& findings, const PresetStudies& of) {
  const std::size_t each = of.near.size() / std::size(heights);
  for (std::size_t i = 0; i < std::size(heights); ++i) {
    const auto rows = rows_at(of.exact, heights[i]);
    const auto more = tripod::range_of(common_feeds(of.exact, rows));
    findings.push_back(
        {fmt::format("{}, z_p = {} m: inputs beside the plane L₁ + L₂ + L₃ = const", of.preset->name,
                     heights[i]),
         "drawn, not printed",
         fmt::format("mean {:.2f} to {:.2f} mm more than level, {} poses, tilts to {:.1f}°", 1e3 * more.low,
                     1e3 * more.high, rows.size(), tripod::largest_tilt(of.exact)),
         "", "for information"});
    const auto near = tripod::rows_where(of.near, [&](std::size_t k) { return k / each == i; });
    const std::vector<double> z = tripod::at_rows(of.near["z"], near);
    const auto height = tripod::range_of(z);
    findings.push_back(
        {fmt::format("{}, h = {} m: z_p on that plane, {} poses", of.preset->name, heights[i], z.size()),
         "horizontal plane",
         fmt::format("{:+.2f} to {:+.2f} mm from h", 1e3 * (height.low - heights[i]),
                     1e3 * (height.high - heights[i])),
         "", "for information"});
  }
  findings.push_back(
      compare::claimed(fmt::format("{}: every tilt of the disc is held at its height", of.preset->name),
                       "drawn", fmt::format("{} of {} poses", of.exact.converged(), of.exact.size()),
                       static_cast<double>(of.exact.size() - of.exact.converged()), 0, "without"));
}

/// The inputs in the plane of constant sum, each along its direction at 90°, 210° and 330°: the tripod's own
/// symmetry is then that of the picture.
Panel joint_panel(const PresetStudies& of, std::size_t i) {
  const auto rows = rows_at(of.exact, heights[i]);
  std::vector<double> across, ahead, feeds = common_feeds(of.exact, rows);
  for (const std::size_t k : rows) {
    const double L1 = of.exact["L1"][k], L2 = of.exact["L2"][k], L3 = of.exact["L3"][k];
    across.push_back(1e3 * (L3 - L2) / std::sqrt(3.0));
    ahead.push_back(1e3 * (2 * L1 - L2 - L3) / 3);
  }
  for (double& feed : feeds) feed *= 1e3;
  const auto axis = [](const char* label) {
    return Axis{.label = label, .unit = "mm", .low = -110, .high = 110, .step = 50};
  };
  return {.title = fmt::format("inputs of the 3PFS {} for z_p = {} m", of.preset->name, heights[i]),
          .x = axis("(L₃ − L₂)/√3"),
          .y = axis("(2 L₁ − L₂ − L₃)/3"),
          .series = {tripod::shaded(std::move(across), std::move(ahead), std::move(feeds), 4)},
          .legend = Legend::none,
          .equal_aspect = true,
          .scale = ColourScale{.label = "mean feed [mm]"}};
}

}  // namespace

Expected<ItemResult> tripod_fig10(const StudyItem&, const std::filesystem::path& folder) {
  ItemResult result;
  Figure figure{.title = "", .panels = {}, .columns = 3, .width = 1500, .height = 960, .comments = {}};
  figure.comments = {fmt::format("sinew {}: inputs that keep a height, [3PFS] Fig. 10", version())};
  for (const Preset& preset : presets) {
    auto exact = tripod::swept(preset.height, folder), near = tripod::swept(preset.parasitic, folder);
    if (!exact) return tl::unexpected(exact.error());
    if (!near) return tl::unexpected(near.error());
    const PresetStudies of{&preset, std::move(*exact), std::move(*near)};
    result.swept.push_back(of.exact.file);
    add_findings(result.findings, of);
    for (std::size_t i = 0; i < std::size(heights); ++i) figure.panels.push_back(joint_panel(of, i));
  }
  result.figures.emplace_back("fig10", figure);
  return result;
}

}  // namespace sinew::inline v1
