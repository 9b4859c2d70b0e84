/// @file descent.hpp
/// Least squares of few unknowns with terms that come and go (contact), within bounds: damped Gauss-Newton
/// (Levenberg, Marquardt), unknowns at a bound held there while they push against it.
#pragma once
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "plan/deadline.hpp"

namespace sinew::inline v1 {

/// Sum of squares at a point, its gradient and J Jᵀ.
struct Quadratic {
  double cost = 0;
  bool has_derivatives = true;  ///< whether they are wanted
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;

  explicit Quadratic(Eigen::Index size) : gradient(size), hessian(size, size) {}
  void clear(bool derivatives) {
    cost = 0;
    has_derivatives = derivatives;
    if (!derivatives) return;
    gradient.setZero();
    hessian.setZero();
  }
  /// Adds ½ r² of a residual whose derivatives by the first `count` unknowns are these.
  template <class Row>
  void add(double residual, Eigen::Index count, Row&& row) {
    cost += 0.5 * residual * residual;
    if (!has_derivatives) return;
    for (Eigen::Index i = 0; i < count; ++i) {
      const double d = row(i);
      gradient[i] += d * residual;
      for (Eigen::Index j = 0; j <= i; ++j) hessian(i, j) += d * row(j);
    }
  }
};

struct DescentOptions {
  int max_steps = 40;
  double min_gain = 1e-6;  ///< it ends where a step lowers the cost by a smaller share
  double damping = 1e-3;   ///< at first, of the diagonal
  Deadline deadline;
};

/// @param cost fills the quadratic
/// @param lower,upper bounds of every unknown @param project further limits, applied to every trial
/// @return the cost reached
double descend(std::vector<double>& x, std::span<const double> lower, std::span<const double> upper,
               const std::function<void(std::span<const double> x, Quadratic& at)>& cost,
               const std::function<void(std::vector<double>&)>& project, const DescentOptions& options);

}  // namespace sinew::inline v1
