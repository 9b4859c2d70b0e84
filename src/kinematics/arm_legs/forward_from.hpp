/// @file forward_from.hpp
/// An equilibrium near a shape, by Newton's method alone: it may be unstable.
#pragma once
#include "kinematics/arm_legs/legs_work.hpp"
#include "kinematics/arm_legs/search/newton.hpp"

namespace sinew::inline v1 {

/// From the coarsest group's equilibrium to finer polynomials; the workspace's state is of the finest that
/// was found, or says why none was. @param found how the coarsest one's search ended; @param budget of that
/// search
void refine_by_newton(const ArmLegs& robot, const LegsProblem& problem, const ArmOptions& options,
                      ArmLegsWorkspace& work, LegsFound found, NewtonBudget& budget);

}  // namespace sinew::inline v1
