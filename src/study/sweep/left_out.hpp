/// @file left_out.hpp
/// Samples with a derived value outside its limits: no sampler sees them.
#pragma once
#include "query/batch/sampler.hpp"
#include "sinew/study/study.hpp"

namespace sinew::inline v1 {

/// Whether a sample is left out.
/// @param values of its axes and derived values; one within rounding of a limit is within it, so that a grid
/// that ends on a limit keeps its end
bool is_left_out(const Study& study, std::span<const double> values);

/// A sampler of whole blocks made of one: it gets what is kept of a block as a block of its own, in the same
/// order, so that neighbours stay neighbours. The rest has the status `left_out` and no outputs. Where the
/// study limits nothing it is the sampler itself.
Sampler without_left_out(const Study& study, Sampler sampler);

}  // namespace sinew::inline v1
