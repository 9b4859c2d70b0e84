/// @file cluster.hpp
/// The ranks of a cluster: processes that mpirun or srun started together.
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "sinew/base/error.hpp"

namespace sinew::inline v1 {

struct ChunkJob;

/// The processes that run one sweep together. Rank 0 hands out the chunks and writes.
class Ranks {
 public:
  virtual ~Ranks() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  virtual int size_here() const = 0;  ///< of them on this machine
  /// Runs a job together; of the job of another rank than 0 only the workers count.
  virtual void run(const ChunkJob& job, int threads) = 0;
  /// On every rank, whether all say so. A rank that has nothing to say must not leave the others waiting.
  virtual bool all_say(bool yes) = 0;
  /// On every rank, whether all have this number.
  virtual bool all_have(std::uint64_t number) = 0;
  /// Sums to rank 0; elsewhere the own ones stay.
  virtual void add_up(std::span<double> values) = 0;
};

/// The ranks this process is one of; null where it was started alone. To be called once, and destroyed before
/// the process ends. Code `no_mpi`: there are several ranks, but this sinew was built without MPI.
Expected<std::unique_ptr<Ranks>> join_ranks();

}  // namespace sinew::inline v1
