#include "kinematics/modes/circle_polynomial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sinew::inline v1 {
namespace {

using Complex = std::complex<double>;
using Quadratic = Vec3<Complex>;  // coefficients of 1, x, x²
using Quartic = Vec<Complex, 5>;
constexpr double turn = 2 * std::numbers::pi;

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
  const auto row = [&](int i) { return Quadratic(rows.row(i).transpose().template cast<Complex>()); };
  const Quadratic C = row(0), B = row(1), A = row(2);
  const Complex a = q[2], b = q[1], c = q[0];
  const Quadratic ac = a * C - c * A;
  return product(ac, ac) - product(Quadratic(a * B - b * A), Quadratic(b * C - c * B));
}

/// Resultant of a quadratic and a quartic Q, a⁴ Q(β₁) Q(β₂), by the power sums of the roots: no division.
Complex resultant(const Quadratic& q, const Quartic& Q) {
  const Complex a = q[2], b = q[1], c = q[0];
  std::array<Complex, 5> sums{2.0, -b, 0.0, 0.0, 0.0}, of_a{1.0, a}, of_c{1.0, c};
  for (std::size_t m = 2; m < 5; ++m) {
    sums[m] = -b * sums[m - 1] - a * c * sums[m - 2];
    of_a[m] = of_a[m - 1] * a;
    of_c[m] = of_c[m - 1] * c;
  }
  Complex sum = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    const Complex own = Q[static_cast<Eigen::Index>(i)];
    sum += own * own * of_c[i] * of_a[4 - i];
    for (std::size_t j = i + 1; j < 5; ++j)
      sum += own * Q[static_cast<Eigen::Index>(j)] * of_c[i] * of_a[4 - j] * sums[j - i];
  }
  return sum;
}

}  // namespace

CirclePolynomial::CirclePolynomial(const ThreeCircles& circles, std::size_t first) {
  const std::size_t second = ThreeCircles::next(first), third = ThreeCircles::next(second);
  const Mat<double, 3, 3> half = half_angle();
  to_second_ = half * circles.form(first).transpose();
  to_third_ = half * circles.form(third);
  between_ = half * circles.form(second) * half.transpose();
  between_ /= between_.norm();
}

Complex CirclePolynomial::at(const Complex& t) const {
  const Vec3<Complex> angle(1.0, std::cos(t), std::sin(t));
  Quadratic second = to_second_ * angle, third = to_third_ * angle;
  second /= second.norm();
  third /= third.norm();
  return resultant(third, eliminated(second, between_));
}

double CirclePolynomial::strength() const {
  double largest = 0;
  for (int k = 0; k < 37; ++k) largest = std::max(largest, std::abs(at(turn * k / 37)));
  return largest;
}

std::optional<double> CirclePolynomial::turning(Complex from, Complex to, double margin) const {
  constexpr double shortest = 1e-7, longest = 0.05;
  struct Sample {
    Complex value;
    double pace;  ///< by how much it changes of itself: 1/distance of a root, summed over roots
  };
  const double length = std::abs(to - from);
  const Complex along = (to - from) / length;
  const auto sample = [&](double s) {
    const double apart = 0.25 * margin;
    const Complex t = from + s * along, value = at(t);
    return Sample{value, std::abs((at(t + apart * along) - value) / (apart * value))};
  };
  double argument = 0, s = 0, step = longest;
  Sample here = sample(0);
  while (s < length) {
    const double ahead = std::min(s + step, length);
    const Sample half = sample(0.5 * (s + ahead)), there = sample(ahead);
    const double first = std::arg(half.value / here.value), second = std::arg(there.value / half.value);
    // Two roots near each other turn the argument by 2π, which looks like none: the pace tells that they are
    // near.
    const double pace = std::max({here.pace, half.pace, there.pace});
    if (!(std::abs(first) < 0.5 && std::abs(second) < 0.5 && 0.5 * (ahead - s) * pace < 1)) {
      step = 0.5 * (ahead - s);
      if (step < shortest) return {};
      continue;
    }
    argument += first + second;
    s = ahead;
    here = there;
    step = std::min(2 * step, longest);
  }
  return argument;
}

bool CirclePolynomial::others_are_real(double t) const {
  constexpr double nearly = 1e-4;  // reached by all between two of the angles that are asked for
  const Vec3<double> angle(1, std::cos(t), std::sin(t));
  for (const Mat<double, 3, 3>* to : {&to_second_, &to_third_}) {
    const Vec3<double> q = *to * angle;
    if (q[1] * q[1] - 4 * q[0] * q[2] < -nearly * q.squaredNorm()) return false;
  }
  return true;
}

std::optional<int> CirclePolynomial::count_real(double margin) const {
  constexpr int samples = 720;
  const auto angle = [](int k) { return turn * k / samples; };
  int start = 0;
  while (start < samples && others_are_real(angle(start))) ++start;
  if (start == samples) {
    const auto argument = turning({0, -margin}, {turn, -margin}, margin);
    if (!argument) return {};
    return static_cast<int>(std::lround(*argument / std::numbers::pi));
  }
  // Around each interval, from the real axis down, along and up again: the other half of the way mirrors it.
  double argument = 0, begin = 0;
  for (int k = start; k < start + samples; ++k) {
    const bool is_inside = others_are_real(angle(k)), enters = others_are_real(angle(k + 1));
    if (!is_inside && enters) begin = angle(k);
    if (!is_inside || enters) continue;
    const double end = angle(k + 1);
    const std::array<Complex, 4> corners{begin, {begin, -margin}, {end, -margin}, end};
    for (std::size_t side = 0; side < 3; ++side) {
      const auto part = turning(corners[side], corners[side + 1], margin);
      if (!part) return {};
      argument += *part;
    }
  }
  const double count = argument / std::numbers::pi;
  if (!(std::abs(count - std::round(count)) < 0.1)) return {};
  return static_cast<int>(std::lround(count));
}

}  // namespace sinew::inline v1
