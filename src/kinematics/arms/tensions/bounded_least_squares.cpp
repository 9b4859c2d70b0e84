#include "kinematics/arms/tensions/bounded_least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/base/numbers.hpp"

namespace sinew::inline v1 {
namespace {

/// Weight of the centre over the mean square of A's columns [1]: small beside what A tells, and still 1e9
/// times what rounding leaves of a square where A tells nothing.
constexpr double centre_weight = 1e-7;
/// Rounds of the active set for each unknown [1]: each binds one or more of them, or frees one and lowers the
/// squares; rounding that goes round in circles ends here, at tensions that are within their bounds.
constexpr std::size_t most_active_sets = 10;
/// Slope of the squares, over those of A, below which freeing a tension gains nothing but rounding [1].
constexpr double least_gain = 1e-12;
/// In place of 0 where that would be divided by.
constexpr double hardly_any = 1e-300;

/// By Cholesky's method. @param matrix n × n
std::vector<double> solve_positive(std::vector<double> matrix, const std::vector<double>& right) {
  const std::size_t n = right.size();
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t j = 0; j < k; ++j) matrix[k * n + k] -= matrix[k * n + j] * matrix[k * n + j];
    matrix[k * n + k] = std::sqrt(std::max(matrix[k * n + k], hardly_any));
    for (std::size_t i = k + 1; i < n; ++i) {
      for (std::size_t j = 0; j < k; ++j) matrix[i * n + k] -= matrix[i * n + j] * matrix[k * n + j];
      matrix[i * n + k] /= matrix[k * n + k];
    }
  }
  std::vector<double> found = right;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < i; ++j) found[i] -= matrix[i * n + j] * found[j];
    found[i] /= matrix[i * n + i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t j = i + 1; j < n; ++j) found[i] -= matrix[j * n + i] * found[j];
    found[i] /= matrix[i * n + i];
  }
  return found;
}

/// (AᵀA + small) x = Aᵀb + small centre, with bounds on x.
class NormalEquations {
 public:
  NormalEquations(const std::vector<double>& A, const std::vector<double>& b,
                  const std::vector<double>& centre, double most)
      : m_(centre.size()),
        most_(most),
        normal_(m_ * m_, 0.0),
        side_(m_, 0.0),
        x_(centre),
        state_(m_, At::free) {
    for (double& value : x_) value = std::clamp(value, 0.0, most_);
    for (const double a : A) size_ += a * a;
    const double small = centre_weight * size_ / static_cast<double>(m_) + hardly_any;
    for (std::size_t i = 0; i < m_; ++i) {
      side_[i] = small * centre[i];
      for (std::size_t r = 0; r < b.size(); ++r) side_[i] += A[r * m_ + i] * b[r];
      for (std::size_t j = 0; j < m_; ++j)
        for (std::size_t r = 0; r < b.size(); ++r) normal_[i * m_ + j] += A[r * m_ + i] * A[r * m_ + j];
      normal_[i * m_ + i] += small;
    }
  }
  /// By an active set, from within the bounds: the squares only fall.
  std::vector<double> solve() {
    for (std::size_t round = 0; round < most_active_sets * m_; ++round)
      if (!solve_free() && !free_one()) break;
    return x_;
  }

 private:
  enum class At { low, free, high };

  /// Those that are free, the others at their bounds; as far as the first bound on the way.
  /// @returns whether one of them had to be bound
  bool solve_free() {
    std::vector<std::size_t> free;
    for (std::size_t i = 0; i < m_; ++i)
      if (state_[i] == At::free) free.push_back(i);
    const std::size_t n = free.size();
    std::vector<double> matrix(n * n), right(n);
    for (std::size_t i = 0; i < n; ++i) {
      right[i] = side_[free[i]];
      for (std::size_t j = 0; j < m_; ++j)
        if (state_[j] == At::high) right[i] -= normal_[free[i] * m_ + j] * most_;
      for (std::size_t j = 0; j < n; ++j) matrix[i * n + j] = normal_[free[i] * m_ + free[j]];
    }
    const std::vector<double> found = solve_positive(std::move(matrix), right);
    // Of the way up to the bound that it crosses: 0 where x is at the bound already, 1 where it crosses none.
    const auto share_to_bound = [&](std::size_t i) {
      const double from = x_[free[i]], to = found[i];
      return to < 0 ? from / (from - to) : to > most_ ? (most_ - from) / (to - from) : 1;
    };
    double share = 1;
    for (std::size_t i = 0; i < n; ++i) share = std::min(share, share_to_bound(i));
    bool is_bound = false;
    for (std::size_t i = 0; i < n; ++i) {
      double& x = x_[free[i]];
      if ((found[i] < 0 || found[i] > most_) && share_to_bound(i) <= share) {
        state_[free[i]] = found[i] < 0 ? At::low : At::high;
        x = found[i] < 0 ? 0 : most_;
        is_bound = true;
      } else {
        x = share < 1 ? std::clamp(x + share * (found[i] - x), 0.0, most_) : found[i];
      }
    }
    return is_bound;
  }
  /// That by which the squares fall most. @returns whether there is one
  bool free_one() {
    std::size_t worst = m_;
    double gain = least_gain * size_;
    for (std::size_t i = 0; i < m_; ++i) {
      if (state_[i] == At::free) continue;
      double slope = side_[i];
      for (std::size_t j = 0; j < m_; ++j) slope -= normal_[i * m_ + j] * x_[j];
      if (state_[i] == At::high) slope = -slope;
      if (slope > gain) gain = slope, worst = i;
    }
    if (worst == m_) return false;
    state_[worst] = At::free;
    return true;
  }

  std::size_t m_;
  double most_, size_ = 0;
  std::vector<double> normal_, side_, x_;
  std::vector<At> state_;
};

/// Solves, each of what the ones before left because of the centre's weight [1]: each leaves about that share
/// of it, so that after these only rounding is.
constexpr int weighted_solves = 4;

}  // namespace

std::vector<double> bounded_least_squares(const std::vector<double>& A, const std::vector<double>& b,
                                          const std::vector<double>& centre, double most) {
  const auto is_finite = [](double x) { return std::isfinite(x); };
  const std::size_t m = centre.size();
  if (!std::ranges::all_of(A, is_finite) || !std::ranges::all_of(b, is_finite) ||
      !std::ranges::all_of(centre, is_finite) || std::isnan(most))
    return std::vector<double>(m, not_a_number);
  std::vector<double> asked = b, x;
  for (int round = 0; round < weighted_solves; ++round) {
    x = NormalEquations(A, asked, centre, most).solve();
    for (std::size_t r = 0; r < b.size(); ++r) {
      double left = b[r];
      for (std::size_t i = 0; i < m; ++i) left -= A[r * m + i] * x[i];
      asked[r] += left;
    }
  }
  return x;
}

}  // namespace sinew::inline v1
