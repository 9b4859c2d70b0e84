/// @file platform_constraint.hpp
/// What the inputs leave of a kinematic leg: a point of the base that a point of the platform keeps a
/// distance from, and of a hinged leg the plane it stays in. Forward kinematics needs no more, whatever the
/// link, its drive and its closure.
#pragma once
#include "leg/closure.hpp"

namespace sinew::inline v1 {

/// @tparam D dimension of space, 2 or 3
template <int D>
struct PlatformConstraint {
  Vec<double, D> anchor;  ///< A, base frame [m]
  double distance;        ///< of the platform point from A [m], ≥ 0; 0: pinned to A, which holds D freedoms
  Vec<double, D> platform_point;  ///< b, platform frame [m]
  /// Unit normal of a plane through A that holds the platform point too, base frame; 0: no such plane.
  Vec<double, D> normal = Vec<double, D>::Zero();

  bool has_plane() const { return normal.squaredNorm() > 0; }
  /// How many freedoms it holds.
  int rows() const { return distance > 0 ? 1 + (has_plane() ? 1 : 0) : D; }

  /// How far from closed it is where the way from the anchor to the platform point is n [m].
  double closure_error(const Vec<double, D>& n) const {
    return closure_error_of(n.norm(), distance, dot(normal, n));
  }

  /// Calls `use` with its rows there.
  template <class Use>
  void with_rows(const Vec<double, D>& n, Use&& use) const {
    const double half_square = 0.5 * distance * distance;
    if (!(distance > 0))
      use(closure_rows<Holds::point>(n, half_square, normal));
    else if (has_plane())
      use(closure_rows<Holds::distance_in_plane>(n, half_square, normal));
    else
      use(closure_rows<Holds::distance>(n, half_square, normal));
  }
};

}  // namespace sinew::inline v1
