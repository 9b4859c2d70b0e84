/// @file bounded_least_squares.hpp
/// Least squares with bounds: what tensions make a step, none of which may push.
#pragma once
#include <vector>

namespace sinew::inline v1 {

/// Of all 0 ≤ x ≤ most that make A x = b as nearly as can be the one nearest to `centre`.
/// As nearly and as near as rounding and a small weight of `centre` let it, which columns need to be of like
/// size for. Not numbers where something is not finite, but `most`, which may be infinite.
/// @param A rows × as many columns as `centre` has numbers, rows first
std::vector<double> bounded_least_squares(const std::vector<double>& A, const std::vector<double>& b,
                                          const std::vector<double>& centre, double most);

}  // namespace sinew::inline v1
