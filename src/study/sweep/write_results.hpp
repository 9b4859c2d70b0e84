/// @file write_results.hpp
/// The chunks of a finished sweep into its file of results.
#pragma once
#include <array>
#include <atomic>

#include "study/sweep/plan.hpp"

namespace sinew::inline v1 {

struct WrittenResults {
  std::vector<FittedTerms> fits;
  std::array<std::size_t, sample_statuses> statuses{};  ///< of all samples; of a reduction it keeps none
};

/// Writes the file and does the fits. The log stays. Codes: `write_failed`, `file_unreadable`, `stopped`.
Expected<WrittenResults> write_results(const SweepPlan& plan, const ChunkLog& log,
                                       const SweepOptions& options, const std::atomic<bool>& stop);

}  // namespace sinew::inline v1
