/// @file margin.hpp
/// The allowed bend whose shortest tendon has the most slack, in both models.
#pragma once
#include "tendon/section_case.hpp"

namespace sinew::inline v1 {

struct Margin {
  Vec2<double> point;
  double slack;  ///< [m]
};

/// @param first taken where no other bend is better but for rounding
Margin largest_margin(const SectionCase& c, const Vec2<double>& first);

/// A point on the rim of the envelope, of which there are `rim_pieces`, each smooth and one unit of `t` long.
Vec2<double> rim(const SectionCase& c, std::size_t piece, double t);
std::size_t rim_pieces(const SectionCase& c);

}  // namespace sinew::inline v1
