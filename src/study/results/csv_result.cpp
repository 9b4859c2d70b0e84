/// Results as CSV: a line a sample, the grid written out; for results that people open in a spreadsheet.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "io/document/quantity.hpp"
#include "io/file/write_file.hpp"
#include "sinew/io/node.hpp"
#include "sinew/io/table.hpp"
#include "study/results/result_file.hpp"

namespace sinew::inline v1 {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view part_ending = ".part";
constexpr std::size_t longest_fact = 200;  ///< texts of whole files stay out of a table

/// `# fit x[m] = 0.1 (e1^2 - e2^2) + ...; rms 1e-5, largest 3e-5, relative 0.01, 121 samples`, or
/// `# fit parasitic: c1 = 0.1, ...; 121 samples` and a line of its residuals a column.
std::string fit_lines(const FittedTerms& fit) {
  const auto residuals = [](const FittedColumn& column) {
    return fmt::format("rms {}, largest {}, relative {}", column.rms, column.largest, column.relative);
  };
  const FittedColumn& first = fit.columns.front();
  const bool is_sum = first.text.empty();
  std::string text = is_sum ? fmt::format("# fit {} =", Column{fit.name, fit.unit, {}}.heading())
                            : fmt::format("# fit {}:", fit.name);
  for (std::size_t t = 0; t < fit.terms.size(); ++t)
    text += is_sum ? fmt::format("{} {} ({})", t == 0 ? "" : " +", fit.coefficients[t], fit.terms[t])
                   : fmt::format("{} {} = {}", t == 0 ? "" : ",", fit.terms[t], fit.coefficients[t]);
  if (is_sum) return text + fmt::format("; {}, {} samples\n", residuals(first), fit.samples);
  text += fmt::format("{}; {} samples\n", fit.is_given ? " (given)" : "", fit.samples);
  for (const FittedColumn& column : fit.columns)
    text += fmt::format("#   {} = {}; {}\n", Column{column.name, column.unit, {}}.heading(),
                        one_line(column.text, longest_fact), residuals(column));
  return text;
}

class CsvResult : public ResultFile {
 public:
  CsvResult(const fs::path& path, ResultLayout layout)
      : path_(path),
        layout_(std::move(layout)),
        file_(FileWriter::open(path, part_ending)) {
    if (!file_) remember(file_.error());
    std::string head;
    if (!layout_.title.empty()) head += "# " + one_line(layout_.title, 200) + '\n';
    for (const Fact& fact : layout_.provenance)
      if (fact.text.size() <= longest_fact && fact.text.find('\n') == std::string::npos)
        head += fmt::format("# {}: {}\n", fact.name, fact.text);
    if (layout_.has_status) {
      head += "# status:";
      for (SampleStatus s = 0; s < sample_statuses; ++s)
        head += fmt::format("{} {} {}", s == 0 ? "" : ",", s, name_of(s));
      head += '\n';
    }
    std::string cells;
    const auto add = [&](const std::string& name, const std::string& unit) {
      cells += (cells.empty() ? "" : ",") + Column{name, unit, {}}.heading();
    };
    for (const auto& axis : layout_.axes) add(axis.name, axis.unit);
    for (const auto& column : layout_.columns) add(column.name, column.unit);
    if (layout_.has_status) add("status", "");
    put(head + cells + '\n');
  }
  Expected<void> begun() const override {
    if (reason_.empty()) return {};
    return failure("file_unwritable", path_.string(), reason_);
  }
  bool wants_axes() const override { return true; }

  Expected<void> write(const ResultRows& rows) override {
    std::string text;
    for (std::size_t k = 0; k < rows.count; ++k) {
      std::size_t cell = 0;
      const auto add = [&](double value) {
        if (cell++ > 0) text += ',';
        if (std::isfinite(value)) fmt::format_to(std::back_inserter(text), "{}", value);
      };
      for (std::size_t a = 0; a < layout_.axes.size(); ++a) add(rows.axes[a * rows.count + k]);
      for (std::size_t c = 0; c < layout_.columns.size(); ++c) add(rows.columns[c * rows.count + k]);
      if (layout_.has_status) add(rows.statuses[k]);
      text += '\n';
    }
    put(text);
    return outcome();
  }

  Expected<void> finish(std::span<const FittedTerms> fits) override {
    for (const FittedTerms& fit : fits) put(fit_lines(fit));
    if (reason_.empty())
      if (const auto done = file_->finish(); !done) remember(done.error());
    return outcome();
  }

 private:
  void remember(const Errors& errors) {
    if (reason_.empty()) reason_ = errors.front().message;
  }
  void put(const std::string& text) {
    if (!reason_.empty()) return;
    if (const auto done = file_->write(text); !done) remember(done.error());
  }
  Expected<void> outcome() const {
    if (reason_.empty()) return {};
    return failure("write_failed", path_.string(), reason_ + "; the chunks are kept, go on with --resume");
  }

  fs::path path_;
  ResultLayout layout_;
  Expected<FileWriter> file_;
  std::string reason_;
};

}  // namespace

std::string recorded_fact(const fs::path& path, const std::string& name) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return {};
  if (path.extension() == ".h5") return recorded_hdf5_fact(path, name);
  std::ifstream file(path);
  const std::string head = fmt::format("# {}: ", name);
  for (std::string line; std::getline(file, line) && line.starts_with('#');)
    if (line.starts_with(head)) return line.substr(head.size());
  return {};
}

std::unique_ptr<ResultFile> create_csv(const fs::path& path, ResultLayout layout) {
  return std::make_unique<CsvResult>(path, std::move(layout));
}

Errors refuse_result_name(const fs::path& path) {
  if (path.extension() == ".h5" || path.extension() == ".csv") return {};
  return {{"unknown_format", "--output",
           fmt::format("{}: results end in .h5 or .csv: -o results.h5.", in_quotes(path.string()))}};
}

Expected<std::unique_ptr<ResultFile>> create_result(const fs::path& path, ResultLayout layout) {
  if (Errors errors = refuse_result_name(path); !errors.empty()) return tl::unexpected(std::move(errors));
  if (path.extension() == ".h5" && is_stream(path))
    return failure("file_unwritable", path.string(),
                   "is no regular file, and HDF5 is not written front to back; give a file, or write .csv");
  auto file =
      path.extension() == ".csv" ? create_csv(path, std::move(layout)) : create_hdf5(path, std::move(layout));
  if (const auto begun = file->begun(); !begun) return tl::unexpected(begun.error());
  return file;
}

}  // namespace sinew::inline v1
