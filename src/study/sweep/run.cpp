/// A sweep from its study to its file of results.
#include <fmt/format.h>
#include <sha2.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <limits>
#include <mutex>
#include <thread>

#include "sinew/study/sweep.hpp"
#include "study/sweep/chunk_log.hpp"
#include "study/sweep/executor.hpp"
#include "study/sweep/fit.hpp"
#include "study/sweep/prepare.hpp"
#include "study/sweep/ranks.hpp"
#include "study/sweep/reduction.hpp"
#include "study/sweep/result_file.hpp"
#include "study/sweep/sampler.hpp"
#include "study/sweep/samples.hpp"

namespace sinew::inline v0 {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

Digest sha256(std::span<const std::string> texts) {
  SHA2_CTX context;
  SHA256Init(&context);
  for (const std::string& text : texts) {
    const std::uint64_t size = text.size();  // else two texts could move their border
    SHA256Update(&context, reinterpret_cast<const std::uint8_t*>(&size), sizeof size);
    SHA256Update(&context, reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  }
  Digest digest{};
  SHA256Final(digest.data(), &context);
  return digest;
}

std::string sha256_of(const std::string& text) {
  std::array<char, SHA256_DIGEST_STRING_LENGTH> digits{};
  SHA256Data(reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), digits.data());
  return digits.data();
}

std::string hexadecimal(const Digest& digest) {
  std::string text;
  for (const std::uint8_t byte : digest) text += fmt::format("{:02x}", byte);
  return text;
}

/// What a tree says, for telling sweeps apart.
void write_tree(const Node& node, std::string& text) {
  text += fmt::format("({} {} {}", static_cast<int>(node.kind), node.text.size(), node.text);
  for (const Node& item : node.items) write_tree(item, text);
  for (const Member& member : node.members) {
    text += fmt::format("{} {}", member.key.size(), member.key);
    write_tree(member.value, text);
  }
  text += ')';
}

/// Everything of a sweep that its data depend on.
class Plan {
 public:
  explicit Plan(const Study& study)
      : study_(study),
        kind_(choose_sampler(study)),
        chunks_(study.samples, study.reductions.empty() ? row_of(study) : study.reduced_samples(),
                kind_.chunk) {}

  const Study& study() const { return study_; }
  const SamplerKind& kind() const { return kind_; }
  const Chunks& chunks() const { return chunks_; }
  bool reduces() const { return !study_.reductions.empty(); }
  bool snakes() const { return study_.is_path && study_.sampling == Study::Sampling::grid; }

  Digest key() const {
    std::string robot;  // with what --set changes
    write_tree(study_.robot_document.root, robot);
    return sha256(std::array<std::string, 6>{version(), std::string(instruction_set_in_use()), study_.text,
                                             robot, study_.list_text,
                                             fmt::format("{} {}", kind_.name, kind_.chunk)});
  }

  ResultLayout layout(const SweepOptions& options) const {
    ResultLayout layout{.title = study_.title, .axes = {}, .columns = {}, .provenance = {}};
    layout.is_grid = study_.sampling == Study::Sampling::grid;
    layout.has_status = !reduces();
    layout.compression = options.compression;
    layout.rows = study_.samples / study_.reduced_samples();
    const std::size_t kept = study_.axes.size() - study_.reduced_axes;
    for (std::size_t a = 0; a < kept; ++a) {
      const StudyAxis& axis = study_.axes[a];
      layout.axes.push_back({axis.name, axis.unit, layout.is_grid ? axis.values : std::vector<double>{}});
    }
    for (const StudyReduction& reduction : study_.reductions)
      layout.columns.push_back({reduction.name, reduction.kind == StudyReduction::Kind::part
                                                    ? ""
                                                    : study_.outputs[reduction.output].unit});
    if (!reduces())
      for (const StudyOutput& output : study_.outputs) layout.columns.push_back({output.name, output.unit});
    layout.provenance = provenance(options);
    return layout;
  }

 private:
  std::vector<Fact> provenance(const SweepOptions& options) const {
    std::vector<Fact> facts{{"sinew_version", version()},
                            {"command", options.command},
                            {"instruction_set", std::string(instruction_set_in_use())},
                            {"key", hexadecimal(key())},
                            {"study_sha256", sha256_of(study_.text)},
                            {"robot", study_.robot},
                            {"robot_sha256", sha256_of(study_.robot_text)}};
    if (!study_.list_text.empty()) facts.push_back({"list_sha256", sha256_of(study_.list_text)});
    facts.push_back({"study", study_.text});
    facts.push_back({"robot_file", study_.robot_text});
    return facts;
  }

  const Study& study_;
  SamplerKind kind_;
  Chunks chunks_;
};

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
  Worker(const Plan& plan, Pulse& pulse) : plan_(plan), pulse_(pulse), sample_(plan.kind().make()) {}

