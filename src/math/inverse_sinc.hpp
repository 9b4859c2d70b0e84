/// @file inverse_sinc.hpp
/// The angle with a given sinc: the half bend of an arc from chord over length.
#pragma once
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "sinew/math/entire.hpp"

namespace sinew::inline v1 {

/// x/√(6w) with sinc x = 1 − w is analytic up to w = 1.217 (first minimum of sinc): a (3,3) rational fit on
/// [0, 1], relative error 2.2e-7, after which one step of Halley's is exact. Coefficients of w⁰ to w³.
struct InverseSincStart {
  static constexpr std::array above{1.0000001492026578, -1.3387580358083788, 0.488095205674328,
                                    -0.03515583935107598};
  static constexpr std::array below{1.0, -1.4887501897972435, 0.654016002869334, -0.07623885905879844};

  static constexpr double at(const std::array<double, 4>& c, double w) {
    return c[0] + w * (c[1] + w * (c[2] + w * c[3]));
  }
};

/// The x in [0, π] with sinc x = y, for y in [0, 1]. An y above 1 by rounding (up to 8 eps) gives 0; other y
/// give NaN. As exact as y allows: an error δ of y moves x by δ/|sinc′ x|, near y = 1 by δ·√(3/2)/√(1−y).
inline double inverse_sinc(double y) {
  constexpr double slack = 8 * std::numeric_limits<double>::epsilon();
  if (!(y >= 0 && y <= 1 + slack)) return std::numeric_limits<double>::quiet_NaN();
  const double w = 1 - y;  // exact for y >= 1/2, where it matters
  if (w <= 0) return 0;
  using Start = InverseSincStart;
  const double x = std::sqrt(6 * w) * Start::at(Start::above, w) / Start::at(Start::below, w);
  // One Halley step cubes that error: nothing is left to iterate, and nothing to safeguard but the end π.
  const auto at = sinc_pair(x);
  const double excess =
      x < 1 ? w - x * x * sinc3(x) : at.value - y;       // sinc x − y, without cancellation near y = 1
  const double curvature = -at.value - 2 * at.rate / x;  // sinc″ x
  const double next = x - 2 * excess * at.rate / (2 * at.rate * at.rate - excess * curvature);
  return next < std::numbers::pi ? next : std::numbers::pi;
}

}  // namespace sinew::inline v1
