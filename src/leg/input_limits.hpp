/// @file input_limits.hpp
/// The lengths of a tendon between which a leg's link stays within its domain.
#pragma once
#include <algorithm>
#include <array>

#include "leg/leg.hpp"

namespace sinew::inline v1 {

/// Of the leg's last input, which moves its link, at the ends of the link's coordinate: the lower one first.
template <class LegT>
std::array<double, 2> input_limits(const LegT& leg) {
  const auto input_at = [&](double end) {
    auto q = LegT::Coordinates::Zero().eval();
    q[LegT::coordinates - 1] = end;
    return leg.inputs_of(q)[LegT::inputs - 1];
  };
  const double a = input_at(-leg.domain()), b = input_at(leg.domain());
  return {std::min(a, b), std::max(a, b)};
}

}  // namespace sinew::inline v1
