/// @file circle_polynomial.hpp
/// Two of three angles eliminated: a trigonometric polynomial F of degree 8 in the one that is left. It
/// vanishes where the platform can fit, so it counts the modes: at most sixteen. Theory:
/// docs/theory/tripod_rigid.md
#pragma once
#include <complex>
#include <optional>

#include "kinematics/modes/three_circles.hpp"

namespace sinew::inline v1 {

/// F is evaluated as it is, never by its coefficients: between its roots it may be 1e-10 of its largest
/// value.
class CirclePolynomial {
 public:
  /// Of the angle of circle `first`.
  CirclePolynomial(const ThreeCircles& circles, std::size_t first);

  /// Largest |F| of some angles, against the terms it is the difference of: 0 where every angle is a root.
  double strength() const;

  /// How many roots are real, or nearer to that than `margin` [rad], multiple ones as often as they are, by
  /// the argument principle; none where that cannot be told. Only those where the other two angles are real
  /// or nearly: where they are not no mode is, but a robot with a mirror has roots there.
  std::optional<int> count_real(double margin) const;

 private:
  /// F at an angle, over its terms: a positive factor that does not change its argument.
  std::complex<double> at(const std::complex<double>& t) const;
  /// Change of its argument along a straight line; none where roots are too near to it.
  std::optional<double> turning(std::complex<double> from, std::complex<double> to, double margin) const;
  bool others_are_real(double t) const;

  Mat<double, 3, 3> to_second_, to_third_, between_;
};

}  // namespace sinew::inline v1
