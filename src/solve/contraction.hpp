/// @file contraction.hpp
/// Newton's method from near by, where it contracts or else is given up: what corrects a step along a curve,
/// and what follows a target that moves a little. From anywhere: sinew/solve/newton.hpp. Theory:
/// docs/theory/continuation.md
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

namespace sinew::inline v1 {

/// The larger of two errors; NaN stays.
inline double worse(double a, double b) {
  return std::isfinite(b) ? std::max(a, std::abs(b)) : std::numeric_limits<double>::quiet_NaN();
}

/// Newton's method as long as each step halves the error, at most twelve of them; on below `tolerance` while
/// it gains a digit a step, down to `rounding`.
/// @param error evaluates where the problem is; @param step moves it, false where it cannot
/// @param residual is left alone where it does not contract
template <class Error, class Step>
bool contract(Error&& error, Step&& step, double tolerance, double rounding, int& iterations,
              double& residual) {
  double here = error();
  for (int k = 0; k < 12 && !(here <= rounding); ++k) {
    if (!step()) return false;
    ++iterations;
    const double next = error();
    const bool is_done = next <= tolerance, gains = next < 0.1 * here;
    if (!is_done && !(next < 0.5 * here)) return false;
    here = next;
    if (is_done && !gains) break;
  }
  residual = here;
  return here <= tolerance;
}

/// The same with factors kept from before: a step or two with those, until new ones would end it at once,
/// then with new ones, and with those kept as long as they gain as much as newer ones would.
/// @param error evaluates where the problem is
/// @param renew factors there; @param step moves it, with `true` right after `renew`; false where it cannot
/// @param here the error where it begins; infinite where it is not known
template <class Error, class Renew, class Step>
bool contract_with_kept_factors(Error&& error, Renew&& renew, Step&& step, double tolerance, double here,
                                int& iterations, double& residual) {
  constexpr double worth_starting = 1e-6, worth_renewing = 3e-9;
  int renewals = 0;
  for (int& k = iterations; !(here <= tolerance); ++k) {
    const bool renews =
        renewals == 0 ? k == 2 || (k == 1 && here < worth_starting) : renewals < 3 && here > worth_renewing;
    if (renews && !renew()) return false;
    renewals += renews;
    if (!step(renews)) return false;
    const double next = error();
    if (renewals > 0 && !(next < 0.3 * here) && !(next <= tolerance)) return false;
    if (k > 10) return false;
    here = next;
  }
  residual = here;
  return true;
}

}  // namespace sinew::inline v1
