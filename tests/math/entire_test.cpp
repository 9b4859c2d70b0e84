#include "sinew/math/entire.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace sinew {
namespace entire_test {

using Real = long double;
using Complex = std::complex<double>;

/// Σ (−x²)ᵏ weight(k)/(n+2k)!, all in 64 bit mantissas.
template <class Weight>
Real series(int n, Real x, Weight weight) {
  Real term = 1, sum = 0;
  for (int i = 2; i <= n; ++i) term /= i;
  for (int k = 0; k < 40; ++k) {
    sum += term * weight(k);
    term *= -x * x / (Real(n + 2 * k + 1) * Real(n + 2 * k + 2));
  }
  return sum;
}
Real series(int n, Real x) {
  return series(n, x, [](int) { return Real(1); });
}

bool small(Real x) { return std::abs(x) < 4; }
Real exact_sinc(Real x) { return std::sin(x) / x; }
Real exact_slope(Real x) {
  return small(x) ? series(3, x, [](int k) { return Real(2 * k + 2); })
                  : (std::sin(x) / x - std::cos(x)) / (x * x);
}
Real exact_dsinc(Real x) { return -x * exact_slope(x); }
Real exact_cosc(Real x) { return small(x) ? series(2, x) : 2 * std::pow(std::sin(x / 2) / x, 2.0L); }
Real exact_dcosc(Real x) { return exact_sinc(x / 2) * exact_dsinc(x / 2) / 2; }
Real exact_sinc3(Real x) { return small(x) ? series(3, x) : (x - std::sin(x)) / (x * x * x); }
Real exact_cosc4(Real x) { return small(x) ? series(4, x) : (0.5L - exact_cosc(x)) / (x * x); }
Real exact_sinc5(Real x) { return small(x) ? series(5, x) : (1 / 6.0L - exact_sinc3(x)) / (x * x); }

/// Both signs, thirty decades below 1 by steps, up to 20, and the last numbers before and after every
/// threshold.
std::vector<double> points() {
  std::vector<double> x;
  for (double e = -300; e < -30; e += 7.3) x.push_back(std::pow(10, e));
  for (double e = -30; e < 0; e += 0.01) x.push_back(std::pow(10, e));
  for (double v = 0.01; v < 20; v += 0.0007) x.push_back(v);
  for (double v : {0.5, 1.0, 2.0, 3.0, 4.0, 6.0}) {
    double below = v, above = v;
    for (int k = 0; k < 50; ++k) {
      x.push_back(below = std::nextafter(below, 0.0));
      x.push_back(above);
      above = std::nextafter(above, 100.0);
    }
  }
  const std::size_t n = x.size();
  for (std::size_t i = 0; i < n; ++i) x.push_back(-x[i]);
  return x;
}

/// Worst |f − exact| in eps of the function's size: its value, or where it oscillates (|x| > 3) its envelope
/// if larger.
template <class F, class Exact, class Envelope>
double worst(F f, Exact exact, Envelope envelope) {
  double most = 0;
  for (double x : points()) {
    const Real want = exact(Real(x));
    Real size = std::abs(want);
    if (std::abs(x) > 3) size = std::max(size, Real(envelope(std::abs(x))));
    const Real error = std::abs(Real(f(x)) - want) / size / Real(std::numeric_limits<double>::epsilon());
    most = std::max(most, static_cast<double>(error));
  }
  return most;
}
double none(double) { return 0; }

TEST(Entire, SincIsExactToOneEps) { EXPECT_LT(worst(sinc<double>, exact_sinc, none), 1.0); }

TEST(Entire, SincRateKeepsItsDigitsThroughZero) {
  EXPECT_LT(worst(dsinc<double>, exact_dsinc, [](double x) { return 1 / x; }), 4.0);
  EXPECT_LT(worst(sinc_slope<double>, exact_slope, [](double x) { return 1 / (x * x); }), 4.0);
}

TEST(Entire, PairIsTheFunctionsItNames) {
  EXPECT_LT(worst([](double x) { return sinc_pair(x).value; }, exact_sinc, none), 1.0);
  EXPECT_LT(worst([](double x) { return sinc_pair(x).rate; }, exact_dsinc, [](double x) { return 1 / x; }),
            4.0);
  for (double x : {0.0, 1e-9, 0.3, -0.7, 2.0, -8.0}) {
    EXPECT_EQ(sinc_pair(x).sin, std::sin(x));
    EXPECT_EQ(sinc_pair(x).cos, std::cos(x));
  }
}

TEST(Entire, CoscNeedsNoThreshold) {
  EXPECT_LT(worst(cosc<double>, exact_cosc, none), 3.0);
  EXPECT_LT(worst(dcosc<double>, exact_dcosc, [](double x) { return 1 / (x * x); }), 5.0);
}

TEST(Entire, TailsKeepTheirDigitsAtTheirOwnThresholds) {
  EXPECT_LT(worst(sinc3<double>, exact_sinc3, none), 4.0);
  EXPECT_LT(worst(cosc4<double>, exact_cosc4, none), 5.0);
  EXPECT_LT(worst(sinc5<double>, exact_sinc5, none), 5.0);
}

TEST(Entire, OneThresholdForAllOrdersWouldLoseEverything) {  // why each function has its own (notes: smooth's
                                                             // x² > 1e-8)
  const double x = 1.01e-4;
  const double direct = (0.5 - (1 - std::cos(x)) / (x * x)) / (x * x);
  EXPECT_GT(std::abs(direct * 24 - 1), 0.1);
  EXPECT_NEAR(cosc4(x) * 24, 1.0, 1e-9);
}

TEST(Entire, ValuesAtZeroAreTheLimits) {
  EXPECT_EQ(sinc(0.0), 1.0);
  EXPECT_EQ(dsinc(0.0), 0.0);
  EXPECT_EQ(sinc_pair(0.0).value, 1.0);
  EXPECT_EQ(sinc_pair(0.0).rate, 0.0);
  EXPECT_EQ(cosc(0.0), 0.5);
  EXPECT_EQ(dcosc(0.0), 0.0);
  EXPECT_EQ(sinc_slope(0.0), 1.0 / 3);
  EXPECT_EQ(sinc3(0.0), 1.0 / 6);
  EXPECT_EQ(cosc4(0.0), 1.0 / 24);
  EXPECT_EQ(sinc5(0.0), 1.0 / 120);
}

template <class F, class Rate>
double worst_complex_step(F f, Rate rate) {
  double most = 0;  // relative, beyond 1.5 to the envelope 0.2/x: sinc″ has a zero at 2.08
  constexpr double h = 1e-30;
  for (double x : points()) {
    if (std::abs(x) < 1e-250) continue;  // the derivative times h would be subnormal
    const double want = rate(x), found = f(Complex(x, h)).imag() / h;
    most = std::max(
        most, std::abs(found - want) / std::max(std::abs(want), std::abs(x) > 1.5 ? 0.2 / std::abs(x) : 0.0));
  }
  return most / std::numeric_limits<double>::epsilon();
}

TEST(Entire, ComplexStepIsTheDerivative) {
  EXPECT_LT(worst_complex_step(sinc<Complex>, dsinc<double>), 12.0);
  EXPECT_LT(worst_complex_step([](Complex x) { return sinc_pair(x).value; }, dsinc<double>), 12.0);
  EXPECT_LT(worst_complex_step(cosc<Complex>, dcosc<double>), 12.0);
  // sinc″ = −sinc − 2 sinc′/x
  const auto second = [](double x) { return -sinc(x) + 2 * sinc_slope(x); };
  EXPECT_LT(worst_complex_step([](Complex x) { return sinc_pair(x).rate; }, second), 20.0);
  EXPECT_LT(worst_complex_step(dsinc<Complex>, second), 20.0);
}

TEST(Entire, ComplexStepIsTheDerivativeOfTheTails) {  // x³ sinc3 = x − sin x, and so on, differentiated
  for (double x : {0.4, -0.999999, 1.0, 1.5, 2.999999, -3.0, 3.1, 7.0}) {
    const auto rate = [x](auto f) { return f(Complex(x, 1e-30)).imag() / 1e-30; };
    EXPECT_NEAR(rate(sinc3<Complex>), (cosc(x) - 3 * sinc3(x)) / x, 1e-14);
    EXPECT_NEAR(rate(cosc4<Complex>), (sinc3(x) - 4 * cosc4(x)) / x, 1e-14);
    EXPECT_NEAR(rate(sinc5<Complex>), (cosc4(x) - 5 * sinc5(x)) / x, 1e-14);
    EXPECT_NEAR(rate(sinc_slope<Complex>), (sinc(x) - 3 * sinc_slope(x)) / x, 1e-14);
  }
}

TEST(Entire, FloatIsAsExactForItsSize) {
  const auto compare = [](auto narrow, auto wide, double tolerance) {
    for (float x : {1e-30F, 1e-8F, 1e-3F, 0.3F, 0.9999F, 1.0F, 1.7F, 2.9999F, 3.0F, 3.1F, 5.0F, 12.0F})
      EXPECT_NEAR(static_cast<double>(narrow(x)) / wide(static_cast<double>(x)), 1.0, tolerance) << x;
  };
  constexpr double eps = static_cast<double>(std::numeric_limits<float>::epsilon());
  compare(sinc<float>, sinc<double>, 2 * eps);
  compare(dsinc<float>, dsinc<double>, 6 * eps);
  compare(cosc<float>, cosc<double>, 4 * eps);
  compare(sinc3<float>, sinc3<double>, 6 * eps);
  compare(cosc4<float>, cosc4<double>, 6 * eps);
  compare(sinc5<float>, sinc5<double>, 6 * eps);
}

}  // namespace entire_test
}  // namespace sinew
