/// @file closure.hpp
/// What every closure is made of: an anchor that moves with the link, and how far the platform point keeps
/// from it. Rows, slopes and closure error, one formula each; second derivatives are in
/// closure_curvature.hpp. Theory: docs/theory/leg.md
///
/// On the way n = r − A from the anchor A to the platform point r a closure has one or more rows: of a
/// distance   g = ½ (|n|² − D²),   of a plane   g = u·n,   of a point   g = n.   The squares keep the papers'
/// raw form of J and K (rows multiplied by the distance) and are smooth at D = 0. A closure itself says no
/// more than which rows it has, whether the anchor is the link's tip, and how long its strut is.
#pragma once
#include <cmath>

#include "link/tip.hpp"

namespace sinew::inline v1 {

/// The anchor of a distance and the distance, in the axes of the link's tip (of a clamped link its base
/// frame, of others the robot's base), with their rates by the link coordinates.
template <Scalar S, int D, int Q>
struct Anchor {
  Vec<S, D> position;             ///< A [m]
  Mat<S, D, Q> rate;              ///< ∂A/∂q
  S half_square;                  ///< ½D² [m²]
  Mat<S, 1, Q> half_square_rate;  ///< ∂(½D²)/∂q
};

/// A closure with a rigid link of its own between the link's tip and the platform.
template <class Closure>
concept HasStrut = requires(const Closure& closure) {
  closure.length;
};

/// Of a chord the anchor is the base point, and of the link only |u| matters, so a planar link serves in
/// space. Of all others it is the link's tip.
/// @implements TDPCR (1), (3)-(4), (21)-(24)
/// @implements 3PFS (1), (11)
template <int D, class Closure, Scalar S, int L, int Q>
[[gnu::always_inline]] inline Anchor<S, D, Q> anchor_of(const Closure& closure, const Tip<S, L, Q>& tip) {
  if constexpr (!Closure::anchor_is_tip) {
    return {Vec<S, D>::Zero(), Mat<S, D, Q>::Zero(), S(0.5) * squared_norm(tip.position),
            tip.position.transpose() * tip.rate};
  } else {
    static_assert(L == D);
    S half_square(0);
    if constexpr (HasStrut<Closure>) half_square = S(0.5 * closure.length * closure.length);
    return {tip.position, tip.rate, half_square, Mat<S, 1, Q>::Zero()};
  }
}

/// Bound on |∂²g/∂q²| of the distance for a link with one coordinate while |n| ≤ pull: (½|u|²)″ = |u′|² +
/// u·u″ and (½|r − u|²)″ = |u′|² − (r − u)·u″.
template <class Closure>
double rate_rate_bound(double pull, const TipBounds& link) {
  return link.rate * link.rate + (Closure::anchor_is_tip ? pull : link.reach) * link.rate_rate;
}

/// What a closure holds the platform point to.
enum class Holds { distance, distance_in_plane, point };

template <Holds holds, int D>
inline constexpr int held_rows = holds == Holds::point      ? D
                                 : holds == Holds::distance ? 1
                                                            : 2;

/// Rows of constraint. The one of a distance comes first.
template <Scalar S, int D, int R>
struct ClosureRows {
  Vec<S, R> g;             ///< residual [m²]; of a plane or a point [m]
  Mat<S, D, R> direction;  ///< a column each, ∂g/∂r: along which the closure pulls; of a distance n [m]
};

/// The rows of every closure, by the way n = r − A from its anchor.
/// @param half_square ½D² [m²]; @param plane unit normal u, of `distance_in_plane`
template <Holds holds, int D, Scalar S>
[[gnu::always_inline]] inline ClosureRows<S, D, held_rows<holds, D>> closure_rows(const Vec<S, D>& n,
                                                                                  const S& half_square,
                                                                                  const Vec<S, D>& plane) {
  if constexpr (holds == Holds::point) {
    return {n, Mat<S, D, D>::Identity()};
  } else {
    ClosureRows<S, D, held_rows<holds, D>> rows;
    rows.g[0] = S(0.5) * squared_norm(n) - half_square;
    rows.direction.col(0) = n;
    if constexpr (holds == Holds::distance_in_plane) {
      rows.g[1] = dot(plane, n);
      rows.direction.col(1) = plane;
    }
    return rows;
  }
}

/// ∂g/∂q of row k.
template <Holds holds, Scalar S, int D, int Q>
[[gnu::always_inline]] inline Mat<S, 1, Q> closure_slope(const ClosureRows<S, D, held_rows<holds, D>>& rows,
                                                         int k, const Anchor<S, D, Q>& anchor) {
  const Mat<S, 1, Q> by_anchor = -(rows.direction.col(k).transpose() * anchor.rate);
  if (k > 0 || holds == Holds::point) return by_anchor;
  return by_anchor - anchor.half_square_rate;
}

/// How far from closed [m].  @param beside how far the platform point is from the plane; 0 without one
inline double closure_error_of(double distance, double wanted, double beside) {
  const double miss = std::abs(distance - wanted);
  return beside == 0 ? miss : std::sqrt(miss * miss + beside * beside);
}

/// Which of a leg's solutions is wanted: the one of this sign of curvature and this elbow (0: any) whose
/// branch coordinate (of an arc the curvature, of a rail the slide) is nearest to `near`.
struct SolutionPreference {
  double near = 0;  ///< [1/m], of a rail [m]
  int bending = 0;  ///< +1, −1 or 0; without effect on a rail
  /// Of a link on a motor +1: the strut is turned counter-clockwise from the link's chord; −1: clockwise. Of
  /// a rail +1: the strut leads ahead along the rail; −1: back. 0: any.
  int elbow = 0;
};

}  // namespace sinew::inline v1
