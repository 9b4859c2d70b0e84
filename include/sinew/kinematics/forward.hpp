/// @file forward.hpp
/// Forward kinematics: the platform pose that the inputs command, by Newton from a start; and every pose that
/// they allow. Theory: docs/theory/kinematics.md, docs/theory/assembly_modes.md
#pragma once
#include <optional>
#include <vector>

#include "sinew/robot/assembly.hpp"

namespace sinew::inline v1 {

/// Where the search begins and ends.
struct ForwardOptions {
  std::optional<AnyPose> start = {};  ///< default: the robot's home. Newton answers with the mode it leads to
  int max_iterations = 100;
  std::span<TraceStep> trace = {};  ///< every iterate's residual, as far as the span reaches
};

/// `pose` is the best iterate, also where the report says that it does not close the legs.
struct Forward {
  Report report;
  AnyPose pose;
  /// Of the links (κ [1/m], θ [rad], slide [m]), leg by leg; view into the workspace
  std::span<const double> coordinates;

  /// `report.ok()`: converged.
  bool ok() const noexcept { return report.ok(); }
};

/// Pose at which every leg closes on the link that `inputs` commands (in leg order: lengths of tendon 1 [m],
/// before them the angles of base motors [rad]). Residual: largest closure error [m]. The aim is 1e-14 of the
/// robot's size; where rounding ends the descent earlier, up to 1e-12 of it counts as converged. A planar
/// robot on which Newton's method fails is answered by all of its assembly modes: the one nearest to the
/// start, or proof that there is none; with more constraints than freedoms they count as closed up to 1e-9 of
/// the size. Where the legs hold fewer freedoms than the platform has, the pose is one of a continuum, and
/// the message says so. Robots on rods, or by the model prb, are answered by `equilibrium` without wrench.
/// No heap, no throw, bounded work.
/// @implements TDPCR (42)
SINEW_API Forward forward(const Robot& robot, Numbers inputs, const ForwardOptions& options, Workspace& work);

/// Poses of one robot at the same inputs, each with its residual.
struct AssemblyModes {
  Report report;  ///< unreachable where there is none; singular where there is a continuum
  std::vector<AnyPose> poses;
  std::vector<double> residual;  ///< largest closure error of each pose [m]
  std::vector<bool> is_double;   ///< of planar and of hinged legs: two modes merge in this pose, see there
  bool is_complete = true;       ///< otherwise their number is a lower bound
  /// Of the links [1/m], [rad], [m], the same in every mode; view into the workspace
  std::span<const double> coordinates;
};

/// All solutions of TDPCR (42); `forward` finds the one a start leads to. Of a robot on rods `unsupported`:
/// see `equilibria`.
/// @param inputs in leg order: lengths of tendons, slides [m], before them angles of base motors [rad]
SINEW_API AssemblyModes assembly_modes(const Robot& robot, Numbers inputs, Workspace& work);

/// Index of the pose nearest to `start`, turns counted by what they move a point at the platform's radius.
SINEW_API std::size_t nearest_pose(const Robot& robot, std::span<const AnyPose> poses, const AnyPose& start);

}  // namespace sinew::inline v1
