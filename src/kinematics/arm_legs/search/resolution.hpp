/// @file resolution.hpp
/// Groups of polynomials from coarse to fine, and equilibria that are refined by them.
#pragma once
#include <vector>

#include "kinematics/arm_legs/legs_work.hpp"
#include "kinematics/arm_legs/search/newton.hpp"

namespace sinew::inline v1 {

/// The bases of the options' polynomials, coarse to fine.
std::vector<ArmBasis> bases_of(const ArmOptions& options);
/// Whether the workspace's groups are of these options.
bool levels_are_for(const ArmOptions& options, const ArmLegsWorkspace::Impl& impl);
/// Makes room for groups of these options and breaks; those of others go.
void prepare_levels(const ArmOptions& options, const LegsBreaks& breaks, ArmLegsWorkspace& work);

/// How finer polynomials go on from an equilibrium.
struct Refinement {
  bool keeps_stable;  ///< one that does not hold is `unstable`, and ends it
  bool keeps_groups;  ///< those that are there are used again
};
/// From the equilibrium of the workspace's level to finer polynomials, until these move the platform less
/// than is asked. The level is then that of the last ones, and the state's resolution what they are off.
/// @param found how the search at the workspace's level ended; @returns how it ended at the last
LegsFound refine_levels(const ArmLegs& robot, const LegsProblem& problem, const ArmOptions& options,
                        ArmLegsWorkspace& work, Refinement how, NewtonBudget& budget, LegsFound found);

/// What the legs need on the platform beyond weight and wrench.
ArmGroup::Wrench constraint_wrench(ArmGroup& group);

}  // namespace sinew::inline v1
