/// @file write_results.hpp
/// The chunks of a finished sweep into its file of results.
#pragma once
#include "study/sweep/plan.hpp"

namespace sinew::inline v0 {

/// Writes the file and does the fits. The log stays. Codes: `write_failed`, `file_unreadable`.
Expected<std::vector<FittedTerms>> write_results(const SweepPlan& plan, const ChunkLog& log,
                                                 const SweepOptions& options);

}  // namespace sinew::inline v0
