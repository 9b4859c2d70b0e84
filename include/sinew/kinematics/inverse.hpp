/// @file inverse.hpp
/// Inverse kinematics: the inputs that hold the platform at a pose. The legs of different inputs decouple, so
/// each is solved alone and completely: every solution within its domain is found. A leg that can still move
/// at the pose (3-RFRR) has a continuum of them; a wish or a start singles one out. Then poses of a platform
/// whose points hinges hold in planes (what is free of a pose, and what follows from it), and paths of the
/// platform: inputs that change continuously, step by step by the differential inverse kinematics and back
/// onto the closures. Theory: docs/theory/kinematics.md, docs/theory/tripod_rigid.md, docs/theory/track.md
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

/// What a redundant robot does with the freedom a pose leaves it. Other robots have none: the objective is
/// then without effect.
enum class Objective {
  none,         ///< the shortest motion of the links
  limits,       ///< away from the ends of the curvatures' domain
  singularity,  ///< away from type II: larger |det J| of unit lines
  smooth,       ///< changes the velocities of the links as little as the path allows, pose by pose
};

/// On which branch, and what for.
struct TrackOptions {
  InverseOptions branch = {};  ///< of the first pose
  Objective objective = Objective::none;
  double null_step = 0.2;  ///< longest null-space motion a pose, all angles (θ, bends κℓ) together [rad]
};

/// A robot on its way along a path. The branch it began on is never left: where that ends the path is
/// `unreachable` and the message says which leg stopped it; `progress` says how far it got.
class SINEW_API Track {
 public:
  /// Robot and workspace must outlive the track.
  Track(const Robot& robot, TrackOptions options, Workspace& work);

  /// To the first pose by inverse kinematics, to every further one by continuation. On the way between two
  /// poses a platform that hinges hold in planes stays in them; the poses themselves must lie in them.
  Report advance(const AnyPose& next);

  /// The last pose reached.
  const AnyPose& pose() const { return pose_; }
  Numbers inputs() const { return inputs_; }            ///< at the last pose reached [m], [rad], in leg order
  Numbers coordinates() const { return coordinates_; }  ///< of the links there [1/m], [rad], [m]
  double closure_error() const { return closure_error_; }  ///< largest of all legs there [m]
  /// Share of the way from the last pose to the next that was made, 1 after a success.
  double progress() const { return progress_; }

 private:
  Report begin(const AnyPose& first);
  int step(const AnyPose& pose, double part, std::vector<double>& coordinates, Report& report);
  void settle();

  const Robot* robot_;
  TrackOptions options_;
  Workspace* work_;
  bool has_begun_ = false;
  AnyPose pose_;
  std::vector<double> coordinates_, inputs_, motion_;  // motion_: the last change of coordinates
  double closure_error_ = 0, progress_ = 0;
};

/// A pose a share `part` of the way from one to another: positions on the straight line, rotations in space
/// the shortest way, φ in the plane as the numbers say (so that a path may turn by more than half a turn).
SINEW_API AnyPose between(const AnyPose& from, const AnyPose& to, double part);

/// The constant twist that leads from one to the other in unit time, base axes: (x, y, φ) in the plane, (v,
/// ω) in space [m], [rad].
SINEW_API Vec<double, 3> twist_between(const PlanarPose& from, const PlanarPose& to);
SINEW_API Vec<double, 6> twist_between(const SpatialPose& from, const SpatialPose& to);

}  // namespace sinew::inline v1
