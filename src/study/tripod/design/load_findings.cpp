/// What the diameter of the rods does to parasitic motion: nothing without load.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/equilibrium.hpp"
#include "study/compare.hpp"
#include "study/tripod/design/parts.hpp"

namespace sinew::inline v1::tripod {
namespace {

std::string listed(const std::vector<double>& values, double factor) {
  std::vector<std::string> parts;
  for (const double value : values) parts.push_back(fmt::format("{:.3g}", factor * value));
  return fmt::format("{}", fmt::join(parts, ", "));
}

void add_unloaded(std::vector<Finding>& findings, std::span<const Loaded> presets) {
  std::size_t asked = 0, solved = 0;
  double change = 0;
  for (const Loaded& preset : presets) {
    change = worse(change, preset.unloaded_change);
    for (const Measures& of : preset.all) asked += of.asked, solved += of.solved;
  }
  const auto& diameters = presets.front().diameters;
  findings.push_back(compare::claimed("G1 and G2 under loads, rods of several diameters: solved",
                                      "not printed", fmt::format("{} of {}", solved, asked),
                                      static_cast<double>(asked - solved), 0, "poses"));
  findings.push_back(compare::claimed(
      "without load stiffness changes no pose: what the height does is geometry",
      "more with shorter rods \"because of the increase in stiffness\"",
      fmt::format("rods of {:g} to {:g} mm, {:.0f} times as stiff: the same x, y, e_3 to rounding",
                  diameters.front(), diameters.back(), std::pow(diameters.back() / diameters.front(), 4)),
      change, 1e-12, "m, of e_3 1"));
}

/// Poses of G1 on rods of a diameter [m] under a wrench, at all tilts of a study.
Expected<std::vector<SpatialPose>> poses(double diameter, const SpatialWrench& wrench, const Swept& study) {
  const auto file = read_robot_file("3pfs-g1");
  if (!file) return tl::unexpected(file.error());
  const auto changed = with(*file, "defaults.link.diameter", make_node(diameter));
  if (!changed) return tl::unexpected(changed.error());
  const auto robot = read_robot(*changed);
  if (!robot) return tl::unexpected(robot.error());
  Workspace work(*robot);
  std::vector<SpatialPose> found;
  const auto rows = rows_where(study, [&, &load = study["load"], &d = study["d"]](std::size_t k) {
    return load[k] == load.front() && d[k] == d.front();
  });
  for (const std::size_t k : rows) {
    const auto here =
        inverse_equilibrium(*robot, {0.2, study["e1"][k], study["e2"][k]}, {.wrench = wrench}, work);
    found.push_back(here.is_solved() ? here.pose
                                     : SpatialPose{Vec3<double>::Constant(NAN), {NAN, NAN, NAN, NAN}});
  }
  return found;
}

/// The equations of a platform on rods hold of forces over EI/L², so of loads over d⁴.
Expected<Finding> same_load_over_stiffness(const Swept& study) {
  SpatialWrench wrench;
  wrench << 5, 0, -10, 0, 0, 0.5;
  const auto thin = poses(0.003, wrench, study), thick = poses(0.006, 16 * wrench, study);
  if (!thin) return tl::unexpected(thin.error());
  if (!thick) return tl::unexpected(thick.error());
  double off = 0;
  for (std::size_t k = 0; k < thin->size(); ++k)
    off = worse(off, ((*thin)[k].position - (*thick)[k].position).norm());
  return compare::claimed(
      "only load over diameter⁴ counts, derived: twice as thick bears 16 times the load", "not stated",
      "G1: 3 mm under 5 N, −10 N, 0.5 N m, and 6 mm under 16 times that: the same x, y", off, 1e-12, "m");
}

/// How far thicker rods are from the unloaded values, beyond how far thinner ones are.
Finding thicker(std::span<const Loaded> presets) {
  double off = 0;
  for (const Loaded& preset : presets)
    for (const Measure measure : {&Measures::turn, &Measures::distance})
      for (std::size_t load = 1; load < std::size(load_names); ++load)
        for (std::size_t d = 0; d + 1 < preset.diameters.size(); ++d) {
          const double unloaded = preset.at(0, d).*measure;
          const double here = std::abs(preset.at(load, d).*measure - unloaded);
          const double next = std::abs(preset.at(load, d + 1).*measure - unloaded);
          off = worse(off, excess(next / here - 1));
        }
  return compare::claimed(
      "under load rms e_3 and distance tend to the unloaded ones as rods get thicker",
      "\"an increase of stiffness\" gives \"lower differences between loaded and unloaded\"",
      "all three loads, G1 and G2", off, 0, "");
}

Finding downwards(std::span<const Loaded> presets) {
  double off = 0;
  std::vector<std::string> parts;
  for (const Loaded& preset : presets) {
    const auto loaded = preset.over_diameter(2, &Measures::distance);
    const double unloaded = preset.at(0, 0).distance;
    for (const double here : loaded)
      off = worse(off, excess(preset.name == "G2" ? here - unloaded : unloaded - here));
    parts.push_back(
        fmt::format("{} {} mm, without {:.3g} mm", preset.name, listed(loaded, 1e3), 1e3 * unloaded));
  }
  return compare::claimed("a load downwards takes G1 farther from rigid and brings G2 nearer", "not printed",
                          fmt::format("{} on rods of {} mm: {}", load_names[2],
                                      listed(presets.front().diameters, 1), fmt::join(parts, "; ")),
                          off, 0, "m");
}

}  // namespace

Expected<void> add_load_findings(std::vector<Finding>& findings, std::span<const Loaded> presets,
                                 const Swept& study) {
  add_unloaded(findings, presets);
  const auto same = same_load_over_stiffness(study);
  if (!same) return tl::unexpected(same.error());
  findings.push_back(*same);
  findings.push_back(thicker(presets));
  for (const std::size_t load : {1U, 3U})
    for (const Loaded& preset : presets)
      findings.push_back(
          {fmt::format("{} under {}, rods of {} mm", preset.name, load_names[load],
                       listed(preset.diameters, 1)),
           "not printed",
           fmt::format("rms e_3 {}e-3, without load {:.3g}e-3; distance {} mm, without {:.3g} mm",
                       listed(preset.over_diameter(load, &Measures::turn), 1e3), 1e3 * preset.at(0, 0).turn,
                       listed(preset.over_diameter(load, &Measures::distance), 1e3),
                       1e3 * preset.at(0, 0).distance),
           "", "for information"});
  findings.push_back(downwards(presets));
  return {};
}

}  // namespace sinew::inline v1::tripod
