/// @file state.hpp
/// What an answer tells of a leg: of one that closes without load, and of an elastic rod; and how a backbone
/// is cut into rigid links and springs where a robot is asked by that model. Theory:
/// docs/theory/pseudo_rigid.md
#pragma once
#include <array>
#include <limits>

#include "sinew/base/export.hpp"
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

/// How the backbone is lumped into joints, and how its tendons run.
enum class PrbDiscretisation {
  even,      ///< M0, as [TDPCR]: all joints alike, tendons guided along the links
  weighted,  ///< M0w: joints next to an end stand for that end too. Of second order in chord and turn
  discs      ///< M1: as M0, tendons straight between discs at the middles of links
};

}  // namespace sinew::inline v1
