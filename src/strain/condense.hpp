/// @file condense.hpp
/// Newton's equations of a rod, piece after piece from its tip to its base: cost linear in pieces. Theory:
/// docs/theory/strain_rod.md
#pragma once
#include "strain/rod_model.hpp"

namespace sinew::inline v1::strain {

/// What a factorisation tells.
struct Inertia {
  bool ok = false;  ///< every pivot is far enough from 0
  /// Of symmetric terms how many eigenvalues of H + shift are below 0; of others 1 where its determinant is.
  int negative = 0;
};

/// Leaves of the terms their symmetric part.
void make_symmetric(const RodModel& model, RodWork& work);
/// Factors H + shift, from the terms of the last `sweep_back_with_hessian`.
Inertia factor(const RodModel& model, RodWork& work, double shift);
/// (H + shift)⁻¹ of `columns` right sides in place; a row for each coordinate, rows `stride` numbers apart, a
/// multiple of eight.
void solve(const RodModel& model, RodWork& work, double* sides, int columns, int stride);
/// The twist of the tip, in its axes, by each coordinate: 6 rows of model.size.
void tip_twists(const RodModel& model, const RodWork& work, double* rows);

}  // namespace sinew::inline v1::strain
