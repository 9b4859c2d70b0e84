/// @file curve_walk.hpp
/// Step after step along a curve. Theory: docs/theory/continuation.md
#pragma once
#include "solve/tracer.hpp"

namespace sinew::inline v1 {

/// What came of a step along a curve.
enum class CurveStep { failed, taken, last };

/// Steps along a curve, each from the place `begun`: `step(stride)` takes one, `longest()` bounds the next.
template <class Problem, class HasBudget, class Longest, class TakeStep>
StepsEnd walk(Tracer<Problem>& tracer, typename Problem::Place& begun, const StrideOptions& options,
              HasBudget&& has_budget, Longest&& longest, TakeStep&& step) {
  tracer.save(begun);
  const auto is_short = [&](double stride) { return stride < tracer.shortest_verified * tracer.size(); };
  return take_steps(options, has_budget, [&](double stride) -> std::optional<double> {
    tracer.before() = begun;
    const CurveStep what = step(stride);
    if (what == CurveStep::last) return {};
    if (what == CurveStep::failed) {
      tracer.restore(begun);
      if (is_short(stride / 3) && !is_short(stride)) {
        tracer.look_closely();
        tracer.save(begun);
      }
      return stride / 3;
    }
    tracer.save(begun);
    const double next = tracer.corrections() <= 3 ? std::min(1.6 * stride, longest()) : stride;
    if (!is_short(next)) tracer.look_farther();
    return next;
  });
}

}  // namespace sinew::inline v1
