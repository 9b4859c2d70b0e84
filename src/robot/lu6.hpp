/// @file lu6.hpp
/// The factors of a platform's stiffness.
#pragma once
#include <array>

namespace sinew::inline v0 {

/// LU factors of a 6×6 matrix whose moments are divided by a length first, with partial pivoting.
class Lu6 {
 public:
  /// False where a pivot is 0 or not a number.
  bool factor(const double* matrix, double length);
  void solve(const double* rhs, double* x) const;
  double smallest_pivot() const { return smallest_; }  ///< over the largest, 0 to 1
  bool has_negative_determinant() const;

 private:
  std::array<double, 36> lu_;
  std::array<int, 6> order_{};
  double per_length_ = 1, smallest_ = 0;
};

}  // namespace sinew::inline v0
