/// @file blocks.hpp
/// Residual rows of a leg with their Jacobian blocks: all a robot or a solver ever learns of it.
#pragma once
#include "sinew/math/vec.hpp"

namespace sinew::inline v1 {

/// What a leg hands over at platform pose x and link coordinates q. The row of a plane comes last.
template <Scalar S, int R, int Dof, int Q>
struct LegBlocks {
  Vec<S, R> g;         ///< residual [m²]; of a pin or a plane [m]
  Mat<S, R, Dof> g_x;  ///< ∂g/∂x by the platform's twist: Plücker lines (times the distance); rows of J
  Mat<S, R, Q> g_q;    ///< ∂g/∂q by the link coordinates
  S error;             ///< the residual as a distance [m], without that of a plane
};

}  // namespace sinew::inline v1
