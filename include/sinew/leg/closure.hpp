/// @file closure.hpp
/// What every closure is made of: an anchor that moves with the link, and how far the platform point keeps
/// from it. Theory: docs/theory/leg.md
///
/// A closure says where its anchor A(q) is and how far, D(q), the platform point r keeps from it. All of it
/// is in the axes of the link's tip (of a clamped link its base frame, of others the robot's base):   g = ½
/// (|r − A|² − D²) = 0,   ∂g/∂r = r − A = n,   ∂g/∂q = −n·A′ − (½D²)′. The squares keep the papers' raw form
/// of J and K (rows multiplied by the distance) and are smooth at D = 0. A closure that pins the point to the
/// anchor holds it in every direction:   g = r − A = 0. A hinge at the anchor holds it besides in the plane
/// through A with the hinge's axis u for a normal:   g = u·(r − A) = 0.
#pragma once
#include "sinew/link/tip.hpp"

namespace sinew::inline v0 {

/// The anchor of a distance and the distance, with their rates by the link coordinates.
template <Scalar S, int D, int Q>
struct Anchor {
  Vec<S, D> position;             ///< A [m]
  Mat<S, D, Q> rate;              ///< ∂A/∂q
  S half_square;                  ///< ½D² [m²]
  Mat<S, 1, Q> half_square_rate;  ///< ∂(½D²)/∂q
};

/// One row of constraint.
template <Scalar S, int D, int Q>
struct DistanceRow {
  S g;               ///< residual [m²]
  Vec<S, D> normal;  ///< ∂g/∂r [m], along the line on which the closure pulls
  Mat<S, 1, Q> g_q;  ///< ∂g/∂q
};

/// The row of a distance closure.
template <Scalar S, int D, int Q>
[[gnu::always_inline]] inline DistanceRow<S, D, Q> distance_row(const Vec<S, D>& r,
                                                                const Anchor<S, D, Q>& anchor) {
  const Vec<S, D> n = r - anchor.position;
  const Mat<S, 1, Q> g_q = -(n.transpose() * anchor.rate) - anchor.half_square_rate;
  return {S(0.5) * squared_norm(n) - anchor.half_square, n, g_q};
}

/// A closure that also holds the platform point in a plane through the anchor: it gives one more row.
template <class Closure>
concept HoldsInPlane = requires {
  Closure::template plane_normal<double>();
};

/// Which of a leg's solutions is wanted: the one of this sign of curvature and this elbow (0: any) whose
/// branch coordinate (of an arc the curvature, of a rail the slide) is nearest to `near`.
struct Wish {
  double near = 0;  ///< [1/m], of a rail [m]
  int bending = 0;  ///< +1, −1 or 0; without effect on a rail
  /// Of a link on a motor +1: the strut is turned counter-clockwise from the link's chord; −1: clockwise. Of
  /// a rail +1: the strut leads ahead along the rail; −1: back. 0: any.
  int elbow = 0;
};

}  // namespace sinew::inline v0
