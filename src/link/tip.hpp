/// @file tip.hpp
/// What a link tells a closure: where its tip is and how it moves, in the link's own base frame.
#pragma once
#include "sinew/math/vec.hpp"

namespace sinew::inline v1 {

/// Tip position and its derivative by the link's own coordinates q. Base at the origin, base tangent along
/// +y.
/// @tparam D dimension of the link's frame (2 in a plane, 3 in space), @tparam Q number of coordinates
template <Scalar S, int D, int Q>
struct Tip {
  Vec<S, D> position;  ///< u(q) [m]
  Mat<S, D, Q> rate;   ///< ∂u/∂q [m per unit of q]
};

/// A link whose backbone is an arc: closures may then solve in closed form.
template <class Link>
concept HasArc = requires(const Link& link) {
  link.arc().curvature_from_chord(1.0);
  link.arc().tangent_lead(1.0);
};

/// A link that slides its tip along +y: closures may then solve in closed form.
template <class Link>
concept HasSlide = requires(const Link& link, const Vec<double, 1>& q) {
  link.slide(q);
};

/// Bounds that hold for every value of the coordinate of a one-coordinate link. They make root isolation a
/// proof.
struct TipBounds {
  double reach;      ///< |u| ≤ reach [m]
  double rate;       ///< |∂u/∂q| ≤ rate
  double rate_rate;  ///< |∂²u/∂q²| ≤ rate_rate
  double domain;     ///< the coordinate lies in (−domain, domain)
};

}  // namespace sinew::inline v1
