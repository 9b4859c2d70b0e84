/// @file stopped.hpp
/// The report of a solve that was asked to stop.
#pragma once
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// Status and message of it; residual and iterations stay those of the best iterate.
inline void say_stopped(Report& report) {
  report.status = Status::stopped;
  report.message = std::string_view("stopped on request before the answer was complete");
}

/// The same where a stop was requested.
inline bool note_stop(StopToken stop, Report& report) {
  const bool is_stopped = stop.stop_requested();
  if (is_stopped) say_stopped(report);
  return is_stopped;
}

}  // namespace sinew::inline v1
