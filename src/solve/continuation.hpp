/// @file continuation.hpp
/// Following a solution while a parameter grows, in steps whose length their own success decides.
/// Theory: docs/theory/continuation.md
#pragma once
#include <algorithm>
#include <optional>

#include "sinew/solve/report.hpp"
#include "solve/contraction.hpp"

namespace sinew::inline v1 {

/// How a series of steps ended; `lost`: no step however short succeeds.
enum class StepsEnd { done, lost, ran_out, stopped };

struct StrideOptions {
  double first = 1;
  double shortest = 1e-6;  ///< strides end where they are no longer than that
  StopToken stop = {};
};

/// Calls `attempt(stride)` until it says no next stride: then the way is done.
template <class HasBudget, class Attempt>
StepsEnd take_steps(const StrideOptions& options, HasBudget&& has_budget, Attempt&& attempt) {
  for (double stride = options.first;;) {
    if (!has_budget()) return StepsEnd::ran_out;
    if (!(stride > options.shortest)) return StepsEnd::lost;
    if (options.stop.stop_requested()) return StepsEnd::stopped;
    const std::optional<double> next = attempt(stride);
    if (!next) return StepsEnd::done;
    stride = *next;
  }
}

/// What came of a step along a parameter, and the stride that is to follow.
struct ParameterStep {
  enum Kind {
    failed,
    crossed,  ///< signs of the curve changed over it, and it is too long to tell that no other was met
    reached,
    reached_other_side,  ///< the same over a step that is short enough
  } kind;
  double next = 0;        ///< stride; 0 gives up
  double verifiable = 0;  ///< how much of the way may be stepped over where signs change
};

struct ParameterOptions {
  StrideOptions stride = {};
  double shortest_share = 0;  ///< of what is behind: no stride is shorter
  int max_iterations = 0;     ///< see there
};

/// How a path along a parameter ended.
struct ParameterPath {
  bool arrived = false;
  bool ran_out = false;  ///< of iterations
  bool stopped = false;  ///< on request
  double progress = 0;   ///< 0 at the start, 1 at the target
  int iterations = 0;    ///< counted by whoever attempts
};

/// From 0 to 1. `attempt(next, taken)` goes to `next`, over `taken` of the way, or leaves everything as it
/// was. A step that crossed is halved until the place where signs change is near: a long one may have led to
/// another curve.
template <class Attempt>
void follow_parameter(ParameterPath& end, const ParameterOptions& options, Attempt&& attempt) {
  double suspect = 0, verifiable = 0, stride_before = options.stride.first;
  const auto is_ahead = [&] { return suspect > end.progress; };
  const auto go_on = [&](double stride) -> std::optional<double> {
    double next = std::min(1.0, end.progress + stride);
    if (is_ahead()) {
      const double ahead = suspect - end.progress;
      next = std::min(next, ahead <= verifiable ? suspect : end.progress + 0.5 * ahead);
      if (!(next > end.progress)) next = suspect;
    }
    const double taken = next - end.progress;
    const ParameterStep step = attempt(next, taken);
    if (step.kind == ParameterStep::failed) return step.next;
    verifiable = step.verifiable;
    if (step.kind == ParameterStep::crossed) {
      if (!is_ahead()) stride_before = taken;
      suspect = next;
      return stride;
    }
    const bool passes = is_ahead() && next >= suspect;
    if (step.kind == ParameterStep::reached_other_side) suspect = 0;
    end.progress = next;
    if (next == 1) return {};
    return passes ? stride_before : step.next;
  };
  const auto has_budget = [&] { return end.iterations < options.max_iterations; };
  const StepsEnd why = take_steps(options.stride, has_budget, [&](double stride) {
    auto next = go_on(stride);
    if (next && !(*next > options.shortest_share * end.progress)) next = 0;
    return next;
  });
  end.arrived = why == StepsEnd::done;
  end.ran_out = why == StepsEnd::ran_out;
  end.stopped = why == StepsEnd::stopped;
}

}  // namespace sinew::inline v1
