/// @file equation36.hpp
/// The parasitic motion of the flexible tripod as the paper fits it. Theory: docs/theory/tripod_flexible.md
#pragma once
#include <array>

namespace sinew::inline v1::tripod {

/// c₀ to c₆; c₀ has no unit, the others are in m, and each stands with terms of several powers.
using Coefficients36 = std::array<double, 7>;
inline constexpr Coefficients36 printed_36{1.6, 0.077, 0.24, 0.64, 0.60, 0.11, 0.80};

struct Parasitic36 {
  double e3, x, y;  ///< [1, m, m]
};

/// With the signs of three terms of y that the symmetry by thirds of a turn asks for, or as printed; see
/// docs/errata.md.  @implements 3PFS (36)
Parasitic36 equation_36(const Coefficients36& c, double e1, double e2, bool as_printed = false);

}  // namespace sinew::inline v1::tripod
