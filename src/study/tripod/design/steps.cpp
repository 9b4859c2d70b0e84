#include "study/tripod/design/steps.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

namespace sinew::inline v1::tripod {

std::vector<Step> steps(const Designs& made, Along along, Measure measure) {
  const std::size_t di = along == Along::radius, dj = along == Along::height, dk = along == Along::angle;
  std::vector<Step> all;
  for (std::size_t i = 0; i + di < made.radii.size(); ++i)
    for (std::size_t j = 0; j + dj < made.heights.size(); ++j)
      for (std::size_t k = 0; k + dk < made.angles.size(); ++k) {
        const double from = made.at(i, j, k).*measure, to = made.at(i + di, j + dj, k + dk).*measure;
        all.push_back({i, j, k, to / from - 1});
      }
  return all;
}

std::string exceptions(const Designs& made, const std::vector<Step>& all, double sign) {
  std::vector<std::string> found;
  std::set<double> angles;
  for (const Step& step : all) {
    if (!(sign * step.rise > 0)) continue;
    angles.insert(made.angles[step.angle]);
    found.push_back(fmt::format("({:g} mm, {:g} mm, {:g}°)", made.radii[step.radius],
                                made.heights[step.height], made.angles[step.angle]));
  }
  const std::size_t kept = all.size() - found.size();
  if (found.empty()) return fmt::format("in all {} steps", all.size());
  if (found.size() <= 4)
    return fmt::format("in {} of {} steps; not from (r_A, h, ψ) = {}", kept, all.size(),
                       fmt::join(found, ", "));
  return fmt::format("in {} of {} steps; not in {}, of ψ = {}°", kept, all.size(), found.size(),
                     fmt::join(angles, "°, "));
}

}  // namespace sinew::inline v1::tripod
