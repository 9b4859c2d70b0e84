/// @file rod_result.hpp
/// What people want to know of a rod in an equilibrium.
#pragma once
#include <limits>

#include "sinew/math/vec.hpp"

namespace sinew::inline v1 {

/// Vectors in base axes.
struct RodResult {
  double length = 0;         ///< L [m]
  double chord = 0;          ///< from base to tip [m]
  double tip_angle = 0;      ///< of the tangent at the tip from that at the base, in the rod's plane [rad]
  double lateral_force = 0;  ///< of the platform on the tip, away from the base tangent [N]
  double axial_force = 0;    ///< along the base tangent [N]
  Vec3<double> force = Vec3<double>::Zero();     ///< n of the platform on the tip [N]
  Vec3<double> moment = Vec3<double>::Zero();    ///< m of the platform on the tip; 0 at a ball joint [N m]
  Vec3<double> force_0 = Vec3<double>::Zero();   ///< internal force at the base: n and the rod's weight [N]
  Vec3<double> moment_0 = Vec3<double>::Zero();  ///< internal moment at the base [N m]
  Vec3<double> curvature_0 = Vec3<double>::Zero();  ///< at the base, twist along the tangent [1/m]
  Vec3<double> tip = Vec3<double>::Zero();          ///< [m]
  double largest_curvature = 0;                     ///< of bending, anywhere, beyond that at rest [1/m]
  /// Of bending, anywhere; NaN of round rods, whose is this curvature times half their diameter.
  double largest_strain = std::numeric_limits<double>::quiet_NaN();
  double energy = 0;  ///< elastic [J]
};

}  // namespace sinew::inline v1
