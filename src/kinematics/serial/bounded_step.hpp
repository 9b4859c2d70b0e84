/// @file bounded_step.hpp
/// Damped least squares of few rows within bounds:  min |A d − r|² + μ |d|²,  low ≤ d ≤ high.
/// Theory: docs/theory/serial_inverse.md
#pragma once
#include <algorithm>
#include <cmath>

#include "base/limits.hpp"

namespace sinew::inline v1 {

/// Columns are the components of bends and extensions; bounds that leave no room (low = high = 0) hold one
/// where it is.
struct BoundedStep {
  static constexpr int max_rows = 6, max_columns = 3 * max_sections + max_sections % 2;
  using Row = double[max_columns];

  int rows = 0, columns = 0;  ///< columns even
  Row A[max_rows];
  double r[max_rows];
  Row low, high;
  Row step;      ///< the answer
  int held = 0;  ///< components of it at a bound

  /// Σ of the squares of A.
  double trace() const {
    double sum = 0;
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < columns; ++j) sum += A[i][j] * A[i][j];
    return sum;
  }

  /// |A·step − r|²
  double missed() const {
    double sum = 0;
    for (int i = 0; i < rows; ++i) {
      double left = r[i];
      for (int j = 0; j < columns; ++j) left -= A[i][j] * step[j];
      sum += left * left;
    }
    return sum;
  }

  /// False where A is not finite, or 0 and μ as well.
  [[nodiscard]] bool solve(double damping) {
    switch (rows) {
      case 3:
        return solve_rows<3>(damping);
      case 5:
        return solve_rows<5>(damping);
      default:
        return solve_rows<6>(damping);
    }
  }

 private:
  template <int Rows>
  using Few = double[static_cast<std::size_t>(Rows)];
  template <int Rows>
  using Square = double[static_cast<std::size_t>(Rows)][static_cast<std::size_t>(Rows)];

  /// The solution is d = clamp(Aᵀy) of the y, as many as rows, that minimises the convex  μ|y|²/2 − r·y + Σ
  /// ∫clamp  of Aᵀy. Newton's method, with a search along each step: which components are held settles in two
  /// or three rounds mostly, and the step is then exact; it is within the bounds in any case.
  template <int Rows>
  bool solve_rows(double damping) {
    Few<Rows> y = {};
    Row u = {}, along;
    for (int j = 0; j < columns; ++j) step[j] = 0;
    for (int round = 0; round < 24; ++round) {
      bool free[max_columns];
      for (int j = 0; j < columns; ++j) free[j] = u[j] > low[j] && u[j] < high[j];
      if (round == 0)  // a step of 0 is free to go where there is room
        for (int j = 0; j < columns; ++j) free[j] = low[j] < high[j];
      Few<Rows> ahead;
      if (!solve_free<Rows>(free, damping, ahead)) return false;
      for (int i = 0; i < Rows; ++i) ahead[i] -= y[i];
      apply<Rows>(ahead, along);
      const double fraction = search<Rows>(damping, y, u, ahead, along);
      bool settled = fraction == 1;
      for (int i = 0; i < Rows; ++i) y[i] += fraction * ahead[i];
      held = 0;
      for (int j = 0; j < columns; ++j) {
        u[j] += fraction * along[j];
        const bool inside = u[j] > low[j] && u[j] < high[j];
        const double bounded = std::clamp(u[j], low[j], high[j]);
        settled = settled && inside == free[j] && (inside || bounded == step[j]);
        held += !inside;
        step[j] = bounded;
      }
      if (settled) break;
    }
    return true;
  }

  /// Aᵀy
  template <int Rows>
  void apply(const Few<Rows>& y, Row& u) const {
    for (int j = 0; j < columns; ++j) {
      u[j] = 0;
      for (int i = 0; i < Rows; ++i) u[j] += A[i][j] * y[i];
    }
  }

  /// The fraction of the way ahead at which the convex function is least, 1 if beyond: where its slope,
  /// increasing and straight between the bounds that are met, is 0.
  template <int Rows>
  double search(double damping, const Few<Rows>& y, const Row& u, const Few<Rows>& ahead,
                const Row& along) const {
    double start = 0, rise = 0;
    for (int i = 0; i < Rows; ++i) {
      start += (damping * y[i] - r[i]) * ahead[i];
      rise += damping * ahead[i] * ahead[i];
    }
    const auto slope = [&](double t) {
      double sum = start + t * rise;
      for (int j = 0; j < columns; ++j) sum += along[j] * std::clamp(u[j] + t * along[j], low[j], high[j]);
      return sum;
    };
    const double first = slope(0);
    double below = 0, above = 1, slope_below = first, slope_above = slope(1);
    if (!(slope_above > -1e-6 * first)) return 1;
    for (int i = 0; i < 24; ++i) {
      const double share = i % 3 == 2 ? 0.5 : -slope_below / (slope_above - slope_below);
      const double t = below + share * (above - below), at = slope(t);
      if (std::abs(at) < -1e-3 * first) return t;
      (at > 0 ? above : below) = t;
      (at > 0 ? slope_above : slope_below) = at;
    }
    return above;
  }

  template <int Rows>
  bool solve_free(const bool (&is_free)[max_columns], double damping, Few<Rows>& y) const {
    Row free[static_cast<std::size_t>(Rows)];
    for (int i = 0; i < Rows; ++i) {
      y[i] = r[i];
      for (int j = 0; j < columns; ++j) {
        free[i][j] = is_free[j] ? A[i][j] : 0;
        y[i] -= is_free[j] ? 0 : A[i][j] * step[j];
      }
    }
    Square<Rows> G;
    for (int i = 0; i < Rows; ++i)
      for (int k = 0; k <= i; ++k) {
        double even = 0, odd = 0;
        for (int j = 0; j < columns; j += 2) {
          even += free[i][j] * free[k][j];
          odd += free[i][j + 1] * free[k][j + 1];
        }
        G[i][k] = even + odd + (i == k ? damping : 0);
      }
    return cholesky<Rows>(G, y);
  }

  /// G⁻¹y into y, by the lower half of a symmetric positive G.
  template <int Rows>
  static bool cholesky(Square<Rows>& G, Few<Rows>& y) {
    Few<Rows> reciprocal;
    for (int i = 0; i < Rows; ++i) {
      for (int k = 0; k < i; ++k) {
        for (int j = 0; j < k; ++j) G[i][k] -= G[i][j] * G[k][j];
        G[i][k] *= reciprocal[k];
      }
      for (int j = 0; j < i; ++j) G[i][i] -= G[i][j] * G[i][j];
      if (!(G[i][i] > 0)) return false;
      reciprocal[i] = 1 / std::sqrt(G[i][i]);
      for (int j = 0; j < i; ++j) y[i] -= G[i][j] * y[j];
      y[i] *= reciprocal[i];
    }
    for (int i = Rows; i-- > 0;) {
      for (int j = i + 1; j < Rows; ++j) y[i] -= G[j][i] * y[j];
      y[i] *= reciprocal[i];
    }
    return true;
  }
};

}  // namespace sinew::inline v1
