/// @file elastica_map.hpp
/// The universal map of the elastica: all equilibria of a rod, in space, whose base is clamped and whose tip
/// is held at a point without moment. Units, frame and signs: elastica.hpp. Theory: docs/theory/elastica.md
///
/// An isotropic rod without tip moment lies in the plane of base tangent and tip, so the map takes (d, w) and
/// not three coordinates. It has several values: bent to either side of the chord, and with more inflections.
#pragma once
#include <vector>

#include "link/elastica.hpp"

namespace sinew::inline v1 {

struct ElasticaEquilibrium {
  ElasticaState<double> state;  ///< its tip is the one asked for, to 1e-14
  Vec2<double> local_force;
  Mat<double, 2, 2> stiffness;    ///< ∂(fd, fw)/∂(d, w)
  double out_of_plane_stiffness;  ///< of the tip across the plane, fd/d; NaN where d = 0
  int inflections;                ///< points of zero curvature between base and tip
  /// Directions in which the energy falls while the tip is held: Morse indices, exact, not from a basis;
  /// -1 where the stiffness is not finite: a fold, a straight rod, a force that is not a number.
  int unstable_in_plane, unstable_out_of_plane;

  bool is_stable() const { return unstable_in_plane == 0 && unstable_out_of_plane == 0; }
};

struct ElasticaMapOptions {
  double force_bound = 45;  ///< largest |f| to be looked for [EI/L²], at most 300
  int refinement = 1;       ///< 2 halves the cells of the search, and so on
};

struct ElasticaMap {
  /// - `converged`: the list is what the search found, at least one.
  /// - `unreachable`: the tip is farther away than the rod is long, or as far and not straight ahead.
  /// - `left_domain`: none was found within the bound on the force; or a number is not finite.
  /// - `singular`, and a list: d = 0, w < 1. The plane is undetermined. The list has the equilibria of one
  ///   plane, each with its mirror image; all turn freely about the base tangent, and that neutral motion is
  ///   not counted as unstable.
  /// - `singular`, and no list: the rod is straight (|d| < 1e-5 and |1 − w| < 1e-10). fd is 0 and fw
  ///   undetermined; the state is stable for fw > −20.19 (−x², tan x = x).
  Report report;
  std::vector<ElasticaEquilibrium> equilibria;  ///< energy ascending
};

/// All equilibria with |f| ≤ bound and the tip at (d, w). The plane of local forces is cut into cells, finer
/// where the shape changes faster, and Newton's method starts from each whose linear model, widened, reaches
/// the tip or its mirror image. That is no proof of completeness; cells of a third of the size found no other
/// in 2400 random tips, many of them near folds. Two that are closer than 1e-6 of the force, or that the tip
/// cannot tell apart to 4e-14, are told as one. About 9000 evaluations: some ms.
ElasticaMap elastica_map(const Vec2<double>& tip, const ElasticaMapOptions& options = {});

/// The stability and stiffness of one equilibrium, from its local force: what the map says of each.
ElasticaEquilibrium elastica_equilibrium(const Vec2<double>& local_force);

}  // namespace sinew::inline v1
