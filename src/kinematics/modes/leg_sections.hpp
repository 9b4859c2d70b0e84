/// @file leg_sections.hpp
/// Six distance legs as six linear equations on the rigid motions. A motion is a point (e, g) of the Study
/// quadric e·g = 0: R turns by the quaternion e, p = g ē/(e·e). A leg |p + R b − A| = D is linear in the 17
/// quantities g·g, e_i g_j − e_j g_i and e_i e_j, and six general such equations have 40 solutions.
/// Theory: docs/theory/spatial_modes.md
#pragma once
#include <random>
#include <vector>

#include "leg/platform_constraint.hpp"
#include "sinew/math/se3.hpp"
#include "solve/homotopy.hpp"

namespace sinew::inline v1::detail {

inline constexpr int leg_coordinates = 17, max_modes = 40;
using Study = Vec<Complex, 8>;  ///< (e, g)
using Sections = Mat<Complex, 6, leg_coordinates>;
using LegCoordinates = Vec<Complex, leg_coordinates>;

/// g·g, e_i g_j − e_j g_i for i < j, e_i e_j for i ≤ j.
inline LegCoordinates leg_coordinates_of(const Study& x) {
  LegCoordinates y;
  y[0] = (x.tail<4>().array() * x.tail<4>().array()).sum();
  int k = 1;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) y[k++] = x[i] * x[4 + j] - x[j] * x[4 + i];
  for (int i = 0; i < 4; ++i)
    for (int j = i; j < 4; ++j) y[k++] = x[i] * x[j];
  return y;
}

/// The leg's equation divided by nothing: e·e (|p + R b − a|² − D²) = g·g + 2 g·(e b − a e) + e·A e with the
/// quaternion products as matrices.
inline Vec<double, leg_coordinates> leg_equation(const PlatformConstraint<3>& leg) {
  const Vec3<double>&a = leg.anchor, &b = leg.platform_point;
  Mat<double, 4, 4> from_left, from_right;  // a e and e b
  from_left << 0, -a.transpose(), a, skew<double>(a);
  from_right << 0, -b.transpose(), b, -skew<double>(b);
  const double constant = a.squaredNorm() + b.squaredNorm() - leg.distance * leg.distance;
  const Mat<double, 4, 4> linear = from_right - from_left;
  const Mat<double, 4, 4> square = constant * Mat<double, 4, 4>::Identity() + 2 * from_left * from_right;
  Vec<double, leg_coordinates> row;
  row[0] = 1;
  int k = 1;
  for (int i = 0; i < 4; ++i)
    for (int j = i + 1; j < 4; ++j) row[k++] = -2 * linear(i, j);
  for (int i = 0; i < 4; ++i)
    for (int j = i; j < 4; ++j) row[k++] = i == j ? square(i, i) : square(i, j) + square(j, i);
  return row;
}

/// (1 − t)·from + t·to: every member is again six linear equations, so that 40 solutions stay 40.
class Pencil {
 public:
  static constexpr int unknowns = 8;
  Pencil(const Sections& from, const Sections& to) : from_(from), change_(to - from) {}

  void linearise(const Study& x, Complex t, Mat<Complex, 8, 8>& jacobian, Study& value) const {
    const Sections rows = from_ + t * change_;
    Mat<Complex, 6, 8> top = Mat<Complex, 6, 8>::Zero();
    for (int i = 0; i < 4; ++i) top.col(4 + i) = rows.col(0) * (2.0 * x[4 + i]);
    int k = 1;
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j, ++k) {
        top.col(i) += rows.col(k) * x[4 + j];
        top.col(j) -= rows.col(k) * x[4 + i];
        top.col(4 + j) += rows.col(k) * x[i];
        top.col(4 + i) -= rows.col(k) * x[j];
      }
    for (int i = 0; i < 4; ++i)
      for (int j = i; j < 4; ++j, ++k) {
        top.col(i) += rows.col(k) * x[j];
        top.col(j) += rows.col(k) * x[i];
      }
    jacobian.topRows<6>() = top;
    jacobian.row(6) << x.tail<4>().transpose(), x.head<4>().transpose();
    value = 0.5 * (jacobian * x);  // homogeneous of degree 2
  }

  void rate(const Study& x, Complex, Study& column) const {
    column.head<6>() = change_ * leg_coordinates_of(x);
    column[6] = 0;
  }

  /// e·e = 0: the translation g ē/(e·e) is infinite.
  double finiteness(const Study& x) const {
    return std::abs((x.head<4>().array() * x.head<4>().array()).sum()) / x.squaredNorm();
  }

 private:
  Sections from_, change_;
};

/// Complex numbers of the unit square about 0, the same on every machine (std distributions are not).
class ComplexNumbers {
 public:
  explicit ComplexNumbers(std::uint64_t seed) : engine_(seed) {}
  Complex next() {
    const double x = real();
    return {x, real()};
  }
  Complex phase() { return std::polar(1.0, 6.283185307179586 * real()); }

 private:
  double real() { return 0x1p-53 * static_cast<double>(engine_() >> 11) - 0.5; }
  std::mt19937_64 engine_;
};

/// Six equations that are like no robot's, and their 40 solutions: where all searches start.
struct GenericLegs {
  Sections sections;
  std::vector<Study> solutions;
};

/// Found once a process, by walking from one solution to the others.
const GenericLegs& generic_legs();

/// Whether two points are the same up to scale.
inline bool same_ray(const Study& x, const Study& y, double tolerance) {
  const Complex along = x.dot(y) / x.squaredNorm();
  return (y - along * x).norm() <= tolerance * y.norm();
}

}  // namespace sinew::inline v1::detail

namespace sinew::inline v1 {
extern template class Path<detail::Pencil>;  // compiled once
}
