/// @file solutions.hpp
/// All equilibria of chains that are found of a robot's inputs, or of a pose: searches begin at the solutions
/// of the arcs whose place the chains take. Theory: docs/theory/chain_equilibrium.md
#pragma once
#include "kinematics/chains/arcs.hpp"
#include "kinematics/chains/chain_equilibria.hpp"

namespace sinew::inline v1 {

/// Of what these inputs hold, under a wrench: from where their arcs lead, and from the arcs' assembly modes.
/// @param held of these inputs, its arcs solved
template <class Space>
std::vector<FoundChains<Space>> equilibria_of_inputs(ArcTwin twin, const ChainLegs<Space>& robot,
                                                     const HeldInputs& held, Numbers inputs,
                                                     const Vec<double, Space::dof>& wrench, ChainWork& work,
                                                     const ChainOptions& options);

/// Chains that hold a pose by the lengths of tendons.
template <class Space>
struct ChainsAtPose : FoundChains<Space> {
  ChainLegs<Space> robot;      ///< its bases as motors turn them
  std::vector<double> inputs;  ///< of the robot, in its order
};
template <class Space>
struct AllChainsAtPose {
  std::vector<ChainsAtPose<Space>> found;  ///< in ascending order of potential, those without as if it were 0
  double branches = 0;                     ///< of the arcs, of which the first `max_branches` are tried
};
/// Working modes of arcs that chains are begun on.
inline constexpr double max_branches = 256;

/// Every working mode of the arcs at a pose, as chains that hold it under a wrench.
template <class Space>
AllChainsAtPose<Space> equilibria_at_pose(ArcTwin twin, const ChainLegs<Space>& robot, const AnyPose& pose,
                                          const InverseOptions& branch, const Vec<double, Space::dof>& wrench,
                                          ChainWork& work, const ChainOptions& options);

}  // namespace sinew::inline v1
