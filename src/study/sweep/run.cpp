/// A sweep from its study to its file of results.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <thread>

#include "io/file/write_file.hpp"
#include "sinew/study/sweep.hpp"
#include "study/cluster.hpp"
#include "study/sweep/chunks_in_place.hpp"
#include "study/sweep/executor.hpp"
#include "study/sweep/left_out.hpp"
#include "study/sweep/plan.hpp"
#include "study/sweep/prepare.hpp"
#include "study/sweep/reduction.hpp"
#include "study/sweep/write_results.hpp"

namespace sinew::inline v1 {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_chunks = 20'000'000;  ///< each takes 16 bytes of memory

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// What threads tell each other.
struct Pulse {
  std::atomic<std::size_t> samples{0};
  std::atomic<bool> stop{false};
  std::mutex mutex;  ///< of what follows
  std::array<double, sample_statuses> statuses{};
  double computing = 0;
};

/// Computes chunks on one thread.
class Worker {
 public:
  Worker(const SweepPlan& plan, Pulse& pulse)
      : plan_(plan),
        pulse_(pulse),
        sample_(without_left_out(plan.study(), plan.kind().make())) {}

  void operator()(std::size_t number, std::vector<std::byte>& bytes) {
    const auto begin = Clock::now();
    const Study& study = plan_.study();
    const Chunk chunk = plan_.chunks()[number];
    axes_.resize(study.variable_count() * chunk.count);
    outputs_.resize(study.outputs.size() * chunk.count);
    statuses_.assign(chunk.count, converged);
    axis_values(study, chunk, plan_.snakes(), axes_);
    place_columns<const double>(axes_, chunk.count, input_columns_);
    place_columns<double>(outputs_, chunk.count, output_columns_);
    const SampleBlock block{chunk.count, input_columns_,  output_columns_,
                            statuses_,   &pulse_.samples, &pulse_.stop};
    sample_(block);
    if (pulse_.stop) return;  // broken off
    if (plan_.snakes()) straighten(chunk);
    if (plan_.reduces())
      pack_cells(study, block, bytes);
    else
      pack_samples(outputs_, statuses_, bytes);
    const std::scoped_lock lock(pulse_.mutex);
    for (const SampleStatus status : statuses_) ++pulse_.statuses[status];
    pulse_.computing += seconds_since(begin);
  }

 private:
  void straighten(const Chunk& chunk) {
    const std::size_t row = row_of(plan_.study());
    for (std::size_t o = 0; o < plan_.study().outputs.size(); ++o)
      unwind(chunk, row, std::span(outputs_).subspan(o * chunk.count, chunk.count));
    unwind(chunk, row, std::span(statuses_));
  }

  const SweepPlan& plan_;
  Pulse& pulse_;
  Sampler sample_;
  std::vector<double> axes_, outputs_;
  InputColumns input_columns_;
  OutputColumns output_columns_;
  std::vector<SampleStatus> statuses_;
};

/// Calls the caller's progress while it lives: often, since the answer may be to stop.
class Ticker {
 public:
  Ticker(const SweepOptions& options, SweepProgress progress, Pulse& pulse) {
    if (options.progress)
      thread_ = std::jthread([this, &options, progress, &pulse](const std::stop_token& end) mutable {
        const auto begin = Clock::now();
        std::unique_lock lock(mutex_);
        while (!end.stop_requested()) {
          progress.done = progress.resumed + pulse.samples;
          progress.seconds = seconds_since(begin);
          if (!options.progress(progress)) pulse.stop = true;
          wakes_.wait_for(lock, end, std::chrono::milliseconds(50), [&] { return end.stop_requested(); });
        }
      });
  }

 private:
  std::mutex mutex_;
  std::condition_variable_any wakes_;
  std::jthread thread_;
};

/// One run.
class Sweep {
 public:
  Sweep(const Study& study, const SweepOptions& options) : plan_(study), options_(options) {
    summary_.samples = study.samples;
    summary_.sampler = plan_.kind().name;
    summary_.instruction_set = instruction_set_in_use();
    const int sharing = options.ranks ? options.ranks->size_here() : 1;
    summary_.threads = options.threads > 0 ? options.threads : std::max(1, core_count() / sharing);
    summary_.ranks = options.ranks ? options.ranks->size() : 1;
  }

