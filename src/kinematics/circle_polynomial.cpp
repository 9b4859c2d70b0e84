#include "kinematics/circle_polynomial.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sinew::inline v0 {
namespace {

using Quadratic = Vec3<double>;  // coefficients of 1, x, x²
using Quartic = Vec<double, 5>;
constexpr int samples = 32;  // of F: more than twice its degree, the rest shows rounding

Quartic product(const Quadratic& a, const Quadratic& b) {
  Quartic p = Quartic::Zero();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) p[i + j] += a[i] * b[j];
  return p;
}

/// (1, cos t, sin t) times 1 + x², x = tan ½t, as columns of coefficients.
Mat<double, 3, 3> half_angle() {
  Mat<double, 3, 3> basis;
  basis << 1, 1, 0, 0, 0, 2, 1, -1, 0;
  return basis;
}

/// Resultant of a quadratic q and a polynomial whose coefficients of 1, x, x² are the quadratics of the rows.
Quartic eliminated(const Quadratic& q, const Mat<double, 3, 3>& rows) {
  const Quadratic C = rows.row(0).transpose(), B = rows.row(1).transpose(), A = rows.row(2).transpose();
  const double a = q[2], b = q[1], c = q[0];
  const Quadratic ac = a * C - c * A;
  return product(ac, ac) - product(Quadratic(a * B - b * A), Quadratic(b * C - c * B));
}

/// Resultant of a quadratic and a quartic Q, a⁴ Q(β₁) Q(β₂), by the power sums of the roots: no division.
double resultant(const Quadratic& q, const Quartic& Q) {
  const double a = q[2], b = q[1], c = q[0];
  std::array<double, 5> sums{2, -b, 0, 0, 0}, pa{1, a, a * a, a * a * a, a * a * a * a},
      pc{1, c, c * c, c * c * c, c * c * c * c};
  for (std::size_t m = 2; m < 5; ++m) sums[m] = -b * sums[m - 1] - a * c * sums[m - 2];
  double sum = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    const double qi = Q[static_cast<Eigen::Index>(i)];
    sum += qi * qi * pc[i] * pa[4 - i];
    for (std::size_t j = i + 1; j < 5; ++j)
      sum += qi * Q[static_cast<Eigen::Index>(j)] * pc[i] * pa[4 - j] * sums[j - i];
  }
  return sum;
}

}  // namespace

CirclePolynomial::CirclePolynomial(const ThreeCircles& circles, std::size_t first) {
  const std::size_t second = ThreeCircles::next(first), third = ThreeCircles::next(second);
  const Mat<double, 3, 3> half = half_angle(), to_second = half * circles.form(first).transpose(),
                          to_third = half * circles.form(third);
  const Mat<double, 3, 3> between = half * circles.form(second) * half.transpose();
  std::array<double, samples> f;
  double largest = 0, terms = 0;
  for (int n = 0; n < samples; ++n) {
    const double t = 2 * std::numbers::pi * n / samples;
    const Vec3<double> at(1, std::cos(t), std::sin(t));
    const Quadratic q2 = to_second * at, q3 = to_third * at;
    double& value = f[static_cast<std::size_t>(n)];
    value = resultant(q3, eliminated(q2, between));
    largest = std::max(largest, std::abs(value));
    terms = std::max(terms, std::pow(q2.norm() * q3.norm() * between.norm(), 4));
  }
  if (!(largest > 0) || !std::isfinite(largest)) return;
  strength_ = largest / terms;
  for (int k = 0; k <= samples / 2; ++k) {
    std::complex<double> c = 0;
    for (int n = 0; n < samples; ++n)
      c += f[static_cast<std::size_t>(n)] / largest * std::polar(1.0, -2 * std::numbers::pi * ((k * n) % samples) / samples);
    c *= (k == 0 ? 1.0 : 2.0) / samples;
    if (k <= degree) {
      c_[static_cast<std::size_t>(k)] = c;
      third_ += k * k * k * std::abs(c);
    } else {
      noise_ = std::max(noise_, std::abs(c));
    }
  }
  noise_ = 16 * noise_ + 4e-16;
}

CirclePolynomial::Value CirclePolynomial::at(double t) const {
  const std::complex<double> z = std::polar(1.0, t);
  std::complex<double> p = 0, rate = 0, rate_rate = 0;
  for (int k = degree; k >= 0; --k) {
    const std::complex<double> c = c_[static_cast<std::size_t>(k)];
    p = p * z + c;
    rate = rate * z + static_cast<double>(k) * c;
    rate_rate = rate_rate * z + static_cast<double>(k * k) * c;
  }
  return {p.real(), -rate.imag(), -rate_rate.real()};
}

}  // namespace sinew::inline v0
