/// @file bent_motion.hpp
/// Poses along a bent backbone, one after the other, and how they move with a bend of two components.
/// Theory: docs/theory/section.md
#pragma once
#include <cstring>

#include "sinew/math/se3.hpp"

namespace sinew::inline v1 {

namespace detail {

/// A rotation about to turn many vectors.
template <Scalar S>
struct Turn {
  S r[3][3];

  [[gnu::always_inline]] Turn(const S& w, const S (&v)[3]) {
    const S x = v[0] + v[0], y = v[1] + v[1], z = v[2] + v[2];
    const S xx = x * v[0], yy = y * v[1], zz = z * v[2], xy = x * v[1], xz = x * v[2], yz = y * v[2];
    const S wx = w * x, wy = w * y, wz = w * z;
    r[0][0] = S(1) - (yy + zz), r[0][1] = xy - wz, r[0][2] = xz + wy;
    r[1][0] = xy + wz, r[1][1] = S(1) - (xx + zz), r[1][2] = yz - wx;
    r[2][0] = xz - wy, r[2][1] = yz + wx, r[2][2] = S(1) - (xx + yy);
  }

  template <class T>
  [[gnu::always_inline]] void apply(const T (&from)[3], T (&to)[3]) const {
    for (int i = 0; i < 3; ++i) to[i] = r[i][0] * from[0] + r[i][1] * from[1] + r[i][2] * from[2];
  }
};

/// Two numbers abreast, one a component of a bend: all work on them is alike, and is done on both at once.
template <Scalar S>
struct Abreast {
  S x, y;
  [[gnu::always_inline]] void store(S* at) const { at[0] = x, at[1] = y; }
  [[gnu::always_inline]] friend Abreast operator+(const Abreast& a, const Abreast& b) {
    return {S(a.x + b.x), S(a.y + b.y)};
  }
  [[gnu::always_inline]] friend Abreast operator-(const Abreast& a, const Abreast& b) {
    return {S(a.x - b.x), S(a.y - b.y)};
  }
  [[gnu::always_inline]] friend Abreast operator*(const S& a, const Abreast& b) {
    return {S(a * b.x), S(a * b.y)};
  }
};
/// Both in one register, of the baseline instruction set.
template <>
struct Abreast<double> {
  using Two [[gnu::vector_size(16)]] = double;
  Two both;
  Abreast() = default;
  [[gnu::always_inline]] Abreast(double x, double y) : both{x, y} {}
  [[gnu::always_inline]] explicit Abreast(Two two) : both(two) {}
  [[gnu::always_inline]] void store(double* at) const { std::memcpy(at, &both, sizeof both); }
  [[gnu::always_inline]] friend Abreast operator+(Abreast a, Abreast b) { return Abreast(a.both + b.both); }
  [[gnu::always_inline]] friend Abreast operator-(Abreast a, Abreast b) { return Abreast(a.both - b.both); }
  [[gnu::always_inline]] friend Abreast operator*(double a, Abreast b) { return Abreast(a * b.both); }
};

/// a + turn × arm, for both components.
template <Scalar S>
[[gnu::always_inline]] inline Abreast<S> carried(const Abreast<S>& shift, const Abreast<S> (&turn)[3],
                                                 const S (&arm)[3], int i) {
  const int k = (i + 1) % 3, l = (i + 2) % 3;
  return shift + (arm[l] * turn[k] - arm[k] * turn[l]);
}

}  // namespace detail

/// A pose: rotation as a unit quaternion (w, v), and position.
template <Scalar S>
struct BentPose {
  S w = S(1), v[3] = {S(0), S(0), S(0)}, p[3] = {S(0), S(0), S(0)};

  /// The same as a rigid motion.
  SE3<S> rigid() const { return {Vec3<S>(p[0], p[1], p[2]), {w, Vec3<S>(v[0], v[1], v[2])}}; }

  /// This pose, then `next`.
  [[gnu::always_inline]] BentPose then(const BentPose& next) const {
    S arm[3];
    detail::Turn<S>(w, v).apply(next.p, arm);
    return then(next, arm);
  }

  /// The same where `arm` is next.p turned by this pose already.
  [[gnu::always_inline]] BentPose then(const BentPose& next, const S (&arm)[3]) const {
    BentPose both;
    both.w = w * next.w - (v[0] * next.v[0] + v[1] * next.v[1] + v[2] * next.v[2]);
    for (int i = 0; i < 3; ++i) {
      const int k = (i + 1) % 3, l = (i + 2) % 3;
      both.v[i] = (w * next.v[i] + next.w * v[i]) + (v[k] * next.v[l] - v[l] * next.v[k]);
      both.p[i] = p[i] + arm[i];
    }
    return both;
  }
};

/// A pose and (δp, δθ) of it per component of a bend, in the axes of its base, of its own origin.
template <Scalar S>
struct BentMotion {
  BentPose<S> pose;
  detail::Abreast<S> shift[3], turn[3];

  /// This pose, then `next`, both moving with the same bend.
  [[gnu::always_inline]] BentMotion then(const BentMotion& next) const {
    const detail::Turn<S> R(pose.w, pose.v);
    S arm[3];
    R.apply(next.pose.p, arm);
    BentMotion both;
    both.pose = pose.then(next.pose, arm);
    R.apply(next.shift, both.shift);
    R.apply(next.turn, both.turn);
    for (int i = 0; i < 3; ++i) {
      both.shift[i] = both.shift[i] + detail::carried(shift[i], turn, arm, i);
      both.turn[i] = both.turn[i] + turn[i];
    }
    return both;
  }
};

}  // namespace sinew::inline v1
