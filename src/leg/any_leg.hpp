/// @file any_leg.hpp
/// One leg out of a closed set: how a robot carries legs that are not all alike.
#pragma once
#include <variant>

#include "leg/leg.hpp"

namespace sinew::inline v1 {

/// A leg whose force depends on where its tip is held.
template <class LegT>
concept BearsLoad = requires {
  requires LegT::bears_load;
};

/// The kinds share their space.
template <class First, class... Rest>
struct AnyLeg {
  using Space = typename First::Space;
  static_assert((std::same_as<Space, typename Rest::Space> && ...));

  std::variant<First, Rest...> kind;
};

/// Calls `use` with the concrete leg behind `leg`.
template <class LegT, class Use>
decltype(auto) with_leg(LegT& leg, Use&& use) {
  if constexpr (requires { leg.kind; })
    return std::visit(use, leg.kind);
  else
    return use(leg);
}

}  // namespace sinew::inline v1
