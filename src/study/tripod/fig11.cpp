/// 3PFS Figs. 11 to 13: the parasitic e₃, x_p and y_p of the flexible tripod beside the rigid 3PRS, which has
/// the same tilt. The paper prints three root mean squares of e₃, but neither geometry nor inputs; both
/// presets are run. Theory: docs/theory/tripod_flexible.md
#include <fmt/format.h>

#include <cmath>

#include "sinew/base/numbers.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/equilibrium.hpp"
#include "sinew/kinematics/inverse.hpp"
#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/tripod/tilt_plane.hpp"

namespace sinew::inline v1 {
namespace {

using tripod::Preset, tripod::presets, tripod::heights, tripod::Swept;

constexpr double printed_rmse[] = {0.0132, 0.0095, 0.0065};  // for h = 0.2, 0.4, 0.6 m

/// One of the parasitic coordinates.
struct Coordinate {
  std::string_view column, label, unit;
  double scale;  ///< to the unit
};
constexpr Coordinate e3{"e3", "e₃", "", 1}, x{"x", "x_p", "mm", 1e3}, y{"y", "y_p", "mm", 1e3};

struct PresetHeights {
  const Preset* preset;
  Robot robot;
  Swept near, exact;  ///< poses near the three heights, and at them
};

/// The rigid twin at the tilt of each sample.
struct Rigid {
  Robot robot;

