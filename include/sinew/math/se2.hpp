/// @file se2.hpp
/// Planar rigid motions. A twist is (vx, vy, ω), linear first. exp and log are those of the group, so
/// X·exp(ξ) moves X by a twist in its own axes (left-invariant) and exp(Ad_X ξ)·X is the same motion in base
/// axes. `displaced` is the update of DESIGN §4: (δx, δy, δφ) in base axes about the reference point.
#pragma once
#include <cmath>
#include <numbers>

#include "sinew/math/entire.hpp"
#include "sinew/math/vec.hpp"

namespace sinew::inline v1 {

/// The angle in (−π, π]. Exact: the remainder of an IEEE division by the double 2π is not rounded.
inline double wrap_angle(double angle) {
  const double wrapped = std::remainder(angle, 2 * std::numbers::pi);
  return wrapped == -std::numbers::pi ? std::numbers::pi : wrapped;
}

/// Platform pose as people write it; `phi` in (−π, π].
struct PlanarPose {
  double x = 0;    ///< of the reference point, base frame [m]
  double y = 0;    ///< [m]
  double phi = 0;  ///< of the platform against the base, counter-clockwise [rad]
};

/// The angle whose sine and cosine are (s, c) up to a factor, in (−π, π]. On derivative types the analytic
/// continuation about the real angle.
template <Scalar S>
S angle_of(const S& s, const S& c) {
  using std::atan;
  if constexpr (std::floating_point<S>) {
    return std::atan2(s, c);
  } else {
    const double s0 = real_part(s), c0 = real_part(c);
    return static_cast<S>(std::atan2(s0, c0)) + atan(S((s * static_cast<S>(c0) - c * static_cast<S>(s0)) /
                                                       (c * static_cast<S>(c0) + s * static_cast<S>(s0))));
  }
}

/// A rigid motion of the plane: x ↦ p + R x.
template <Scalar S>
struct SE2 {
  Vec2<S> p = Vec2<S>(S(0), S(0));  ///< where the origin goes [m]
  S c = S(1), s = S(0);             ///< cosine and sine of the angle

  /// The motion that moves nothing.
  static SE2 identity() { return {}; }

  /// By coordinates [m] and angle [rad].
  static SE2 from(const S& x, const S& y, const S& angle) {
    using std::cos, std::sin;
    return {Vec2<S>(x, y), cos(angle), sin(angle)};
  }
  static SE2 from(const PlanarPose& pose) {
    return from(static_cast<S>(pose.x), static_cast<S>(pose.y), static_cast<S>(pose.phi));
  }

  /// In (−π, π].
  S angle() const { return angle_of(s, c); }
  /// R v.
  Vec2<S> rotate(const Vec2<S>& v) const { return {c * v[0] - s * v[1], s * v[0] + c * v[1]}; }
  /// Rᵀ v.
  Vec2<S> rotate_back(const Vec2<S>& v) const { return {c * v[0] + s * v[1], c * v[1] - s * v[0]}; }

  /// p + R b: where the body-fixed point b is.
  Vec2<S> point(const Vec2<S>& b) const { return p + rotate(b); }

  /// This motion after `next`: `next` is given in the axes of this one.
  SE2 compose(const SE2& next) const {
    return {point(next.p), c * next.c - s * next.s, s * next.c + c * next.s};
  }
  /// The motion back.
  SE2 inverse() const { return {-rotate_back(p), c, -s}; }

  /// This pose after the small motion (δx, δy, δφ) in base axes about the reference point.
  SE2 displaced(const Vec3<S>& motion) const {
    using std::cos, std::sin;
    const S dc = cos(motion[2]), ds = sin(motion[2]);
    const S x = dc * c - ds * s, y = ds * c + dc * s;
    const S keep = S(1.5) - (x * x + y * y) * S(0.5);  // 1/√(x² + y²) near 1: many updates do not drift
    return {p + Vec2<S>(motion[0], motion[1]), x * keep, y * keep};
  }

  /// The motion by a constant twist (vx, vy, ω) in its own axes for unit time.
  static SE2 exp(const Vec3<S>& twist) {
    const auto turn = sinc_pair(twist[2]);
    const S lift = twist[2] * cosc(twist[2]);
    return {Vec2<S>(turn.value * twist[0] - lift * twist[1], lift * twist[0] + turn.value * twist[1]),
            turn.cos, turn.sin};
  }

  /// The twist with |ω| ≤ π that exp maps here.
  Vec3<S> log() const {
    using std::cos;
    const S turn = angle(), half = turn * S(0.5);
    const S stretch = cos(half) / sinc(half);  // (θ/2)·cot(θ/2)
    return {stretch * p[0] + half * p[1], stretch * p[1] - half * p[0], turn};
  }

  /// Ad: X·exp(ξ)·X⁻¹ = exp(Ad ξ).
  Mat<S, 3, 3> adjoint() const {
    Mat<S, 3, 3> ad;
    ad << c, -s, p[1], s, c, -p[0], S(0), S(0), S(1);
    return ad;
  }

  /// exp(ξ + δ) ≈ exp(J δ)·exp(ξ) to first order.
  static Mat<S, 3, 3> left_jacobian(const Vec3<S>& twist) {
    const S t = twist[2], a = sinc(t), b = t * cosc(t), u = cosc(t), w = t * sinc3(t);
    Mat<S, 3, 3> jacobian;
    jacobian << a, -b, w * twist[0] + u * twist[1], b, a, w * twist[1] - u * twist[0], S(0), S(0), S(1);
    return jacobian;
  }
};

/// As people write it.
inline PlanarPose planar_pose(const SE2<double>& pose) {
  return {pose.p[0], pose.p[1], wrap_angle(pose.angle())};
}

}  // namespace sinew::inline v1
