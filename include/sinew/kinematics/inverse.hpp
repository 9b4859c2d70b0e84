/// @file inverse.hpp
/// Inverse kinematics: the inputs that hold the platform at a pose. The legs of different inputs decouple, so
/// each is solved alone and completely: every solution within its domain is found. A leg that can still move
/// at the pose (3-RFRR) has a continuum of them; a wish or a start singles one out. Theory:
/// docs/theory/kinematics.md
#pragma once
#include "sinew/robot/assembly.hpp"

namespace sinew::inline v1 {

/// Which of the solutions is wanted; default the smallest |κ|, positive where both signs do.
struct InverseOptions {
  std::span<const int> bending =
      {};                  ///< +1 or −1 a leg: only curvatures of this sign (a straight link has both)
  Numbers curvature = {};  ///< κ a leg [1/m]: the nearest solution is taken
  std::span<const int> elbow =
      {};              ///< +1 or −1 a leg: to which side the strut of a swivelled link turns; default +1
  Numbers start = {};  ///< inputs [m], [rad]: the solution nearest to them is taken, of a redundant leg too
};

/// Inputs that hold a pose.
struct Inverse {
  Report report;  ///< unreachable names the leg and what it would need
  /// In leg order: lengths of tendon 1 or slides [m], before them angles of base motors [rad]; view into the
  /// workspace.
  std::span<const double> inputs;
  /// Of the links (κ [1/m], θ [rad], slide [m]), leg by leg; view into the workspace.
  std::span<const double> coordinates;

  /// `report.ok()`: converged.
  bool ok() const noexcept { return report.ok(); }
};

/// Inputs at `pose`. Residual: largest closure error [m]. No heap, no throw, bounded work.
SINEW_API Inverse inverse(const Robot& robot, const AnyPose& pose, const InverseOptions& options,
                          Workspace& work);

/// Every solution of every leg at a pose; of a leg with a continuum of them those of the curvature wished
/// for. The working modes of the robot are their combinations.
struct WorkingModes {
  Report report;  ///< unreachable where a leg has no solution
  /// Inputs [m], [rad] of each leg's solutions, read by `mode`; view into the workspace
  std::span<const double> solutions;
  std::span<const int> solution_count;  ///< a leg
  double count;                         ///< number of modes: product of the counts; exact up to 2^53
  bool is_continuum = false;            ///< a leg is redundant: these are some of infinitely many

  /// Inputs [m], [rad] of mode k < count, the first leg turning slowest; NaN where there are none, or they
  /// are of another robot. `coordinates_from_inputs` gives their link coordinates.
  SINEW_API void mode(const Robot& robot, std::size_t k, std::span<double> inputs) const;
};

/// All working modes at a pose. `unreachable` names the leg that has no solution. No heap.
SINEW_API WorkingModes working_modes(const Robot& robot, const AnyPose& pose, const InverseOptions& options,
                                     Workspace& work);

}  // namespace sinew::inline v1
