/// @file plan.hpp
/// Everything of a sweep that its data depend on.
#pragma once
#include "query/batch/sampler.hpp"
#include "sinew/study/sweep.hpp"
#include "study/results/chunk_log.hpp"
#include "study/results/result_file.hpp"
#include "study/sweep/samples.hpp"

namespace sinew::inline v1 {

/// What a study asks at each of its samples.
BatchQuestion question_of(const Study& study);

class SweepPlan {
 public:
  /// @param study prepared; it must outlive the plan
  explicit SweepPlan(const Study& study);

  const Study& study() const { return study_; }
  const SamplerKind& kind() const { return kind_; }
  const Chunks& chunks() const { return chunks_; }
  bool reduces() const { return !study_.reductions.empty(); }
  bool snakes() const { return study_.is_path && study_.sampling == Study::Sampling::grid; }

  Digest key() const;  ///< tells apart sweeps whose data may differ
  ResultLayout layout(const SweepOptions& options) const;

 private:
  std::vector<Fact> provenance(const SweepOptions& options) const;

  const Study& study_;
  SamplerKind kind_;
  Chunks chunks_;
};

std::string hexadecimal(const Digest& digest);

}  // namespace sinew::inline v1
