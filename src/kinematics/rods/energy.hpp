/// @file energy.hpp
/// What is read off all rods of a system together, after `evaluate`.
#pragma once
#include <limits>
#include <vector>

#include "robot/tangent_system.hpp"

namespace sinew::inline v0 {

template <class System>
std::vector<RodReading> readings_of(const System& system) {
  std::vector<RodReading> rods;
  for (int k = 0; k < system.rods(); ++k) rods.push_back(system.rod(k));
  return rods;
}

template <class System>
double energy_of(const System& system) {
  double energy = 0;
  for (int k = 0; k < system.rods(); ++k) energy += system.rod(k).energy;
  return energy;
}

/// Of the rods' weight and own load [J].
template <class System>
double weight_of(const System& system) {
  if constexpr (requires { system.weight_energy(); })
    return system.weight_energy();
  else
    return 0;
}

/// A moment that keeps its axes has no potential.
template <class System>
double potential_of(const System& system) {
  if (system.wrench().template tail<3>() != Vec3<double>::Zero())
    return std::numeric_limits<double>::quiet_NaN();
  return energy_of(system) + weight_of(system) -
         dot(Vec3<double>(system.wrench().template head<3>()), system.platform().p);
}

}  // namespace sinew::inline v0
