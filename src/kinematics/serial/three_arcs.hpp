/// @file three_arcs.hpp
/// All inverse solutions of a serial robot of three sections, each a single inextensible arc of constant
/// curvature (neutral backbone, one segment, no disc): every triple of bends that puts the tip at a given
/// pose. The six equations are brought down to two curves, one of the first bend and one of the last, and all
/// pairs of their pieces are searched with bounds. Theory: docs/theory/three_arcs.md
#pragma once
#include <array>
#include <numbers>
#include <vector>

#include "sinew/math/se3.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// The robot, from base to tip. Base at the origin, base tangent along +z, no twist between sections.
struct ThreeArcs {
  std::array<double, 3> lengths = {1, 1, 1};  ///< arc lengths L [m], > 0
  /// Largest bend |b| of a section [rad], > 0 and at most 2π: a full turn.
  double limit = 2 * std::numbers::pi;
};

/// Bends of the three sections [rad] as in bent_joint.hpp: the section's tip turns by |b| towards the
/// direction b of the section's own base axes.
using ThreeBends = std::array<Vec2<double>, 3>;

/// What the search found, and how far it can be believed.
struct ThreeArcSolutions {
  /// Bends are told apart, and boxes of bends split, down to this size [rad].
  static constexpr double resolution = 1e-6;

  /// `unreachable`: no bends reach the pose, with proof where `is_complete()`. `stalled`: none was found,
  /// without proof. `singular`: a continuum of bends reaches the pose, or too many to list; those listed are
  /// examples. `left_domain`: a number is not finite, a length not above 0, the limit not in (0, 2π].
  /// residual: the largest of all solutions.
  Report report;
  std::vector<ThreeBends> solutions;  ///< Σ|b|² ascending (equal within 1e-9: by the first bend, and so on)
  /// Of each, the largest of what the tip is off [m], turns times the length of the robot.
  std::vector<double> residual;
  /// Of each, the smallest singular value of its Jacobian, lengths divided by that of the robot.
  std::vector<double> regularity;
  int boxes = 0;       ///< pairs of pieces looked at
  int open_boxes = 0;  ///< of these, neither free of solutions nor with exactly one, and not split

  /// No other bends within the limit reach the pose: all others were excluded by bounds on the equations,
  /// taken in floating point with a margin of 1e-12 of the size (not in outward rounded intervals). Otherwise
  /// the number of solutions is a lower bound.
  bool is_complete() const noexcept { return open_boxes == 0 && report.status != Status::left_domain; }
  bool ok() const noexcept { return report.ok(); }
};

/// Deterministic, no threads, bounded work: at most 32 solutions, 400 000 pairs of pieces and 40 MB.
ThreeArcSolutions all_bends(const ThreeArcs& robot, const SpatialPose& tip, StopToken stop = {});

/// Pose of the tip under these bends.
SE3<double> tip_pose(const ThreeArcs& robot, const ThreeBends& bends);

}  // namespace sinew::inline v1
