/// @file hinged_modes.hpp
/// Assembly modes of a platform on three hinged legs (3PRS and its kin): every pose that closes them,
/// whatever drives the hinges. Each platform point moves on a circle; at most sixteen poses close the three,
/// both operation modes of a 3PRS among them. Theory: docs/theory/tripod_rigid.md
#pragma once
#include <array>
#include <span>

#include "leg/platform_constraint.hpp"
#include "sinew/math/se3.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// What the report says besides `converged`: `unreachable`, no pose closes the legs; `singular`, a continuum
/// of poses does, some of which may be listed; `stalled`, none was found and some may be missing;
/// `left_domain`, a number is not finite or the legs are not three with a plane each.
struct HingedModes {
  static constexpr int most = 16;
  Report report;  ///< residual: the largest of all poses
  int count = 0;
  std::array<SpatialPose, most> poses{};  ///< z descending, then y, x descending, then the quaternion
  std::array<double, most> residual{};    ///< largest closure error of each pose [m]
  std::array<bool, most> is_double{};     ///< modes merge here: a type II singularity
  bool is_complete = false;  ///< every root of the polynomial is accounted for; else a lower bound

  bool ok() const noexcept { return report.ok(); }
};

/// Whether these are three hinged legs.
bool are_hinged(std::span<const PlatformConstraint<3>> legs);

/// A pose counts if it closes the legs to 1e-12 of their size; poses nearer than 1e-6 of it count as one. No
/// heap, no throw, bounded work.
HingedModes hinged_modes(std::span<const PlatformConstraint<3>> legs);

}  // namespace sinew::inline v1
