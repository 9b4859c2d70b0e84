/// Results as CSV: a line a sample, the grid written out; for results that people open in a spreadsheet.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "sinew/io/node.hpp"
#include "sinew/io/quantity.hpp"
#include "sinew/io/table.hpp"
#include "study/results/result_file.hpp"

namespace sinew::inline v0 {
namespace {

namespace fs = std::filesystem;

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
        part_(path.string() + ".part"),
        layout_(std::move(layout)),
        file_(std::fopen(part_.c_str(), "wb")) {
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
  ~CsvResult() override {
    if (file_) std::fclose(file_);
    std::error_code ignored;
    if (!is_finished_) fs::remove(part_, ignored);
  }

  Expected<void> begun() const override { return outcome(); }
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
    if (file_ && std::fclose(std::exchange(file_, nullptr)) != 0) remember();
    if (reason_.empty()) reason_ = put_in_place(part_, path_);
    is_finished_ = reason_.empty();
    return outcome();
  }

 private:
  void remember() {
    if (reason_.empty()) reason_ = std::strerror(errno);
  }
  void put(const std::string& text) {
    if (!file_ || std::fwrite(text.data(), 1, text.size(), file_) != text.size()) remember();
  }
  Expected<void> outcome() const {
    if (reason_.empty()) return {};
    return failure("write_failed", path_.string(),
                   fmt::format("cannot be written: {}; the chunks are kept, go on with --resume", reason_));
  }

  fs::path path_, part_;
  ResultLayout layout_;
  std::FILE* file_;
  std::string reason_;
  bool is_finished_ = false;
};

}  // namespace

std::string recorded_fact(const fs::path& path, const std::string& name) {
  if (path.extension() == ".h5") return recorded_hdf5_fact(path, name);
  std::ifstream file(path);
  const std::string head = fmt::format("# {}: ", name);
  for (std::string line; std::getline(file, line) && line.starts_with('#');)
    if (line.starts_with(head)) return line.substr(head.size());
  return {};
}

std::string put_in_place(const fs::path& part, const fs::path& path) {
  const auto sync = [](const fs::path& what) {
    const int file = ::open(what.c_str(), O_RDONLY | O_CLOEXEC);
    const bool good = file >= 0 && ::fsync(file) == 0;
    const std::string why = good ? "" : std::strerror(errno);
    if (file >= 0) ::close(file);
    return why;
  };
  if (std::string why = sync(part); !why.empty()) return why;
  std::error_code code;
  fs::rename(part, path, code);
  if (code) return code.message();
  sync(path.has_parent_path() ? path.parent_path() : fs::path("."));  // the name; not every system can
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
  std::error_code ignored;
  if (fs::is_directory(path, ignored))
    return failure("file_unwritable", path.string(), "is a folder; give a file: -o results.h5");
  auto file =
      path.extension() == ".csv" ? create_csv(path, std::move(layout)) : create_hdf5(path, std::move(layout));
  if (const auto begun = file->begun(); !begun) return tl::unexpected(begun.error());
  return file;
}

}  // namespace sinew::inline v0
