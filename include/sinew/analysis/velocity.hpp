/// @file velocity.hpp
/// Velocity equations, kinematic sensitivities and both kinds of singularity at one configuration.
/// Theory: docs/theory/velocity.md
#pragma once
#include "sinew/analysis/lines.hpp"
#include "sinew/robot/assembly.hpp"

namespace sinew::inline v1 {

/// Performance indices. `position` and `rotation` are the 2-norms of the blocks of U: the largest platform
/// speed [m/s] and turning rate [rad/s] that inputs of unit norm can cause. Absent (NaN) where J is singular;
/// the condition numbers, where they exceed 1e15 and say how J was rounded.
struct Indices {
  double condition;              ///< σmax/σmin of J as the paper has it: mixes m and m²
  double condition_homogenised;  ///< rows scaled to unit lines, moments divided by the platform radius
  double position;               ///< [m per unit of input]
  double rotation;               ///< [rad per unit of input]
};

/// Velocity equations at one configuration: views into the workspace. Rows leg by leg, those of planes last;
/// columns of J the twist (vx, vy, ω) or (v, ω) of the platform, those of K the inputs in leg order.
struct Velocity {
  Report report;  ///< singular where J is; residual: closure error of the configuration [m]
  MatrixView J;  ///< rows × freedoms, J·t = K·ȧ: linear columns [m], angular ones [m²], of planes [1] and [m]
  MatrixView K;  ///< rows × inputs: [m] for inputs that are lengths, [m²] for angles, of planes [1] and [m]
  MatrixView U;  ///< freedoms × inputs, t = U·ȧ [m or rad per unit of input]; no rows where J is singular
  double determinant;  ///< of J where it is square, in the units of its rows, else NaN
  Indices indices;
  std::span<const int>
      type_1;  ///< legs whose inputs cannot follow every motion (a row of K is zero): the workspace boundary
  TypeTwo type_2;
};

/// Where one leg's tip velocity has a component along its line below this fraction, the leg is at a type I
/// singularity. Inverse kinematics is a square root there: a pose exact to 1e-16 gives curvatures exact to
/// 1e-8.
inline constexpr double type_1_tolerance = 1e-6;

/// Velocity analysis at a pose and link coordinates [1/m], [rad], [m] that close the legs (as `forward` and
/// `inverse` answer them). `bad_input` where they do not fit the robot. No heap.
SINEW_API Velocity velocity(const Robot& robot, const AnyPose& pose, Numbers coordinates, Workspace& work);

/// Input rates [m/s], [rad/s] for a platform twist [m/s, rad/s, base axes], into `work.rates`, at the
/// configuration last put to `velocity` with this workspace; the shortest where there are many. `singular`
/// where a leg at a type I singularity cannot follow, or legs that are tied would need different rates.
/// @implements TDPCR (41)
SINEW_API Report rates(const Velocity& velocity, Numbers twist, Workspace& work);

}  // namespace sinew::inline v1
