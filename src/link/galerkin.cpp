#include "link/galerkin.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "link/interpolation.hpp"

namespace sinew::inline v1 {
namespace {

/// Gauss nodes and weights of (0, 1), ascending: Newton's method on the Legendre polynomial.
template <std::size_t N>
void gauss(std::array<Real, N>& node, std::array<Real, N>& weight) {
  constexpr int degree = static_cast<int>(N);
  for (std::size_t i = 0; i < N; ++i) {
    Real x = -std::cos(std::numbers::pi_v<Real> * (Real(i) + Real(0.75)) / (degree + Real(0.5))), rate = 1;
    for (int k = 0; k < 8; ++k) {  // the guess is good to 1e-3: four are enough
      const auto [before, value] = legendre(N, x);
      rate = degree * (x * value - before) / (x * x - 1);
      x -= value / rate;
    }
    node[i] = (1 + x) / 2;
    weight[i] = 1 / ((1 - x * x) * rate * rate);
  }
}

/// Lagrange polynomials on the points z.
template <std::size_t M>
Real lagrange(const std::array<Real, M>& z, std::size_t j, Real s) {
  Real value = 1;
  for (std::size_t m = 0; m < M; ++m)
    if (m != j) value *= (s - z[m]) / (z[j] - z[m]);
  return value;
}

}  // namespace

template <std::size_t N>
GalerkinBasis<N> GalerkinBasis<N>::make() {
  std::array<Real, N> node, weight;
  gauss<N>(node, weight);
  std::array<Real, N + 1> z{};  // the base, where θ = 0, then the nodes
  for (std::size_t i = 0; i < N; ++i) z[i + 1] = node[i];

  const auto slopes = lagrange_slopes(z);
  std::array<std::array<Real, N>, N> slope;
  GalerkinBasis basis;
  for (std::size_t j = 0; j < N; ++j) {
    basis.node[j] = static_cast<double>(node[j]);
    basis.weight[j] = static_cast<double>(weight[j]);
    basis.at_tip[j] = static_cast<double>(lagrange(z, j + 1, Real(1)));
    basis.last[j] = basis.before_last[j] = 0;
    for (std::size_t i = 0; i < N; ++i) {
      slope[i][j] = slopes[i + 1][j + 1];
      basis.slope[i][j] = static_cast<double>(slope[i][j]);
      const auto [before, value] = legendre(N - 1, 2 * node[i] - 1);
      basis.last[j] += static_cast<double>(Real(2 * N - 1) * weight[i] * slope[i][j] * value);
      basis.before_last[j] += static_cast<double>(Real(2 * N - 3) * weight[i] * slope[i][j] * before);
    }
  }
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t j = 0; j < N; ++j) {
      Real sum = 0;  // exact: the integrand has degree 2N − 2
      for (std::size_t k = 0; k < N; ++k) sum += weight[k] * slope[k][i] * slope[k][j];
      basis.bending[i][j] = static_cast<double>(sum);
    }
  return basis;
}

template <std::size_t N>
const GalerkinBasis<N> GalerkinBasis<N>::basis_ = GalerkinBasis<N>::make();

template struct GalerkinBasis<coarse_nodes>;
template struct GalerkinBasis<fine_nodes>;

namespace {

/// Values at the nodes of To from those at the nodes of From.
template <std::size_t From, std::size_t To>
void interpolate(double (&rows)[To][From]) {
  std::array<Real, From> node, weight;
  std::array<Real, To> wanted, unused;
  gauss<From>(node, weight);
  gauss<To>(wanted, unused);
  std::array<Real, From + 1> z{};
  std::copy(node.begin(), node.end(), z.begin() + 1);
  for (std::size_t i = 0; i < To; ++i)
    for (std::size_t j = 0; j < From; ++j) rows[i][j] = static_cast<double>(lagrange(z, j + 1, wanted[i]));
}

}  // namespace

const Refinement& refinement() {
  static const Refinement table = [] {
    Refinement made;
    interpolate<coarse_nodes, fine_nodes>(made.fine_from_coarse);
    interpolate<fine_nodes, coarse_nodes>(made.coarse_from_fine);
    return made;
  }();
  return table;
}

}  // namespace sinew::inline v1
