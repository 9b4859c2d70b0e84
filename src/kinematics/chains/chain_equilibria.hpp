/// @file chain_equilibria.hpp
/// Several equilibria of chains under the same load. Theory: docs/theory/chain_equilibrium.md
#pragma once
#include "kinematics/chains/chain_analysis.hpp"

namespace sinew::inline v1 {

/// Where a search begins: chains at rest at this pose, near these curvatures.
template <class Space>
struct ChainStart {
  typename Space::Pose pose;
  std::vector<double> curvature;  ///< of each leg [1/m]
};

template <class Space>
struct FoundChains {
  ChainState<Space> state;
  Report report;         ///< `converged`, or `slack` where a tendon would have to push
  double potential = 0;  ///< [J]; NaN under a moment in space
  ChainStability<Space> stability;
};

/// Equilibria of what is held, under a wrench, found from these starts with all their bends, and from poses
/// spread around the first, in ascending order of potential: a lower bound of their number, never proven to
/// be all. Every start is let go without load, which is then added, and with it. Ends early when it is
/// stopped. Allocates.
template <class Space>
std::vector<FoundChains<Space>> chain_equilibria(const ChainLegs<Space>& robot,
                                                 std::span<const ChainStart<Space>> starts,
                                                 std::span<const TendonConstraint> hold,
                                                 const Vec<double, Space::dof>& wrench, ChainWork& work,
                                                 const ChainOptions& options = {});

}  // namespace sinew::inline v1
