/// @file constrained_pose.hpp
/// Poses of a platform whose points hinges hold in planes: what is free of a pose, and what follows from it.
/// Theory: docs/theory/tripod_rigid.md
#pragma once
#include "sinew/robot/assembly.hpp"

namespace sinew::inline v1 {

/// What can be chosen of the pose of a tripod, or of a spatial robot with three inputs: a height and two
/// components of the quaternion (e₀, e₁, e₂, e₃); the others are parasitic.
struct IndependentPose {
  double z = 0;   ///< [m]
  double e1 = 0;  ///< component of the unit quaternion
  double e2 = 0;  ///< component of the unit quaternion, e₁² + e₂² ≤ 1
};

/// A 3PRS moves in one of two ways: e₃ = 0, the platform tilts; or e₀ = 0, it is turned over by half a turn.
enum class OperationMode { tilt, half_turn };

/// `pose` is the best iterate, also where the report says that it keeps not all points in their planes.
struct ConstrainedPose {
  Report report;     ///< residual: largest distance of a platform point from its plane [m]
  SpatialPose pose;  ///< its e₁ and e₂ are those given

  /// `report.ok()`: converged.
  bool ok() const noexcept { return report.ok(); }
};

/// The pose of these independent coordinates: x, y and how e₀ and e₃ share what e₁ and e₂ leave, by Newton's
/// method from the robot's axis and e₃ = 0 or e₀ = 0. Three planes of any direction; of a symmetric 3PRS
/// exactly x = −2r e₁e₂, y = r(e₂² − e₁²) and e₃ = 0 or e₀ = 0. `left_domain` where the robot has not three
/// planes, or the coordinates are no quaternion's. No heap, no throw, bounded work.
/// @implements 3PFS (9)-(10)
SINEW_API ConstrainedPose constrained_pose(const Robot& robot, const IndependentPose& independent,
                                           OperationMode mode = OperationMode::tilt);

/// The pose put back into the planes of the robot's hinges, by shifts where these suffice and small turns
/// where not; of a robot without such planes the pose itself. A pose from which no steps lead there is
/// answered by the nearest one found.
SINEW_API AnyPose project_to_constraints(const Robot& robot, const AnyPose& pose);

}  // namespace sinew::inline v1
