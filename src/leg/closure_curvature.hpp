/// @file closure_curvature.hpp
/// Second derivatives of the rows of a closure by the pose: what of a force along them changes as the
/// platform moves. Theory: docs/theory/leg.md
#pragma once
#include "leg/closure.hpp"
#include "leg/space.hpp"

namespace sinew::inline v1 {

/// ∂(g_x)/∂x of one row, whose direction is that of a plane or a point and does not change ...
/// Columns: what moves. In space not symmetric, as turns keep the order in which they are made.
template <class Space>
Mat<double, Space::dof, Space::dof> fixed_line_change(const Vec<double, Space::dimension>& direction,
                                                      const Vec<double, Space::dimension>& b) {
  Mat<double, Space::dof, Space::dof> change = Mat<double, Space::dof, Space::dof>::Zero();
  Space::add_turn(direction, b, change);
  return change;
}

/// ... or that of a distance, ½|n|², whose direction n follows the platform point.
template <class Space>
Mat<double, Space::dof, Space::dof> distance_line_change(const Vec<double, Space::dimension>& n,
                                                         const Vec<double, Space::dimension>& b) {
  const auto rate = Space::point_rate(b);
  Mat<double, Space::dof, Space::dof> change = rate.transpose() * rate;
  Space::add_turn(n, b, change);
  return change;
}

}  // namespace sinew::inline v1
