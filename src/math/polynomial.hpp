/// @file polynomial.hpp
/// Real roots of a real polynomial in an interval, none skipped: between two critical points there is at most
/// one, and the critical points are the roots of the derivative, down to the linear one. A root where the
/// polynomial only touches zero is a critical point, so it is found even where rounding lifts it off zero.
/// Theory: docs/theory/assembly_modes.md
#pragma once
#include <array>
#include <span>

namespace sinew::inline v1 {

/// Highest degree `real_roots` takes.
inline constexpr int max_degree = 6;

struct PolynomialRoot {
  double x;
  bool touches;  ///< |p| is within rounding of zero at this critical point: a multiple root, or nearly one
};

/// Ascending; a touching root may have the crossings it stands for beside it, or none.
struct PolynomialRoots {
  int count = 0;
  std::array<PolynomialRoot, (1 << max_degree) - 1> root;  // not initialised: only the first `count` are read

  const PolynomialRoot* begin() const { return root.data(); }
  const PolynomialRoot* end() const { return root.data() + count; }
};

struct PolynomialOptions {
  double low = -1, high = 1;  ///< the interval searched
  double touch = 1e-12;       ///< zero within rounding: |p(x)| ≤ touch·max|cₖ|·max(1, |x|)ⁿ
};

/// Roots of c₀ + c₁x + … + cₙxⁿ, n ≤ `max_degree`. No heap, bounded work. None where a coefficient is not
/// finite.
PolynomialRoots real_roots(std::span<const double> coefficients, const PolynomialOptions& options);

}  // namespace sinew::inline v1
