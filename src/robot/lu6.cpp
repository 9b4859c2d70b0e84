#include "robot/lu6.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/at.hpp"

namespace sinew::inline v0 {

bool Lu6::factor(const double* matrix, double length) {
  per_length_ = 1 / length;
  const double scale[3] = {1, per_length_, per_length_ * per_length_};
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) lu_[6 * i + j] = matrix[6 * i + j] * scale[(i > 2) + (j > 2)];
  double largest = 0;
  smallest_ = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 6; ++k) {
    std::size_t best = k;
    for (std::size_t i = k + 1; i < 6; ++i)
      if (std::abs(lu_[6 * i + k]) > std::abs(lu_[6 * best + k])) best = i;
    order_[k] = static_cast<int>(best);
    if (best != k) std::swap_ranges(&lu_[6 * k], &lu_[6 * k] + 6, &lu_[6 * best]);
    const double pivot = lu_[7 * k];
    if (!(std::abs(pivot) > 0)) return false;
    largest = std::max(largest, std::abs(pivot));
    smallest_ = std::min(smallest_, std::abs(pivot));
    lu_[7 * k] = 1 / pivot;
    for (std::size_t i = k + 1; i < 6; ++i) {
      const double factor = lu_[6 * i + k] *= lu_[7 * k];
      for (std::size_t j = k + 1; j < 6; ++j) lu_[6 * i + j] -= factor * lu_[6 * k + j];
    }
  }
  smallest_ /= largest;
  return std::isfinite(smallest_);
}

bool Lu6::has_negative_determinant() const {
  bool is_negative = false;
  for (std::size_t k = 0; k < 6; ++k) is_negative ^= (lu_[7 * k] < 0) != (order_[k] != static_cast<int>(k));
  return is_negative;
}

void Lu6::solve(const double* rhs, double* x) const {
  for (std::size_t i = 0; i < 6; ++i) x[i] = i < 3 ? rhs[i] : rhs[i] * per_length_;
  for (std::size_t k = 0; k < 6; ++k) std::swap(x[k], x[at(order_[k])]);
  for (std::size_t i = 1; i < 6; ++i)
    for (std::size_t k = 0; k < i; ++k) x[i] -= lu_[6 * i + k] * x[k];
  for (std::size_t i = 6; i-- > 0;) {
    for (std::size_t k = i + 1; k < 6; ++k) x[i] -= lu_[6 * i + k] * x[k];
    x[i] *= lu_[7 * i];
  }
  for (std::size_t i = 3; i < 6; ++i) x[i] *= per_length_;
}

}  // namespace sinew::inline v0
