#include "math/polynomial.hpp"

#include <algorithm>
#include <cmath>

#include "base/assert.hpp"
#include "math/polygon.hpp"

namespace sinew::inline v1 {
namespace {

struct Sample {
  double value, rate;
};

/// A polynomial of a degree known at run time.
struct Polynomial {
  int degree = 0;
  std::array<double, max_degree + 1> c{};

  double coefficient(int k) const { return c[static_cast<std::size_t>(k)]; }

  Sample at(double x) const {  // Horner
    Sample p{coefficient(degree), 0};
    for (int k = degree - 1; k >= 0; --k) p = {p.value * x + coefficient(k), p.rate * x + p.value};
    return p;
  }
  /// What rounding of the largest coefficient can do at x, in units of eps.
  double magnitude(double x) const {
    double largest = 0, power = 1;
    for (int k = 0; k <= degree; ++k) largest = std::max(largest, std::abs(coefficient(k)));
    for (int k = 0; k < degree; ++k) power *= std::max(1.0, std::abs(x));
    return largest * power;
  }
  Polynomial derivative() const {
    Polynomial d{degree - 1, {}};
    for (int k = 1; k <= degree; ++k) d.c[static_cast<std::size_t>(k - 1)] = k * coefficient(k);
    return d;
  }
};

struct End {
  double x, value;
};

/// The root between two points of opposite sign: Newton, and a halving where it would leave the bracket or
/// converges slower than one.
double crossing(const Polynomial& p, End low, End high, double accuracy) {
  double x = 0.5 * (low.x + high.x), before = high.x - low.x;
  for (int i = 0; i < 100; ++i) {
    const Sample here = p.at(x);
    (here.value < 0) == (low.value < 0) ? low.x = x : high.x = x;
    const double newton = x - here.value / here.rate;
    const bool trusted = newton > low.x && newton < high.x && std::abs(newton - x) < 0.5 * before;
    const double next = trusted ? newton : 0.5 * (low.x + high.x);
    before = std::abs(next - x);
    x = next;
    if (before <= accuracy * std::max(std::abs(x), 1e-3)) break;
  }
  return x;
}

/// Roots of p, given those of its derivative.
PolynomialRoots between(const Polynomial& p, const PolynomialRoots& critical,
                        const PolynomialOptions& options, double accuracy) {
  PolynomialRoots roots;
  const auto add = [&](PolynomialRoot root) { roots.root[static_cast<std::size_t>(roots.count++)] = root; };
  End before{options.low, p.at(options.low).value};
  const auto walk_to = [&](double x) {
    const End here{x, p.at(x).value};
    if ((before.value < 0 && here.value > 0) || (before.value > 0 && here.value < 0))
      add({crossing(p, before, here, accuracy), false});
    before = here;
  };
  for (const PolynomialRoot& point : critical) {
    walk_to(point.x);
    if (std::abs(before.value) <= options.touch * p.magnitude(point.x)) add({point.x, true});
  }
  walk_to(options.high);
  return roots;
}

}  // namespace

PolynomialRoots real_roots(std::span<const double> coefficients, const PolynomialOptions& options) {
  SINEW_EXPECTS(!coefficients.empty() && coefficients.size() <= max_degree + 1);
  std::array<Polynomial, max_degree + 1> level;
  const int degree = static_cast<int>(std::min<std::size_t>(coefficients.size(), max_degree + 1)) - 1;
  if (degree < 1) return {};
  const auto finite = [](double c) { return std::isfinite(c); };
  if (!std::all_of(coefficients.begin(), coefficients.end(), finite)) return {};
  level[0].degree = degree;
  std::copy_n(coefficients.begin(), degree + 1, level[0].c.begin());
  for (std::size_t k = 1; k < static_cast<std::size_t>(degree); ++k) level[k] = level[k - 1].derivative();

  PolynomialRoots roots;
  // A critical point that is off by δ shows p off by ½p″δ² only: half the digits are enough.
  for (int k = degree - 1; k >= 0; --k)
    roots = between(level[static_cast<std::size_t>(k)], roots, options, k == 0 ? 1e-15 : 1e-9);
  return roots;
}

}  // namespace sinew::inline v1
