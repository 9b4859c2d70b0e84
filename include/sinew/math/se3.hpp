/// @file se3.hpp
/// Rotations in space and spatial rigid motions.
///
/// Rotations are unit quaternions [w, x, y, z], platform to base; their exp and log take rotation vectors.
/// All formulas are entire in θ (entire.hpp) or regular up to θ = 2π, so none has a small-angle switch of its
/// own. The twist of a motion is (v, ω), linear first. exp and log are those of the group, as in se2.hpp;
/// `displaced` is the update of DESIGN §4: linear and angular part in base axes about the reference point.
#pragma once
#include <array>

#include "sinew/math/entire.hpp"
#include "sinew/math/se2.hpp"
#include "sinew/math/vec.hpp"

namespace sinew::inline v1 {

/// [v]: the matrix with [v] u = v × u.
template <Scalar S>
Mat<S, 3, 3> skew(const Vec3<S>& v) {
  Mat<S, 3, 3> m;
  m << S(0), -v[2], v[1], v[2], S(0), -v[0], -v[1], v[0], S(0);
  return m;
}

namespace detail {
/// √q for use in even functions of it only: at 0 their derivative is 0, that of the root is not finite.
template <Scalar S>
S even_root(const S& q) {
  using std::sqrt;
  return real_part(q) == 0 ? S(0) : S(sqrt(q));
}
template <Scalar S>
S angle_norm(const Vec3<S>& v) {
  return even_root(squared_norm(v));
}
}  // namespace detail

/// A rotation as the unit quaternion w + v: half the angle's cosine, the axis times its sine.
template <Scalar S>
struct SO3 {
  S w = S(1);                             ///< real part
  Vec3<S> v = Vec3<S>(S(0), S(0), S(0));  ///< vector part

  /// The rotation that turns nothing.
  static SO3 identity() { return {}; }

  /// By a rotation vector [rad].
  static SO3 exp(const Vec3<S>& turn) {
    using std::cos;
    const S half = detail::angle_norm(turn) * S(0.5);
    return {cos(half), turn * (sinc(half) * S(0.5))};
  }

  /// The shortest rotation vector, |log| ≤ π. No division by sin θ: accurate at 0 and at π alike.
  Vec3<S> log() const {
    const S sign = real_part(w) < 0 ? S(-1) : S(1);
    const S half = angle_of(detail::angle_norm(v), S(sign * w));
    return v * (S(2) * sign / sinc(half));
  }

  /// This rotation after `next`.
  SO3 compose(const SO3& next) const {
    return {w * next.w - dot(v, next.v), Vec3<S>(next.v * w + v * next.w + cross(v, next.v))};
  }
  /// The rotation back.
  SO3 inverse() const { return {w, -v}; }

  /// R u.
  [[gnu::always_inline]] Vec3<S> rotate(const Vec3<S>& u) const {
    const Vec3<S> side = cross(v, u) * S(2);
    return u + side * w + cross(v, side);
  }
  /// Rᵀ u.
  [[gnu::always_inline]] Vec3<S> rotate_back(const Vec3<S>& u) const { return inverse().rotate(u); }

  /// Ad: R·exp(ω)·R⁻¹ = exp(Ad ω); the rotation matrix itself.
  Mat<S, 3, 3> adjoint() const { return matrix(); }

  /// R.
  Mat<S, 3, 3> matrix() const {
    const Mat<S, 3, 3> k = skew<S>(v);
    return Mat<S, 3, 3>::Identity() + k * (S(2) * w) + (k * k) * S(2);
  }

  /// From an orthonormal matrix with determinant 1. Shepperd: divide by the largest component, never by a
  /// small one.
  static SO3 from(const Mat<S, 3, 3>& m) {
    const S trace = m(0, 0) + m(1, 1) + m(2, 2);
    int i = 0;
    for (int k = 1; k < 3; ++k)
      if (real_part(m(k, k)) > real_part(m(i, i))) i = k;
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    SO3 q;
    if (real_part(trace) > real_part(m(i, i))) {
      q.w = S(1) + trace;
      q.v = Vec3<S>(m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1));
    } else {
      q.w = m(k, j) - m(j, k);
      q.v[i] = S(1) + m(i, i) - m(j, j) - m(k, k);
      q.v[j] = m(i, j) + m(j, i);
      q.v[k] = m(i, k) + m(k, i);
    }
    return q.normalised().canonical();
  }

  /// Of length 1 again; not of 0.
  SO3 normalised() const {
    using std::sqrt;
    const S factor = S(1) / S(sqrt(S(w * w + squared_norm(v))));
    return {w * factor, v * factor};
  }

  /// Of q and −q, the one with w ≥ 0; at w = 0 the one whose first component other than 0 is positive.
  SO3 canonical() const {
    double lead = real_part(w);
    for (int i = 0; i < 3 && lead == 0; ++i) lead = real_part(v[i]);
    return lead < 0 ? SO3{-w, -v} : *this;
  }

  /// exp(ω + δ) ≈ exp(J δ)·exp(ω):  J = 1 + cosc θ [ω] + sinc3 θ [ω]².
  static Mat<S, 3, 3> left_jacobian(const Vec3<S>& turn) {
    const S angle = detail::angle_norm(turn);
    const Mat<S, 3, 3> k = skew<S>(turn);
    return Mat<S, 3, 3>::Identity() + k * cosc(angle) + (k * k) * sinc3(angle);
  }