  Expected<SweepSummary> run() {
    const auto begin = Clock::now();
    const bool is_first = !options_.ranks || options_.ranks->rank() == 0;
    Expected<void> opened;
    if (is_first) opened = open();
    const bool goes = opened.has_value() && !summary_.was_complete;
    if (options_.ranks ? !options_.ranks->all_say(goes) : !goes) {
      if (!opened) return tl::unexpected(opened.error());
      summary_.is_complete = true;
      return summary_;
    }
    const Ticker ticker(options_, {.total = summary_.samples, .resumed = summary_.resumed}, pulse_);
    compute();
    collect();
    if (is_first)
      if (const auto done = conclude(); !done) return tl::unexpected(done.error());
    summary_.total = seconds_since(begin);
    return summary_;
  }

 private:
  Expected<void> open() {
    if (Errors errors = refuse_result_name(options_.output); !errors.empty())
      return tl::unexpected(std::move(errors));
    if (plan_.chunks().count() > max_chunks)
      return failure(
          "too_large", plan_.study().source,
          fmt::format(
              "has {} samples in {} chunks, more than a log of this version holds; make several studies",
              plan_.study().samples, plan_.chunks().count()));
    const Digest key = plan_.key();
    const fs::path path = options_.output.string() + ".log";
    if (ChunksInPlace::serves(plan_, options_)) in_place_.emplace(plan_, options_);
    std::error_code ignored;
    const bool is_going_on = fs::exists(path, ignored) && !(in_place_ && in_place_->has_become_results());
    if (options_.resume && !is_going_on && recorded_fact(options_.output, "key") == hexadecimal(key)) {
      fs::remove(path, ignored);
      summary_.was_complete = true;
      return {};
    }
    if (!fs::exists(path, ignored))
      if (auto spared = spare(); !spared) return spared;
    auto log = ChunkLog::open(path, key, plan_.chunks().count(),
                              options_.resume ? ChunkLog::Open::resume : ChunkLog::Open::create,
                              in_place_ ? &*in_place_ : nullptr);
    if (!log) return tl::unexpected(log.error());
    log_ = std::move(*log);
    // what could not be written at the end is not begun; this leaves nothing
    const bool is_read_once = is_stream(options_.output) && options_.output.extension() == ".csv";
    if (!is_read_once && !in_place_)
      if (const auto trial = create_result(options_.output, plan_.layout(options_)); !trial) {
        if (log_->count() == 0) log_->remove();
        return tl::unexpected(trial.error());
      }
    for (std::size_t c = 0; c < plan_.chunks().count(); ++c)
      if (log_->has(c)) summary_.resumed += plan_.chunks()[c].count;
    return {};
  }

  /// Results are hours of work: none are replaced that nobody said could go.
  Expected<void> spare() const {
    std::error_code ignored;
    if (options_.replaces_results || !fs::is_regular_file(options_.output, ignored) ||
        fs::file_size(options_.output, ignored) == 0)
      return {};
    const bool is_same = recorded_fact(options_.output, "key") == hexadecimal(plan_.key());
    return failure(
        "result_exists", options_.output.string(),
        is_same ? "holds the results of this very sweep; --resume takes them as they are, --force computes "
                  "them anew"
                : "is there, and holds something else than this sweep; --force replaces it, or give another "
                  "--output");
  }

  void compute() {
    const ChunkJob job{
        .next = [this] { return next(); },
        .make_worker = [this]() -> ChunkWorker {
          return [worker = std::make_shared<Worker>(plan_, pulse_)](
                     std::size_t chunk, std::vector<std::byte>& bytes) { (*worker)(chunk, bytes); };
        },
        .keep =
            [this](std::size_t chunk, std::span<const std::byte> bytes, bool is_from_elsewhere) {
              if (is_from_elsewhere) pulse_.samples += plan_.chunks()[chunk].count;
              keep(chunk, bytes);
            }};
    if (options_.ranks)
      options_.ranks->run(job, summary_.threads);
    else
      run_on_threads(job, summary_.threads);
  }

  std::optional<std::size_t> next() {
    while (next_ < plan_.chunks().count() && log_->has(next_)) ++next_;
    if (pulse_.stop || next_ >= plan_.chunks().count()) return {};
    return next_++;
  }

