/// @file rod_3pfs.hpp
/// One rod of the flexible tripod as 3PFS (20)-(24) write it, integrated two ways: Runge-Kutta 4, as the
/// paper does, and order 8, to judge by. Reads nothing of the library. Any scalar, so that complex steps pass
/// through.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>

namespace sinew::test::shooting {

template <class S>
using Vector3 = Eigen::Matrix<S, 3, 1>;

enum class Method { rk4, order_8 };

struct Integration {
  Method method = Method::order_8;
  int steps = 64;  ///< of order 8: rounding, see the test IntegratesToRounding
};

/// Cross-section: x, y, z, q0…q3, u_x, u_y of (20), u_z = 0.
template <class S>
using Section = std::array<S, 9>;

/// (24); n in N, EI in N m².
template <class S>
Section<S> rate(const Section<S>& y, const Vector3<S>& n, double EI) {
  const S &q0 = y[3], &q1 = y[4], &q2 = y[5], &q3 = y[6], &ux = y[7], &uy = y[8];
  const S q00 = q0 * q0, q11 = q1 * q1, q22 = q2 * q2, q33 = q3 * q3;
  const S q12 = q1 * q2, q03 = q0 * q3, q23 = q2 * q3, q01 = q0 * q1, q13 = q1 * q3, q02 = q0 * q2;
  return {2.0 * (q13 + q02),
          2.0 * (q23 - q01),
          q00 - q11 - q22 + q33,
          0.5 * (-ux * q1 - uy * q2),
          0.5 * (ux * q0 - uy * q3),
          0.5 * (uy * q0 + ux * q3),
          0.5 * (uy * q1 - ux * q2),
          (2.0 * n[0] * (q12 - q03) + n[1] * (q00 - q11 + q22 - q33) + 2.0 * n[2] * (q23 + q01)) / EI,
          (-n[0] * (q00 + q11 - q22 - q33) - 2.0 * n[1] * (q12 + q03) - 2.0 * n[2] * (q13 - q02)) / EI};
}

template <class S>
Section<S> ahead(Section<S> y, double h, const Section<S>& slope) {
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += h * slope[i];
  return y;
}

template <class S>
Section<S> step_rk4(const Section<S>& y, double h, const Vector3<S>& n, double EI) {
  const Section<S> k1 = rate(y, n, EI), k2 = rate(ahead(y, h / 2, k1), n, EI),
                   k3 = rate(ahead(y, h / 2, k2), n, EI), k4 = rate(ahead(y, h, k3), n, EI);
  Section<S> next = y;
  for (std::size_t i = 0; i < y.size(); ++i) next[i] += h / 6 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
  return next;
}

/// Cooper and Verner's 11 stages of order 8 (SIAM J. Numer. Anal. 9, 1972), whose coefficients are closed
/// forms in √21: nothing to mistype digit by digit, and the tests measure the order.
struct CooperVerner {
  std::array<std::array<double, 11>, 11> a{};
  std::array<double, 11> b{};
  CooperVerner() {
    const double s = std::sqrt(21.0);
    a[1] = {1 / 2.};
    a[2] = {1 / 4., 1 / 4.};
    a[3] = {1 / 7., (-7 - 3 * s) / 98, (21 + 5 * s) / 49};
    a[4] = {(11 + s) / 84, 0, (18 + 4 * s) / 63, (21 - s) / 252};
    a[5] = {(5 + s) / 48, 0, (9 + s) / 36, (-231 + 14 * s) / 360, (63 - 7 * s) / 80};
    a[6] = {(10 - s) / 42,     0, (-432 + 92 * s) / 315, (633 - 145 * s) / 90, (-504 + 115 * s) / 70,
            (63 - 13 * s) / 35};
    a[7] = {1 / 14., 0, 0, 0, (14 - 3 * s) / 126, (13 - 3 * s) / 63, 1 / 9.};
    a[8] = {1 / 32., 0, 0, 0, (91 - 21 * s) / 576, 11 / 72., (-385 - 75 * s) / 1152, (63 + 13 * s) / 128};
    a[9] = {1 / 14.,
            0,
            0,
            0,
            1 / 9.,
            (-733 - 147 * s) / 2205,
            (515 + 111 * s) / 504,
            (-51 - 11 * s) / 56,
            (132 + 28 * s) / 245};
    a[10] = {0,
             0,
             0,
             0,
             (-42 + 7 * s) / 18,
             (-18 + 28 * s) / 45,
             (-273 - 53 * s) / 72,
             (301 + 53 * s) / 72,
             (28 - 28 * s) / 45,
             (49 - 7 * s) / 18};
    b = {1 / 20., 0, 0, 0, 0, 0, 0, 49 / 180., 16 / 45., 49 / 180., 1 / 20.};
  }
};

template <class S>
Section<S> step_order_8(const Section<S>& y, double h, const Vector3<S>& n, double EI) {
  static const CooperVerner method;
  std::array<Section<S>, 11> k;
  const auto sum = [&](const std::array<double, 11>& weight, std::size_t stages) {
    Section<S> at = y;
    for (std::size_t j = 0; j < stages; ++j)
      if (weight[j] != 0) at = ahead(at, h * weight[j], k[j]);
    return at;
  };
  for (std::size_t i = 0; i < 11; ++i) k[i] = rate(sum(method.a[i], i), n, EI);
  return sum(method.b, 11);
}

/// The section at s = `length` of a rod with base curvature (ux, uy) [1/m] and force n [N].
template <class S>
Section<S> tip(const Vector3<S>& n, const S& ux, const S& uy, double length, double EI,
               const Integration& how) {
  Section<S> y{S(0), S(0), S(0), S(1), S(0), S(0), S(0), ux, uy};
  const double h = length / how.steps;
  for (int k = 0; k < how.steps; ++k)
    y = how.method == Method::rk4 ? step_rk4(y, h, n, EI) : step_order_8(y, h, n, EI);
  return y;
}

}  // namespace sinew::test::shooting
