/// @file section_motion.hpp
/// Kinematics of one section, on any scalar: pose of its end, and how it moves with the section's bend.
/// Theory: docs/theory/section.md
#pragma once
#include "link/bent_joint.hpp"
#include "link/bent_motion.hpp"
#include "sinew/robot/serial.hpp"

namespace sinew::inline v1 {

namespace detail {

/// A segment bent by β₂, about −x, then one bent by β₁, about y.
template <Scalar S>
[[gnu::always_inline]] inline BentMotion<S> twin_motion(const PivotMotion<S>& low,
                                                        const PivotMotion<S>& high) {
  return {
      {low.half_cosine * high.half_cosine,
       {-low.half_sine * high.half_cosine, low.half_cosine * high.half_sine, -low.half_sine * high.half_sine},
       {high.side, low.side + high.ahead * low.sine, low.ahead + high.ahead * low.cosine}},
      {{high.side_rate, S(0)},
       {high.ahead_rate * low.sine, low.side_rate + high.ahead * low.cosine},
       {high.ahead_rate * low.cosine, low.ahead_rate - high.ahead * low.sine}},
      {{S(0), S(-1)}, {low.cosine, S(0)}, {-low.sine, S(0)}}};
}

/// unitᴺ by squaring.
template <Scalar S>
[[gnu::always_inline]] inline BentMotion<S> power(BentMotion<S> unit, int count) {
  for (; count % 2 == 0; count /= 2) unit = unit.then(unit);
  BentMotion<S> all = unit;
  for (count /= 2; count > 0; count /= 2) {
    unit = unit.then(unit);
    if (count % 2 == 1) all = all.then(unit);
  }
  return all;
}

}  // namespace detail

/// Pose of the section's end on its base [m], z distal, with its derivatives by the bend [m/rad], [rad/rad].
template <Scalar S>
[[gnu::always_inline]] inline BentMotion<S> section_motion(const Section& section, const Vec2<S>& bend) {
  const BentJoint one{section.joint, section.disc_height, section.is_twin() ? 1 : section.segments};
  if (!section.is_twin()) return one.motion(bend[0], bend[1]);
  return detail::power(detail::twin_motion(one.pivot(bend[1]), one.pivot(bend[0])), section.segments / 2);
}

/// The pose alone.  @implements LSK (3), (4)
template <Scalar S>
[[gnu::always_inline]] inline BentPose<S> section_pose(const Section& section, const Vec2<S>& bend) {
  return section_motion(section, bend).pose;  // inlined: rates not asked for are not computed
}

}  // namespace sinew::inline v1
