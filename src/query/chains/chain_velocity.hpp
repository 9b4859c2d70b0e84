/// @file chain_velocity.hpp
/// Velocity equations of chains in answers.
#pragma once
#include "analysis/chain_velocity.hpp"
#include "query/wants.hpp"

namespace sinew::inline v1::chains {

/// `twist`, if it is given; it goes with the want `velocity`.
template <class Space>
std::vector<double> read_twist(Context& context, Wants wants) {
  refuse_without(context, wants, Want::velocity, {"twist"});
  if (!wants.has(Want::velocity)) return {};
  const auto asked = context.query.optional("twist");
  if (!asked) return {};
  return asked->quantities(Dimension::number, {}, static_cast<std::size_t>(Space::dof));
}

/// Writes J, K, U, indices and singularities, and the rates of a twist. Where the equations are singular the
/// report says so.
template <class Space>
void put_velocity(Context& context, const ChainVelocity<Space>& velocity, std::span<const double> twist);

}  // namespace sinew::inline v1::chains
