/// @file chain_velocity.hpp
/// Velocity equations, sensitivities and singularities of robots on pseudo-rigid chains. Theory:
/// docs/theory/chain_velocity.md
#pragma once
#include "kinematics/chains/chain.hpp"
#include "sinew/analysis/velocity.hpp"

namespace sinew::inline v1 {

/// U = J⁻¹K has a column for each joint, but a row of K only those of one leg: U = R·diag(|gᵢ|)·Q with
/// orthonormal rows Q, so that its norms are those of a square matrix of the platform's size, however many
/// joints there are.
template <class Space>
struct ChainVelocity {
  template <class T>
  using OfLegs = typename ChainRates<Space>::template OfLegs<T>;
  Report report;  ///< singular where J is; residual: closure error [m]
  ChainRates<Space> rates;
  Mat<double, Space::dof, Space::dof> inverse;  ///< J⁻¹, where `has_inverse`
  bool has_inverse = false;                     ///< as many legs as freedoms, and not singular
  double determinant = 0;                       ///< of J where it is square, else NaN
  Indices indices{};
  OfLegs<double> drive{};  ///< |gᵢ|, the norm of the leg's row of K
  OfLegs<int> type_1_legs{};
  int type_1_count = 0;  ///< legs whose joints move their chord in no direction: straight or folded
  TypeTwo type_2;

  std::span<const int> type_1() const { return {type_1_legs.data(), static_cast<std::size_t>(type_1_count)}; }
};

/// At a pose and angles that close the legs. There is no U of more legs than freedoms; `singular` where they
/// are fewer, `bad_input` of more than `max_rows`. No heap.
/// @implements TDPCR (35), (40)
template <class Space>
ChainVelocity<Space> chain_velocity(const ChainLegs<Space>& robot, const typename Space::Pose& pose,
                                    std::span<const ChainLegState> legs);

/// The shortest rates of all joints for a twist, leg by leg: θ̇ = g (J t)ᵢ/|g|². Not finite where a leg is of
/// type I. Allocates.
template <class Space>
std::vector<double> least_norm_rates(const ChainVelocity<Space>& velocity,
                                     const Vec<double, Space::dof>& twist);

}  // namespace sinew::inline v1
