/// @file any_leg.hpp
/// One leg out of a closed set, itself a leg: how a robot carries legs that are not all alike.
#pragma once
#include <variant>

#include "sinew/leg/leg.hpp"

namespace sinew::inline v0 {

/// The kinds share their space and their number of coordinates, so that their blocks have one type.
template <class First, class... Rest>
struct AnyLeg {
  using Space = typename First::Space;
  using Frame = typename Space::template Frame<double>;
  using Tip = typename First::template LinkTip<double>;
  static constexpr int coordinates = First::coordinates;
  static_assert(((First::coordinates == Rest::coordinates) && ...));

  std::variant<First, Rest...> kind;

  Tip tip(double q) const {
    return std::visit([&](const auto& leg) { return leg.tip(q); }, kind);
  }
  auto blocks(const Frame& platform, const Tip& tip) const {
    return std::visit([&](const auto& leg) { return leg.template blocks<double>(platform, tip); }, kind);
  }
  int coordinates_at(const Frame& platform, std::span<double> roots) const {
    return std::visit([&](const auto& leg) { return leg.coordinates_at(platform, roots); }, kind);
  }
  double coordinate(double input) const {
    return std::visit([&](const auto& leg) { return leg.coordinate(input); }, kind);
  }
  double input(double q) const {
    return std::visit([&](const auto& leg) { return leg.input(q); }, kind);
  }
  bool in_domain(double q) const {
    return std::visit([&](const auto& leg) { return leg.in_domain(q); }, kind);
  }
  NearestRoot coordinate_near(const Frame& platform, double target, int sign) const {
    return std::visit([&](const auto& leg) { return leg.coordinate_near(platform, target, sign); }, kind);
  }
  void explain_unreachable(const Frame& platform, FixedText<240>& text) const {
    std::visit([&](const auto& leg) { leg.explain_unreachable(platform, text); }, kind);
  }
  Frame base_frame(const Frame& platform, const Tip& tip) const {
    return std::visit([&](const auto& leg) { return leg.base_frame(platform, tip); }, kind);
  }
  LegState state(const Frame& platform, double q) const {
    return std::visit([&](const auto& leg) { return leg.state(platform, q); }, kind);
  }
};

/// Calls `use` with the concrete leg behind `leg`.
template <class LegT, class Use>
decltype(auto) with_leg(const LegT& leg, Use&& use) {
  if constexpr (requires { leg.kind; })
    return std::visit(use, leg.kind);
  else
    return use(leg);
}

}  // namespace sinew::inline v0
