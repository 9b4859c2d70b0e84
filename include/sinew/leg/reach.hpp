/// @file reach.hpp
/// What the inputs leave of a kinematic leg: a point of the base that a point of the platform keeps a
/// distance from. Forward kinematics needs no more, whatever the link, its drive and its closure.
#pragma once
#include "sinew/math/vec.hpp"

namespace sinew::inline v0 {

/// @tparam D dimension of space, 2 or 3
template <int D>
struct Reach {
  Vec<double, D> anchor;  ///< A, base frame [m]
  double distance;        ///< of the platform point from A [m], ≥ 0; 0: pinned to A, which holds D freedoms
  Vec<double, D> platform_point;  ///< b, platform frame [m]
};

}  // namespace sinew::inline v0
