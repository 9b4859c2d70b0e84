/// @file velocity_batch.hpp
/// Inverse kinematics and velocity analysis of many poses at once, one pose a lane of a vector register, for
/// robots whose legs close in closed form: constant-curvature arcs between free joints (3-RFR, 6-UFS), struts
/// on hinges at carriages on rails (3PRS). Theory: docs/theory/velocity.md
#pragma once
#include <cstdint>

#include "sinew/analysis/velocity.hpp"
#include "sinew/kinematics/constrained_pose.hpp"

namespace sinew::inline v1 {

/// n poses and the branch on which they are reached.
struct PoseBatch {
  /// x of all poses, then y, then φ; in space x, y, z and the quaternion w, x, y, z. Where `independent` says
  /// so, z of all, then e₁, then e₂, of a robot with three planes in this mode of operation.
  Numbers coordinates;
  std::span<const int> bending = {}, elbow = {};  ///< a sign a leg, or empty, as `InverseOptions`
  std::optional<OperationMode> independent = {};
};

/// Where each quantity of n poses goes. A span is of n numbers, one of a leg of n a leg: those of the first
/// leg, then those of the second. What nobody asks for (an empty span) is not computed. Numbers are absent
/// (NaN) as they are in `velocity`, and all of them where there is no solution.
struct VelocityBatch {
  /// Of `constrained_pose` or `inverse` where one has no solution, else of `velocity`: converged,
  /// unreachable, singular (type II), stalled, or left_domain where the pose is not finite.
  std::span<Status> status = {};
  /// [m] and quaternion, seven numbers a pose: those of `independent` coordinates
  std::span<double> poses = {};
  std::span<double> inputs = {};       ///< tendon 1 of each leg, or its slide [m]
  std::span<double> curvatures = {};   ///< of each leg [1/m]; of a rail absent
  std::span<double> residual = {};     ///< largest closure error of a leg, as that of `inverse` [m]
  std::span<double> determinant = {};  ///< of J, in the units of `Velocity`
  std::span<double> condition = {};    ///< as `Indices`, units mixed as J's, and so are the next three
  std::span<double> condition_homogenised = {};  ///< no unit
  std::span<double> position = {};               ///< [m per unit of input]
  std::span<double> rotation = {};               ///< [rad per unit of input]
  std::span<std::uint8_t> type_1 = {};           ///< number of legs at a type I singularity
  std::span<std::uint8_t> is_type_2 = {};        ///< 1 at a type II singularity
};

/// Whether `velocity_batch` serves this robot: chord legs of arcs with tendons of their own, as many as the
/// platform has freedoms, or three struts on hinges at carriages of their own.
SINEW_API bool has_velocity_batch(const Robot& robot);

/// What `inverse` and `velocity` say of each pose. Poses with a chord within 1e-7 of its backbone, or whose
/// status rounding could turn, are put to these two one by one, with `work`; returns how many were. The
/// answer for a pose does not depend on the others. No heap.
SINEW_API std::size_t velocity_batch(const Robot& robot, const PoseBatch& batch, const VelocityBatch& out,
                                     Workspace& work);

}  // namespace sinew::inline v1
