/// @file questions.hpp
/// What kinematics/equilibrium.hpp and equilibrium_curve.hpp ask, of a robot by the model prb. The
/// equilibrium that was found stays in the workspace. A robot in the plane is in the plane z = 0 of space,
/// with wrenches in it.
#pragma once
#include "sinew/kinematics/equilibrium.hpp"
#include "sinew/kinematics/equilibrium_curve.hpp"

namespace sinew::inline v1 {

inline bool has_chains(const Robot& robot) { return robot.model() == Model::prb; }

Equilibrium equilibrium_of_chains(const Robot& robot, Numbers inputs, const EquilibriumOptions& options,
                                  Workspace& work);
Equilibrium inverse_equilibrium_of_chains(const Robot& robot, const SpatialPose& wanted,
                                          const EquilibriumOptions& options, Workspace& work);
Equilibrium held_equilibrium_of_chains(const Robot& robot, Workspace& work);
LoadPath follow_load_of_chains(const Robot& robot, const SpatialWrench& direction, double limit,
                               Workspace& work);
std::vector<FoundEquilibrium> equilibria_of_chains(const Robot& robot, Numbers inputs,
                                                   const EquilibriumOptions& options, Workspace& work);
std::vector<FoundEquilibrium> inverse_equilibria_of_chains(const Robot& robot, const SpatialPose& wanted,
                                                           const EquilibriumOptions& options,
                                                           Workspace& work);
RodAnalysis analyse_equilibrium_of_chains(const Robot& robot, Workspace& work);
std::vector<EquilibriumCurve> equilibrium_curves_of_chains(const Robot& robot, const CurveOptions& how,
                                                           Workspace& work);
SensedWrench sense_wrench_of_chains(const Robot& robot, Numbers inputs, Numbers tensions, Numbers deviations,
                                    const EquilibriumOptions& options, Workspace& work);

}  // namespace sinew::inline v1
