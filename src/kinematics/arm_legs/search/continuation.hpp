/// @file continuation.hpp
/// Continuation of a stable equilibrium: from the rest, and from an equilibrium to what is asked, in steps
/// that adapt.
#pragma once
#include "kinematics/arm_legs/legs_work.hpp"
#include "kinematics/arm_legs/search/newton.hpp"

namespace sinew::inline v1 {

/// From the rest, or where the group is at share 0; the platform is free.
/// @param reached share of inputs and loads up to which a stable equilibrium was found
LegsFound grow_legs(ArmGroup& group, NewtonBudget& budget, double& reached);

/// From the group's equilibrium, at the polynomials it has: all that differs changes evenly, in steps as
/// short as they have to be. Where that ends early the group is at the last one that was found.
/// @param reached share of the way; @param max_steps most equilibria that are tried on it, 0: any number
LegsFound walk_legs(ArmGroup& group, const LegsProblem& problem, NewtonBudget& budget, double& reached,
                    int max_steps = 0);

/// From an equilibrium with softened tendons to one with tendons as they are: what softening gave way by is
/// taken back and tendons become stiffer, in turn (the method of multipliers).
/// `unreachable` where they are nearly as stiff as they are and still too long.
/// @param softness the share by which they are softened
LegsFound tighten_legs(ArmGroup& group, double softness, bool is_pose_prescribed, NewtonBudget& budget);

/// At a share of the way by a twist, its translation and its rotation evenly.
ArmGroup::Frame displaced_by_share(const ArmGroup::Frame& from, const Vec<double, 6>& twist, double share);

}  // namespace sinew::inline v1
