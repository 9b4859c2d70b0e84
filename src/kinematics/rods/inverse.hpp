/// @file inverse.hpp
/// Lengths of rods for wanted coordinates of the platform.
#pragma once
#include "kinematics/rods/solve.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::inline v1 {

/// Brings the system to rest at these coordinates; lengths and the other coordinates follow.
Report solve_rods_at(RodWork& work, const SE3<double>& home, const IndependentPose& wanted,
                     const RodQuestion& question);

}  // namespace sinew::inline v1
