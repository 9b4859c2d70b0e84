/// @file interpolation.hpp
/// Polynomials on given points, in the extended precision tables are made in.
#pragma once
#include <array>
#include <cstddef>
#include <utility>

namespace sinew::inline v1 {

using Real = long double;

/// Legendre polynomials of degree n − 1 and n at x.
inline std::pair<Real, Real> legendre(std::size_t n, Real x) {
  Real before = 1, value = x;
  for (std::size_t k = 2; k <= n; ++k) {
    const Real next = (Real(2 * k - 1) * x * value - Real(k - 1) * before) / Real(k);
    before = value;
    value = next;
  }
  return {before, value};
}

/// ℓⱼ′ at zᵢ, for all i and j: by barycentric weights, as every program that links this waits for it.
template <std::size_t M>
std::array<std::array<Real, M>, M> lagrange_slopes(const std::array<Real, M>& z) {
  std::array<Real, M> weight;
  for (std::size_t j = 0; j < M; ++j) {
    weight[j] = 1;
    for (std::size_t m = 0; m < M; ++m)
      if (m != j) weight[j] /= z[j] - z[m];
  }
  std::array<std::array<Real, M>, M> slope{};
  for (std::size_t i = 0; i < M; ++i)
    for (std::size_t j = 0; j < M; ++j) {
      if (i == j) continue;
      slope[i][j] = weight[j] / (weight[i] * (z[i] - z[j]));
      slope[i][i] += 1 / (z[i] - z[j]);
    }
  return slope;
}

}  // namespace sinew::inline v1
