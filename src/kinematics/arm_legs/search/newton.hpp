/// @file newton.hpp
/// Newton's method for one equilibrium, and its stability.
#pragma once
#include "kinematics/arm_legs/group/arm_group.hpp"
#include "sinew/kinematics/arm_legs.hpp"

namespace sinew::inline v1 {

/// How a search for an equilibrium ended.
struct LegsFound {
  Status status = Status::converged;
  double residual = 0;
  /// Of a search in steps that is `stalled`: of the last step that was tried.
  Status last_step = Status::converged;
  /// Of one that is `unreachable`: the tendon that is held too short, of all legs', and by how much [m].
  int short_tendon = -1;
  double short_by = 0;
};

/// Newton's steps of a search: what ends them, and how many all its stages have taken together.
struct NewtonBudget {
  double tolerance;    ///< of the residual [1]
  int max_iterations;  ///< of all stages together [1]
  const StopToken& stop;
  int iterations = 0;  ///< that were taken [1]

  NewtonBudget(const ArmOptions& options, const StopToken& token)
      : tolerance(options.tolerance),
        max_iterations(options.max_iterations),
        stop(token) {}
};

/// At the share of inputs and loads that the group has.
/// @param is_pose_prescribed the platform stays where it is
LegsFound iterate_legs(ArmGroup& group, bool is_pose_prescribed, NewtonBudget& budget);
/// Of an equilibrium that the group was evaluated at; factors its legs.
bool is_stable(ArmGroup& group, bool is_pose_prescribed);

/// Where tensions are not determined, from a converged equilibrium to the least ones, which is where it stays
/// if they are found.
void come_to_least_tensions(ArmGroup& group, bool is_pose_prescribed, NewtonBudget& budget, LegsFound& found);

}  // namespace sinew::inline v1
