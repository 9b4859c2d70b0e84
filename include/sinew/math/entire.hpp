/// @file entire.hpp
/// sinc and its relatives, analytic through 0. Theory and loss estimates: docs/theory/math.md
///
///   sinc x       = sin x / x             1    − x²/6   + …   = Σ (−x²)ᵏ/(2k+1)!
///   sinc_slope x = (sinc x − cos x)/x²   1/3  − x²/30  + …   = Σ (−x²)ᵏ(2k+2)/(2k+3)!
///   cosc x       = (1 − cos x)/x²        1/2  − x²/24  + …   = Σ (−x²)ᵏ/(2k+2)!
///   sinc3 x      = (x − sin x)/x³        1/6  − x²/120 + …   = Σ (−x²)ᵏ/(2k+3)!
///   cosc4 x      = (1/2 − cosc x)/x²     1/24 − x²/720 + …   = Σ (−x²)ᵏ/(2k+4)!
///   sinc5 x      = (1/6 − sinc3 x)/x²    1/120 − …           = Σ (−x²)ᵏ/(2k+5)!
///   dsinc x      = sinc′ x = −x·sinc_slope x,   dcosc x = cosc′ x
///
/// The threshold between series and closed form belongs to the order of the function: the closed form loses
/// about (value of the subtracted terms)/(value of the difference), and that decides where the series ends.
#pragma once
#include <array>
#include <cstddef>

#include "sinew/math/vec.hpp"

namespace sinew::inline v1 {

namespace detail {

/// Σ cₖ qᵏ by Horner. The number of terms leaves less than eps/10 at the end of the range.
template <std::size_t N>
struct Series {
  std::array<double, N> c;

  /// Terms (−1)ᵏ/(n+2k)!
  static constexpr Series reciprocal_factorials(int n) {
    Series series{};
    double factorial = 1;
    for (int i = 2; i <= n; ++i) factorial *= i;
    for (std::size_t k = 0; k < N; ++k) {
      series.c[k] = (k % 2 == 0 ? 1.0 : -1.0) / factorial;
      const double m = n + 2.0 * static_cast<double>(k);
      factorial *= (m + 1) * (m + 2);
    }
    return series;
  }

  template <class S>
  constexpr S operator()(const S& q) const {
    S sum = static_cast<S>(c[N - 1]);
    for (std::size_t k = N - 1; k-- > 0;) sum = sum * q + static_cast<S>(c[k]);
    return sum;
  }
};

template <std::size_t N>
constexpr Series<N> slope_series() {  // (2k+2)/(2k+3)!
  auto series = Series<N>::reciprocal_factorials(3);
  for (std::size_t k = 0; k < N; ++k) series.c[k] *= 2.0 * static_cast<double>(k + 1);
  return series;
}

inline constexpr auto sinc_terms = Series<10>::reciprocal_factorials(1);   // |x| < 1
inline constexpr auto slope_terms = slope_series<9>();                     // |x| < 1
inline constexpr auto sinc3_terms = Series<9>::reciprocal_factorials(3);   // |x| < 1
inline constexpr auto cosc4_terms = Series<13>::reciprocal_factorials(4);  // |x| < 3
inline constexpr auto sinc5_terms = Series<13>::reciprocal_factorials(5);  // |x| < 3

template <Scalar S>
bool within(const S& x, double bound) {
  const double a = real_part(x);
  return a < bound && a > -bound;
}

}  // namespace detail

/// sin x / x. Loses nothing anywhere. The series serves derivative types, whose derivative part is sinc′.
template <Scalar S>
S sinc(const S& x) {
  using std::sin;
  if constexpr (std::floating_point<S>) {
    return x == S(0) ? S(1) : sin(x) / x;
  } else {
    return detail::within(x, 1.0) ? detail::sinc_terms(S(x * x)) : S(sin(x) / x);
  }
}

/// sinc, sinc′, sin and cos from one sine and one cosine.
template <class S>
struct SincPair {
  S value, rate, sin, cos;
};

/// All four at x [rad], for the price of one sine and one cosine.
template <Scalar S>
SincPair<S> sinc_pair(const S& x) {
  using std::cos, std::sin;
  const S s = sin(x);
  const S c = cos(x);
  if (detail::within(x, 1.0)) {
    const S q = x * x;
    S value(1);
    if constexpr (std::floating_point<S>) {
      if (x != S(0)) value = s / x;
    } else {
      value = detail::sinc_terms(q);
    }
    return {value, -x * detail::slope_terms(q), s, c};
  }
  const S value = s / x;
  return {value, (c - value) / x, s, c};
}

/// −sinc′(x)/x. Closed form loses 3 eps/x²: series for |x| < 1.
template <Scalar S>
S sinc_slope(const S& x) {
  using std::cos;
  if (detail::within(x, 1.0)) return detail::slope_terms(S(x * x));
  return (sinc(x) - cos(x)) / (x * x);
}

/// sinc′ x.
template <Scalar S>
S dsinc(const S& x) {
  return -x * sinc_slope(x);
}

/// (1 − cos x)/x² as sinc²(x/2)/2: no cancellation, no threshold of its own.
template <Scalar S>
S cosc(const S& x) {
  const S half = sinc(S(x * S(0.5)));
  return half * half * S(0.5);
}

/// cosc′ x = sinc(x/2)·sinc′(x/2)/2.
template <Scalar S>
S dcosc(const S& x) {
  const auto half = sinc_pair(S(x * S(0.5)));
  return half.value * half.rate * S(0.5);
}

/// (x − sin x)/x³. Closed form loses 6 eps/x²: series for |x| < 1.
template <Scalar S>
S sinc3(const S& x) {
  using std::sin;
  if (detail::within(x, 1.0)) return detail::sinc3_terms(S(x * x));
  return (x - sin(x)) / (x * x * x);
}

/// (x²/2 + cos x − 1)/x⁴. Closed form loses 12 eps/x² more than cosc: series for |x| < 3.
template <Scalar S>
S cosc4(const S& x) {
  if (detail::within(x, 3.0)) return detail::cosc4_terms(S(x * x));
  return (S(0.5) - cosc(x)) / (x * x);
}

/// (sin x − x + x³/6)/x⁵. Closed form loses 20 eps/x² more than sinc3: series for |x| < 3.
template <Scalar S>
S sinc5(const S& x) {
  if (detail::within(x, 3.0)) return detail::sinc5_terms(S(x * x));
  return (static_cast<S>(1.0 / 6.0) - sinc3(x)) / (x * x);
}

}  // namespace sinew::inline v1