  double at(const Coordinate& what, double z, double e1, double e2) const {
    const ConstrainedPose pose = constrained_pose(robot, {z, e1, e2});
    if (!pose.ok()) return not_a_number;
    if (what.column == x.column) return pose.pose.position.x();
    return what.column == y.column ? pose.pose.position.y() : pose.pose.quaternion[3];
  }
  std::vector<double> all(const Coordinate& what, const Swept& study, const char* z) const {
    std::vector<double> values;
    for (std::size_t k = 0; k < study.size(); ++k)
      values.push_back(at(what, study[z][k], study["e1"][k], study["e2"][k]));
    return values;
  }
};

/// Those of the poses that start from the length of one of the heights, in their order.
std::vector<std::size_t> rows_near(const Swept& study, std::size_t height) {
  const std::size_t each = study.size() / std::size(heights);
  return tripod::rows_where(study, [&](std::size_t k) { return k / each == height; });
}

/// Parasitic turns of the same tilts at the height exactly.
double rmse_at_height(const PresetHeights& of, std::size_t height) {
  Workspace work(of.robot);
  std::vector<double> turns;
  for (const std::size_t k : rows_near(of.near, height)) {
    const Equilibrium held = inverse_equilibrium(
        of.robot, IndependentPose{heights[height], of.near["e1"][k], of.near["e2"][k]}, {}, work);
    turns.push_back(held.is_solved() ? held.pose.quaternion[3] : not_a_number);
  }
  return tripod::root_mean_square(turns);
}

std::string name_of(const PresetHeights& of, std::size_t height) {
  return fmt::format("{}, h = {} m", of.preset->name, heights[height]);
}

void add_turns(std::vector<Finding>& findings, const PresetHeights& of) {
  for (std::size_t i = 0; i < std::size(heights); ++i) {
    const auto rows = rows_near(of.near, i);
    const double ours = tripod::root_mean_square(tripod::at_rows(of.near["e3"], rows));
    const double off = ours / printed_rmse[i] - 1;
    findings.push_back({fmt::format("RMSE of e_3, {}, {} poses", name_of(of, i), rows.size()),
                        fmt::format("{}", printed_rmse[i]), fmt::format("{:.6f}", ours),
                        fmt::format("{:+.1f} %", 100 * off), std::abs(off) <= 0.05 ? "agrees" : "differs"});
    findings.push_back({fmt::format("the same tilts at z = h exactly, {}", name_of(of, i)), "not printed",
                        fmt::format("{:.6f}", rmse_at_height(of, i)), "", "for information"});
  }
}

void add_shifts(std::vector<Finding>& findings, const PresetHeights& of, const Coordinate& what,
                const Rigid& rigid) {
  const std::vector<double> twin = rigid.all(what, of.near, "z");
  for (std::size_t i = 0; i < std::size(heights); ++i) {
    const auto rows = rows_near(of.near, i);
    const std::vector<double> ours = tripod::at_rows(of.near[what.column], rows),
                              theirs = tripod::at_rows(twin, rows);
    std::vector<double> off;
    for (std::size_t k = 0; k < ours.size(); ++k) off.push_back(ours[k] - theirs[k]);
    const double apart = tripod::root_mean_square(off), size = tripod::root_mean_square(theirs);
    findings.push_back(compare::given(
        fmt::format("{} beside the 3PRS, {}", what.label, name_of(of, i)), "slight differences",
        fmt::format("rms {:.2f} mm, rigid {:.2f} mm, apart {:.2f} mm: {:.0f} %; likeness {:+.2f}",
                    1e3 * tripod::root_mean_square(ours), 1e3 * size, 1e3 * apart, 100 * apart / size,
                    tripod::likeness(ours, theirs)),
        apart / size, 0.25, "of the rigid rms"));
  }
}

/// Why agreement and difference mean no more than they do.
void add_reasons(std::vector<Finding>& findings, const Coordinate& what) {
  findings.push_back(
      {"radii, pairs, inputs", "not printed",
       "G1 and the range of its inputs, 64 mm, were found by (36) and these root mean squares; "
       "G2 has the radii of the 3PRS",
       "", "for information"});
  if (what.column == e3.column) return;
  findings.push_back(
      {"why x and y are not those of the 3PRS", "its rods do not keep the joints in their planes",
       "near pairs hold them less than wide ones; (36) itself has c_2 of the sign opposite to the rigid "
       "tripod's −r, and a term linear in the tilt that this has not",
       "", "for information"});
}

Table table_of(std::span<const PresetHeights> all, const Coordinate& what, const Rigid& rigid) {
  const std::string heading = what.unit.empty() ? std::string(what.column) : std::string(what.column) + "[m]";
  Table table{"preset", "h[m]", "z[m]", "e1", "e2", heading, "rigid_" + heading};
  table.comments = {fmt::format("sinew {}: {} of the flexible tripod and of the 3PRS, [3PFS] section 4",
                                version(), what.column)};
  double number = 1;
  for (const PresetHeights& of : all) {
    const auto twin = rigid.all(what, of.near, "z");
    for (std::size_t i = 0; i < std::size(heights); ++i)
      for (const std::size_t k : rows_near(of.near, i))
        table.add_row({number, heights[i], of.near["z"][k], of.near["e1"][k], of.near["e2"][k],
                       of.near[what.column][k], twin[k]});
    ++number;
  }
  return table;
}

std::vector<double> scaled(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

std::string label_of(const Coordinate& what) {
  return what.unit.empty() ? std::string(what.label) : fmt::format("{} [{}]", what.label, what.unit);
}

Panel map_panel(const PresetHeights& of, std::size_t height, const std::vector<double>& values,
                const Coordinate& what, std::string title) {
  Panel panel = tripod::tilt_panel(std::move(title), 0.32);
  panel.map = tripod::height_map(of.exact, heights[height], scaled(values, what.scale), label_of(what));
  panel.series.push_back(tripod::rim());
  return panel;
}

Series dots(const PresetHeights& of, std::size_t height) {
  const auto rows = rows_near(of.near, height);
  return {.label = "",
          .x = tripod::at_rows(of.near["e1"], rows),
          .y = tripod::at_rows(of.near["e2"], rows),
          .mark = Mark::points,
          .colour = Colour::white,
          .width = 3};
}

Figure figure_of(std::span<const PresetHeights> all, const Coordinate& what, const Rigid& rigid) {
  const bool shows_rigid = what.column != e3.column;  // its e₃ is 0
  Figure figure{.title = "",
                .panels = {},
                .columns = shows_rigid ? 4 : 3,
                .width = shows_rigid ? 2000.0 : 1500.0,
                .height = 960,
                .comments = {fmt::format("sinew {}: parasitic {} over the tilts", version(), what.column),
                             "white dots: poses of the joint space whose root mean square is compared"}};
  for (const PresetHeights& of : all) {
    for (std::size_t i = 0; i < std::size(heights); ++i) {
      figure.panels.push_back(
          map_panel(of, i, of.exact[what.column], what,
                    fmt::format("{} of the 3PFS {}, z = {} m", what.label, of.preset->name, heights[i])));
      figure.panels.back().series.push_back(dots(of, i));
    }
    if (shows_rigid)
      figure.panels.push_back(map_panel(of, 0, rigid.all(what, of.exact, "h"), what,
                                        fmt::format("{} of the rigid 3PRS", what.label)));
  }
  return figure;
}

Expected<ItemResult> reproduce_coordinate(const StudyItem& item, const std::filesystem::path& folder,
                                          const Coordinate& what) {
  auto twin = load("3prs");
  if (!twin) return tl::unexpected(twin.error());
  const Rigid rigid{std::move(*twin)};
  std::vector<PresetHeights> all;
  ItemResult result;
  for (const Preset& preset : presets) {
    auto near = tripod::swept(preset.parasitic, folder), exact = tripod::swept(preset.height, folder);
    auto robot = load(preset.robot);
    if (!near) return tl::unexpected(near.error());
    if (!exact) return tl::unexpected(exact.error());
    if (!robot) return tl::unexpected(robot.error());
    all.push_back({&preset, std::move(*robot), std::move(*near), std::move(*exact)});
    result.swept.push_back(all.back().near.file);
    result.swept.push_back(all.back().exact.file);
    if (what.column == e3.column)
      add_turns(result.findings, all.back());
    else
      add_shifts(result.findings, all.back(), what, rigid);
  }
  add_reasons(result.findings, what);
  const std::string name(item.id.substr(item.id.find('/') + 1));
  result.tables.emplace_back(name, table_of(all, what, rigid));
  result.figures.emplace_back(name, figure_of(all, what, rigid));
  return result;
}

}  // namespace

Expected<ItemResult> tripod_fig11(const StudyItem& item, const std::filesystem::path& folder) {
  return reproduce_coordinate(item, folder, e3);
}
Expected<ItemResult> tripod_fig12(const StudyItem& item, const std::filesystem::path& folder) {
  return reproduce_coordinate(item, folder, x);
}
Expected<ItemResult> tripod_fig13(const StudyItem& item, const std::filesystem::path& folder) {
  return reproduce_coordinate(item, folder, y);
}

}  // namespace sinew::inline v1
