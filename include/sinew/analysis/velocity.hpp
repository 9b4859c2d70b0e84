/// @file velocity.hpp
/// Velocity equations, kinematic sensitivities and both kinds of singularity: at one configuration, or at
/// many poses at once, one a lane of a vector register. Theory: docs/theory/velocity.md, docs/theory/lines.md
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "sinew/kinematics/inverse.hpp"
#include "sinew/math/vec.hpp"
#include "sinew/robot/assembly.hpp"

namespace sinew::inline v1 {

/// In the plane by name; in space the varieties of lines of Grassmann geometry, whose customary number begins
/// the text of `to_string` ("5a general linear complex").
enum class LineClass {
  regular,    ///< the lines leave no twist free
  undefined,  ///< a row is not a finite number
  none,       ///< no rows, or rows of zeros only

  concurrent,  ///< plane, rank 2: meet in a point
  parallel,    ///< plane, rank 2
  coincident,  ///< plane, rank 1

  single_line,            ///< 1
  skew_pair,              ///< 2a
  planar_pencil,          ///< 2b: in one plane, and through one point or parallel
  regulus,                ///< 3a: one family of lines of a hyperboloid
  two_pencils,            ///< 3b: planar pencils in two planes, with one line in common
  bundle,                 ///< 3c: through one point, or parallel
  plane_of_lines,         ///< 3d
  elliptic_congruence,    ///< 4a: no line meets them all
  hyperbolic_congruence,  ///< 4b: meet two skew lines
  parabolic_congruence,   ///< 4c: pencils centred along one line, in planes through it
  degenerate_congruence,  ///< 4d: in one plane, or through one point of that plane
  general_complex,        ///< 5a: leave a screw motion free
  special_complex,        ///< 5b: meet one line: leave a rotation or (line at infinity) a translation free
};

/// In words, for people: `concurrent`, `5a general linear complex`.
SINEW_API std::string_view to_string(LineClass kind) noexcept;

/// The one motion that lines of rank 5 leave free, base frame.
struct Screw {
  double pitch;            ///< [m/rad]; 0: a rotation, infinite: a translation
  Vec3<double> point;      ///< of the axis, nearest to O′; O′ itself for a translation [m]
  Vec3<double> direction;  ///< unit; of its components z, y, x the first that is not zero is positive
};

/// Type II: J loses rank, the platform moves with the inputs held.
struct TypeTwo {
  bool singular = false;  ///< rank below the freedoms; true too where nothing can be told (`undefined`)
  int rank = 0;           ///< number of σᵢ/σmax above `type_2_tolerance`
  LineClass kind = LineClass::regular;
  /// σmax/σmin of the homogenised rows [1]. NaN above 1e15, where it says how they were rounded, and where
  /// there are fewer rows than freedoms.
  double condition = std::numeric_limits<double>::quiet_NaN();
  std::optional<Vec3<double>> point;  ///< `concurrent` (z = 0), `bundle`: where lines meet, base frame [m]
  std::optional<Screw> screw;         ///< rank 5 in space
};

/// A singular value of the homogenised rows counts as 0 up to this share of the largest.
inline constexpr double type_2_tolerance = 1e-10;

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
