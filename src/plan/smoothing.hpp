/// @file smoothing.hpp
/// All steps of a way at once: short changes from step to step, clear of the solids.
#pragma once
#include "plan/search.hpp"

namespace sinew::inline v1 {

/// Lowers  ½ Σ |q_{k+1} − q_k|²/ρ² + contact of every step + target of the last  over the bends of all steps,
/// the stages held. Every step is a block: its Hessian is block tridiagonal and is solved as such.
/// @param way from outside to the target; improved in place
/// @param goal clearance that contact asks for [m]
void smooth(std::vector<Posture>& way, std::vector<Search>& searches, double goal, int max_rounds);

}  // namespace sinew::inline v1
