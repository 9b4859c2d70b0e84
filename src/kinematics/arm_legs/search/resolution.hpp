/// @file resolution.hpp
/// Groups of polynomials from coarse to fine, and how far an equilibrium of one of them is off.
#pragma once
#include <vector>

#include "kinematics/arm_legs/legs_work.hpp"

namespace sinew::inline v1 {

/// The bases of the options' polynomials, coarse to fine.
std::vector<ArmBasis> bases_of(const ArmOptions& options);
/// Whether the workspace's groups are of these options.
bool levels_are_for(const ArmOptions& options, const ArmLegsWorkspace::Impl& impl);
/// Makes room for groups of these options and breaks; those of others go.
void prepare_levels(const ArmOptions& options, const LegsBreaks& breaks, ArmLegsWorkspace& work);

/// By how much polynomials that are finer move the platform, or would if it were free [m].
double moved_by(ArmGroup& coarse, ArmGroup& fine, bool is_pose_prescribed);
/// The error that the finer ones have themselves, as errors fall with the fourth power of elements [m].
double error_left(double moved, const ArmBasis& coarse, const ArmBasis& fine);
/// Says so where an error is far from the accuracy that was asked.
void report_coarse(double error, double wanted, Report& report);

/// What the legs need on the platform beyond weight and wrench.
ArmGroup::Wrench constraint_wrench(ArmGroup& group);

}  // namespace sinew::inline v1
