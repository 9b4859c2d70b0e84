#include "study/sweep/executor.hpp"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <memory>

#ifdef __SANITIZE_THREAD__
extern "C" void __tsan_acquire(void* at);
extern "C" void __tsan_release(void* at);
#endif

namespace sinew::inline v1 {
namespace {

/// A filter's turn. ThreadSanitizer does not see how TBB, which is not compiled with it, hands things from
/// one filter to the next: it is told that a turn comes after those that have ended.
struct Turn {
#ifdef __SANITIZE_THREAD__
  explicit Turn(void* pipeline) : pipeline_(pipeline) { __tsan_acquire(pipeline_); }
  ~Turn() { __tsan_release(pipeline_); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;
  void* pipeline_;
#else
  explicit Turn(void*) {}
#endif
};

struct Done {
  std::size_t chunk = 0;
  std::vector<std::byte> bytes;
};

}  // namespace

void run_on_threads(const ChunkJob& job, int threads) {
  namespace tbb = oneapi::tbb;
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  tbb::task_arena arena(threads);
  tbb::enumerable_thread_specific<ChunkWorker> workers(job.make_worker);
  char pipeline = 0;
  { const Turn begun(&pipeline); }
  arena.execute([&] {
    tbb::parallel_pipeline(
        2 * static_cast<std::size_t>(threads),
        tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order,
                                            [&](tbb::flow_control& flow) -> std::size_t {
                                              const Turn turn(&pipeline);
                                              const auto chunk = job.next();
                                              if (!chunk) flow.stop();
                                              return chunk.value_or(0);
                                            }) &
            tbb::make_filter<std::size_t, std::shared_ptr<Done>>(
                tbb::filter_mode::parallel,
                [&](std::size_t chunk) {
                  const Turn turn(&pipeline);
                  auto done = std::make_shared<Done>(Done{chunk, {}});
                  workers.local()(chunk, done->bytes);
                  return done;
                }) &
            tbb::make_filter<std::shared_ptr<Done>, void>(tbb::filter_mode::serial_out_of_order,
                                                          [&](const std::shared_ptr<Done>& done) {
                                                            const Turn turn(&pipeline);
                                                            job.keep(done->chunk, done->bytes, false);
                                                          }));
  });
  const Turn ended(&pipeline);
}

int core_count() { return std::max(1, oneapi::tbb::info::default_concurrency()); }

}  // namespace sinew::inline v1
