/// @file cpu_time.hpp
/// The time that this process has computed. What a test allows of it does not depend on what else the machine
/// does.
#pragma once
#include <ctime>

namespace sinew::test {

/// Of all threads together, those that have ended too [s].
inline double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace sinew::test
