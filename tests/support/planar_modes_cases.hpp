/// @file planar_modes_cases.hpp
/// Planar legs whose assembly modes are known in part: their distances come from a pose.
#pragma once
#include <algorithm>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "kinematics/modes/planar_modes.hpp"
#include "uniform.hpp"

namespace sinew::test {

using Legs = std::vector<PlatformConstraint<2>>;
using Point = Vec2<double>;
inline constexpr double pi = std::numbers::pi;

inline Point point(std::mt19937& random, double size = 1) {
  return {uniform(random, -size, size), uniform(random, -size, size)};
}

inline double error(const Legs& legs, const PlanarPose& pose) {
  double worst = 0;
  for (const auto& leg : legs)
    worst = std::max(worst, std::abs((SE2<double>::from(pose).point(leg.platform_point) - leg.anchor).norm() -
                                     leg.distance));
  return worst;
}

/// The distances that the pose leaves.
inline void set_distances(Legs& legs, const PlanarPose& pose) {
  for (auto& leg : legs)
    leg.distance = (SE2<double>::from(pose).point(leg.platform_point) - leg.anchor).norm();
}

inline double gap(const PlanarPose& a, const PlanarPose& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(wrap_angle(a.phi - b.phi))});
}

/// Distance from a pose to the nearest mode.
inline double miss(const PlanarModes& modes, const PlanarPose& pose) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < modes.count; ++i)
    nearest = std::min(nearest, gap(modes.poses[static_cast<std::size_t>(i)], pose));
  return nearest;
}

inline Legs random_legs(std::mt19937& random, std::size_t count, double platform = 1) {
  Legs legs(count);
  for (auto& leg : legs) leg = {point(random), 0, point(random, platform)};
  return legs;
}
inline PlanarPose any_pose(std::mt19937& random) {
  return {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -pi, pi)};
}

/// Concentric equilateral triangles, the 3-RFR of TDPCR 5.1.
inline Legs example(std::array<double, 3> distances, double base = 0.19, double platform = 0.05) {
  Legs legs(3);
  for (std::size_t i = 0; i < 3; ++i) {
    const double foot = (90 + 120 * static_cast<double>(i)) * pi / 180, head = foot - pi / 3;
    legs[i] = {base * Point(std::cos(foot), std::sin(foot)), distances[i],
               platform * Point(std::cos(head), std::sin(head))};
  }
  return legs;
}

}  // namespace sinew::test
