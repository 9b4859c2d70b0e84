/// @file inverse.hpp
/// Lengths of rods for wanted coordinates of the platform.
#pragma once
#include "kinematics/rods/solve.hpp"

namespace sinew::inline v1 {

/// Coordinates a robot with three inputs can be asked for.
struct RodCoordinates {
  double z, e1, e2;
};

/// Brings the system to rest at these coordinates; lengths and the other coordinates follow.
Report solve_rods_at(RodWork& work, const SE3<double>& home, const RodCoordinates& wanted,
                     const RodQuestion& question);

}  // namespace sinew::inline v1
