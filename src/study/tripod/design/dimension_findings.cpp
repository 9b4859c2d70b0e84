/// How parasitic motion without load depends on the dimensions: what holds of all tripods computed, and
/// where a rule has exceptions, these.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "study/compare.hpp"
#include "study/tripod/design/parts.hpp"
#include "study/tripod/design/steps.hpp"

namespace sinew::inline v1::tripod {
namespace {

using Index = std::size_t;

const char* const shorter =
    "\"the magnitude of the parasitic motions increases as the length of the rods decreases\"";

/// "130 mm: 30°; 250 mm: 3° to 7°" of an angle for each base and height.
template <class F>
std::string by_radius(const Designs& made, const F& angle_of) {
  std::vector<std::string> parts;
  for (Index i = 0; i < made.radii.size(); ++i) {
    std::vector<double> angles;
    for (Index j = 0; j < made.heights.size(); ++j) angles.push_back(made.angles[angle_of(i, j)]);
    const auto [low, high] = std::ranges::minmax(angles);
    parts.push_back(low == high ? fmt::format("{:g} mm: {:g}°", made.radii[i], low)
                                : fmt::format("{:g} mm: {:g}° to {:g}°", made.radii[i], low, high));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

Finding largest_of_all(const Designs& made) {
  const auto by = [](Measure measure) {
    return [measure](const Measures& a, const Measures& b) { return a.*measure < b.*measure; };
  };
  const auto turn = std::ranges::max_element(made.all, by(&Measures::turn));
  const auto [near, far] = std::ranges::minmax_element(made.all, by(&Measures::distance));
  return {
      "parasitic motion of all tripods computed, rms over the tilts",
      "\"small changes from the null value\" of e_3, \"slight differences\" of x, y",
      fmt::format("e_3 up to {:.2g}, a twist of {:.2f}°; (x, y) from {:.3f} to {:.1f} mm off the rigid "
                  "one's, which are {:.2f} mm",
                  turn->turn, turn->twist(), 1e3 * near->distance, 1e3 * far->distance, 1e3 * near->rigid),
      "", "for information"};
}

void add_heights(std::vector<Finding>& findings, const Designs& made) {
  const auto distance = steps(made, Along::height, &Measures::distance);
  findings.push_back(compare::claimed("distance from rigid falls with h", shorter,
                                      exceptions(made, distance, 1),
                                      largest_rise(distance, 1, [](const Step&) { return true; }), 0, ""));
  const auto turn = steps(made, Along::height, &Measures::turn);
  findings.push_back(compare::claimed(
      "rms e_3 falls with h, ψ from 5° to 40°", shorter, exceptions(made, turn, 1),
      largest_rise(turn, 1,
                   [&](const Step& at) { return made.angles[at.angle] >= 5 && made.angles[at.angle] <= 40; }),
      0, ""));
}

/// Falls to its least and rises beyond.
Finding min_distance(const Designs& made) {
  const auto nearest = [&](Index i, Index j) { return least(made.over_angle(i, j, &Measures::distance)); };
  const auto all = steps(made, Along::angle, &Measures::distance);
  const double rise =
      largest_rise(all, 1, [&](const Step& at) { return at.angle < nearest(at.radius, at.height); });
  const double fall =
      largest_rise(all, -1, [&](const Step& at) { return at.angle >= nearest(at.radius, at.height); });
  return compare::claimed(
      fmt::format("distance from rigid falls with ψ to a least one, of ψ to {:g}°", made.angles.back()),
      "not printed", by_radius(made, nearest) + " (r_A: ψ); it rises beyond", worse(rise, fall), 0, "");
}

Finding drift_over_angle(const Designs& made) {
  double rise = 0, most = 0;
  for (Index i = 0; i < made.radii.size(); ++i)
    for (Index j = 0; j < made.heights.size(); ++j) {
      const auto drift = made.over_angle(i, j, &Measures::drift);
      most = std::max(most, drift.front());
      for (Index k = 0; k + 1 < drift.size(); ++k) rise = worse(rise, excess(drift[k + 1] - drift[k]));
    }
  std::vector<std::string> turned;
  for (Index i = 0; i < made.radii.size(); ++i)
    for (Index k = 0; k < made.angles.size(); ++k)
      if (made.at(i, 0, k).drift < 0) {
        turned.push_back(fmt::format("{:g}° ({:g} mm)", made.angles[k], made.radii[i]));
        break;
      }
  return compare::claimed(
      "linear drift c_1 falls with ψ: x = c_1 e_2, y = −c_1 e_1 near home, rigid 0", "c_1 = 0.077 m in (36)",
      fmt::format("{:.0f} mm at most; below 0 from ψ = {} (r_A) on", 1e3 * most, fmt::join(turned, ", ")),
      rise, 0, "m");
}

void add_largest_turn(std::vector<Finding>& findings, const Designs& made) {
  const auto peak = [&](Index i, Index j) { return largest(made.over_angle(i, j, &Measures::turn)); };
  double off = 0;
  for (Index i = 0; i < made.radii.size(); ++i)
    for (Index j = 0; j < made.heights.size(); ++j) {
      const double here = made.angles[peak(i, j)];
      if (i + 1 < made.radii.size()) off = worse(off, here - made.angles[peak(i + 1, j)]);
      if (j + 1 < made.heights.size()) off = worse(off, made.angles[peak(i, j + 1)] - here);
    }
  findings.push_back(compare::claimed(
      "rms e_3 does not fall with ψ throughout: ψ of the largest, wider with r_A, narrower with h",
      "not printed", by_radius(made, peak) + " (r_A: ψ)", excess(off), 0, "°"));
  auto all = steps(made, Along::angle, &Measures::turn);
  std::erase_if(all, [&](const Step& at) { return at.angle < peak(at.radius, at.height); });
  findings.push_back(compare::claimed(
      "beyond, rms e_3 falls with ψ, r_A from 150 mm", "not printed", exceptions(made, all, 1),
      largest_rise(all, 1, [&](const Step& at) { return made.radii[at.radius] >= 150; }), 0, ""));
}

}  // namespace

void add_dimension_findings(std::vector<Finding>& findings, const Designs& made) {
  std::size_t asked = 0, solved = 0;
  for (const Measures& of : made.all) asked += of.asked, solved += of.solved;
  findings.push_back(
      compare::claimed(fmt::format("{} tripods without load, each at {} tilts of up to 20°: solved",
                                   made.all.size(), made.all.front().asked),
                       "not printed", fmt::format("{} of {}", solved, asked),
                       static_cast<double>(asked - solved), 0, "poses"));
  findings.push_back(largest_of_all(made));
  add_heights(findings, made);
  findings.push_back(min_distance(made));
  findings.push_back(drift_over_angle(made));
  add_largest_turn(findings, made);
}

}  // namespace sinew::inline v1::tripod
