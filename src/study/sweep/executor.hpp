/// @file executor.hpp
/// Chunks computed side by side: by threads of this process, or by the ranks of a cluster. An executor sees
/// numbers of chunks and bytes, no robot.
#pragma once
#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace sinew::inline v1 {

/// The bytes of a chunk; empty where the work was broken off.
using ChunkWorker = std::function<void(std::size_t chunk, std::vector<std::byte>& bytes)>;

struct ChunkJob {
  /// The next chunk to compute, or none. Called by one thread at a time.
  std::function<std::optional<std::size_t>()> next;
  /// A worker for one thread. Called by several threads.
  std::function<ChunkWorker()> make_worker;
  /// Takes what was computed, here or by another rank, in any order. Called by one thread at a time.
  std::function<void(std::size_t chunk, std::span<const std::byte> bytes, bool is_from_elsewhere)> keep;
};

/// On threads of this process. Memory: two chunks a thread, however many there are.
void run_on_threads(const ChunkJob& job, int threads);

/// Threads this process may use: one for each core.
int core_count();

}  // namespace sinew::inline v1
