/// @file ranks.hpp
/// The processes of a cluster that run one sweep together. Rank 0 hands out the chunks and writes.
#pragma once
#include "study/sweep/executor.hpp"

namespace sinew::inline v0 {

class Ranks {
 public:
  virtual ~Ranks() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  /// Runs a job together; of the job of another rank than 0 only `make_worker` counts.
  virtual void run(const ChunkJob& job, int threads) = 0;
  /// What rank 0 says, on every rank.
  virtual int agreed(int value) = 0;
  /// Sums to rank 0; elsewhere the own ones stay.
  virtual void add_up(std::span<double> values) = 0;
};

}  // namespace sinew::inline v0
