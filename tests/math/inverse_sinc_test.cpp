#include "math/inverse_sinc.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace sinew {
namespace inverse_sinc_test {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// |sinc x − y| with sinc in 64 bit mantissas.
double residual(double x, double y) {
  const auto wide = static_cast<long double>(x);
  return static_cast<double>(std::abs((x == 0 ? 1.0L : std::sin(wide) / wide) - static_cast<long double>(y)));
}

/// Newton in 64 bit mantissas on x²·sinc3 x = 1 − y, which does not cancel.
double exact(double y) {
  const long double w = 1 - static_cast<long double>(y);
  auto x = static_cast<long double>(inverse_sinc(y));
  for (int i = 0; i < 3 && x > 0; ++i) {
    long double tail = 0, slope = 0, term = x * x / 6;
    for (int k = 0; k < 30; ++k) {
      tail += term;
      slope += term * (2 * k + 2) / x;
      term *= -x * x / (static_cast<long double>(2 * k + 4) * static_cast<long double>(2 * k + 5));
    }
    x -= (tail - w) / slope;
  }
  return static_cast<double>(x);
}

double forward_error(double y) { return std::abs(inverse_sinc(y) - exact(y)) / (eps * exact(y)); }

TEST(InverseSinc, EndsAreExact) {
  EXPECT_EQ(inverse_sinc(1.0), 0.0);
  EXPECT_NEAR(inverse_sinc(0.0), std::numbers::pi, 4 * eps);
  EXPECT_LE(inverse_sinc(0.0), std::numbers::pi);
}

TEST(InverseSinc, JustAboveOneIsRoundingAndFurtherIsNot) {
  EXPECT_EQ(inverse_sinc(1 + 8 * eps), 0.0);
  EXPECT_TRUE(std::isnan(inverse_sinc(1 + 9 * eps)));
  EXPECT_TRUE(std::isnan(inverse_sinc(-1e-300)));
  EXPECT_TRUE(std::isnan(inverse_sinc(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_TRUE(std::isnan(inverse_sinc(std::numeric_limits<double>::infinity())));
}

TEST(InverseSinc, BackwardErrorIsTwoEpsEverywhere) {
  for (int i = 0; i <= 200000; ++i) {
    const double y = i / 200000.0;
    ASSERT_LE(residual(inverse_sinc(y), y), 2 * eps) << y;
  }
  for (double w = 1e-16; w < 0.5; w *= 1.01) ASSERT_LE(residual(inverse_sinc(1 - w), 1 - w), 2 * eps) << w;
}

TEST(InverseSinc,
     ForwardErrorDoesNotFeelTheConditionNumber) {  // y is taken as exact: √(1/(1−y)) belongs to the caller
  for (double w = 1e-16; w < 1; w *= 1.003) ASSERT_LE(forward_error(1 - w), 3.0) << w;
  for (double x : {0.999999, 1.0, 1.000001})
    ASSERT_LE(forward_error(sinc(x)), 3.0) << x;  // where the residual changes form
}

TEST(InverseSinc, FallsMonotonicallyUpToRounding) {
  for (int i = 0; i < 100000; ++i) ASSERT_LE(inverse_sinc((i + 1) / 1e5), inverse_sinc(i / 1e5));
}

RC_GTEST_PROP(InverseSinc, RoundTripWithinTheConditionNumber, (std::uint32_t bits)) {
  const double x = std::numbers::pi * bits / 4294967296.0;
  const double back = inverse_sinc(sinc(x));
  const double moved = eps / std::max(std::abs(dsinc(x)), std::sqrt(eps) / 3);  // sinc x itself is rounded
  RC_ASSERT(std::abs(back - x) <= 3 * eps * x + moved);
}

}  // namespace inverse_sinc_test
}  // namespace sinew