  void operator()(std::size_t number, std::vector<std::byte>& bytes) {
    const auto begin = Clock::now();
    const Study& study = plan_.study();
    const Chunk chunk = plan_.chunks()[number];
    axes_.resize(study.axes.size() * chunk.count);
    outputs_.resize(study.outputs.size() * chunk.count);
    statuses_.assign(chunk.count, converged);
    axis_values(study, chunk, plan_.snakes(), axes_);
    const SampleBlock block{chunk.count, axes_, outputs_, statuses_, &pulse_.samples, &pulse_.stop};
    sample_(block);
    if (pulse_.stop) return;  // broken off
    if (plan_.snakes()) straighten(chunk);
    if (plan_.reduces())
      pack_cells(study, block, bytes);
    else
      pack_samples(block, bytes);
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

  const Plan& plan_;
  Pulse& pulse_;
  Sampler sample_;
  std::vector<double> axes_, outputs_;
  std::vector<SampleStatus> statuses_;
};

/// Calls the caller's progress a few times a second while it lives.
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
          wakes_.wait_for(lock, end, std::chrono::milliseconds(200), [&] { return end.stop_requested(); });
        }
      });
  }

 private:
  std::mutex mutex_;
  std::condition_variable_any wakes_;
  std::jthread thread_;
};

/// The log into the file of results.
class Writer {
 public:
  Writer(const Plan& plan, const ChunkLog& log, const SweepOptions& options)
      : plan_(plan),
        log_(log),
        options_(options) {}

  Expected<std::vector<FittedTerms>> run() {
    auto file = create_result(options_.output, plan_.layout(options_));
    if (!file) return tl::unexpected(file.error());
    for (const StudyFit& fit : plan_.study().fits) fits_.emplace_back(fit);
    const auto read = plan_.reduces() ? cells(**file) : samples(**file, true);
    if (!read) return tl::unexpected(read.error());
    for (StreamedFit& fit : fits_) fit.solve();
    if (!fits_.empty())
      if (const auto again = samples(**file, false); !again) return tl::unexpected(again.error());
    std::vector<FittedTerms> found;
    for (std::size_t f = 0; f < fits_.size(); ++f) {
      found.push_back(fits_[f].result());
      const std::size_t axes = plan_.study().axes.size(), column = plan_.study().fits[f].column;
      found.back().unit =
          column < axes ? plan_.study().axes[column].unit : plan_.study().outputs[column - axes].unit;
    }
    if (const auto done = (*file)->finish(found); !done) return tl::unexpected(done.error());
    return found;
  }

 private:
  /// Every chunk, in order: into the file and the fits or, in a second pass, what the fits miss.
  Expected<void> samples(ResultFile& file, bool is_first) {
    const Study& study = plan_.study();
    std::vector<std::byte> bytes;
    std::vector<double> axes, row(study.axes.size() + study.outputs.size());
    for (std::size_t c = 0; c < plan_.chunks().count(); ++c) {
      const Chunk chunk = plan_.chunks()[c];
      if (const auto done = log_.read(c, bytes); !done) return done;
      const std::span values(reinterpret_cast<const double*>(bytes.data()),
                             study.outputs.size() * chunk.count);
      const std::span statuses(reinterpret_cast<const SampleStatus*>(bytes.data() + values.size_bytes()),
                               chunk.count);
      axes.resize(study.axes.size() * chunk.count);
      axis_values(study, chunk, false, axes);
      if (is_first)
        if (const auto done = file.write({chunk.first, chunk.count, axes, values, statuses}); !done)
          return done;
      for (std::size_t k = 0; !fits_.empty() && k < chunk.count; ++k) {
        for (std::size_t i = 0; i < row.size(); ++i)
          row[i] = i < study.axes.size() ? axes[i * chunk.count + k]
                                         : values[(i - study.axes.size()) * chunk.count + k];
        for (StreamedFit& fit : fits_) is_first ? fit.add(row) : fit.add_residual(row);
      }
    }
    return {};
  }

  /// Cells that several chunks share are added up in the order of the chunks.
  Expected<void> cells(ResultFile& file) {
    const Study& study = plan_.study();
    const std::size_t columns = study.reductions.size(), cell = study.reduced_samples();
    std::vector<std::byte> bytes;
    std::vector<CellSum> sums;
    std::size_t first = 0;
    for (std::size_t c = 0; c < plan_.chunks().count(); ++c) {
      const Chunk chunk = plan_.chunks()[c];
      if (const auto done = log_.read(c, bytes); !done) return done;
      const std::span more(reinterpret_cast<const CellSum*>(bytes.data()), bytes.size() / sizeof(CellSum));
      if (chunk.first % cell == 0) {
        sums.assign(more.begin(), more.end());
        first = chunk.first / cell;
      } else {
        for (std::size_t i = 0; i < columns; ++i) add(study.reductions[i].kind, sums[i], more[i]);
      }
      if ((chunk.first + chunk.count) % cell != 0) continue;
      if (const auto done = write_cells(file, first, sums); !done) return done;
    }
    return {};
  }

