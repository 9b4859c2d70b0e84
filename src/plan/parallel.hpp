/// @file parallel.hpp
/// Independent pieces of work on a few threads.
#pragma once
#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace sinew::inline v1 {

/// Calls `work(i, thread)` once for every i < count; what it does must not depend on the thread.
template <class Work>
void in_parallel(std::size_t count, std::size_t threads, Work&& work) {
  std::atomic<std::size_t> next = 0;
  const auto run = [&](std::size_t thread) {
    for (std::size_t i; (i = next.fetch_add(1)) < count;) work(i, thread);
  };
  std::vector<std::jthread> helpers;
  for (std::size_t t = 1; t < std::min(threads, count); ++t) helpers.emplace_back(run, t);
  run(0);
}

}  // namespace sinew::inline v1
