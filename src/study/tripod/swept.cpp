#include "study/tripod/swept.hpp"

#include <algorithm>
#include <cmath>

#include "base/assert.hpp"
#include "query/batch/sampler.hpp"
#include "sinew/study/study.hpp"

namespace sinew::inline v1::tripod {
namespace {

void drop_left_out(Table& table) {
  const Column* status = table.find("status");
  if (!status) return;
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < table.row_count(); ++k)
    if (status->values[k] != left_out) kept.push_back(k);
  for (Column& column : table.columns) column.values = at_rows(column.values, kept);
}

}  // namespace

std::size_t Swept::converged() const {
  return static_cast<std::size_t>(std::ranges::count((*this)["status"], ::sinew::converged));
}

const std::vector<double>& Swept::operator[](std::string_view name) const {
  const Column* column = table.find(name);
  static const std::vector<double> none;
  SINEW_EXPECTS(column != nullptr);
  return column ? column->values : none;
}

Expected<Swept> swept(std::string_view name, const std::filesystem::path& folder) {
  auto study = read_study(std::string(name));
  if (!study) return tl::unexpected(study.error());
  // reduced results, which somebody may have made here, are of the same study
  const std::string file = std::string(name) + (study->reductions.empty() ? ".h5" : "-samples.h5");
  study->reductions.clear();
  study->reduced_axes = 0;
  Swept done{.table = {}, .summary = {}, .file = folder / file};
  // several figures are of one study; what is fitted is known to a run only
  auto summary = sweep(*study, {.output = done.file, .resume = study->fits.empty(), .compression = 4});
  if (!summary) return tl::unexpected(summary.error());
  done.summary = std::move(*summary);
  auto table = read_hdf5(done.file);
  if (!table) return tl::unexpected(table.error());
  done.table = std::move(*table);
  for (std::size_t c = 0; c < study->column_count(); ++c)
    if (!done.table.find(study->column_name(c)))
      return failure("file_unreadable", done.file.string(),
                     "is not what sinew wrote: a column is missing; remove the file");
  drop_left_out(done.table);
  return done;
}

std::vector<std::size_t> rows_where(const Swept& study, const std::function<bool(std::size_t)>& wanted) {
  std::vector<std::size_t> rows;
  for (std::size_t k = 0; k < study.size(); ++k)
    if (wanted(k)) rows.push_back(k);
  return rows;
}

std::vector<double> at_rows(const std::vector<double>& column, std::span<const std::size_t> rows) {
  std::vector<double> values;
  values.reserve(rows.size());
  for (const std::size_t row : rows) values.push_back(column[row]);
  return values;
}

double root_mean_square(std::span<const double> values) {
  double sum = 0, count = 0;
  for (const double value : values)
    if (std::isfinite(value)) sum += value * value, count += 1;
  return std::sqrt(sum / count);
}

double likeness(std::span<const double> a, std::span<const double> b) {
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
    if (!std::isfinite(a[k] + b[k])) continue;
    ab += a[k] * b[k], aa += a[k] * a[k], bb += b[k] * b[k];
  }
  return ab / std::sqrt(aa * bb);
}

}  // namespace sinew::inline v1::tripod
