/// @file chord.hpp
/// Chord closure: both ends of the link turn freely (R or U at the base, R or S at the platform), so all that
/// the leg fixes is the distance between them, the link's chord.  |r| = |u(q)|
#pragma once
#include <span>
#include <string_view>

#include "leg/closure.hpp"
#include "solve/message.hpp"

namespace sinew::inline v1 {

struct Chord {
  static constexpr std::string_view name = "chord";
  static constexpr bool base_turns = true;  ///< the base tangent is free: a base direction means nothing
  static constexpr bool anchor_is_tip = false;
  static constexpr Holds holds = Holds::distance;

  template <class Self, class Visit>
  static void fields(Self&, Visit&&) {}

  /// Closed form where the link has one: the two curvatures ±κ, once where the link is straight; none beyond
  /// it.
  template <HasArc Link, int D>
  requires(!Link::has_base_joint) int coordinates_at(const Link& link, const Vec<double, D>& r,
                                                     const SolutionPreference&, double,
                                                     std::span<Vec<double, 1>> roots) const {
    const double curvature = link.arc().curvature_from_chord(r.norm());
    if (std::isnan(curvature)) return 0;  // too far
    roots[0][0] = curvature == 0 ? 0 : -curvature;
    roots[1][0] = curvature;
    return curvature == 0 ? 1 : 2;
  }

  template <int D>
  void explain_unreachable(const Vec<double, D>& r, double reach, FixedText<240>& text) const {
    explain_chord(r.norm(), reach, text);
  }

  static void explain_chord(double distance, double reach, FixedText<240>& text) {
    if (distance <= reach) {
      text.append("has its platform point ");
      append_mm(text, distance);
      text.append(" from its base point: its backbone of ");
      append_mm(text, reach);
      text.append(" would be folded");
    } else if (distance < reach * (1 + 1e-8)) {
      text.append("is stretched straight here: its backbone of ");
      append_mm(text, reach);
      text.append(" reaches no further");
    } else if (distance < reach * (1 + 1e-5)) {
      text.append("needs a chord ");
      append_mm(text, distance - reach);
      text.append(" longer than its backbone of ");
      append_mm(text, reach);
    } else {
      text.append("needs a chord of ");
      append_mm(text, distance);
      text.append(", its backbone is ");
      append_mm(text, reach);
      text.append(" long");
    }
  }
};

}  // namespace sinew::inline v1
