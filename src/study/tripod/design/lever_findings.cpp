/// Which dimension does most for a motion like the rigid one's, and what is not worth making small.
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

void add_radii(std::vector<Finding>& findings, const Designs& made) {
  const auto distance = steps(made, Along::radius, &Measures::distance);
  findings.push_back(compare::claimed(
      "distance from rigid falls with r_A towards r = 125 mm, ψ to 30°", "not printed",
      exceptions(made, distance, -1),
      largest_rise(distance, -1, [&](const Step& at) { return made.angles[at.angle] <= 30; }), 0, ""));
  const auto turn = steps(made, Along::radius, &Measures::turn);
  findings.push_back(compare::claimed(
      "rms e_3 falls with r_A towards r, ψ from 7° to 40°", "not printed", exceptions(made, turn, -1),
      largest_rise(turn, -1,
                   [&](const Step& at) { return made.angles[at.angle] >= 7 && made.angles[at.angle] <= 40; }),
      0, ""));
}

/// Factors by which the distance falls from one end of a dimension to the other, the others kept.
struct Factors {
  std::vector<double> all;
  void add(const Measures& from, const Measures& to) { all.push_back(from.distance / to.distance); }
  std::string text() const {
    double sum = 0;
    for (const double factor : all) sum += std::log(factor);
    const auto [low, high] = std::ranges::minmax(all);
    return fmt::format("{:.3g} ({:.2g} to {:.3g})", std::exp(sum / static_cast<double>(all.size())), low,
                       high);
  }
};

Finding levers(const Designs& made) {
  const Index wide = made.radii.size() - 1, high = made.heights.size() - 1, most = made.angles.size() - 1;
  Factors radius, height, angle;
  for (Index j = 0; j <= high; ++j)
    for (Index k = 0; k <= most; ++k) radius.add(made.at(wide, j, k), made.at(0, j, k));
  for (Index i = 0; i <= wide; ++i)
    for (Index k = 0; k <= most; ++k) height.add(made.at(i, 0, k), made.at(i, high, k));
  for (Index i = 0; i <= wide; ++i)
    for (Index j = 0; j <= high; ++j) angle.add(made.at(i, j, 0), made.at(i, j, most));
  return {"what one dimension makes of the distance, the others kept: geometric mean (range)", "not printed",
          fmt::format(
              "ψ from {:g}° to {:g}° divides it by {}, r_A from {:g} to {:g} mm by {}, h from {:g} to "
              "{:g} mm by {}",
              made.angles.front(), made.angles.back(), angle.text(), made.radii.back(), made.radii.front(),
              radius.text(), made.heights.front(), made.heights.back(), height.text()),
          "", "for information"};
}

/// Guides below the platform's points make more of narrow pairs than distant guides of wide ones.
Finding near_guides(const Designs& made) {
  const Index wide = made.radii.size() - 1, narrow = index_of(made.angles, 3),
              broad = index_of(made.angles, 40);
  double off = 0;
  std::vector<std::string> near, far;
  for (Index j = 0; j < made.heights.size(); ++j) {
    const double here = made.at(0, j, narrow).distance, there = made.at(wide, j, broad).distance;
    off = worse(off, excess(here / there - 1));
    near.push_back(fmt::format("{:.2f}", 1e3 * here));
    far.push_back(fmt::format("{:.2f}", 1e3 * there));
  }
  return compare::claimed(
      "r_A = 130 mm with ψ = 3° is nearer to rigid than 250 mm with 40°", "not printed",
      fmt::format("{} mm, and {} mm, by height", fmt::join(near, ", "), fmt::join(far, ", ")), off, 0, "");
}

void add_total_shift(std::vector<Finding>& findings, const Designs& made) {
  const Index last = made.angles.size() - 1;
  double off = 0, other = 0, low = 1, high = 0;
  for (Index i = 0; i < made.radii.size(); ++i)
    for (Index j = 0; j < made.heights.size(); ++j) {
      const Measures& wide = made.at(i, j, last);
      off = worse(off, std::abs(wide.shift / wide.rigid - 1));
      const auto shift = made.over_angle(i, j, &Measures::shift),
                 distance = made.over_angle(i, j, &Measures::distance);
      const Index smallest = least(shift), nearest = least(distance);
      other += smallest == nearest;
      const double there = made.at(i, j, smallest).relative();
      low = std::min(low, there), high = std::max(high, there);
    }
  findings.push_back(
      compare::claimed(fmt::format("rms (x, y) tends to the rigid one's, not to 0: a tenth off at ψ = {:g}°",
                                   made.angles[last]),
                       "not printed", fmt::format("{:.1f} % at most", 100 * off), off, 0.1, ""));
  findings.push_back(compare::claimed(
      "the pair angle of the least (x, y) is not the one of the least distance", "not printed",
      fmt::format("least (x, y) where the distance is {:.0f} to {:.0f} % of the rigid motion", 100 * low,
                  100 * high),
      other, 0, "tripods"));
}

}  // namespace

void add_lever_findings(std::vector<Finding>& findings, const Designs& made) {
  add_radii(findings, made);
  findings.push_back(levers(made));
  findings.push_back(near_guides(made));
  add_total_shift(findings, made);
}

}  // namespace sinew::inline v1::tripod
