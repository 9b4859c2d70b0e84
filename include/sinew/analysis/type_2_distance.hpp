/// @file type_2_distance.hpp
/// How far the platform can move in a direction before it meets a type II singularity.
/// Theory: docs/theory/singularity.md
#pragma once
#include <limits>

#include "sinew/analysis/lines.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::inline v1 {

/// How a direction is searched.
struct TypeTwoSearch {
  InverseOptions branch = {};  ///< of the first pose; it is followed from there
  /// Largest s looked at, a factor of the direction. Default: a full turn; for a direction without rotation
  /// there is none, as the legs end it.
  double limit = std::numeric_limits<double>::quiet_NaN();
  bool both_ways = false;  ///< also against the direction; the nearer one is answered
};

/// What the search found.
struct TypeTwoDistance {
  bool found = false;  ///< a type II singularity lies in that direction
  /// s of the type II, a multiple of the direction (metres where its linear part has unit length), negative
  /// where it lies against the direction; not found: how far the search came.
  double distance = 0;
  AnyPose pose;    ///< there
  TypeTwo type_2;  ///< there
  /// Where nothing was found: converged if the limit was reached; unreachable if the branch ends, with the
  /// leg that ends it.
  Report report;
};

/// The nearest type II along a straight motion: in the plane (x, y, φ) + s·direction; in space p + s·v,
/// exp(s·ω)·R, of a platform that hinges hold in planes the nearest pose in these. The distance is the
/// multiple of the direction given, exact to 1e-10 for directions of a length near one. A pose that is itself
/// singular has the distance 0.
/// @param direction a twist in base axes: (vx, vy, ω) or (v, ω) [m], [rad] per unit of s. `bad_input` where
/// it, or the pose, does not fit the robot
SINEW_API TypeTwoDistance type_2_distance(const Robot& robot, const AnyPose& pose, Numbers direction,
                                          const TypeTwoSearch& search, Workspace& work);

}  // namespace sinew::inline v1
