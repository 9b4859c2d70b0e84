/// @file curve.hpp
/// What is asked of equations whose curves of solutions are followed. Theory: docs/theory/continuation.md
#pragma once
#include "sinew/math/vec.hpp"

namespace sinew::inline v1 {

/// What decides where something happened between two points of a curve.
struct CurveSigns {
  double along = 0;     ///< dλ/ds
  int unstable = 0;     ///< directions, of the whole
  int own = 0;          ///< ... of what the problem has eliminated
  bool is_odd = false;  ///< the sign of the bordered determinant, without the poles of what is eliminated
};

/// N equations and a state of its own. Every unknown is a length; `Place` is { state, lambda, tangent }.
template <class P>
concept CurveProblem = requires(P problem, const P& fixed, typename P::Place& place, double lambda,
                                const Vec<double, P::unknowns>& step) {
  fixed.save(place.state);
  problem.restore(place.state);  // `evaluate` and `linearise` follow
  problem.evaluate();            // the error where it is ...
  problem.linearise();           // false where it is singular at fixed λ
  problem.refine();              // where the state asks for a finer grid; false: fine as it is
  problem.move(step, lambda, /* change of λ */ lambda);
  problem.put(lambda);                                // exactly there
  fixed.equations(/* length of λ */ lambda);          // [A c], rows first
  fixed.residual();                                   // what is to become 0, negative
  fixed.tolerance(), fixed.rounding();                // ... what counts as solved, and where no step can gain
  fixed.size(), fixed.unit(), fixed.longest_scale();  // of steps, of A, of λ
  fixed.signs();                                      // `unstable` and `own` of CurveSigns
};

}  // namespace sinew::inline v1
