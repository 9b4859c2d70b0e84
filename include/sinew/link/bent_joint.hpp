/// @file bent_joint.hpp
/// A constant-curvature joint in space and the disc that follows it. Base at the origin, backbone along +z, x
/// and y across it; a bend (x, y) turns the tip by |(x, y)| towards that direction. Theory:
/// docs/theory/section.md
///
/// With a = |bend|, s = sinc(a/2) and c = cos(a/2) the joint ends at  L s (s/2·bend, c):  a chord of length L
/// s, half as much inclined as the tip; the disc adds  h (s c·bend, cos a).  All are entire functions of w =
/// (a/2)²: no angle is divided by, no root is taken of a small one, and the direction of a straight joint is
/// never asked for.
///
/// Numbers one by one, and all inlined: as matrices of Eigen's the same takes ten times as long, because they
/// go through memory in parts of other sizes than they are read back in.
#pragma once
#include "sinew/link/bent_motion.hpp"

namespace sinew::inline v0 {

namespace detail {

/// sinc, cosine and −sinc′(x)/x of the half angle x, by w = x².
template <Scalar S>
struct HalfAngle {
  S sinc, cos, slope;
};

template <Scalar S>
[[gnu::noinline]] HalfAngle<S> half_angle_beyond(const S& w) {
  const S x = even_root(w);
  const auto pair = sinc_pair(x);
  return {pair.value, pair.cos, sinc_slope(x)};
}

inline constexpr auto few_sinc_terms = Series<6>::reciprocal_factorials(1);  // w < 1/16
inline constexpr auto few_slope_terms = slope_series<6>();                   // w < 1/16

/// Joints of robots with many of them bend little: two short polynomials, and cos x = sinc x − w·slope.
template <Scalar S>
[[gnu::always_inline]] inline HalfAngle<S> half_angle(const S& w) {
  if (!(real_part(w) < 0.0625)) return half_angle_beyond(w);
  const S sinc = few_sinc_terms(w), slope = few_slope_terms(w);
  return {sinc, S(sinc - w * slope), slope};
}

}  // namespace detail

/// A joint and its disc, bent about one axis across the backbone: how far its end lies to the side and ahead
/// in the plane it bends in, and how fast these change with the bend.
template <Scalar S>
struct PivotMotion {
  S side, ahead, side_rate, ahead_rate;
  S half_sine, half_cosine;  ///< of half the bend
  S sine, cosine;            ///< of the bend
};

struct BentJoint {
  double length;    ///< arc length L [m], > 0
  double disc = 0;  ///< height h of the disc after it [m], ≥ 0

  /// End of the disc.
  template <Scalar S>
  [[gnu::always_inline]] BentPose<S> pose(const S& x, const S& y) const {
    return motion(x, y).pose;  // inlined: rates not asked for are not computed
  }

  /// The same with its derivatives: ∂w/∂bend = bend/2, ∂s/∂w = −slope/2, ∂c/∂w =
  /// −s/2, and δθ = 2 (c δv − v δc + v × δv) of the quaternion (c, v).
  template <Scalar S>
  [[gnu::always_inline]] BentMotion<S> motion(const S& x, const S& y) const {
    const S w = (x * x + y * y) * S(0.25), L(length), h(disc);
    const auto [s, c, slope] = detail::half_angle(w);
    const S lean = s * S(0.5), sc = s * c, ss = s * s, mix = slope * c + ss;
    const S side = L * s * lean + h * sc, side_rate = -(L * s * slope + h * mix) * S(0.25);
    const S down = -(L * mix * S(0.25) + h * sc), roll = ss * S(0.5), turn_rate = (ss - c * slope) * S(0.25);
    const S xy = side_rate * x * y, turn_xy = turn_rate * x * y;
    return {
        {c, {-lean * y, lean * x, S(0)}, {side * x, side * y, L * sc + h * (S(1) - S(2) * w * ss)}},
        {{side + side_rate * x * x, xy}, {xy, side + side_rate * y * y}, {down * x, down * y}},
        {{-turn_xy, -(sc + turn_rate * y * y)}, {sc + turn_rate * x * x, turn_xy}, {-roll * y, roll * x}}};
  }

  /// The same of a bend about one axis.
  template <Scalar S>
  [[gnu::always_inline]] PivotMotion<S> pivot(const S& bend) const {
    const S half = bend * S(0.5), L(length), h(disc);
    const auto [s, c, slope] = detail::half_angle(S(half * half));
    const S sine = half * s, whole = S(2) * sine * c, cosine = S(1) - S(2) * sine * sine;
    return {L * s * sine + h * whole,
            L * s * c + h * cosine,
            L * S(0.5) * s * (s - S(2) * half * half * slope) + h * cosine,
            -(L * S(0.5) * half * (slope * c + s * s) + h * whole),
            sine,
            c,
            whole,
            cosine};
  }
};

}  // namespace sinew::inline v0
