/// @file spread.hpp
/// Low-discrepancy numbers: many starts that leave no gap.
#pragma once

namespace sinew::inline v1 {

/// The k-th number of van der Corput to a prime base, in (−1, 1).
inline double spread_number(int k, int base) {
  double value = 0, part = 1;
  for (int n = k + 1; n > 0; n /= base) {
    part /= base;
    value += part * (n % base);
  }
  return 2 * value - 1;
}

}  // namespace sinew::inline v1
