/// @file newton.hpp
/// Newton's method for one equilibrium, and its stability.
#pragma once
#include "kinematics/arm_legs/group/arm_group.hpp"
#include "sinew/kinematics/arm_legs.hpp"

namespace sinew::inline v1 {

/// How a search for an equilibrium ended.
struct LegsFound {
  Status status = Status::converged;
  int iterations = 0;
  double residual = 0;
  /// Of a search in steps that is `stalled`: of the last step that was tried.
  Status last_step = Status::converged;
};

/// At the share of inputs and loads that the group has.
/// @param is_pose_prescribed the platform stays where it is; @param spent of options' iterations
LegsFound iterate_legs(ArmGroup& group, bool is_pose_prescribed, const ArmOptions& options,
                       const StopToken& stop, int spent);
/// Of an equilibrium that the group was evaluated at; factors its legs.
bool is_stable(ArmGroup& group, bool is_pose_prescribed);

}  // namespace sinew::inline v1
