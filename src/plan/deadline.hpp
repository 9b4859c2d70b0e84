/// @file deadline.hpp
/// When a search has to end.
#pragma once
#include <chrono>

#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

struct Deadline {
  StopToken stop;
  std::chrono::steady_clock::time_point at = std::chrono::steady_clock::time_point::max();
  bool is_over() const { return stop.stop_requested() || std::chrono::steady_clock::now() > at; }
};

}  // namespace sinew::inline v1
