#include "study/sweep/chunks_in_place.hpp"

#include <algorithm>

#include "io/file/write_file.hpp"

namespace sinew::inline v1 {

bool ChunksInPlace::serves(const SweepPlan& plan, const SweepOptions& options) {
  return options.output.extension() == ".h5" && options.compression == 0 && !plan.reduces() &&
         plan.study().fits.empty() && plan.study().samples > 0 && !is_stream(options.output);
}

bool ChunksInPlace::has_become_results() const {
  const auto target = without_links(options_.output);
  std::error_code ignored;
  return target && !std::filesystem::exists(std::filesystem::path(*target) += ".part", ignored);
}

Expected<void> ChunksInPlace::open(bool resumes) {
  const ResultLayout layout = plan_.layout(options_);
  axes_ = layout.is_grid ? 0 : layout.axes.size();
  auto file = ResultInPlace::open(options_.output, layout, resumes);
  if (!file) return tl::unexpected(file.error());
  file_.emplace(std::move(*file));
  return {};
}

/// The columns before those of the outputs: axes of a list, and derived values.
std::span<const double> ChunksInPlace::axes_of(const Chunk& chunk, std::vector<double>& values) const {
  const Study& study = plan_.study();
  if (axes_ == 0 && study.derived.empty()) return {};
  values.resize(study.variable_count() * chunk.count);
  axis_values(study, chunk, false, values);
  return std::span(values).subspan((study.axes.size() - axes_) * chunk.count);
}

Expected<void> ChunksInPlace::write(std::size_t number, std::span<const std::byte> bytes) {
  const Chunk chunk = plan_.chunks()[number];
  std::vector<double> variables;
  const auto before = axes_of(chunk, variables);
  const std::size_t outputs = plan_.study().outputs.size() * chunk.count;
  const auto* numbers = reinterpret_cast<const double*>(bytes.data());
  const auto* statuses = reinterpret_cast<const SampleStatus*>(numbers + outputs);
  return file_->write({.first = chunk.first,
                       .count = chunk.count,
                       .axes = before,
                       .columns = {numbers, outputs},
                       .statuses = {statuses, chunk.count}});
}

bool ChunksInPlace::read(std::size_t number, std::vector<std::byte>& bytes) const {
  const Chunk chunk = plan_.chunks()[number];
  std::vector<double> values, variables;
  std::vector<SampleStatus> statuses;
  if (!file_->read(chunk.first, chunk.count, values, statuses)) return false;
  const auto before = axes_of(chunk, variables);  // which no checksum covers
  if (!std::ranges::equal(before, std::span(values).first(before.size()))) return false;
  const auto outputs = std::as_bytes(std::span(values).subspan(before.size()));
  bytes.assign(outputs.begin(), outputs.end());
  const auto ends = std::as_bytes(std::span(statuses));
  bytes.insert(bytes.end(), ends.begin(), ends.end());
  return true;
}

Expected<WrittenResults> ChunksInPlace::finish() {
  WrittenResults results;
  for (std::size_t c = 0; c < plan_.chunks().count(); ++c) {
    const Chunk chunk = plan_.chunks()[c];
    std::vector<SampleStatus> statuses(chunk.count);
    if (!file_->read_statuses(chunk.first, statuses))
      return failure("file_unreadable", options_.output.string(),
                     "can no longer be read as it was written; go on with --resume");
    for (const SampleStatus status : statuses)
      ++results.statuses[std::min<std::size_t>(status, sample_statuses - 1)];
  }
  if (const auto done = file_->finish(); !done) return tl::unexpected(done.error());
  return results;
}

}  // namespace sinew::inline v1
