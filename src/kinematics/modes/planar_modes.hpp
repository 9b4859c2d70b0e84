/// @file planar_modes.hpp
/// Assembly modes of a planar parallel robot: every platform pose that closes the legs, whatever the links
/// and drives are. Three distances leave up to six poses: real roots of a sextic in e^{iφ}, TDPCR (42) text,
/// ref. 33; derivation docs/theory/assembly_modes.md.
#pragma once
#include <array>
#include <span>

#include "leg/platform_constraint.hpp"
#include "sinew/math/se2.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// Every platform pose that closes the legs.
///
/// What the report says besides `converged`: `unreachable`, no pose closes the legs; `singular`, a continuum
/// of poses does (fewer than three constraints, or legs that do not bind each other, such as equal parallel
/// legs between congruent triangles), some of which may be listed; `left_domain`, a number is not finite,
/// beyond 1e150 or a negative distance.
struct PlanarModes {
  static constexpr int most = 6;
  Report report;  ///< residual: the largest of all poses
  int count = 0;
  std::array<PlanarPose, most> poses{};  ///< ascending by φ in (−π, π] (equal within 1e-9: by x, then y)
  std::array<double, most> residual{};   ///< largest closure error of each pose [m]
  /// Modes merge here within about 1e-5 of the robot's size (type II singularity). Where they are nearer than
  /// about 1e-7 one pose stands for them, known to half the digits (two modes) or fewer (more).
  std::array<bool, most> is_double{};

  bool ok() const noexcept { return report.ok(); }
};

/// A pose counts if it closes three constraints to 1e-12 of the robot's size; more constraints than three
/// (extra legs, pinned legs) to 1e-9, in the least squares sense. Two poses are one if the pose half way
/// closes the legs as well as they do (1e-14). A leg shorter than 1e-14 of the size is pinned. No heap, no
/// throw, bounded work.
PlanarModes planar_modes(std::span<const PlatformConstraint<2>> legs);

}  // namespace sinew::inline v1
