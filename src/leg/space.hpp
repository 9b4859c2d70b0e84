/// @file space.hpp
/// What a robot's space fixes: size of a point, of a twist, the frame of a platform, the moment of a line and
/// the joint at the foot of a leg that turns freely. Theory: docs/theory/space.md
#pragma once
#include "sinew/math/se2.hpp"
#include "sinew/math/se3.hpp"
#include "sinew/math/vec.hpp"

namespace sinew::inline v1 {

/// The plane: twist (ẋ, ẏ, φ̇), wrench (fx, fy, m).
struct Planar {
  static constexpr std::string_view name = "planar";
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

  /// ∂r/∂x of the platform point r = p + b:  (1, E b).
  static Mat<double, 2, 3> point_rate(const Vec2<double>& b) {
    Mat<double, 2, 3> rate;
    rate << 1, 0, -b[1], 0, 1, b[0];
    return rate;
  }

  /// What a turn of b alone changes the line of a direction through it by: the last rows and columns.
  static void add_turn(const Vec2<double>& direction, const Vec2<double>& b, Mat<double, 3, 3>& change) {
    change(2, 2) -= dot(direction, b);
  }

  static bool is_finite(const SE2<double>& frame) {
    return frame.p.allFinite() && std::isfinite(frame.c) && std::isfinite(frame.s);
  }

  static SE2<double> frame(const PlanarPose& pose) { return SE2<double>::from(pose); }
  static Vec2<double> position(const PlanarPose& pose) { return {pose.x, pose.y}; }

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

  /// The frame of a link whose base joint (R) is free, turned so that its tip u lies towards r.
  static SE2<double> aimed(const SE2<double>& base, const Vec2<double>& r, const Vec2<double>& u) {
    return SE2<double>::from(base.p.x(), base.p.y(), std::atan2(r.y(), r.x()) - std::atan2(u.y(), u.x()));
  }
  static Vec3<double> base_tangent(const SE2<double>& link_frame) { return {-link_frame.s, link_frame.c, 0}; }
};

/// Space: twist (ṗ, ω), wrench (f, m), base axes, about the platform's reference point.
///
/// The frame at the foot of a leg is that of its universal joint: x along the first axis g, which the base
/// holds, y where the leg points when both angles are 0, z along the second axis then. The joint turns by ψ₁
/// about g and by ψ₂ about the second axis e = unit(g × r), which is the normal of the bending plane.
struct Spatial {
  static constexpr std::string_view name = "spatial";
  static constexpr int dimension = 3;
  static constexpr int dof = 6;
  using Pose = SpatialPose;
  template <class S>
  using Frame = SE3<S>;

  /// Plücker line of a force f through the point b: (f, b × f).  @implements TDPCR (56), (58)
  template <Scalar S>
  static Mat<S, 1, 6> line(const Vec3<S>& direction, const Vec3<S>& point) {
    Mat<S, 1, 6> row;
    row << direction.transpose(), cross(point, direction).transpose();
    return row;
  }

  /// ∂r/∂x of the platform point r = p + b:  (1, −[b]×).
  static Mat<double, 3, 6> point_rate(const Vec3<double>& b) {
    Mat<double, 3, 6> rate;
    rate << 1, 0, 0, 0, b[2], -b[1], 0, 1, 0, -b[2], 0, b[0], 0, 0, 1, b[1], -b[0], 0;
    return rate;
  }

  /// What a turn of b alone changes the line of a direction through it by: the last rows and columns.
  static void add_turn(const Vec3<double>& direction, const Vec3<double>& b, Mat<double, 6, 6>& change) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) change(3 + i, 3 + j) += b[i] * direction[j];
      change(3 + i, 3 + i) -= dot(direction, b);
    }
  }

  static bool is_finite(const SE3<double>& frame) {
    return frame.p.allFinite() && frame.R.v.allFinite() && std::isfinite(frame.R.w);
  }

  static SE3<double> frame(const SpatialPose& pose) { return SE3<double>::from(pose); }
  static Vec3<double> position(const SpatialPose& pose) { return pose.position; }

  /// What rotates (1, 0, 0) and (0, 1, 0) of a frame to: cheaper than by `rotate`.
  static Vec3<double> first_axis(const SE3<double>& frame) {
    const double w = frame.R.w;
    const Vec3<double>& v = frame.R.v;
    return {1 - 2 * (v[1] * v[1] + v[2] * v[2]), 2 * (v[0] * v[1] + w * v[2]), 2 * (v[0] * v[2] - w * v[1])};
  }
  static Vec3<double> second_axis(const SE3<double>& frame) {
    const double w = frame.R.w;
    const Vec3<double>& v = frame.R.v;
    return {2 * (v[0] * v[1] - w * v[2]), 1 - 2 * (v[0] * v[0] + v[2] * v[2]), 2 * (v[1] * v[2] + w * v[0])};
  }

  template <Scalar S>
  static SE3<S> cast(const SE3<double>& frame) {
    return {frame.p.cast<S>(), {S(frame.R.w), frame.R.v.cast<S>()}};
  }

  static SpatialPose moved(const SpatialPose& pose, const Vec<double, 6>& step) {
    return spatial_pose(frame(pose).displaced(step));
  }
  static SpatialPose tidy(const SpatialPose& pose) { return spatial_pose(frame(pose)); }

  /// Angles ψ₁, ψ₂ [rad] of the universal joint when the link's tip u (in its plane) lies towards r (base
  /// axes).
  static std::array<double, 2> joint_angles(const SE3<double>& base, const Vec3<double>& r,
                                            const Vec2<double>& u) {
    const Vec3<double> local = base.rotate_back(r);
    const double out = std::hypot(local.y(), local.z());  // from the first axis
    // in the plane of x (the first axis) and the leg, as the link's own frame has it: y ahead, x beside
    return {std::atan2(local.z(), local.y()),
            wrap_angle(std::atan2(u.x(), u.y()) - std::atan2(local.x(), out))};
  }
  static SE3<double> aimed(const SE3<double>& base, const Vec3<double>& r, const Vec2<double>& u) {
    const auto [first, second] = joint_angles(base, r, u);
    const SO3<double> turn = SO3<double>::exp(Vec3<double>(first, 0, 0));
    return {base.p, base.R.compose(turn).compose(SO3<double>::exp(Vec3<double>(0, 0, second)))};
  }
  static Vec3<double> base_tangent(const SE3<double>& link_frame) {
    return link_frame.rotate(Vec3<double>(0, 1, 0));
  }
};

}  // namespace sinew::inline v1
