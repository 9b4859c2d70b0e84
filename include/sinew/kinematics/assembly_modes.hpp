/// @file assembly_modes.hpp
/// Every platform pose that given inputs allow, for any robot. Planar: planar_modes.hpp, all of them.
/// Spatial: hinged_modes.hpp for three hinged legs, spatial_modes.hpp for others, all of them or a lower
/// bound that says so. Theory: docs/theory/assembly_modes.md
#pragma once
#include <vector>

#include "sinew/robot/assembly.hpp"

namespace sinew::inline v1 {

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
