/// @file stopped.hpp
/// The report of a solve that was asked to stop.
#pragma once
#include "sinew/base/stop.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v0 {

/// Replaces status and message where a stop was requested; residual and iterations stay those of the best
/// iterate.
inline bool note_stop(StopToken stop, Report& report) {
  if (!stop.stop_requested()) return false;
  report.status = Status::stopped;
  report.message = std::string_view("stopped on request before the answer was complete");
  return true;
}

}  // namespace sinew::inline v0
