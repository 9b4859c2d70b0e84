/// @file state.hpp
/// What an answer tells of a leg.
#pragma once
#include <array>
#include <limits>

#include "sinew/math/vec.hpp"

namespace sinew::inline v1 {

/// What a person wants to know of a leg in an answer: first of one with an arc, then of one on a rail; what
/// the leg has not is NaN or 0.
struct LegState {
  /// NaN, of whatever unit: what stands for a number that the leg has not.
  static constexpr double absent = std::numeric_limits<double>::quiet_NaN();

  double curvature = absent;                                ///< κ [1/m], signed
  double chord = absent;                                    ///< ρ [m]
  std::array<double, 2> tendon_lengths = {absent, absent};  ///< tendon 1, tendon 2 [m]
  Vec3<double> base_tangent =
      Vec3<double>::Zero();                     ///< unit vector along the backbone at its base, base axes
  std::array<double, 2> joint_angles = {0, 0};  ///< of the universal joint at the base [rad]; 0 in the plane

  double slide = absent;                         ///< ρ of the carriage along its rail [m]
  Vec3<double> carriage = Vec3<double>::Zero();  ///< base frame [m]
  double hinge_angle = absent;                   ///< of the strut about the hinge's axis, from the rail [rad]

  int elbow = 0;  ///< see SolutionPreference, ±1; 0 of a leg without
};

}  // namespace sinew::inline v1