  Expected<void> write_cells(ResultFile& file, std::size_t first, std::span<const CellSum> sums) {
    const Study& study = plan_.study();
    const std::size_t columns = study.reductions.size(), count = sums.size() / columns;
    const std::size_t kept = study.axes.size() - study.reduced_axes;
    std::vector<double> values(sums.size()), axes(kept * count), one(study.axes.size());
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t i = 0; i < columns; ++i)
        values[i * count + k] = value_of(study.reductions[i].kind, sums[k * columns + i]);
      axis_values(study, {(first + k) * study.reduced_samples(), 1}, false, one);
      for (std::size_t a = 0; a < kept; ++a) axes[a * count + k] = one[a];
    }
    return file.write({first, count, axes, values, {}});
  }

  const Plan& plan_;
  const ChunkLog& log_;
  const SweepOptions& options_;
  std::vector<StreamedFit> fits_;
};

/// One run.
class Sweep {
 public:
  Sweep(const Study& study, const SweepOptions& options) : plan_(study), options_(options) {
    summary_.samples = study.samples;
    summary_.sampler = plan_.kind().name;
    summary_.instruction_set = instruction_set_in_use();
    summary_.threads = options.threads > 0 ? options.threads : core_count();
    summary_.ranks = options.ranks ? options.ranks->size() : 1;
  }

  Expected<SweepSummary> run() {
    const auto begin = Clock::now();
    const bool is_first = !options_.ranks || options_.ranks->rank() == 0;
    Expected<void> opened;
    if (is_first) opened = open();
    const bool goes = (opened.has_value() && !summary_.was_complete);
    if (options_.ranks ? options_.ranks->agreed(goes) == 0 : !goes) {
      if (!opened) return tl::unexpected(opened.error());
      summary_.is_complete = true;
      return summary_;
    }
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
    const Digest key = plan_.key();
    const fs::path path = options_.output.string() + ".log";
    std::error_code ignored;
    if (options_.resume && !fs::exists(path, ignored) &&
        recorded_fact(options_.output, "key") == hexadecimal(key)) {
      summary_.was_complete = true;
      return {};
    }
    auto log = ChunkLog::open(path, key, plan_.chunks().count(),
                              options_.resume ? ChunkLog::Open::resume : ChunkLog::Open::create);
    if (!log) return tl::unexpected(log.error());
    log_ = std::move(*log);
    for (std::size_t c = 0; c < plan_.chunks().count(); ++c)
      if (log_->has(c)) summary_.resumed += plan_.chunks()[c].count;
    return {};
  }

  void compute() {
    const Ticker ticker(options_, {.total = summary_.samples, .resumed = summary_.resumed}, pulse_);
    const ChunkJob job{
        .next = [this] { return next(); },
        .make_worker = [this]() -> ChunkWorker {
          return [worker = std::make_shared<Worker>(plan_, pulse_)](
                     std::size_t chunk, std::vector<std::byte>& bytes) { (*worker)(chunk, bytes); };
        },
        .keep = [this](std::size_t chunk, std::span<const std::byte> bytes) { keep(chunk, bytes); }};
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
    summary_.logging += seconds_since(begin);
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
    summary_.logged_bytes = log_->bytes();
    if (log_->count() < plan_.chunks().count()) {
      log_->flush();
      return {};
    }
    const auto begin = Clock::now();
    auto fits = Writer(plan_, *log_, options_).run();
    if (!fits) return tl::unexpected(fits.error());
    summary_.fits = std::move(*fits);
    summary_.writing = seconds_since(begin);
    std::error_code ignored;
    summary_.written_bytes = fs::file_size(options_.output, ignored);
    log_->remove();
    summary_.is_complete = true;
    return {};
  }

  Plan plan_;
  const SweepOptions& options_;
  SweepSummary summary_;
  Pulse pulse_;
  std::optional<ChunkLog> log_;
  std::size_t next_ = 0;
  std::optional<Errors> error_;
};

}  // namespace

std::string_view sample_status_name(std::size_t status) { return name_of(static_cast<SampleStatus>(status)); }

Expected<SweepColumns> sweep_columns(Study study) {
  const auto warning = prepare(study);
  if (!warning) return tl::unexpected(warning.error());
  const Plan plan(study);
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

Expected<SweepSummary> sweep(Study study, const SweepOptions& options) {
  const auto warning = prepare(study);
  if (!warning) return tl::unexpected(warning.error());
  auto summary = Sweep(study, options).run();
  if (summary) summary->warning = *warning;
  return summary;
}

}  // namespace sinew::inline v0
