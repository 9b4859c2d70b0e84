/// @file lobatto.hpp
/// One spectral element of a rod: a field on [0, 1] is a polynomial given by its values at the Gauss-Lobatto
/// nodes, both ends among them, so that elements join at a node. Theory: docs/theory/tangent_rod.md
#pragma once
#include <cstddef>

namespace sinew::inline v1 {

/// Tables for polynomials of degree N, made once in extended precision.
template <std::size_t N>
struct LobattoBasis {
  using Row = double[N + 1];
  Row node, weight;              ///< of [0, 1], ascending, ends included; exact to degree 2N − 1
  double slope[N + 1][N + 1];    ///< ℓⱼ′ at node i
  double bending[N + 1][N + 1];  ///< ∫ ℓᵢ′ℓⱼ′, exact
  Row last, before_last;         ///< rows that give the two highest Legendre coefficients of the derivative

  static const LobattoBasis& get() { return basis_; }

 private:
  static LobattoBasis make();
  static const LobattoBasis basis_;
};

/// Degree of the elements in use.
inline constexpr std::size_t element_degree = 8;
extern template struct LobattoBasis<element_degree>;

}  // namespace sinew::inline v1
