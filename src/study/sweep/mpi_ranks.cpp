/// Ranks by MPI; without it, only the message that says so.
#include <cstdlib>

#include "study/cluster.hpp"
#include "study/sweep/executor.hpp"

#ifdef SINEW_WITH_MPI
#include <mpi.h>

#include <array>
#include <chrono>
#include <cstring>
#include <mutex>
#include <thread>
#endif

namespace sinew::inline v1 {
namespace {

/// Of the starters of OpenMPI, MPICH, and Slurm with either.
bool is_started_together() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* text = std::getenv(name)) return std::atoi(text) > 1;
  const char* tasks = std::getenv("SLURM_NTASKS");
  return std::getenv("PMIX_RANK") && (!tasks || std::atoi(tasks) > 1);
}

#ifdef SINEW_WITH_MPI
constexpr int no_chunk = -1;
enum Tag : int { tag_request = 1, tag_chunk, tag_result, tag_end };

/// Results travel with their number in front.
class MpiRanks : public Ranks {
 public:
  MpiRanks() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    MPI_Comm here;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &here);
    MPI_Comm_size(here, &size_here_);
    MPI_Comm_free(&here);
  }
  ~MpiRanks() override { MPI_Finalize(); }

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  int size_here() const override { return size_here_; }

  void run(const ChunkJob& job, int threads) override {
    if (rank_ == 0)
      lead(job, threads);
    else
      follow(job, threads);
  }

  bool all_say(bool yes) override {
    int value = yes ? 1 : 0;
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    return value != 0;
  }

  bool all_have(std::uint64_t number) override {
    std::array<std::uint64_t, 2> ends{number, ~number};  // the largest of both is the largest and the least
    MPI_Allreduce(MPI_IN_PLACE, ends.data(), 2, MPI_UINT64_T, MPI_MAX, MPI_COMM_WORLD);
    return ends[0] == ~ends[1];
  }

  void add_up(std::span<double> values) override {
    const int count = static_cast<int>(values.size());
    if (rank_ == 0)
      MPI_Reduce(MPI_IN_PLACE, values.data(), count, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
    else
      MPI_Reduce(values.data(), nullptr, count, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
  }

 private:
  /// Rank 0 computes on its threads as all do; this one serves the others, and alone speaks to MPI.
  void lead(const ChunkJob& job, int threads) {
    std::mutex mutex;
    const ChunkJob shared{
        .next =
            [&] {
              const std::scoped_lock lock(mutex);
              return job.next();
            },
        .make_worker = job.make_worker,
        .keep =
            [&](std::size_t chunk, std::span<const std::byte> bytes, bool is_from_elsewhere) {
              const std::scoped_lock lock(mutex);
              job.keep(chunk, bytes, is_from_elsewhere);
            }};
    const std::jthread own([&] { run_on_threads(shared, threads); });
    for (int followers = size_ - 1; followers > 0;) {
      int is_there = 0;
      MPI_Status status;
      MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &is_there, &status);
      if (!is_there)  // MPI's own waiting would take a core
        std::this_thread::sleep_for(std::chrono::microseconds(100));
      else
        followers -= serve(shared, status);
    }
  }

  /// One message of a follower; 1 where it was its last.
  int serve(const ChunkJob& job, const MPI_Status& status) {
    int size = 0;
    MPI_Get_count(&status, MPI_BYTE, &size);
    message_.resize(static_cast<std::size_t>(size));
    MPI_Recv(message_.data(), size, MPI_BYTE, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD,
             MPI_STATUS_IGNORE);
    if (status.MPI_TAG == tag_request) {
      const auto chunk = job.next();
      const long long number = chunk ? static_cast<long long>(*chunk) : no_chunk;
      MPI_Send(&number, 1, MPI_LONG_LONG, status.MPI_SOURCE, tag_chunk, MPI_COMM_WORLD);
    } else if (status.MPI_TAG == tag_result) {
      std::uint64_t chunk = 0;
      std::memcpy(&chunk, message_.data(), sizeof chunk);
      job.keep(chunk, std::span(message_).subspan(sizeof chunk), true);
    }
    return status.MPI_TAG == tag_end;
  }

  /// Its threads take turns at MPI.
  void follow(const ChunkJob& job, int threads) {
    std::mutex mutex;
    std::vector<std::byte> message;
    const ChunkJob remote{
        .next = [&]() -> std::optional<std::size_t> {
          const std::scoped_lock lock(mutex);
          long long number = no_chunk;
          MPI_Send(nullptr, 0, MPI_BYTE, 0, tag_request, MPI_COMM_WORLD);
          MPI_Recv(&number, 1, MPI_LONG_LONG, 0, tag_chunk, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
          return number == no_chunk ? std::nullopt : std::optional(static_cast<std::size_t>(number));
        },
        .make_worker = job.make_worker,
        .keep =
            [&](std::size_t chunk, std::span<const std::byte> bytes, bool) {
              if (bytes.empty()) return;  // broken off
              const std::scoped_lock lock(mutex);
              const std::uint64_t number = chunk;
              message.resize(sizeof number + bytes.size());
              std::memcpy(message.data(), &number, sizeof number);
              std::memcpy(message.data() + sizeof number, bytes.data(), bytes.size());
              MPI_Send(message.data(), static_cast<int>(message.size()), MPI_BYTE, 0, tag_result,
                       MPI_COMM_WORLD);
            }};
    run_on_threads(remote, threads);
    MPI_Send(nullptr, 0, MPI_BYTE, 0, tag_end, MPI_COMM_WORLD);
  }

  int rank_ = 0, size_ = 1, size_here_ = 1;
  std::vector<std::byte> message_;
};
#endif

}  // namespace

Expected<std::unique_ptr<Ranks>> join_ranks() {
  if (!is_started_together()) return std::unique_ptr<Ranks>();
#ifdef SINEW_WITH_MPI
  return std::unique_ptr<Ranks>(std::make_unique<MpiRanks>());
#else
  return failure(
      "no_mpi", "",
      "this sinew was built without MPI, so that every process would run the whole sweep; build it with "
      "-D SINEW_MPI=ON, or start one process.");
#endif
}

}  // namespace sinew::inline v1