  /// J⁻¹ = 1 − [ω]/2 + (1 − (θ/2)·cot(θ/2))/θ² [ω]², for θ < 2π. The last factor as sinc_slope(θ/2)/(4
  /// sinc(θ/2)).
  static Mat<S, 3, 3> left_jacobian_inverse(const Vec3<S>& turn) {
    const S half = detail::angle_norm(turn) * S(0.5);
    const Mat<S, 3, 3> k = skew<S>(turn);
    return Mat<S, 3, 3>::Identity() - k * S(0.5) + (k * k) * (sinc_slope(half) / (S(4) * sinc(half)));
  }
};

/// Platform pose as people write it; quaternion [w, x, y, z], w ≥ 0, platform → base.
struct SpatialPose {
  Vec3<double> position = Vec3<double>(0, 0, 0);    ///< of the reference point, base frame [m]
  std::array<double, 4> quaternion = {1, 0, 0, 0};  ///< [w, x, y, z]
};

/// A rigid motion in space: x ↦ p + R x.
template <Scalar S>
struct SE3 {
  Vec3<S> p = Vec3<S>(S(0), S(0), S(0));  ///< where the origin goes [m]
  SO3<S> R;                               ///< how it turns

  /// The motion that moves nothing.
  static SE3 identity() { return {}; }

  /// The quaternion need not be normalised, but must not be 0.
  static SE3 from(const SpatialPose& pose) {
    const auto& q = pose.quaternion;
    const SO3<double> turn = SO3<double>{q[0], Vec3<double>(q[1], q[2], q[3])}.normalised();
    return {pose.position.cast<S>(), {static_cast<S>(turn.w), turn.v.cast<S>()}};
  }

  /// R u.
  [[gnu::always_inline]] Vec3<S> rotate(const Vec3<S>& u) const { return R.rotate(u); }
  /// Rᵀ u.
  [[gnu::always_inline]] Vec3<S> rotate_back(const Vec3<S>& u) const { return R.rotate_back(u); }

  /// p + R b: where the body-fixed point b is.
  [[gnu::always_inline]] Vec3<S> point(const Vec3<S>& b) const { return p + R.rotate(b); }

  /// This motion after `next`: `next` is given in the axes of this one.
  SE3 compose(const SE3& next) const { return {point(next.p), R.compose(next.R)}; }
  /// The motion back.
  SE3 inverse() const { return {-R.rotate_back(p), R.inverse()}; }

  /// This pose after the small motion (δp, δθ) in base axes about the reference point.
  SE3 displaced(const Vec<S, 6>& motion) const {
    const Vec3<S> shift = motion.template head<3>(), turn = motion.template tail<3>();
    return {p + shift, SO3<S>::exp(turn).compose(R).normalised()};
  }

  /// The motion by a constant twist (v, ω) in its own axes for unit time.
  static SE3 exp(const Vec<S, 6>& twist) {
    const Vec3<S> v = twist.template head<3>(), turn = twist.template tail<3>();
    return {SO3<S>::left_jacobian(turn) * v, SO3<S>::exp(turn)};
  }

  /// The twist with |ω| ≤ π that exp maps here.
  Vec<S, 6> log() const {
    const Vec3<S> turn = R.log();
    Vec<S, 6> twist;
    twist << SO3<S>::left_jacobian_inverse(turn) * p, turn;
    return twist;
  }

  /// Ad: X·exp(ξ)·X⁻¹ = exp(Ad ξ).
  Mat<S, 6, 6> adjoint() const {
    const Mat<S, 3, 3> turn = R.matrix();
    Mat<S, 6, 6> ad;
    ad << turn, skew<S>(p) * turn, Mat<S, 3, 3>::Zero(), turn;
    return ad;
  }

  /// exp(ξ + δ) ≈ exp(J δ)·exp(ξ). The coupling block is Barfoot, State Estimation for Robotics (2017),
  /// (7.86), with its last coefficient (2θ − 3 sin θ + θ cos θ)/(2θ⁵) as (cosc4 θ − 3 sinc5 θ)/2.
  static Mat<S, 6, 6> left_jacobian(const Vec<S, 6>& twist) {
    const Vec3<S> v = twist.template head<3>(), turn = twist.template tail<3>();
    const S angle = detail::angle_norm(turn), c4 = cosc4(angle);
    const Mat<S, 3, 3> r = skew<S>(v), f = skew<S>(turn), fr = f * r, rf = r * f, frf = fr * f;
    const Mat<S, 3, 3> coupling = r * S(0.5) + (fr + rf + frf) * sinc3(angle) +
                                  (f * fr + rf * f - frf * S(3)) * c4 +
                                  (frf * f + f * frf) * ((c4 - S(3) * sinc5(angle)) * S(0.5));
    const Mat<S, 3, 3> block = SO3<S>::left_jacobian(turn);
    Mat<S, 6, 6> jacobian;
    jacobian << block, coupling, Mat<S, 3, 3>::Zero(), block;
    return jacobian;
  }
};

/// As people write it: w ≥ 0.
inline SpatialPose spatial_pose(const SE3<double>& pose) {
  const SO3<double> q = pose.R.normalised().canonical();
  return {pose.p, {q.w, q.v[0], q.v[1], q.v[2]}};
}

}  // namespace sinew::inline v1
