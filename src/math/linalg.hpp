/// @file linalg.hpp
/// Decompositions of small matrices of run-time size, behind plain functions: compiling Eigen's takes seconds
/// a file, and one object file pays for it. Nothing here allocates for up to 24 rows and columns; larger is a
/// broken precondition (in a release build it is answered like numbers that are not finite: by NaN or false).
/// Matrices are rows first; an output span may not overlap an input.
#pragma once
#include <array>
#include <cstddef>
#include <span>

#include "base/limits.hpp"
#include "sinew/math/vec.hpp"

namespace sinew::inline v1 {

/// A = U·diag(σ)·Vᵀ, σ descending. U and V are square, columns are vectors: the last columns of V from `rank`
/// on span the null space of A, those of U that of Aᵀ.
struct Svd {
  int rows = 0, columns = 0;
  std::array<double, max_rows> sigma_data;         ///< read by `sigma`
  std::array<double, max_rows * max_rows> u_data;  ///< read by `u`
  std::array<double, max_rows * max_rows> v_data;  ///< read by `v`

  /// Number of singular values.
  int count() const { return rows < columns ? rows : columns; }
  /// The singular values, descending.
  std::span<const double> sigma() const { return {sigma_data.data(), static_cast<std::size_t>(count())}; }
  MatrixView u() const { return {u_data.data(), rows, rows}; }        ///< U, rows × rows
  MatrixView v() const { return {v_data.data(), columns, columns}; }  ///< V, columns × columns
};

/// min(rows, columns) singular values into `out`, descending. Those of a 3×3 matrix each to 1e-13 of itself,
/// however ill-conditioned the matrix; others to a few eps of the largest. Allocates for more columns than
/// max_rows.
void singular_values(const MatrixView& a, std::span<double> out);

/// The decomposition of a matrix of at most `max_rows` rows and columns.
Svd svd(const MatrixView& a);

/// How many singular values exceed tolerance·(the largest); 0 for a matrix of zeros.
int rank(std::span<const double> sigma, double tolerance = 1e-12);

/// J⁻¹B (n×m, rows first) into `out`, by LU with partial pivoting. False, and `out` not to be used, if J is
/// singular to working precision (estimated reciprocal condition number below n eps) or not finite.
[[nodiscard]] bool solve(const MatrixView& j, const MatrixView& b, std::span<double> out);

/// The shortest x that minimises |A x − b|, into `out`; singular values up to tolerance·(the largest) count
/// as 0. Returns the rank.
int least_norm(const MatrixView& a, std::span<const double> b, std::span<double> out,
               double tolerance = 1e-12);

/// Eigenvalues of the symmetric part (A + Aᵀ)/2 of a square matrix, ascending, into `values`; where `vectors`
/// is not empty the eigenvectors too, one a row.
void symmetric_eigenvalues(const MatrixView& a, std::span<double> values, std::span<double> vectors = {});

/// How many eigenvalues of the symmetric part are negative. Of a matrix that is clearly positive definite, as
/// most stiffnesses are, it is told by its pivots, in a tenth of the time.
int count_negative_eigenvalues(const MatrixView& a);

/// How many eigenvalues of a square matrix have a real part below 0; none where an entry is not finite.
int count_left_of_zero(const MatrixView& a);

/// Of a square matrix.
double determinant(const MatrixView& a);

}  // namespace sinew::inline v1
