/// @file project.hpp
/// Puts link coordinates back on a leg's closure by the shortest way: Newton's method, of least norm where
/// the leg is redundant. Theory: docs/theory/track.md
#pragma once
#include <Eigen/LU>

#include "leg/leg.hpp"

namespace sinew::inline v1 {

/// Lengths of the unit steps of link coordinates, so that they compare: all in radians. A curvature counts by
/// the bend angle κℓ it makes, a slide over the leg's size.
template <class LegT>
typename LegT::Coordinates coordinate_scale(const LegT& leg) {
  auto scale = LegT::Coordinates::Ones().eval();
  scale[LegT::coordinates - 1] = leg.branch_unit();
  return scale;
}

/// How a projection went.
struct Projection {
  bool ok = false;
  double error = 0;        ///< closure error left [m]
  double contraction = 0;  ///< second Newton step over the first: small where the branch is near
};

/// Whether the platform point lies in the plane that the leg may hold it in.
template <class LegT>
bool is_in_plane(const LegT& leg, const typename LegT::template Blocks<double>& blocks) {
  if constexpr (LegT::has_plane)
    return std::abs(blocks.g[LegT::rows - 1]) <= LegT::Closure::plane_tolerance * leg.closure.length;
  else
    return true;
}

/// Moves q onto the closure at `platform`. Bounded work, no heap.
/// @param tolerance closure error that counts as closed [m]
template <class LegT>
Projection project(const LegT& leg, const typename LegT::Frame& platform, double tolerance,
                   typename LegT::Coordinates& q) {
  constexpr int R = LegT::driven_rows;
  const auto scale = coordinate_scale(leg);
  Projection result;
  double first = 0;
  bool is_held = false;  // a redundant leg that bends as far as it may goes on by its other coordinates
  for (int iteration = 0; iteration < 12; ++iteration) {
    const auto blocks = leg.template blocks<double>(platform, leg.template tip<double>(q));
    result.error = std::abs(blocks.error);
    if (!(result.error > tolerance)) {
      result.ok = std::isfinite(result.error) && leg.in_domain(q) && is_in_plane(leg, blocks);
      return result;
    }
    Mat<double, R, LegT::coordinates> slope = blocks.g_q.template topRows<R>() * scale.asDiagonal();
    if (is_held) slope.col(LegT::coordinates - 1).setZero();
    const Mat<double, R, R> normal = slope * slope.transpose();
    const Vec<double, LegT::coordinates> step =
        slope.transpose() * (normal.inverse() * -blocks.g.template head<R>());
    const double length = step.norm();
    if (!std::isfinite(length) || length > 1) return result;
    if (iteration == 0) first = length;
    if (iteration == 1) result.contraction = length / first;
    q += scale.cwiseProduct(step);
    if constexpr (LegT::is_redundant)
      if (double& curvature = q[LegT::coordinates - 1]; !(std::abs(curvature) < leg.domain())) {
        curvature = std::copysign(leg.domain() * (1 - 1e-9), curvature);
        is_held = true;
      }
  }
  const auto blocks = leg.template blocks<double>(platform, leg.template tip<double>(q));
  result.ok = result.error <= 1e3 * tolerance && leg.in_domain(q) &&
              is_in_plane(leg, blocks);  // the last digits need not come
  return result;
}

}  // namespace sinew::inline v1
