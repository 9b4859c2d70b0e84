/// @file regular_lu.hpp
/// Factors of a matrix that is far enough from a singular one.
#pragma once
#include <Eigen/LU>

#include <cmath>
#include <optional>

namespace sinew::inline v1 {

/// A last pivot below this share of the largest [1] is one of rounding, which leaves about 1e-16 of it:
/// equations are scaled by their units, and pivots of regular ones are far above.
constexpr double smallest_pivot = 1e-13;

using RegularLu = Eigen::FullPivLU<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;
/// None where the matrix is singular or not finite.
inline std::optional<RegularLu> regular_lu(const RegularLu::MatrixType& matrix) {
  if (!matrix.allFinite()) return {};
  std::optional<RegularLu> lu(std::in_place, matrix);
  if (!(std::abs(lu->matrixLU().diagonal().tail(1)[0]) > smallest_pivot * lu->maxPivot())) return {};
  return lu;
}

}  // namespace sinew::inline v1
