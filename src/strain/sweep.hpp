/// @file sweep.hpp
/// Along a rod and back: frames and energy, then the gradient of the potential and its Hessian. Theory:
/// docs/theory/strain_rod.md
#pragma once
#include "strain/rod_model.hpp"

namespace sinew::inline v1::strain {

/// From the coordinates `y` strains, frames, lengths of tendons and the energy.
void sweep_out(const RodModel& model, RodWork& work);
/// After it: the gradient of energy and of tendons at their tensions; that of each tendon's length.
void sweep_back(const RodModel& model, RodWork& work);
/// The same and the Hessian's terms, piece by piece. Where a load has no potential they are not symmetric.
void sweep_back_with_hessian(const RodModel& model, RodWork& work);

}  // namespace sinew::inline v1::strain
