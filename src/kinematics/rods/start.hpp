/// @file start.hpp
/// Where a search for an equilibrium of rods begins: at home, or at a pose the rods are laid to.
#pragma once
#include "kinematics/rods/path.hpp"
#include "robot/rods/rod_work.hpp"
#include "sinew/base/numbers.hpp"

namespace sinew::inline v1 {

/// Lengths of all rods from the inputs.
RodTarget target_of(const RodGroup& system, Numbers inputs, const Vec<double, 6>& wrench);

/// To the home state, in equilibrium under some wrench.
Report go_home(RodWork& work, const SE3<double>& home);

/// Lays the rods to a pose at these lengths and finds the wrench that holds them so; false where a rod cannot
/// be laid, the state is then at rest with lengths of its own. See rest_at for what it needs.
bool lay_rods(RodWork& work, const SE3<double>& pose, Numbers inputs);

}  // namespace sinew::inline v1
