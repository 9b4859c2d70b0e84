/// @file leg_curvature.hpp
/// Second derivatives of a leg's rows, contracted with multipliers: the geometric stiffness of a leg that
/// bears a force. Theory: docs/theory/leg.md
#pragma once
#include "leg/closure_curvature.hpp"
#include "leg/leg.hpp"

namespace sinew::inline v1 {

/// What the wrench λᵀ g_x of multipliers λ of the rows changes by, a column for each motion.
template <class LegT>
struct LegCurvature {
  static constexpr int dof = LegT::Space::dof;
  Mat<double, dof, dof> by_platform = Mat<double, dof, dof>::Zero();
  Mat<double, dof, LegT::coordinates> by_coordinates = Mat<double, dof, LegT::coordinates>::Zero();
};

template <class LegT>
LegCurvature<LegT> leg_curvature(const LegT& leg, const typename LegT::Frame& platform,
                                 const typename LegT::Coordinates& q,
                                 const Vec<double, LegT::rows>& multipliers) {
  using Space = typename LegT::Space;
  using Point = typename LegT::Point;
  constexpr Holds holds = LegT::Closure::holds;
  const Point b = platform.rotate(leg.platform_point);
  const auto anchor = anchor_of<LegT::dimension>(leg.closure, leg.link.tip(q));
  const Point n = leg.template offset<double>(platform) - anchor.position;
  const auto held = closure_rows<holds>(n, anchor.half_square, LegT::template plane_normal<double>());
  LegCurvature<LegT> change;
  for (int k = 0; k < LegT::rows; ++k) {
    const Point direction = leg.template to_world<double>(Point(held.direction.col(k)));
    if (k > 0 || holds == Holds::point) {
      change.by_platform += multipliers[k] * fixed_line_change<Space>(direction, b);
      continue;
    }
    change.by_platform += multipliers[k] * distance_line_change<Space>(direction, b);
    for (int j = 0; j < LegT::coordinates; ++j)
      change.by_coordinates.col(j) -=
          multipliers[k] *
          Space::line(leg.template to_world<double>(Point(anchor.rate.col(j))), b).transpose();
  }
  return change;
}

}  // namespace sinew::inline v1
