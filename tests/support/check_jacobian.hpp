/// @file check_jacobian.hpp
/// Derivatives are never trusted: the one helper that compares a Jacobian with differences of its function.
///
///   EXPECT_LT(check_jacobian([&]<class S>(const Vec<S, 3>& x) { return residual(x); }, x, jacobian), 1e-10);
///
/// The error is max over i, j of |A − B|ᵢⱼ / max(unit, largest |A|, |B| in row i): a row has one unit of
/// measure, so its entries that happen to cancel are judged by their row; rows smaller than `unit` are judged
/// absolutely. (MuJoCo divides entry by entry, which calls every difference against an exact 0 an error of
/// 100 %.)
#pragma once
#include <algorithm>
#include <complex>
#include <limits>
#include <type_traits>

#include "sinew/math/vec.hpp"

namespace sinew::test {

/// x with scalar S: a fixed `Vec<S, N>`, so that functions may be templates on S, or a dynamic vector.
template <class S, class X>
using Rebound =
    std::conditional_t<X::SizeAtCompileTime == Eigen::Dynamic, Eigen::Matrix<S, Eigen::Dynamic, 1>,
                       Vec<S, X::SizeAtCompileTime == Eigen::Dynamic ? 1 : X::SizeAtCompileTime>>;

struct JacobianCheck {
  double step = 4e-3;  ///< largest step of the differences, times max(1, |xⱼ|)
  double unit = 1e-3;  ///< rows below this are compared absolutely, as if this large
};

inline double jacobian_error(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                             double unit = JacobianCheck{}.unit) {
  constexpr double worst_of_all = std::numeric_limits<double>::infinity();
  if (a.rows() != b.rows() || a.cols() != b.cols() || !a.allFinite() || !b.allFinite()) return worst_of_all;
  double worst = 0;
  for (Eigen::Index i = 0; i < a.rows(); ++i) {
    const double size = std::max({unit, a.row(i).cwiseAbs().maxCoeff(), b.row(i).cwiseAbs().maxCoeff()});
    worst = std::max(worst, (a.row(i) - b.row(i)).cwiseAbs().maxCoeff() / size);
  }
  return worst;
}

/// Exact to rounding: Im f(x + i·h·eⱼ)/h has no subtraction. f must be analytic and take
/// std::complex<double>.
template <class F, class X>
Eigen::MatrixXd complex_step_jacobian(const F& f, const Eigen::MatrixBase<X>& x) {
  using C = std::complex<double>;
  constexpr double h = 1e-30;
  Eigen::MatrixXd jacobian;
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    Rebound<C, X> at = x.template cast<C>();
    at[j] += C(0, h);
    const Eigen::VectorXd column = (Eigen::VectorXcd(f(at)) / h).imag();
    if (j == 0) jacobian.resize(column.size(), x.size());
    jacobian.col(j) = column;
  }
  return jacobian;
}

/// Central differences at h, h/2, h/4, extrapolated twice (Richardson): truncation h⁶, rounding about 8 eps
/// |f|/h.
template <class F, class X>
Eigen::MatrixXd central_jacobian(const F& f, const Eigen::MatrixBase<X>& x,
                                 double step = JacobianCheck{}.step) {
  Eigen::MatrixXd jacobian;
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    const auto slope = [&](double wanted) -> Eigen::VectorXd {
      Rebound<double, X> ahead = x, behind = x;
      ahead[j] += wanted;
      behind[j] -= wanted;
      const double taken = ahead[j] - behind[j];  // what rounding made of the step
      return (Eigen::VectorXd(f(ahead)) - Eigen::VectorXd(f(behind))) / taken;
    };
    const double h = step * std::max(1.0, std::abs(x[j]));
    const Eigen::VectorXd coarse = slope(h), middle = slope(h / 2), fine = slope(h / 4);
    const Eigen::VectorXd first = (4 * middle - coarse) / 3, second = (4 * fine - middle) / 3;
    if (j == 0) jacobian.resize(coarse.size(), x.size());
    jacobian.col(j) = (16 * second - first) / 15;
  }
  return jacobian;
}

/// Worst error against differences alone: for a function of doubles.
template <class F, class X, class A>
double check_jacobian_real(const F& f, const Eigen::MatrixBase<X>& x, const Eigen::MatrixBase<A>& analytic,
                           JacobianCheck how = {}) {
  return jacobian_error(Eigen::MatrixXd(analytic), central_jacobian(f, x, how.step), how.unit);
}

/// Worst error against the complex step and against differences: for a function templated on its scalar.
template <class F, class X, class A>
double check_jacobian(const F& f, const Eigen::MatrixBase<X>& x, const Eigen::MatrixBase<A>& analytic,
                      JacobianCheck how = {}) {
  return std::max(jacobian_error(Eigen::MatrixXd(analytic), complex_step_jacobian(f, x), how.unit),
                  check_jacobian_real(f, x, analytic, how));
}

}  // namespace sinew::test
