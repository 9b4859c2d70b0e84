/// @file circle_polynomial.hpp
/// Two of three angles eliminated: a trigonometric polynomial of degree 8 in the one that is left, whose real
/// roots are the places where the platform can fit. Theory: docs/theory/tripod_rigid.md
#pragma once
#include <array>
#include <complex>

#include "kinematics/three_circles.hpp"

namespace sinew::inline v0 {

/// F(t) = Re Σ cₖ e^{ikt}, |F| ≤ about 1.
class CirclePolynomial {
 public:
  static constexpr int degree = 8;

  /// Of the angle of circle `first`.
  CirclePolynomial(const ThreeCircles& circles, std::size_t first);

  struct Value {
    double value, rate, rate_rate;
  };
  Value at(double t) const;

  /// Largest |F| against the terms it is the difference of: 0 where every angle is a root.
  double strength() const { return strength_; }
  /// Rounding of a value of F, as the harmonics above the eighth show it.
  double noise() const { return noise_; }
  /// Bound on |F‴|.
  double third_bound() const { return third_; }

 private:
  std::array<std::complex<double>, degree + 1> c_;
  double strength_ = 0, noise_ = 0, third_ = 0;
};

}  // namespace sinew::inline v0
