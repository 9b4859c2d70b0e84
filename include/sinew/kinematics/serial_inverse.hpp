/// @file serial_inverse.hpp
/// Bends of a serial robot that bring its tip to a target: a position, a position and the direction of the
/// tip's axis, or a whole pose. Theory: docs/theory/serial_inverse.md
#pragma once
#include <optional>

#include "sinew/kinematics/serial.hpp"

namespace sinew::inline v1 {

/// Where the tip is wanted, in the base's frame. Of `direction` and `rotation` at most one.
struct TipTarget {
  Vec3<double> position;                       ///< [m]
  std::optional<Vec3<double>> direction = {};  ///< of the tip's z axis, of any length but 0: no unit
  std::optional<SO3<double>> rotation = {};    ///< of the tip, a unit quaternion
};

/// Where the search begins and ends.
struct SerialInverseOptions {
  /// [rad], tried first, brought within the limits; empty: the straight robot
  std::span<const Bend> start = {};
  /// Of the sections [m], with it; empty: their lengths at rest
  std::span<const double> start_extensions = {};
  int starts = 128;          ///< others tried after it, at most: a fixed set spread over the limits
  int max_iterations = 100;  ///< of each start
  double tolerance = 1e-12;  ///< on the residual, as a share of the robot's length
};

/// A target has finitely many solutions or a continuum of them; this is the one that `start` leads to: near
/// it where there is one near it, but in general not the nearest.
struct SerialInverse {
  /// Residual: the larger of position error and, times the robot's length, angle error [m].
  Report report;
  std::span<const Bend> bends;         ///< [rad], within the limits, view into the workspace
  std::span<const double> extensions;  ///< of the sections [m], within the limits, view into the workspace
  double position_error = 0;           ///< [m]
  double angle_error = 0;              ///< of the direction or the rotation, where one was wanted [rad]
  int start = 0;                       ///< which start led here: 0 the first, k the k-th of the fixed set

  /// `report.ok()`: converged.
  bool ok() const noexcept { return report.ok(); }
};

/// Damped least squares within the limits of every section, from one start after the other until one
/// converges. No heap, no throw, bounded work, and the same answer to the same question always.
///
/// Not converged, with the nearest bends found: `unreachable` where the target lies farther away than the
/// robot can be long; else `stalled` or `iteration_limit`, as the best start ended: none of the starts led to
/// the target, which may be out of reach for all that is known. `work.bends`, `work.extensions`, `work.ends`
/// and `work.J` are those of the answer. At most `max_sections` sections.
SINEW_API SerialInverse inverse(const SerialRobot& robot, const TipTarget& target,
                                const SerialInverseOptions& options, SerialWorkspace& work);

}  // namespace sinew::inline v1
