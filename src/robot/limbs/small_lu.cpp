#include "robot/limbs/small_lu.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/at.hpp"

namespace sinew::inline v1 {

template <int N>
bool SmallLu<N>::factor(const double* matrix, double length) {
  per_length_ = 1 / length;
  const double scale[3] = {1, per_length_, per_length_ * per_length_};
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < size; ++j)
      lu_[size * i + j] = matrix[size * i + j] * scale[(i >= forces) + (j >= forces)];
  double largest = 0;
  smallest_ = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < size; ++k) {
    std::size_t best = k;
    for (std::size_t i = k + 1; i < size; ++i)
      if (std::abs(lu_[size * i + k]) > std::abs(lu_[size * best + k])) best = i;
    order_[k] = static_cast<int>(best);
    if (best != k) std::swap_ranges(&lu_[size * k], &lu_[size * k] + size, &lu_[size * best]);
    const double pivot = lu_[(size + 1) * k];
    if (!(std::abs(pivot) > 0)) {  // what is solved by it then is no number
      lu_.fill(std::numeric_limits<double>::quiet_NaN());
      order_.fill(static_cast<int>(k));
      smallest_ = 0;
      return false;
    }
    largest = std::max(largest, std::abs(pivot));
    smallest_ = std::min(smallest_, std::abs(pivot));
    lu_[(size + 1) * k] = 1 / pivot;
    for (std::size_t i = k + 1; i < size; ++i) {
      const double factor = lu_[size * i + k] *= lu_[(size + 1) * k];
      for (std::size_t j = k + 1; j < size; ++j) lu_[size * i + j] -= factor * lu_[size * k + j];
    }
  }
  smallest_ /= largest;
  return std::isfinite(smallest_);
}

template <int N>
bool SmallLu<N>::has_negative_determinant() const {
  bool is_negative = false;
  for (std::size_t k = 0; k < size; ++k)
    is_negative ^= (lu_[(size + 1) * k] < 0) != (order_[k] != static_cast<int>(k));
  return is_negative;
}

template <int N>
void SmallLu<N>::solve(const double* rhs, double* x) const {
  for (std::size_t i = 0; i < size; ++i) x[i] = i < forces ? rhs[i] : rhs[i] * per_length_;
  for (std::size_t k = 0; k < size; ++k) std::swap(x[k], x[at(order_[k])]);
  for (std::size_t i = 1; i < size; ++i)
    for (std::size_t k = 0; k < i; ++k) x[i] -= lu_[size * i + k] * x[k];
  for (std::size_t i = size; i-- > 0;) {
    for (std::size_t k = i + 1; k < size; ++k) x[i] -= lu_[size * i + k] * x[k];
    x[i] *= lu_[(size + 1) * i];
  }
  for (std::size_t i = forces; i < size; ++i) x[i] *= per_length_;
}

template class SmallLu<3>;
template class SmallLu<6>;

}  // namespace sinew::inline v1
