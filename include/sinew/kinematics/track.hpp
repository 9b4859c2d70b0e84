/// @file track.hpp
/// Following a path of the platform: inputs that change continuously, step by step by the differential
/// inverse kinematics and back onto the closures. Theory: docs/theory/track.md
#pragma once
#include "sinew/kinematics/inverse.hpp"

namespace sinew::inline v1 {

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
