/// @file chain_sensing.hpp
/// `statics` of pseudo-rigid chains with tensions that are measured.
#pragma once
#include "query/chains/chain_answer.hpp"

namespace sinew::inline v1::chains {

template <class Space>
void answer_sensing(Context& context, ChainLegs<Space>& robot);

}  // namespace sinew::inline v1::chains
