/// What the numbers say to somebody who has to choose.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "study/tripod/design/parts.hpp"

namespace sinew::inline v1::tripod {
namespace {

/// Parts of the rigid motion that a tripod may be off.
constexpr double near = 0.25, nearer = 0.1;

/// Whether it is so at this pair angle and at all wider ones.
bool stays(const Designs& made, std::size_t radius, std::size_t height, std::size_t angle, double part) {
  for (std::size_t k = angle; k < made.angles.size(); ++k)
    if (!(made.at(radius, height, k).relative() <= part)) return false;
  return true;
}

/// "7 to 50°": the widest stretch of angles that are near enough; "none".
std::string angles_of(const Designs& made, std::size_t radius, std::size_t height, double part) {
  const auto enough = [&](std::size_t k) { return made.at(radius, height, k).relative() <= part; };
  std::size_t first = 0;
  while (first < made.angles.size() && !enough(first)) ++first;
  if (first == made.angles.size()) return "none";
  if (stays(made, radius, height, first, part)) return fmt::format("from {:g}°", made.angles[first]);
  std::size_t last = first;
  while (last + 1 < made.angles.size() && enough(last + 1)) ++last;
  return fmt::format("{:g}° to {:g}°", made.angles[first], made.angles[last]);
}

Finding of_radius(const Designs& made, std::size_t radius) {
  std::vector<std::string> wide, narrow;
  for (std::size_t j = 0; j < made.heights.size(); ++j) {
    wide.push_back(angles_of(made, radius, j, near));
    narrow.push_back(angles_of(made, radius, j, nearer));
  }
  std::vector<std::string> heights;
  for (const double height : made.heights) heights.push_back(fmt::format("{:g}", height));
  return {fmt::format("r_A = {:g} mm: ψ for a distance of {:.0f} %, of {:.0f} % of the rigid motion",
                      made.radii[radius], 100 * near, 100 * nearer),
          "not printed",
          fmt::format("{}; {} (h = {} mm)", fmt::join(wide, ", "), fmt::join(narrow, ", "),
                      fmt::join(heights, ", ")),
          "", "for information"};
}

/// From which pair angle on every height is near enough; none: NaN.
double angle_for_all_heights(const Designs& made, std::size_t radius, double part) {
  for (std::size_t k = 0; k < made.angles.size(); ++k) {
    bool all = true;
    for (std::size_t j = 0; j < made.heights.size(); ++j) all = all && stays(made, radius, j, k, part);
    if (all) return made.angles[k];
  }
  return std::numeric_limits<double>::quiet_NaN();
}

Finding of_presets(std::span<const Loaded> presets) {
  std::vector<std::string> parts;
  for (const Loaded& preset : presets)
    parts.push_back(fmt::format("{} {:.2g}", preset.name, preset.at(0, 0).relative()));
  return {"distance from rigid over the rigid motion, of the presets",
          "\"the motion of the 3PFS is similar to the rigid tripod\"",
          fmt::format("{}", fmt::join(parts, ", ")), "", "for information"};
}

Finding in_short(const Designs& made) {
  const std::size_t wide = made.radii.size() - 1;
  return {"for designers, in this order", "not printed",
          fmt::format(
              "1. guides below the platform's points: with r_A = {:g} mm, ψ from {:g}° is within {:.0f} % at "
              "every height, with {:g} mm from {:g}°; 2. wide pairs, not to lessen (x, y) but its distance; "
              "3. a high platform; 4. rods by load/diameter⁴",
              made.radii.front(), angle_for_all_heights(made, 0, near), 100 * near, made.radii[wide],
              angle_for_all_heights(made, wide, near)),
          "", "for information"};
}

}  // namespace

void add_recommendations(std::vector<Finding>& findings, const Designs& made,
                         std::span<const Loaded> presets) {
  findings.push_back(of_presets(presets));
  for (std::size_t i = 0; i < made.radii.size(); ++i) findings.push_back(of_radius(made, i));
  findings.push_back(in_short(made));
}

}  // namespace sinew::inline v1::tripod
