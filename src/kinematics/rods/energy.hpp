/// @file energy.hpp
/// What is read off all rods of a system together, after `evaluate`.
#pragma once
#include <limits>
#include <vector>

#include "robot/rod_group.hpp"

namespace sinew::inline v0 {

inline std::vector<RodReading> readings_of(const RodGroup& system) {
  std::vector<RodReading> rods;
  for (int k = 0; k < system.limbs(); ++k) rods.push_back(system.rod(k));
  return rods;
}

/// A moment that keeps its axes has no potential.
inline double potential_of(const RodGroup& system) {
  if (system.wrench().tail<3>() != Vec3<double>::Zero()) return std::numeric_limits<double>::quiet_NaN();
  return system.energy() + system.weight_energy() -
         dot(Vec3<double>(system.wrench().head<3>()), system.platform().p);
}

}  // namespace sinew::inline v0
