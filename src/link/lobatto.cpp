#include "link/lobatto.hpp"

#include <cmath>
#include <numbers>

#include "link/interpolation.hpp"

namespace sinew::inline v1 {

/// The inner nodes are where P_N′ vanishes: Newton's method from those of Chebyshev, by Legendre's equation.
template <std::size_t N>
LobattoBasis<N> LobattoBasis<N>::make() {
  constexpr Real degree = N;
  std::array<Real, N + 1> z, weight;
  for (std::size_t i = 0; i <= N; ++i) {
    Real x = i == 0 ? -1 : i == N ? 1 : -std::cos(std::numbers::pi_v<Real> * Real(i) / degree);
    for (int k = 0; k < 12 && i > 0 && i < N; ++k) {
      const auto [before, value] = legendre(N, x);
      const Real slope = degree * (before - x * value) / (1 - x * x);
      x -= slope * (1 - x * x) / (2 * x * slope - degree * (degree + 1) * value);
    }
    const Real value = legendre(N, x).second;
    z[i] = (1 + x) / 2;
    weight[i] = 1 / (degree * (degree + 1) * value * value);
  }
  const auto slope = lagrange_slopes(z);  // ℓⱼ′ at node i
  LobattoBasis basis;
  for (std::size_t i = 0; i <= N; ++i) {
    basis.node[i] = static_cast<double>(z[i]);
    basis.weight[i] = static_cast<double>(weight[i]);
    Real last = 0, before_last = 0;  // ∫ of ℓᵢ′ with a Legendre polynomial: exact, degree 2N − 2
    for (std::size_t k = 0; k <= N; ++k) {
      const auto [before, value] = legendre(N - 1, 2 * z[k] - 1);
      last += weight[k] * slope[k][i] * value;
      before_last += weight[k] * slope[k][i] * before;
    }
    basis.last[i] = static_cast<double>((2 * degree - 1) * last);
    basis.before_last[i] = static_cast<double>((2 * degree - 3) * before_last);
    for (std::size_t j = 0; j <= N; ++j) {
      Real sum = 0;
      for (std::size_t k = 0; k <= N; ++k) sum += weight[k] * slope[k][i] * slope[k][j];
      basis.bending[i][j] = static_cast<double>(sum);
      basis.slope[i][j] = static_cast<double>(slope[i][j]);
    }
  }
  return basis;
}

template <std::size_t N>
const LobattoBasis<N> LobattoBasis<N>::basis_ = LobattoBasis<N>::make();

template struct LobattoBasis<element_degree>;

}  // namespace sinew::inline v1
