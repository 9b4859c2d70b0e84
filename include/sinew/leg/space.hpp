/// @file space.hpp
/// What a robot's space fixes: size of a point, of a twist, the frame of a platform and the moment of a line.
#pragma once
#include "sinew/math/se2.hpp"
#include "sinew/math/vec.hpp"

namespace sinew::inline v0 {

/// The plane: twist (ẋ, ẏ, φ̇), wrench (fx, fy, m).
struct Planar {
  static constexpr int dimension = 2;
  static constexpr int dof = 3;
  using Pose = PlanarPose;
  template <class S>
  using Frame = SE2<S>;

  /// Plücker line of a force f through the point b: (f, b × f); a row of J.
  template <Scalar S>
  static Mat<S, 1, 3> line(const Vec2<S>& direction, const Vec2<S>& point) {
    return {direction.x(), direction.y(), cross(point, direction)};
  }

  static bool is_finite(const SE2<double>& frame) {
    return frame.p.allFinite() && std::isfinite(frame.c) && std::isfinite(frame.s);
  }

  static SE2<double> frame(const PlanarPose& pose) { return SE2<double>::from(pose); }

  template <Scalar S>
  static SE2<S> cast(const SE2<double>& frame) {
    return {frame.p.cast<S>(), S(frame.c), S(frame.s)};
  }

  /// Pose moved by a small step (δx, δy, δφ).
  static PlanarPose moved(const PlanarPose& pose, const Vec<double, 3>& step) {
    return {pose.x + step[0], pose.y + step[1], pose.phi + step[2]};
  }

  /// The same pose with its angle in (−π, π].
  static PlanarPose tidy(const PlanarPose& pose) { return {pose.x, pose.y, wrap_angle(pose.phi)}; }
};

}  // namespace sinew::inline v0
