/// @file elimination.hpp
/// Small linear systems of run-time size in caller's memory. The library's LU of run-time size takes several
/// times as long on ten rows, most of it bookkeeping, and a minute to compile for all its shapes.
#pragma once
#include <algorithm>
#include <cmath>
#include <utility>

namespace sinew::inline v0 {

/// Overwrites the right-hand sides (rows × sides) with the solution and A (rows × rows, `stride` apart) with
/// its factors, by Gaussian elimination with partial pivoting. A singular A gives numbers that are not
/// finite. Returns whether its determinant is negative.
inline bool eliminate(double* A, int rows, int stride, double* right, int sides) {
  bool is_negative = false;
  for (int k = 0; k < rows; ++k) {
    double* const pivot = A + k * stride;
    int best = k;
    for (int i = k + 1; i < rows; ++i)
      if (std::abs(A[i * stride + k]) > std::abs(A[best * stride + k])) best = i;
    if (best != k) {
      is_negative = !is_negative;
      std::swap_ranges(pivot + k, pivot + rows, A + best * stride + k);
      std::swap_ranges(right + k * sides, right + (k + 1) * sides, right + best * sides);
    }
    const double inverse = 1 / pivot[k];
    is_negative ^= inverse < 0;
    for (int i = k + 1; i < rows; ++i) {
      double* const row = A + i * stride;
      const double share = row[k] * inverse;
      if (share == 0) continue;
      for (int j = k + 1; j < rows; ++j) row[j] -= share * pivot[j];
      for (int j = 0; j < sides; ++j) right[i * sides + j] -= share * right[k * sides + j];
    }
  }
  for (int k = rows - 1; k >= 0; --k) {
    const double inverse = 1 / A[k * stride + k];
    double* const own = right + k * sides;
    for (int j = 0; j < sides; ++j) own[j] *= inverse;
    for (int i = 0; i < k; ++i)
      for (int j = 0; j < sides; ++j) right[i * sides + j] -= A[i * stride + k] * own[j];
  }
  return is_negative;
}

}  // namespace sinew::inline v0
