/// @file pin.hpp
/// Pin closure: the link's tip is the platform point, and turns freely there. It holds the point in every
/// direction, so the leg has as many rows as space has dimensions.  r = u(q)
#pragma once
#include <span>
#include <string_view>

#include "leg/chord.hpp"
#include "sinew/math/se2.hpp"

namespace sinew::inline v1 {

struct Pin {
  static constexpr std::string_view name = "pin";
  static constexpr bool base_turns = false;
  static constexpr bool anchor_is_tip = true;
  static constexpr Holds holds = Holds::point;

  template <class Self, class Visit>
  static void fields(Self&, Visit&&) {}

  /// The chord ends at the platform point: ±κ, and the base turned half a bend beside it.
  template <HasArc Link>
  requires(Link::has_base_joint) int coordinates_at(const Link& link, const Vec2<double>& r,
                                                    const SolutionPreference&, double,
                                                    std::span<Vec<double, 2>> roots) const {
    const double curvature = link.arc().curvature_from_chord(r.norm());
    if (std::isnan(curvature)) return 0;
    const double towards = std::atan2(r.y(), r.x()), bend = link.arc().tangent_lead(curvature);
    roots[1] = Vec<double, 2>(wrap_angle(towards + bend), curvature);
    roots[0] = curvature == 0 ? roots[1] : Vec<double, 2>(wrap_angle(towards - bend), -curvature);
    return curvature == 0 ? 1 : 2;
  }

  template <int D>
  void explain_unreachable(const Vec<double, D>& r, double reach, FixedText<240>& text) const {
    Chord::explain_chord(r.norm(), reach, text);
  }
};

}  // namespace sinew::inline v1
