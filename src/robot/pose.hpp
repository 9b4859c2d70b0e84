/// @file pose.hpp
/// The pose of a robot's own space out of the variant at the edge.
#pragma once
#include <cmath>

#include "leg/space.hpp"
#include "sinew/base/numbers.hpp"
#include "sinew/robot/robot.hpp"

namespace sinew::inline v1 {

inline PlanarPose nowhere(Planar) { return {not_a_number, not_a_number, not_a_number}; }
inline SpatialPose nowhere(Spatial) { return {Vec3<double>::Constant(not_a_number), {1, 0, 0, 0}}; }

/// A pose of the other space becomes NaN: a caller that did not check it gets no answer, and no crash.
template <class Space>
typename Space::Pose in_space(const AnyPose& pose) {
  if (const auto* own = std::get_if<typename Space::Pose>(&pose)) return *own;
  return nowhere(Space{});
}

/// A pose in the plane is one in the plane z = 0 of space ...
inline SpatialPose in_space(const PlanarPose& pose) {
  const double half = wrap_angle(pose.phi) / 2;
  return {Vec3<double>(pose.x, pose.y, 0), {std::cos(half), 0, 0, std::sin(half)}};
}
/// ... and such a one in space, turned about z alone, is one in the plane.
inline PlanarPose in_plane(const SpatialPose& pose) {
  const auto& q = pose.quaternion;
  return {pose.position[0], pose.position[1], wrap_angle(2 * std::atan2(q[3], q[0]))};
}

/// The pose of a frame, its angle or quaternion as answers have it.
inline PlanarPose pose_of(const SE2<double>& frame) { return planar_pose(frame); }
inline SpatialPose pose_of(const SE3<double>& frame) { return spatial_pose(frame); }

/// From one frame to the other as one twist, base axes; the shortest turn.
inline Vec<double, 6> twist_between(const SE3<double>& from, const SE3<double>& to) {
  Vec<double, 6> twist;
  twist << to.p - from.p, to.R.compose(from.R.inverse()).log();
  return twist;
}
inline Vec<double, 3> twist_between(const SE2<double>& from, const SE2<double>& to) {
  return {to.p[0] - from.p[0], to.p[1] - from.p[1], wrap_angle(to.angle() - from.angle())};
}

/// How far two poses are apart [m], turns counted by what they move a point at `radius`.
inline double gap(const PlanarPose& a, const PlanarPose& b, double radius) {
  return std::hypot(a.x - b.x, a.y - b.y, radius * wrap_angle(a.phi - b.phi));
}
inline double gap(const SpatialPose& a, const SpatialPose& b, double radius) {
  const Vec3<double> turn = SE3<double>::from(a).R.inverse().compose(SE3<double>::from(b).R).log();
  return std::hypot((a.position - b.position).norm(), radius * turn.norm());
}

}  // namespace sinew::inline v1
