/// @file sense.hpp
/// The wrench on a platform from the axial forces of its six rods.
#pragma once
#include "kinematics/effort_sensor.hpp"
#include "kinematics/rods/solve.hpp"

namespace sinew::inline v1 {

/// What is measured at the guides, and what it says.
struct RodSensing {
  std::array<double, 6> axial{};       ///< of each rod at its guide, pull > 0 [N]
  EffortSensor<Spatial>::Rows rows{};  ///< ∂wrench/∂axial
  int max_iterations = 4000;           ///< Newton steps
  double truncation = 0;               ///< to which shapes are resolved
};

/// From a solved state near by: moves the platform, at fixed lengths, to where the rods pull as `sensing`
/// says. The wrench that is left over is what acts there. Fills `rows`.
Report sense_rods(RodWork& work, RodSensing& sensing);

}  // namespace sinew::inline v1
