/// @file small_lu.hpp
/// The factors of a platform's stiffness.
#pragma once
#include <array>

namespace sinew::inline v1 {

/// LU factors, with partial pivoting, of an N×N matrix that takes twists to wrenches, its moments divided by
/// a length first.
/// @tparam N 3 in the plane, where the last row is a moment, or 6, where the last three are
template <int N>
class SmallLu {
 public:
  /// False where a pivot is 0 or not a number.
  bool factor(const double* matrix, double length);
  void solve(const double* rhs, double* x) const;
  double smallest_pivot() const { return smallest_; }  ///< over the largest, 0 to 1
  bool has_negative_determinant() const;

 private:
  static constexpr std::size_t size = N, forces = N == 3 ? 2 : 3;
  std::array<double, size * size> lu_;
  std::array<int, size> order_{};
  double per_length_ = 1, smallest_ = 0;
};

}  // namespace sinew::inline v1