  void keep(std::size_t chunk, std::span<const std::byte> bytes) {
    if (bytes.empty() || error_) return;  // broken off
    const auto begin = Clock::now();
    if (auto done = log_->append(chunk, bytes); !done) {
      error_ = std::move(done.error());
      pulse_.stop = true;
    }
    (in_place_ ? summary_.writing : summary_.logging) += seconds_since(begin);
  }

  void collect() {
    std::array<double, sample_statuses + 1> sums{};
    std::ranges::copy(pulse_.statuses, sums.begin());
    sums.back() = pulse_.computing;
    if (options_.ranks) options_.ranks->add_up(sums);
    for (std::size_t s = 0; s < sample_statuses; ++s)
      summary_.statuses[s] = static_cast<std::size_t>(sums[s]);
    summary_.computing = sums.back() / (summary_.threads * summary_.ranks);
  }

  Expected<void> conclude() {
    if (error_) return tl::unexpected(*error_);
    if (!in_place_) summary_.logged_bytes = log_->bytes();
    if (log_->count() < plan_.chunks().count()) {
      log_->flush();
      return {};
    }
    const auto begin = Clock::now();
    auto written = in_place_ ? in_place_->finish() : write_results(plan_, *log_, options_, pulse_.stop);
    if (!written && written.error().front().code == "stopped") return {};
    if (!written) return tl::unexpected(written.error());
    summary_.fits = std::move(written->fits);
    summary_.counts_all = !plan_.reduces() || summary_.resumed == 0;
    if (!plan_.reduces()) summary_.statuses = written->statuses;
    summary_.writing += seconds_since(begin);
    std::error_code ignored;
    summary_.written_bytes = fs::file_size(options_.output, ignored);
    log_->remove();
    summary_.is_complete = true;
    return {};
  }

  SweepPlan plan_;
  const SweepOptions& options_;
  SweepSummary summary_;
  Pulse pulse_;
  std::optional<ChunksInPlace> in_place_;
  std::optional<ChunkLog> log_;
  std::size_t next_ = 0;
  std::optional<Errors> error_;
};

}  // namespace

std::string_view sample_status_name(std::size_t status) { return name_of(static_cast<SampleStatus>(status)); }

Expected<SweepColumns> sweep_columns(Study study) {
  const auto warning = prepare(study);
  if (!warning) return tl::unexpected(warning.error());
  const SweepPlan plan(study);
  const ResultLayout layout = plan.layout({});
  SweepColumns columns{.dimensions = {},
                       .axes = {},
                       .columns = {},
                       .sampler = std::string(plan.kind().name),
                       .chunk = plan.chunks().largest(),
                       .chunks = plan.chunks().count(),
                       .warning = *warning};
  for (const auto& axis : layout.axes) {
    columns.axes.emplace_back(axis.name, axis.unit);
    if (layout.is_grid) columns.dimensions.push_back(axis.values.size());
  }
  if (columns.dimensions.empty()) columns.dimensions.push_back(layout.rows);
  for (const auto& column : layout.columns) columns.columns.emplace_back(column.name, column.unit);
  return columns;
}

namespace {

/// One study on every rank, or the error that keeps all of them from it.
Expected<void> agree(const Expected<std::string>& prepared, const Study& study, Ranks& ranks) {
  const bool is_well = ranks.all_say(prepared.has_value());
  const bool is_ill_everywhere = ranks.all_say(!prepared.has_value());  // one tells for all
  if (!prepared && (ranks.rank() == 0 || !is_ill_everywhere)) return tl::unexpected(prepared.error());
  if (!is_well)
    return failure("other_rank", study.source, "another rank could not begin with it; its message says why");
  std::uint64_t start = 0;
  const Digest key = SweepPlan(study).key();
  std::memcpy(&start, key.data(), sizeof start);
  if (ranks.all_have(start)) return {};
  return failure(
      "other_rank", study.source,
      "the ranks do not read the same study and robot, or run on machines with other instruction sets; "
      "choose one that all have: --isa avx2, or --isa baseline");
}

}  // namespace

Expected<SweepSummary> sweep(Study study, const SweepOptions& options) {
  const auto warning = prepare(study);
  if (options.ranks)
    if (const auto agreed = agree(warning, study, *options.ranks); !agreed)
      return tl::unexpected(agreed.error());
  if (!warning) return tl::unexpected(warning.error());
  auto summary = Sweep(study, options).run();
  if (summary) summary->warning = *warning;
  return summary;
}

}  // namespace sinew::inline v1
