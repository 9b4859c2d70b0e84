/// @file chunks_in_place.hpp
/// The chunks of a sweep in its file of results, where they stay.
#pragma once
#include <optional>

#include "study/results/chunk_log.hpp"
#include "study/results/result_in_place.hpp"
#include "study/sweep/plan.hpp"
#include "study/sweep/write_results.hpp"

namespace sinew::inline v1 {

class ChunksInPlace : public ChunkPlace {
 public:
  /// Whether rows go into the file as they are computed: HDF5, uncompressed, nothing added up or fitted.
  static bool serves(const SweepPlan& plan, const SweepOptions& options);

  ChunksInPlace(const SweepPlan& plan, const SweepOptions& options) : plan_(plan), options_(options) {}

  /// Where a run was killed between giving the file its name and removing the log.
  bool has_become_results() const;

  Expected<void> open(bool resumes) override;
  Expected<void> write(std::size_t chunk, std::span<const std::byte> bytes) override;
  bool read(std::size_t chunk, std::vector<std::byte>& bytes) const override;
  void flush() override { file_->flush(); }

  /// All chunks are there.
  Expected<WrittenResults> finish();

 private:
  std::span<const double> axes_of(const Chunk& chunk, std::vector<double>& values) const;

  const SweepPlan& plan_;
  const SweepOptions& options_;
  std::size_t axes_ = 0;  ///< columns that are axes
  std::optional<ResultInPlace> file_;
};

}  // namespace sinew::inline v1
