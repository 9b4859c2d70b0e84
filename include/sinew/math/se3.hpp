/// @file se3.hpp
/// Spatial rigid motions. A twist is (v, ω), linear first. exp and log are those of the group, as in se2.hpp;
/// `displaced` is the update of DESIGN §4: linear and angular part in base axes about the reference point.
#pragma once
#include <array>

#include "sinew/math/so3.hpp"

namespace sinew::inline v1 {

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
