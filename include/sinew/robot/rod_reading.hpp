/// @file rod_reading.hpp
/// What people want to know of a rod in an equilibrium.
#pragma once
#include "sinew/math/vec.hpp"

namespace sinew::inline v0 {

/// Vectors in base axes. A rod has one force n along its length: of the platform on its tip.
struct RodReading {
  double length = 0;         ///< L [m]
  double chord = 0;          ///< from base to tip [m]
  double tip_angle = 0;      ///< of the tangent at the tip from that at the base, in the rod's plane [rad]
  double lateral_force = 0;  ///< of the platform on the tip, away from the base tangent [N]
  double axial_force = 0;    ///< along the base tangent [N]
  Vec3<double> force = Vec3<double>::Zero();        ///< n [N]
  Vec3<double> moment_0 = Vec3<double>::Zero();     ///< internal moment at the base [N m]
  Vec3<double> curvature_0 = Vec3<double>::Zero();  ///< at the base [1/m]
  Vec3<double> tip = Vec3<double>::Zero();          ///< [m]
  double largest_curvature = 0;                     ///< anywhere along the rod [1/m]
  double energy = 0;                                ///< of bending [J]
};

}  // namespace sinew::inline v0
