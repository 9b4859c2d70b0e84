/// @file strut.hpp
/// Strut closure: a rigid link of constant length between the link's tip and the platform point, turning
/// freely at both ends; the base of the link is clamped.  |r − u(q)| = v
#pragma once
#include <string_view>

#include "sinew/base/fixed_text.hpp"
#include "sinew/base/units.hpp"
#include "sinew/leg/closure.hpp"

namespace sinew::inline v0 {

struct Strut {
  static constexpr std::string_view name = "strut";
  static constexpr bool base_turns = false;  ///< the base tangent has a direction of its own

  double length = 0;  ///< v [m], > 0

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("length", self.length, Dimension::length, Range::size(), "length of the rigid link");
  }

  /// The row of J that follows is vᵀ, vᵀ E Q c: TDPCR (29) prints vᵀ Eᵢ Qᵢ c, but (22) gives E Q. See
  /// docs/errata.md.
  /// @implements TDPCR (21)-(24), (28)-(30)
  template <Scalar S, int D, int Q>
  Anchor<S, D, Q> anchor(const Tip<S, D, Q>& tip) const {
    return {tip.position, tip.rate, S(0.5 * length * length), Mat<S, 1, Q>::Zero()};
  }

  /// Bound on |∂²g/∂q²| for a link with one coordinate while |r − u| ≤ pull: (½|r − u|²)″ = |u′|² − (r −
  /// u)·u″.
  double rate_rate_bound(double pull, const TipBounds& link) const {
    return link.rate * link.rate + pull * link.rate_rate;
  }

  void explain_unreachable(double distance, double reach, FixedText<240>& text) const {
    text.append("cannot bend its tip to within ");
    append_mm(text, length);
    text.append(" (its strut) of the platform point, which is ");
    append_mm(text, distance);
    text.append(" from its base; its backbone is ");
    append_mm(text, reach);
    text.append(" long");
  }
};

}  // namespace sinew::inline v0
