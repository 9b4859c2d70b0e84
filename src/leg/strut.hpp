/// @file strut.hpp
/// Strut closure: a rigid link of constant length between the link's tip and the platform point, turning
/// freely at both ends; the base of the link is clamped.  |r − u(q)| = v
#pragma once
#include <algorithm>
#include <span>
#include <string_view>

#include "leg/closure.hpp"
#include "sinew/math/se2.hpp"
#include "sinew/units.hpp"
#include "solve/message.hpp"

namespace sinew::inline v1 {

struct Strut {
  static constexpr std::string_view name = "strut";
  static constexpr bool base_turns = false;  ///< the base tangent has a direction of its own
  static constexpr bool anchor_is_tip = true;
  static constexpr Holds holds = Holds::distance;

  /// v [m], > 0. The row of J is vᵀ, vᵀ E Q c: TDPCR (29) prints vᵀ Eᵢ Qᵢ c, but (22) gives E Q. See
  /// docs/errata.md.  @implements TDPCR (28)-(30)
  double length = 0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("length", self.length, Dimension::length, Range::size(), "length of the rigid link");
  }

  /// A link that turns at its base and the strut are two sides of a triangle on r: one curvature is free.
  /// The feasible one nearest to the wish is taken, with both elbows.
  /// @param end of the curvature's domain [1/m]
  template <HasArc Link>
  requires(Link::has_base_joint) int coordinates_at(const Link& link, const Vec2<double>& r,
                                                    const SolutionPreference& wish, double end,
                                                    std::span<Vec<double, 2>> roots) const {
    const double distance = r.norm(), reach = link.arc().length;
    const double shortest = std::abs(distance - length), longest = std::min(distance + length, reach);
    if (!(shortest <= reach)) return 0;
    const double least = link.arc().curvature_from_chord(longest);
    const double most = std::min(link.arc().curvature_from_chord(shortest), end * (1 - 1e-12));
    if (least > most) return 0;
    const bool is_negative = wish.bending < 0 || (wish.bending == 0 && wish.near < 0);
    const double size = std::clamp(is_negative ? -wish.near : wish.near, least, most);
    const double curvature = is_negative ? -size : size, chord = link.arc().chord(curvature);
    // law of cosines; where the triangle is flat, or has no side to speak of, the elbow is straight
    const double cosine = (chord * chord + distance * distance - length * length) / (2 * chord * distance);
    const double corner = std::isfinite(cosine) ? std::acos(std::clamp(cosine, -1.0, 1.0)) : 0;
    const double towards = std::atan2(r.y(), r.x()), bend = link.arc().tangent_lead(curvature);
    for (const int elbow : {-1, 1})
      roots[elbow < 0 ? 0 : 1] = Vec<double, 2>(wrap_angle(towards - elbow * corner + bend), curvature);
    if (wish.elbow != 0) roots[0] = roots[wish.elbow < 0 ? 0 : 1];
    return corner == 0 || wish.elbow != 0 ? 1 : 2;
  }

  template <int D>
  void explain_unreachable(const Vec<double, D>& r, double reach, FixedText<240>& text) const {
    text.append("cannot bend its tip to within ");
    append_mm(text, length);
    text.append(" (its strut) of the platform point, which is ");
    append_mm(text, r.norm());
    text.append(" from its base; its backbone is ");
    append_mm(text, reach);
    text.append(" long");
  }
};

}  // namespace sinew::inline v1
