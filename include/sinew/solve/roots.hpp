/// @file roots.hpp
/// All roots of a smooth function of one variable on an interval, with proof: a bound on |f″| decides on every
/// subinterval that it holds no root, or at most one. Theory: docs/theory/roots.md
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "sinew/base/export.hpp"

namespace sinew::inline v0 {

/// Value and derivative of a function of one variable.
struct ValueAndRate {
  double value;
  double rate;
};

struct RootsOptions {
  double low, high;     ///< the interval searched
  double rate_rate;     ///< bound on |f″| there
  double value_noise;   ///< rounding error of a value of f: where |f| stays below it, a double root is reported
};

namespace detail {

/// The root in [low, high] of a function that changes sign once there: Newton, kept inside by bisection.
template <class F>
double bracketed_root(const F& f, double low, double high, bool rising) {
  double x = 0.5 * (low + high);
  for (int i = 0; i < 100; ++i) {
    const ValueAndRate here = f(x);
    if (here.value == 0) return x;
    ((here.value > 0) == rising ? high : low) = x;
    const double newton = x - here.value / here.rate;
    const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
    if (std::abs(next - x) <= 2 * std::numeric_limits<double>::epsilon() * std::abs(next) || next == x) return next;
    x = next;
  }
  return x;
}

}  // namespace detail

/// Writes the roots in ascending order and returns how many there are (at most roots.size(), the lowest ones);
/// -1 where f is not finite or the interval is not resolved within 10 000 cells (a few dozen are usual).
/// A double root, where two solutions merge, is written once.
template <class F>
int all_roots(const F& f, const RootsOptions& options, std::span<double> roots) {
  struct Interval {
    double low, high;
  };
  std::array<Interval, 128> stack;  // depth-first, left first: never holds more than one interval a level
  std::size_t pending = 0;
  stack[pending++] = {options.low, options.high};
  std::size_t count = 0;
  const double smallest = 1e-8 * (options.high - options.low);
  double last = -std::numeric_limits<double>::infinity();
  const auto add = [&](double x) {
    const bool same = x - last <= 4 * smallest;  // a shared end point, or one more cell of a double root
    last = x;
    if (!same && count < roots.size()) roots[count++] = x;
  };
  for (int cells = 0; pending > 0 && count < roots.size(); ++cells) {
    const auto [low, high] = stack[--pending];
    const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
    const ValueAndRate m = f(middle);
    if (cells > 10000 || !std::isfinite(m.value)) return -1;
    const double bend = options.rate_rate * half;
    const double slope = std::abs(m.rate);
    if (std::abs(m.value) > slope * half + 0.5 * bend * half + options.value_noise) continue;  // no root here
    if (slope > bend) {  // monotone: at most one root
      const double at_low = f(low).value, at_high = f(high).value;
      if ((at_low <= 0) != (at_high <= 0)) add(detail::bracketed_root(f, low, high, m.rate > 0));
      continue;
    }
    if (half < smallest) {  // a minimum of |f| within rounding of zero
      add(middle);
      continue;
    }
    stack[pending++] = {middle, high};
    stack[pending++] = {low, middle};
  }
  return static_cast<int>(count);
}

}  // namespace sinew::inline v0
