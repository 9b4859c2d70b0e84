/// @file section.hpp
/// One section of a serial robot: segments, each a joint and then a disc, and the tendons that end at its
/// last disc. Theory: docs/theory/section.md
#pragma once
#include <limits>
#include <numbers>

#include "sinew/kernel/direction.h"
#include "sinew/kernel/section.h"
#include "sinew/link/bent_joint.hpp"

namespace sinew::inline v1 {

/// Bend of a section [rad]: (β₁, β₂) of each joint of a twin-pivot backbone, θ (cos φ, sin φ) of a neutral
/// one.
using Bend = Vec2<double>;

/// Sizes of a section, and its kinematics: pose of its end, derivatives, directions of tendons.
struct Section {
  kernel::Backbone backbone = kernel::Backbone::twin_pivot;
  int segments = 8;           ///< N ≥ 1; of twin pivots even: they bend about two axes in turn
  double joint = 0;           ///< arc length L of one joint [m], > 0
  double disc_height = 0;     ///< h of the disc after it [m]
  double disc_radius = 0;     ///< of the disc [m]; 0: the section has none
  int tendons = 3;            ///< n ≥ 3
  double tendon_radius = 0;   ///< r_c, distance of every tendon from the backbone [m], > 0
  double tendon_angle = 0;    ///< δ of tendon 0 [rad]; the others follow evenly spread ...
  bool is_clockwise = false;  ///< ... counter-clockwise, seen from the tip, or the other way
  /// Largest bend [rad]: |β| of a joint about either axis, θ of a section with a neutral backbone.
  double limit = std::numeric_limits<double>::infinity();
  /// How much longer than at rest its backbone can be made [m], evenly over its joints: least ≤ 0 ≤
  /// most. The third coordinate of a neutral backbone; 0 and 0: the length is fixed.
  double min_extension = 0;
  double max_extension = 0;  ///< [m], see `min_extension`

  bool is_extensible() const { return min_extension < max_extension; }  ///< its length varies
  /// The section made longer by so much [m].
  Section extended(double extension) const {
    Section longer = *this;
    longer.joint += extension / segments;
    return longer;
  }
  /// How fast its end moves when it is made longer [m/m], in its base's frame, at this bend [rad].
  Vec3<double> extension_motion(const Bend& bend) const {
    Section chords = *this;  // the end is linear in the length of the joints
    chords.joint = 1.0 / segments;
    chords.disc_height = 0;
    return chords.pose(bend).rigid().p;
  }

  bool is_twin() const { return backbone == kernel::Backbone::twin_pivot; }  ///< a twin-pivot backbone
  double arc_length() const { return segments * joint; }                     ///< N L [m]
  double length() const { return segments * (joint + disc_height); }         ///< of the whole section [m]

  /// Of a section's bend [rad] what its k-th joint has; of twin pivots the proximal one of a pair bends by
  /// β₂.
  Bend joint_bend(const Bend& bend, int k) const {
    if (!is_twin()) return bend / segments;
    return k % 2 == 0 ? Bend(0, bend.y()) : Bend(bend.x(), 0);
  }
  /// Of the tube that holds discs and tendons [m].
  double outer_radius() const { return disc_radius > tendon_radius ? disc_radius : tendon_radius; }

  /// What the kernel needs of it to map bends and tendons [m].
  kernel::Section<double> map() const {
    return kernel::make_section<double>(backbone, segments, joint, tendon_radius);
  }
  /// Of a tendon around the disc, from +x [rad].
  double angle_of(int tendon) const {
    return tendon_angle + (is_clockwise ? -2 : 2) * std::numbers::pi * tendon / tendons;
  }
  /// Cosine and sine of `angle_of` [1].
  kernel::Direction<double> direction(int tendon) const {
    return kernel::direction<double>(angle_of(tendon));
  }

  /// Pose of the section's end on its base [m], z distal, at this bend [rad].  @implements LSK (3), (4)
  template <Scalar S>
  [[gnu::always_inline]] BentPose<S> pose(const Vec2<S>& bend) const {
    return motion(bend).pose;  // inlined: rates not asked for are not computed
  }
  /// The same with its derivatives by the bend [m/rad], [rad/rad].
  template <Scalar S>
  [[gnu::always_inline]] BentMotion<S> motion(const Vec2<S>& bend) const {
    const BentJoint one{joint, disc_height, is_twin() ? 1 : segments};
    if (!is_twin()) return one.motion(bend[0], bend[1]);
    return power(twin_motion(one.pivot(bend[1]), one.pivot(bend[0])), segments / 2);
  }

 private:
  /// A segment bent by β₂, about −x, then one bent by β₁, about y.
  template <Scalar S>
  [[gnu::always_inline]] static BentMotion<S> twin_motion(const PivotMotion<S>& low,
                                                          const PivotMotion<S>& high) {
    return {{low.half_cosine * high.half_cosine,
             {-low.half_sine * high.half_cosine, low.half_cosine * high.half_sine,
              -low.half_sine * high.half_sine},
             {high.side, low.side + high.ahead * low.sine, low.ahead + high.ahead * low.cosine}},
            {{high.side_rate, S(0)},
             {high.ahead_rate * low.sine, low.side_rate + high.ahead * low.cosine},
             {high.ahead_rate * low.cosine, low.ahead_rate - high.ahead * low.sine}},
            {{S(0), S(-1)}, {low.cosine, S(0)}, {-low.sine, S(0)}}};
  }

  /// unitᴺ by squaring.
  template <Scalar S>
  [[gnu::always_inline]] static BentMotion<S> power(BentMotion<S> unit, int count) {
    for (; count % 2 == 0; count /= 2) unit = unit.then(unit);
    BentMotion<S> all = unit;
    for (count /= 2; count > 0; count /= 2) {
      unit = unit.then(unit);
      if (count % 2 == 1) all = all.then(unit);
    }
    return all;
  }
};

}  // namespace sinew::inline v1
