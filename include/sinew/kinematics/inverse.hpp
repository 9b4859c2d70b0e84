/// @file inverse.hpp
/// Inverse kinematics: the inputs that hold the platform at a pose. The legs decouple, so each is solved
/// alone and completely: every solution within the link's domain is found. Theory: docs/theory/kinematics.md
#pragma once
#include "sinew/robot/assembly.hpp"

namespace sinew::inline v0 {

/// Which of a leg's solutions is wanted; default the smallest |κ|, positive where both signs do.
struct InverseOptions {
  std::span<const int> bending =
      {};                  ///< +1 or −1 a leg: only curvatures of this sign (a straight link has both)
  Numbers curvature = {};  ///< κ a leg [1/m]: the nearest solution is taken
};

struct Inverse {
  Report report;                        ///< unreachable names the leg and what it would need
  std::span<const double> inputs;       ///< view into the workspace
  std::span<const double> coordinates;  ///< of the links, view into the workspace

  bool ok() const noexcept { return report.ok(); }
};

/// Inputs at `pose`. Residual: largest closure error [m]. No heap, no throw, bounded work.
SINEW_API Inverse inverse(const AnyRobot& robot, const AnyPose& pose, const InverseOptions& options,
                          Workspace& work);

/// Every solution of every leg at a pose. The working modes of the robot are their combinations.
struct WorkingModes {
  Report report;                        ///< unreachable where a leg has no solution
  std::span<const double> solutions;    ///< leg-major, Workspace::max_solutions a leg, ascending
  std::span<const int> solution_count;  ///< a leg
  std::size_t count;                    ///< product of the counts

  /// Link coordinates of mode k < count, the first leg turning slowest.
  SINEW_API void mode(std::size_t k, std::span<double> coordinates) const;
};

SINEW_API WorkingModes working_modes(const AnyRobot& robot, const AnyPose& pose, Workspace& work);

}  // namespace sinew::inline v0
