/// @file symmetric_factors.hpp
/// LDLᵀ of a small symmetric matrix, definite or not.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>

namespace sinew::inline v1 {

/// P M Pᵀ = L D Lᵀ with D of 1×1 and 2×2 blocks, by complete pivoting (Bunch and Parlett 1971): as stable as
/// LU, and its blocks tell how many eigenvalues are negative (Sylvester's law of inertia).
/// @tparam Max most rows
template <std::size_t Max>
class SymmetricFactors {
 public:
  using Square = std::array<std::array<double, Max>, Max>;

  /// Of a singular matrix the solutions are no numbers.
  void factor(const Square& matrix, std::size_t size) {
    m_ = matrix;
    size_ = size;
    negatives_ = 0;
    for (std::size_t k = 0; k < size_; ++k) order_[k] = k;
    for (std::size_t k = 0; k < size_; k += blocks_[k]) {
      blocks_[k] = choose(k);
      if (blocks_[k] == 1) {
        eliminate_one(k);
      } else {
        blocks_[k + 1] = 0;
        eliminate_pair(k);
      }
    }
  }

  /// M⁻¹ x in place.
  void solve(std::array<double, Max>& x) const {
    std::array<double, Max> y{};
    for (std::size_t k = 0; k < size_; ++k) y[k] = x[order_[k]];
    for (std::size_t k = 0; k < size_; k += blocks_[k])
      for (std::size_t i = k + blocks_[k]; i < size_; ++i)
        for (std::size_t j = k; j < k + blocks_[k]; ++j) y[i] -= m_[i][j] * y[j];
    for (std::size_t k = 0; k < size_; k += blocks_[k]) {
      if (blocks_[k] == 1) {
        y[k] /= m_[k][k];
      } else {
        const auto [first, second] = over_pair(k, y[k], y[k + 1]);
        y[k] = first, y[k + 1] = second;
      }
    }
    for (std::size_t j = size_; j-- > 0;)
      for (std::size_t i = j + 1 + (blocks_[j] == 2); i < size_; ++i) y[j] -= m_[i][j] * y[i];
    for (std::size_t k = 0; k < size_; ++k) x[order_[k]] = y[k];
  }

  int negatives() const { return negatives_; }  ///< negative eigenvalues

 private:
  /// Brings the next block to row k. How many rows it has.
  std::size_t choose(std::size_t k) {
    constexpr double alpha = 0.6403882032022076;  // (1 + √17)/8: bounds how much entries grow
    std::size_t on = k, row = k, column = k;
    double beside = 0;
    for (std::size_t i = k; i < size_; ++i) {
      if (std::abs(m_[i][i]) > std::abs(m_[on][on])) on = i;
      for (std::size_t j = k; j < i; ++j)
        if (std::abs(m_[i][j]) > beside) beside = std::abs(m_[i][j]), row = i, column = j;
    }
    if (!(std::abs(m_[on][on]) < alpha * beside)) {  // also where one is no number
      exchange(k, on);
      return 1;
    }
    exchange(k, column);
    exchange(k + 1, row);
    return 2;
  }

  void exchange(std::size_t a, std::size_t b) {
    if (a == b) return;
    std::swap(order_[a], order_[b]);
    std::swap(m_[a], m_[b]);
    for (auto& row : m_) std::swap(row[a], row[b]);
  }

  void eliminate_one(std::size_t k) {
    negatives_ += m_[k][k] < 0;
    for (std::size_t i = k + 1; i < size_; ++i) {
      m_[i][k] = m_[k][i] / m_[k][k];
      for (std::size_t j = k + 1; j <= i; ++j) m_[j][i] = m_[i][j] -= m_[i][k] * m_[k][j];
    }
  }

  void eliminate_pair(std::size_t k) {
    const double determinant = m_[k][k] * m_[k + 1][k + 1] - m_[k][k + 1] * m_[k][k + 1];
    negatives_ += determinant < 0 ? 1 : 2 * (m_[k][k] < 0);
    for (std::size_t i = k + 2; i < size_; ++i) {
      std::tie(m_[i][k], m_[i][k + 1]) = over_pair(k, m_[k][i], m_[k + 1][i]);
      for (std::size_t j = k + 2; j <= i; ++j)
        m_[j][i] = m_[i][j] -= m_[i][k] * m_[k][j] + m_[i][k + 1] * m_[k + 1][j];
    }
  }

  /// The inverse of the 2×2 block at k times (x, y).
  std::pair<double, double> over_pair(std::size_t k, double x, double y) const {
    const double a = m_[k][k], b = m_[k][k + 1], c = m_[k + 1][k + 1], determinant = a * c - b * b;
    return {(c * x - b * y) / determinant, (a * y - b * x) / determinant};
  }

  Square m_;  ///< D on the diagonal and above it, L below
  std::size_t size_ = 0;
  std::array<std::size_t, Max> order_{}, blocks_{};  ///< rows of the block that begins at a row
  int negatives_ = 0;
};

}  // namespace sinew::inline v1
