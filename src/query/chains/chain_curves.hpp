/// @file chain_curves.hpp
/// `track` of robots on chains along loads and what tendons hold.
#pragma once
#include "query/chains/chains.hpp"

namespace sinew::inline v1::chains {

template <class Space>
void answer_curves(Context& context, ChainLegs<Space>& robot);

}  // namespace sinew::inline v1::chains
