/// @file search.hpp
/// The search for the equilibrium into which the rest grows, or the last one changes: by continuation at
/// coarse polynomials, then by finer ones.
#pragma once
#include "kinematics/arm_legs/legs_work.hpp"

namespace sinew::inline v1 {

/// How a search for an equilibrium may end.
enum class LegsEnd {
  anywhere,    ///< where the last equilibrium leads to none, at what the rest grows into
  on_the_way,  ///< there the workspace stays
  coarse,      ///< `anywhere`, and finer polynomials are not tried
};

/// The equilibrium into which the rest grows, or where options say so the last one; the workspace's state is
/// of it. At a prescribed pose the group's wrench is in the end what keeps the platform there.
void solve_legs(const ArmLegs& robot, const LegsProblem& problem, const ArmOptions& options,
                ArmLegsWorkspace& work, LegsEnd end = LegsEnd::anywhere);

}  // namespace sinew::inline v1
