#include "kinematics/arm_legs/group/legs_loads.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

namespace sinew::inline v1 {

LegsLoads mix(const LegsLoads& from, const LegsLoads& to, double share) {
  if (share == 1) return to;
  LegsLoads loads;
  for (std::size_t i = 0; i < 3; ++i) {
    loads.gravity[i] = std::lerp(from.gravity[i], to.gravity[i], share);
    loads.along[i] = std::lerp(from.along[i], to.along[i], share);
    loads.following_along[i] = std::lerp(from.following_along[i], to.following_along[i], share);
  }
  for (std::size_t i = 0; i < 6; ++i)
    loads.following[i] = std::lerp(from.following[i], to.following[i], share);
  const auto add = [&](const std::vector<ArmLegsPointLoad>& points, double part) {
    if (part == 0) return;
    for (ArmLegsPointLoad point : points) {
      for (double& number : point.wrench) number *= part;
      loads.points.push_back(point);
    }
  };
  add(from.points, 1 - share);
  add(to.points, share);
  return loads;
}

std::vector<ArmLoad> loads_of_legs(const LegsLoads& loads, double share, std::size_t legs) {
  std::vector<ArmLoad> on_legs(legs);
  for (ArmLoad& load : on_legs) {
    load.gravity.emplace();
    for (std::size_t i = 0; i < 3; ++i) {
      (*load.gravity)[i] = share * loads.gravity[i];
      load.along[i] = share * loads.along[i];
      load.following_along[i] = share * loads.following_along[i];
    }
  }
  for (const ArmLegsPointLoad& point : loads.points) {
    PointLoad& own = on_legs[point.leg].points.emplace_back();
    own.place = point.place;
    own.following = point.following;
    for (std::size_t i = 0; i < 6; ++i) own.wrench[i] = share * point.wrench[i];
  }
  return on_legs;
}

bool load_has_potential(const ArmLoad& load, bool is_planar) {
  const auto is_zero = [](std::span<const double> numbers) {
    return std::ranges::all_of(numbers, [](double x) { return x == 0; });
  };
  return is_zero(load.following_along) && std::ranges::all_of(load.points, [&](const PointLoad& point) {
           return is_zero(point.following || !is_planar
                              ? std::span(point.wrench).last(point.following ? 6 : 3)
                              : std::span<const double>());
         });
}

LegsBreaks breaks_for(const ArmLegs& robot, const LegsLoads& loads) {
  LegsBreaks breaks(robot.legs.size());
  for (const ArmLegsPointLoad& point : loads.points)
    if (std::ranges::any_of(point.wrench, [](double number) { return number != 0; }))
      breaks[point.leg].push_back(point.place);
  for (std::vector<double>& places : breaks) {
    std::ranges::sort(places);
    places.erase(std::unique(places.begin(), places.end()), places.end());
  }
  return breaks;
}

bool has_all(const LegsBreaks& breaks, const LegsBreaks& wanted) {
  for (std::size_t k = 0; k < wanted.size(); ++k)
    if (!std::ranges::includes(breaks[k], wanted[k])) return false;
  return true;
}

LegsBreaks together(const LegsBreaks& a, const LegsBreaks& b) {
  LegsBreaks all(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) std::ranges::set_union(a[k], b[k], std::back_inserter(all[k]));
  return all;
}

}  // namespace sinew::inline v1
