#include "study/sweep/write_results.hpp"

#include <algorithm>

#include "study/sweep/fit.hpp"
#include "study/sweep/reduction.hpp"

namespace sinew::inline v1 {
namespace {

/// The log into the file of results.
class Writer {
 public:
  Writer(const SweepPlan& plan, const ChunkLog& log, const SweepOptions& options,
         const std::atomic<bool>& stop)
      : plan_(plan),
        log_(log),
        options_(options),
        stop_(stop) {}

  Expected<WrittenResults> run() {
    auto file = create_result(options_.output, plan_.layout(options_));
    if (!file) return tl::unexpected(file.error());
    for (const StudyFit& fit : plan_.study().fits) fits_.emplace_back(plan_.study(), fit);
    const auto read = plan_.reduces() ? cells(**file) : samples(**file, true);
    if (!read) return tl::unexpected(read.error());
    for (StreamedFit& fit : fits_) fit.solve();
    if (!fits_.empty())
      if (const auto again = samples(**file, false); !again) return tl::unexpected(again.error());
    std::vector<FittedTerms> found;
    for (const StreamedFit& fit : fits_) found.push_back(fit.result());
    if (const auto done = (*file)->finish(found); !done) return tl::unexpected(done.error());
    return WrittenResults{std::move(found), statuses_};
  }

 private:
  /// The next chunk's bytes.
  Expected<void> read(std::size_t chunk, std::vector<std::byte>& bytes) const {
    if (!stop_) return log_.read(chunk, bytes);
    return failure("stopped", options_.output.string(), "was not finished");
  }

  /// Every chunk, in order: into the file and the fits or, in a second pass, what the fits miss.
  Expected<void> samples(ResultFile& file, bool is_first) {
    const Study& study = plan_.study();
    std::vector<std::byte> bytes;
    for (std::size_t c = 0; c < plan_.chunks().count(); ++c) {
      const Chunk chunk = plan_.chunks()[c];
      if (const auto done = read(c, bytes); !done) return done;
      const std::span outputs(reinterpret_cast<const double*>(bytes.data()),
                              study.outputs.size() * chunk.count);
      const std::span statuses(reinterpret_cast<const SampleStatus*>(bytes.data() + outputs.size_bytes()),
                               chunk.count);
      tabulate(chunk, outputs, !fits_.empty() || !study.derived.empty() || file.wants_axes());
      if (is_first) {
        for (const SampleStatus status : statuses)
          ++statuses_[std::min<std::size_t>(status, sample_statuses - 1)];
        const std::size_t axes = study.axes.size() * chunk.count;
        const std::span<const double> table(table_);
        if (const auto done =
                file.write({chunk.first, chunk.count, table.first(axes), table.subspan(axes), statuses});
            !done)
          return done;
      }
      if (!fits_.empty()) fit(chunk, statuses, is_first);
    }
    return {};
  }

  /// The columns of a chunk, one after the other, as the study numbers them.
  void tabulate(const Chunk& chunk, std::span<const double> outputs, bool wants_axes) {
    const std::size_t variables = plan_.study().variable_count() * chunk.count;
    table_.resize(variables + outputs.size());
    if (wants_axes) axis_values(plan_.study(), chunk, false, std::span(table_).first(variables));
    std::ranges::copy(outputs, table_.begin() + static_cast<std::ptrdiff_t>(variables));
  }

  void fit(const Chunk& chunk, std::span<const SampleStatus> statuses, bool is_first) {
    std::vector<double> row(plan_.study().column_count());
    for (std::size_t k = 0; k < chunk.count; ++k) {
      if (statuses[k] != converged) continue;
      for (std::size_t i = 0; i < row.size(); ++i) row[i] = table_[i * chunk.count + k];
      for (StreamedFit& one : fits_) is_first ? one.add(row) : one.add_residual(row);
    }
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
      if (const auto done = read(c, bytes); !done) return done;
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
    std::vector<double> values(sums.size()), axes(kept * count), one(study.variable_count());
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t i = 0; i < columns; ++i)
        values[i * count + k] = value_of(study.reductions[i].kind, sums[k * columns + i]);
      axis_values(study, {(first + k) * study.reduced_samples(), 1}, false, one);
      for (std::size_t a = 0; a < kept; ++a) axes[a * count + k] = one[a];
    }
    return file.write({first, count, axes, values, {}});
  }

  const SweepPlan& plan_;
  const ChunkLog& log_;
  const SweepOptions& options_;
  const std::atomic<bool>& stop_;
  std::vector<StreamedFit> fits_;
  std::vector<double> table_;  ///< of one chunk
  std::array<std::size_t, sample_statuses> statuses_{};
};

}  // namespace

Expected<WrittenResults> write_results(const SweepPlan& plan, const ChunkLog& log,
                                       const SweepOptions& options, const std::atomic<bool>& stop) {
  return Writer(plan, log, options, stop).run();
}

}  // namespace sinew::inline v1
