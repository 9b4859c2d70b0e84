/// @file force_sensing.hpp
/// The load on a platform from the axial forces of its six rods, as load cells at the guides measure them.
/// Theory: docs/theory/rod_robot.md
#pragma once
#include "sinew/kinematics/equilibrium.hpp"

namespace sinew::inline v1 {

/// A wrench with what it is uncertain by.
struct SensedWrench {
  Report report;
  SpatialPose pose;
  SpatialWrench wrench;  ///< of the world on the platform [N, N m], base axes; what gravity does is taken off
  std::array<double, 36> sensitivity;  ///< ∂wrench/∂axial, 6 × 6, rows first: forces [1], moments [m]
  /// Of the wrench, 6 × 6, rows first [N², N² m, N² m²], by that of the measured forces
  std::array<double, 36> covariance;
};

/// The wrench under which the rods of these lengths pull so at their guides. In the place of the wrench the
/// pose is the unknown: at fixed lengths it makes all forces, and the wrench is what they leave over.
/// `singular` where the forces do not tell (or no pose near the unloaded one makes them).
/// Of chains (model prb) of as many legs as the platform has freedoms the same of the tendons whose lengths
/// are held, one a leg: where tendon 1 is the outer one, of the inner one. In the plane sensitivity and
/// covariance are 0 but for fx, fy and m, and sensitivity has a column for each of the three legs.
/// @param inputs lengths of the six rods [m]
/// @param axial of each of six rods, pull > 0 [N]
/// @param deviations standard deviations of these, independent of each other [N]
/// @param options of the unloaded platform, from which the search begins; its wrench is not asked
SINEW_API SensedWrench sense_wrench(const Robot& robot, Numbers inputs, Numbers axial, Numbers deviations,
                                    const EquilibriumOptions& options, Workspace& work);

}  // namespace sinew::inline v1
