/// @file bent_joint.hpp
/// Constant-curvature joints in space, each with a disc after it, that all bend alike; one of them, or a
/// whole section with a neutral backbone. Base at the origin, backbone along +z, x and y across it; a bend
/// (x, y) of all together turns the tip by |(x, y)| towards that direction. Theory: docs/theory/section.md
///
/// With a = |bend|, s = sinc(a/2) and c = cos(a/2) a joint ends at  L s (s/2·bend, c):  a chord of length L
/// s, half as much inclined as the tip; the disc adds  h (s c·bend, cos a).  Of N joints, each of a/N, the
/// chords add up to one of half the bend again, as do waves of equal phase differences. All are entire
/// functions of w = (a/2)²: no angle is divided by, no root is taken of a small one, and the direction of a
/// straight joint is never asked for.
/// Where each of several joints bends by nearly a full turn, which none does, D loses digits.
///
/// Numbers one by one, and all inlined: as matrices of Eigen's the same takes ten times as long, because they
/// go through memory in parts of other sizes than they are read back in.
#pragma once
#include "link/bent_motion.hpp"

namespace sinew::inline v1 {

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

/// Two short polynomials, as cos x = sinc x − w·slope, of small angles, which are doubled until x = 1: sinc
/// 2x = sinc x cos x, and its derivative.
template <Scalar S>
[[gnu::always_inline]] inline HalfAngle<S> half_angle(const S& w) {
  if (!(real_part(w) < 1)) return half_angle_beyond(w);
  S v = w;
  int doublings = 0;
  for (; !(real_part(v) < 0.0625); ++doublings) v = v * S(0.25);
  const S sinc = few_sinc_terms(v), slope = few_slope_terms(v);
  HalfAngle<S> half{sinc, S(sinc - v * slope), slope};
  for (; doublings > 0; --doublings) {
    const S ss = half.sinc * half.sinc;
    half = {half.sinc * half.cos, S(1) - S(2) * v * ss, (half.slope * half.cos + ss) * S(0.25)};
    v = v * S(4);
  }
  return half;
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

/// Joints that bend alike, each with its disc.
struct BentJoint {
  double length;    ///< arc length L [m], > 0
  double disc = 0;  ///< height h of the disc after it [m], ≥ 0
  int count = 1;    ///< N of them, ≥ 1

  /// End of the last disc.
  template <Scalar S>
  [[gnu::always_inline]] BentPose<S> pose(const S& x, const S& y) const {
    return motion(x, y).pose;  // inlined: rates not asked for are not computed
  }

  /// The same with its derivatives: ∂w/∂bend = bend/2, ∂s/∂w = −slope/2, ∂c/∂w = −s/2, and
  /// δθ = 2 (c δv − v δc + v × δv) of the quaternion (c, v).
  template <Scalar S>
  [[gnu::always_inline]] BentMotion<S> motion(const S& x, const S& y) const {
    const S w = (x * x + y * y) * S(0.25), h(disc);
    const auto half = detail::half_angle(w);
    const S &s = half.sinc, &c = half.cos, &slope = half.slope;
    const S s_rate = slope * S(-0.5), c_rate = s * S(-0.5), ss = s * s, sc = s * c;
    const auto [chord, chord_rate] = chords(w, half);
    const S across = chord + h * c, side = s * across * S(0.5);
    const S side_rate = (s_rate * across + s * (chord_rate + h * c_rate)) * S(0.25);
    const S down = (chord_rate * c + chord * c_rate - h * s * (s + S(2) * w * s_rate)) * S(0.5);
    const S lean = s * S(0.5), roll = ss * S(0.5), turn_rate = (ss - c * slope) * S(0.25);
    const S xy = side_rate * x * y, turn_xy = turn_rate * x * y;
    return {
        {c, {-lean * y, lean * x, S(0)}, {side * x, side * y, chord * c - h * w * ss}},
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

 private:
  template <Scalar S>
  struct Chords {
    S length, rate;  ///< rate: by w
  };
  /// Length, half the bend inclined, of all joints and of what discs have along it but the tip's share:
  /// N (L s + h cos(a/2N) D) with D = sin(a/2) / (N sin(a/2N)).
  template <Scalar S>
  [[gnu::always_inline]] Chords<S> chords(const S& w, const detail::HalfAngle<S>& whole) const {
    const S L(length), h(disc), s_rate = whole.slope * S(-0.5);
    if (count == 1) return {L * whole.sinc + h * whole.cos, L * s_rate - h * S(0.5) * whole.sinc};
    const S n(static_cast<double>(count)), share(1.0 / (static_cast<double>(count) * count));
    const auto one = detail::half_angle(S(w * share));
    const S per_sinc = S(1) / one.sinc, D = whole.sinc * per_sinc;
    const S D_rate = (s_rate + D * one.slope * S(0.5) * share) * per_sinc;
    return {n * (L * whole.sinc + h * one.cos * D),
            n * (L * s_rate + h * (one.cos * D_rate - S(0.5) * one.sinc * share * D))};
  }
};

}  // namespace sinew::inline v1
