/// @file newton.hpp
/// Newton's method with a line search, on any problem that gives residuals and a Jacobian. It has never heard
/// of a robot. Where the Newton step is too long or gives no descent (near a singular Jacobian) a
/// Levenberg-Marquardt step takes its place: halving a Newton step there creeps along the singular surface.
/// Theory: docs/theory/newton.md
#pragma once
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <concepts>
#include <span>

#include "base/limits.hpp"
#include "math/linalg.hpp"
#include "sinew/math/vec.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// Residual, Jacobian and error of a problem with N unknowns at one point; rows ≥ N.
template <int N>
struct Linearised {
  using Residual = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::DontAlign, max_rows, 1>;
  using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, N, Eigen::DontAlign, max_rows, N>;
  Residual residual = Residual::Zero(N);
  Jacobian jacobian = Jacobian::Zero(N, N);
  double error = 0;  ///< the same residual in the unit in which convergence is judged [m]

  double merit() const { return 0.5 * residual.squaredNorm(); }
};

/// What the solver needs of a problem: `linearise` returns false where the point is outside the domain.
template <class P>
concept NewtonProblem = requires(const P& problem, const typename P::Point& point,
                                 Linearised<P::unknowns>& system, const Vec<double, P::unknowns>& step) {
  { problem.linearise(point, system) } -> std::same_as<bool>;
  { problem.moved(point, step) } -> std::same_as<typename P::Point>;
  { problem.shortened(step) } -> std::same_as<double>;  // factor ≤ 1 that keeps a step sensible
};

struct NewtonOptions {
  double tolerance = 1e-14;  ///< on Linearised::error
  int max_iterations = 100;
  std::span<TraceStep> trace = {};  ///< filled as far as it reaches
};

namespace detail {

/// Newton step of a square system, Gauss-Newton step of a tall one, the shortest step of a wide one; false
/// where the matrix is singular.
template <int N>
bool newton_step(const Linearised<N>& system, Vec<double, N>& step) {
  if (system.residual.rows() == N) {
    const Mat<double, N, N> square = system.jacobian;
    step = -square.partialPivLu().solve(Vec<double, N>(system.residual));
  } else {
    const Eigen::Matrix<double, Eigen::Dynamic, N, Eigen::RowMajor | Eigen::DontAlign, max_rows, N> rows =
        system.jacobian;
    const typename Linearised<N>::Residual wanted = -system.residual;
    least_norm(MatrixView(rows.data(), rows.rows(), N),
               {wanted.data(), static_cast<std::size_t>(wanted.size())}, {step.data(), N});
  }
  return step.allFinite();
}

/// Levenberg-Marquardt step, damped per column (Marquardt's scaling: the unknowns have different units).
template <int N>
Vec<double, N> damped_step(const Linearised<N>& system, double damping) {
  Mat<double, N, N> normal = system.jacobian.transpose() * system.jacobian;
  const double floor = 1e-12 * normal.diagonal().maxCoeff() + 1e-300;
  for (int i = 0; i < N; ++i) normal(i, i) += damping * std::max(normal(i, i), floor);
  return -normal.ldlt().solve(Vec<double, N>(system.jacobian.transpose() * system.residual));
}

// Of the sizes that robots have; compiling them takes a second or two each.
#define SINEW_NEWTON_STEPS(N)                                                             \
  extern template bool newton_step<N>(const Linearised<N>& system, Vec<double, N>& step); \
  extern template Vec<double, N> damped_step<N>(const Linearised<N>& system, double damping);
SINEW_NEWTON_STEPS(3)
SINEW_NEWTON_STEPS(6)
SINEW_NEWTON_STEPS(8)
#undef SINEW_NEWTON_STEPS

/// One run of the solver: the best iterate and what is known there.
template <class P>
class Newton {
 public:
  static constexpr int N = P::unknowns;
  Newton(const P& problem, typename P::Point& point) : problem_(problem), point_(point) {}

  /// False where the start is outside the domain. (A maximum of errors hides a NaN, the sum of squares does
  /// not.)
  bool begin() { return problem_.linearise(point_, here_) && std::isfinite(here_.merit()); }
  double error() const { return here_.error; }

  /// The Newton step where it is trusted whole, or halved once or twice: then convergence is quadratic.
  /// Returns the fraction taken, 0 if none.
  double newton_search() {
    Vec<double, N> step;
    if (!newton_step(here_, step) || problem_.shortened(step) < 1) return 0;
    for (double fraction = 1; fraction > 0.2; fraction /= 2)
      if (accept(step, fraction)) return fraction;
    return 0;
  }

  /// Elsewhere, near a singular Jacobian above all, Levenberg-Marquardt; its damping is remembered.
  bool damped_search() {
    for (int tries = 0; tries < 16; ++tries, damping_ *= 5) {
      const Vec<double, N> step = damped_step(here_, damping_);
      if (!step.allFinite()) continue;
      const double fraction = problem_.shortened(step);
      if (!accept(step, fraction)) continue;
      if (fraction == 1) damping_ = std::max(damping_ / 10, 1e-10);
      return true;
    }
    return false;
  }

 private:
  /// Tries point ⊕ fraction·step; keeps it if the merit falls.
  bool accept(const Vec<double, N>& step, double fraction) {
    const typename P::Point ahead = problem_.moved(point_, fraction * step);
    if (!problem_.linearise(ahead, there_)) return false;
    if (!(there_.merit() < (1 - 1e-4 * fraction) * here_.merit())) return false;
    point_ = ahead;
    std::swap(here_, there_);
    return true;
  }

  const P& problem_;
  typename P::Point& point_;
  Linearised<N> here_, there_;
  double damping_ = 1e-3;
};

}  // namespace detail

/// Solves `problem` from `point`, which holds the best iterate afterwards. Bounded work: at most
/// `max_iterations` steps of at most 19 evaluations each.
template <NewtonProblem P>
Report newton(const P& problem, typename P::Point& point, const NewtonOptions& options) {
  detail::Newton<P> search(problem, point);
  Report report;
  if (!search.begin()) {
    report.status = Status::left_domain;
    return report;
  }
  const auto record = [&](double fraction) {
    const auto i = static_cast<std::size_t>(report.iterations);
    if (i < options.trace.size()) options.trace[i] = {report.iterations, search.error(), fraction};
  };
  record(0);
  while (search.error() > options.tolerance && report.iterations < options.max_iterations) {
    const double fraction = search.newton_search();
    if (fraction == 0 && !search.damped_search()) break;  // rounding level reached, or a local minimum
    ++report.iterations;
    record(fraction);
  }
  report.residual = search.error();
  // The last digits: where they do not come, 100 times the tolerance is still an answer.
  if (report.residual > 100 * options.tolerance)
    report.status = report.iterations >= options.max_iterations ? Status::iteration_limit : Status::stalled;
  return report;
}

}  // namespace sinew::inline v1
