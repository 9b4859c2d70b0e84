/// @file arc.h
/// The chord factor of an arc bent by β, s = sin(β/2)/(β/2), and what leads back from it. Both are entire
/// functions of the square of the half angle, w = (β/2)²: a straight joint is a regular point, no root is
/// taken and no angle divided by. Freestanding C++14, no includes, no heap. Theory: docs/theory/section.md
#ifndef SINEW_KERNEL_ARC_H
#define SINEW_KERNEL_ARC_H

namespace sinew {
namespace kernel {

/// Bounds of w = (β/2)²: `few` terms of the series do up to 24.3°, `most` up to half a turn.
constexpr double few_below = 0.045;
constexpr double max_below = 2.4675;  ///< see `few_below`

/// How many terms of the series a scalar needs.
template <class S>
struct Terms {
  static constexpr int few = 4;   ///< up to `few_below`
  static constexpr int most = 6;  ///< up to `max_below`
};
template <>
struct Terms<float> {
  static constexpr int few = 3, most = 7;
};
template <>
struct Terms<double> {
  static constexpr int few = 5, most = 12;
};

namespace detail {

/// 1/first · 1/(first + 1) · … , `count` times, with alternating signs: coefficients of sine and cosine.
constexpr double coefficient(int first, int count) {
  double value = 1;
  for (int k = 0; k < count; ++k) value /= -((first + 2.0 * k) * (first + 1 + 2.0 * k));
  return value;
}

/// Σ coefficient(First, k) w^(k − From), k from From to To.
template <class S, int First, int From, int To>
struct PowerSeries {
  static constexpr S at(S w) {
    constexpr double c = coefficient(First, From);
    return S(c) + S(w * PowerSeries<S, First, From + 1, To>::at(w));
  }
};
template <class S, int First, int To>
struct PowerSeries<S, First, To, To> {
  static constexpr S at(S) {
    constexpr double c = coefficient(First, To);
    return S(c);
  }
};

/// s − 1 where the series has lost its digits; scalars without a sine saturate there anyway.
template <class S>
constexpr S chord_loss_beyond(S w) {
  return S(w * PowerSeries<S, 2, 1, Terms<S>::most>::at(w));
}
inline double root(double x) { return __builtin_sqrt(x); }
inline double sine(double x) { return __builtin_sin(x); }
inline double arcsine(double x) { return __builtin_asin(x); }
#if __SIZEOF_DOUBLE__ == __SIZEOF_FLOAT__  // AVR: its library has no names for float
inline float root(float x) { return static_cast<float>(root(static_cast<double>(x))); }
inline float sine(float x) { return static_cast<float>(sine(static_cast<double>(x))); }
inline float arcsine(float x) { return static_cast<float>(arcsine(static_cast<double>(x))); }
#else
inline float root(float x) { return __builtin_sqrtf(x); }
inline float sine(float x) { return __builtin_sinf(x); }
inline float arcsine(float x) { return __builtin_asinf(x); }
#endif

inline double chord_loss_beyond(double w) {
  const double half = root(w);
  return sine(half) / half - 1;
}
inline float chord_loss_beyond(float w) {
  const float half = root(w);
  return sine(half) / half - 1;
}

/// arcsin(√y)/√y
template <class S>
S arcsine_ratio(S y) {
  if (!(y > 0)) return 1;
  const S half_chord = y < 1 ? root(y) : S(1);
  return arcsine(half_chord) / half_chord;
}

}  // namespace detail

/// s − 1 from w = (β/2)². Without the 1, whose rounding would be all that is left when β is small.
/// @implements LSK (6)
template <class S>
constexpr S chord_loss(S w) {
  return !(w > S(few_below))   ? S(w * detail::PowerSeries<S, 2, 1, Terms<S>::few>::at(w))
         : !(w > S(max_below)) ? S(w * detail::PowerSeries<S, 2, 1, Terms<S>::most>::at(w))
                               : detail::chord_loss_beyond(w);
}

/// The same of two axes: where both are small, as they mostly are, without a branch between them.
template <class S>
constexpr void chord_losses(S w_x, S w_y, S& x, S& y) {
  if (!((w_x > w_y ? w_x : w_y) > S(few_below))) {
    x = S(w_x * detail::PowerSeries<S, 2, 1, Terms<S>::few>::at(w_x));
    y = S(w_y * detail::PowerSeries<S, 2, 1, Terms<S>::few>::at(w_y));
  } else {
    x = chord_loss(w_x);
    y = chord_loss(w_y);
  }
}

/// 1/s from the square of the chord, u = s β, of an arc |β| ≤ π: from y = (u/2)² = sin²(β/2). Beyond y = 1 no
/// arc has such a chord; the answer is that of y = 1.
///
/// For any scalar: Newton on w s(w)² = y, whose left side is concave and increasing, so that the iterates
/// climb to the root from w = y and never pass it.
template <class S>
constexpr S arc_over_chord(S y) {
  if (y > S(1.0)) y = S(1.0);
  S w = y;
  for (int i = 0; i < 8; ++i) {
    const S s = S(1.0) + chord_loss(w);
    const S cosine = detail::PowerSeries<S, 1, 0, Terms<S>::most>::at(w);
    const S slope = S(s * cosine), gap = y - S(w * S(s * s));
    if (!(gap > S(0.0)) || !(slope > S(0.0))) break;
    w = w + gap / slope;
    if (w > S(2.4674)) w = S(2.4674);
  }
  return S(1.0) / (S(1.0) + chord_loss(w));
}
inline double arc_over_chord(double y) { return detail::arcsine_ratio(y); }
inline float arc_over_chord(float y) { return detail::arcsine_ratio(y); }

}  // namespace kernel
}  // namespace sinew

#endif
