/// @file inverse.hpp
/// Inverse kinematics: the inputs that hold the platform at a pose. The legs of different inputs decouple, so
/// each input is solved alone and completely: every solution within its legs' domain is found. Theory:
/// docs/theory/kinematics.md
#pragma once
#include "sinew/robot/assembly.hpp"

namespace sinew::inline v0 {

/// Which of the solutions is wanted; default the smallest |κ|, positive where both signs do.
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

/// Every solution of every input at a pose. The working modes of the robot are their combinations.
struct WorkingModes {
  Report report;                        ///< unreachable where an input has no solution
  std::span<const double> solutions;    ///< values of the inputs, Workspace::max_solutions an input
  std::span<const int> solution_count;  ///< an input
  double count;                         ///< product of the counts; exact up to 2^53

  /// Inputs of mode k < count, the first input turning slowest. `command` gives their link coordinates.
  SINEW_API void mode(std::size_t k, std::span<double> inputs) const;
};

SINEW_API WorkingModes working_modes(const AnyRobot& robot, const AnyPose& pose, Workspace& work);

}  // namespace sinew::inline v0
