/// @file first_equilibrium.hpp
/// A first equilibrium, of a group at rest.
#pragma once
#include "kinematics/arm_legs/legs_work.hpp"
#include "kinematics/arm_legs/search/newton.hpp"

namespace sinew::inline v1 {

/// With the platform free; to a prescribed pose it goes from there, since legs at rest are straight and would
/// be pressed on a straight way to it.
/// @param reached share of inputs and loads, or of the way to the pose
LegsFound begin_at_rest(ArmGroup& group, const LegsProblem& problem, NewtonBudget& budget, double& reached);
/// The same with tendons that give way at first, where tendons whose lengths are prescribed lead to none:
/// those that do not stretch may be too short on the way though they are not where it ends.
LegsFound begin_softened(ArmGroup& group, const LegsProblem& problem, NewtonBudget& budget, double& reached);
/// For a prescribed pose, where legs do not bear a free platform under what acts: without it, then under as
/// much as they bear; the rest comes while the platform goes to its pose.
LegsFound begin_unloaded(ArmGroup& group, const LegsProblem& problem, NewtonBudget& budget, double& reached);

}  // namespace sinew::inline v1
