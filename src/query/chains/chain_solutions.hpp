/// @file chain_solutions.hpp
/// `all` of forward and inverse on pseudo-rigid chains.
#pragma once
#include "query/chains/chain_answer.hpp"

namespace sinew::inline v1::chains {

/// Every equilibrium that is found of what these inputs hold.
template <class Space>
void put_all_equilibria(Context& context, const ChainLegs<Space>& robot, const HeldInputs& held,
                        std::span<const double> inputs, const Load<Space>& load);

/// Every working mode of the arcs at a pose, as chains that hold it.
template <class Space>
void put_all_inverses(Context& context, const ChainLegs<Space>& robot, const AnyPose& pose,
                      const Branch& branch, const Load<Space>& load);

}  // namespace sinew::inline v1::chains
