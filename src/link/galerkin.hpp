/// @file galerkin.hpp
/// The Galerkin form of the planar elastica: the tangent's angle θ(s) on [0, 1] is a polynomial of degree N
/// with θ(0) = 0, given by its values at the N Gauss nodes. The free tip is its natural boundary condition.
/// Theory: docs/theory/galerkin_rod.md
///
///   energy/(EI/L) = ½ θᵀBθ − Σ wⱼ (fd sin θⱼ + fw cos θⱼ)     B = ∫ ℓᵢ′ℓⱼ′, constant
#pragma once
#include <cstddef>

#include "link/rod.hpp"

namespace sinew::inline v1 {

/// Tables for N nodes, made once in extended precision.
template <std::size_t N>
struct GalerkinBasis {
  using Row = double[N];
  Row node, weight;       ///< Gauss nodes of (0, 1), ascending, and weights
  Row at_tip;             ///< ℓⱼ(1): the tip's angle is Σ at_tip·θ
  Row last, before_last;  ///< rows that give the two highest Legendre coefficients of θ′
  double slope[N][N];     ///< ℓⱼ′ at node i
  double bending[N][N];   ///< B

  static const GalerkinBasis& get() { return basis_; }

 private:
  static GalerkinBasis make();
  static const GalerkinBasis basis_;
};

/// Nodes of the two sets of tables there are: the coarse one serves wherever it resolves the shape.
inline constexpr std::size_t coarse_nodes = 10, fine_nodes = rod_nodes;
extern template struct GalerkinBasis<coarse_nodes>;
extern template struct GalerkinBasis<fine_nodes>;

/// θ at the other set of nodes: row i of `fine_from_coarse` gives it at fine node i from the coarse ones,
/// exactly, as the coarse polynomials are among the fine; the way back interpolates.
struct Refinement {
  double fine_from_coarse[fine_nodes][coarse_nodes];
  double coarse_from_fine[coarse_nodes][fine_nodes];
};
const Refinement& refinement();

}  // namespace sinew::inline v1
