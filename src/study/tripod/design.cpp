/// 3pfs/design: parasitic motion of the flexible tripod by pair angle, height, base radius and diameter of
/// the rods. The paper has three heights, one diameter more, and no dimension of its robot. Guide:
/// docs/tripod-design.md
#include <fmt/format.h>

#include "study/item.hpp"
#include "study/tripod/design/parts.hpp"

namespace sinew::inline v1 {
namespace {

using tripod::Designs, tripod::Loaded, tripod::Measures;

std::vector<std::string> design_provenance(const char* what) {
  return {fmt::format("sinew {}, study 3pfs/design: {}", version(), what),
          "root mean squares over tilts to 20 degrees at z = h; rigid: x, y of the 3PRS at the same tilts, "
          "Altuzarra et al. 2023, (10)",
          "drift, square: c1, c2 of x = c1 e2 + 2 c2 e1 e2, y = -c1 e1 + c2 (e1^2 - e2^2), least squares; "
          "rigid 0, -r"};
}

std::vector<double> cells(const Measures& of) {
  return {of.turn,       of.twist(),     1e3 * of.shift,  1e3 * of.distance,
          of.relative(), 1e3 * of.drift, 1e3 * of.square, static_cast<double>(of.solved)};
}

std::vector<double> row(std::vector<double> first, const Measures& of) {
  const auto rest = cells(of);
  first.insert(first.end(), rest.begin(), rest.end());
  return first;
}

Table table_of(const Designs& made) {
  Table table{"base_radius[mm]", "height[mm]", "pair_angle[deg]", "e3",         "twist[deg]", "shift[mm]",
              "distance[mm]",    "relative",   "drift[mm]",       "square[mm]", "poses"};
  table.comments = design_provenance("unloaded tripods, platform radius 125 mm, by their dimensions");
  for (std::size_t i = 0; i < made.radii.size(); ++i)
    for (std::size_t j = 0; j < made.heights.size(); ++j)
      for (std::size_t k = 0; k < made.angles.size(); ++k)
        table.add_row(row({made.radii[i], made.heights[j], made.angles[k]}, made.at(i, j, k)));
  return table;
}

Table table_of(std::span<const Loaded> presets) {
  Table table{"preset",    "height[mm]",   "load",     "diameter[mm]", "e3",         "twist[deg]",
              "shift[mm]", "distance[mm]", "relative", "drift[mm]",    "square[mm]", "poses"};
  table.comments = design_provenance("presets 3pfs-g1 and 3pfs-g2 under load, by the diameter of their rods");
  table.comments.push_back("preset: 1 3pfs-g1, 2 3pfs-g2");
  std::string loads = "load:";
  for (std::size_t k = 0; k < std::size(tripod::load_names); ++k)
    loads +=
        fmt::format(" {} {}{}", k, tripod::load_names[k], k + 1 < std::size(tripod::load_names) ? "," : "");
  table.comments.push_back(loads);
  double preset = 0;
  for (const Loaded& of : presets) {
    preset += 1;
    for (std::size_t load = 0; load < std::size(tripod::load_names); ++load)
      for (std::size_t d = 0; d < of.diameters.size(); ++d)
        table.add_row(row({preset, of.height, static_cast<double>(load), of.diameters[d]}, of.at(load, d)));
  }
  return table;
}

}  // namespace

Expected<ItemResult> tripod_design(const StudyItem&, const std::filesystem::path& folder) {
  const auto study = tripod::swept("3pfs-design", folder);
  if (!study) return tl::unexpected(study.error());
  const auto low = tripod::swept("3pfs-g1-diameter", folder),
             high = tripod::swept("3pfs-g2-diameter", folder);
  if (!low) return tl::unexpected(low.error());
  if (!high) return tl::unexpected(high.error());
  const Designs made = tripod::designs(*study);
  const std::vector<Loaded> presets{tripod::loaded(*low, "G1", 200), tripod::loaded(*high, "G2", 400)};

  ItemResult result{{}, {study->file, low->file, high->file}, {}, {}};
  tripod::add_dimension_findings(result.findings, made);
  tripod::add_lever_findings(result.findings, made);
  if (auto done = tripod::add_load_findings(result.findings, presets, *low); !done)
    return tl::unexpected(done.error());
  tripod::add_recommendations(result.findings, made, presets);

  result.tables.emplace_back("design", table_of(made));
  result.tables.emplace_back("diameter", table_of(presets));
  result.figures.emplace_back("design", tripod::design_figure(made, presets));
  return result;
}

}  // namespace sinew::inline v1
