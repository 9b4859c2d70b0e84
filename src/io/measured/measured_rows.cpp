/// Tables of measured rows.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "io/document/quantity.hpp"
#include "io/measured/measurement.hpp"
#include "sinew/analysis/identify.hpp"
#include "sinew/io/node.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"

namespace sinew::inline v1 {
namespace {

/// A column, and what its values are to be multiplied by.
struct InSi {
  const Column* column = nullptr;
  double factor = 1;
  double at(std::size_t row) const { return column->values[row] * factor; }
};

class RowsReader {
 public:
  RowsReader(const Table& table, const Arm& arm, const std::string& file)
      : table_(table),
        file_(file),
        names_(tendon_names(arm)) {}

  Expected<MeasuredRows> read() {
    for (const std::string& name : names_) tendons_.push_back(required(name, "of a tendon"));
    for (const char* name : {"x", "y", "z"}) markers_.push_back(required(name, "of the marker"));
    if (const Column* time = table_.find("time")) time_ = in_si(*time, Dimension::time);
    if (const Column* block = table_.find("block")) block_ = in_si(*block, Dimension::number);
    refuse_other_tendons();
    const std::size_t rows = table_.row_count();
    if (errors_.empty() && rows == 0) fail("no_rows", file_, "has no row below its heading; measure some");
    for (std::size_t k = 0; errors_.empty() && k < rows; ++k) read_row(k);
    if (!errors_.empty()) return tl::unexpected(errors_);
    return std::move(rows_);
  }

 private:
  void fail(std::string_view code, const std::string& where, std::string message) {
    errors_.push_back({std::string(code), where, std::move(message)});
  }

  InSi required(const std::string& name, std::string_view of) {
    if (const Column* column = table_.find(name)) return in_si(*column, Dimension::length);
    std::vector<std::string_view> known;
    for (const Column& column : table_.columns) known.push_back(column.name);
    const std::string_view hint = closest(name, known);
    fail("missing_column", file_,
         fmt::format("has no column {0} {1}{2}; head it {0}[mm]", name, of,
                     hint.empty() ? "" : fmt::format(" (is it {}?)", in_quotes(hint))));
    return {};
  }

  InSi in_si(const Column& column, Dimension dimension) {
    const std::string where = fmt::format("{}: {}", file_, column.heading());
    if (dimension == Dimension::number) {
      if (!column.unit.empty()) fail("wrong_dimension", where, "is a number of a block; it has no unit");
      return {&column};
    }
    if (column.unit.empty()) {
      const bool is_time = dimension == Dimension::time;
      fail("missing_unit", where,
           fmt::format("has no unit; write it into the heading: {0}[{1}], or {0}[{2}]", column.name,
                       is_time ? "s" : "mm", is_time ? "ms" : "m"));
      return {};
    }
    const auto factor = parse_quantity("1 " + column.unit, dimension);
    if (factor) return {&column, *factor};
    fail(factor.error().front().code, where, factor.error().front().message);
    return {};
  }

  /// A table of another arm has tendons that this one has not.
  void refuse_other_tendons() {
    for (const Column& column : table_.columns) {
      const std::string& name = column.name;
      if (!name.starts_with("sections[") || name.find(".tendons[") == std::string::npos) continue;
      if (std::ranges::find(names_, name) == names_.end())
        fail("too_many_tendons", fmt::format("{}: {}", file_, name),
             fmt::format("the arm has no such tendon: it has {}, up to {}", names_.size(),
                         names_.empty() ? "none" : names_.back()));
    }
  }

  std::string place(std::size_t row) const { return fmt::format("{}: row {}", file_, row + 1); }

  /// A number of a row, in SI; places and times that no arm has are slips of units.
  double value(const InSi& column, std::size_t row, double limit) {
    const double si = column.at(row);
    if (std::isnan(si))
      fail("not_a_number", place(row),
           fmt::format("{} is empty; leave out rows that lack a number", column.column->heading()));
    else if (!(std::abs(si) <= limit))
      fail("out_of_range", place(row),
           fmt::format("{} = {} is beyond what can be measured; is a unit wrong?", column.column->heading(),
                       si_text(column.column->values[row])));
    return si;
  }

  void read_row(std::size_t row) {
    constexpr double furthest = 1e3, latest = 1e12;  // [m], [s]
    for (const InSi& tendon : tendons_) rows_.pulls.push_back(value(tendon, row, furthest));
    for (const InSi& marker : markers_) rows_.markers.push_back(value(marker, row, furthest));
    if (block_) read_block(row);
    if (!time_) return;
    const double now = value(*time_, row, latest);
    const bool goes_on = row > 0 && (!block_ || rows_.blocks[row] == rows_.blocks[row - 1]);
    if (goes_on && now < rows_.time.back())
      fail("not_in_order", place(row),
           fmt::format("{} goes back, and tendons lag behind what was before; sort the rows{}",
                       time_->column->heading(),
                       block_ ? ", or give rows of another recording another block" : ""));
    rows_.time.push_back(now);
  }

  void read_block(std::size_t row) {
    const double number = value(*block_, row, 1e9);
    if (std::isfinite(number) && number != std::floor(number))
      fail("not_whole", place(row),
           fmt::format("block = {} is no whole number; rows of one number belong "
                       "together",
                       si_text(number)));
    rows_.blocks.push_back(errors_.empty() ? static_cast<int>(number) : 0);
  }

  const Table& table_;
  const std::string& file_;
  std::vector<std::string> names_;
  std::vector<InSi> tendons_, markers_;
  std::optional<InSi> time_, block_;
  MeasuredRows rows_;
  Errors errors_;
};

}  // namespace

Expected<MeasuredRows> read_measured_rows(const Table& table, const Arm& arm, const std::string& file) {
  return RowsReader(table, arm, file).read();
}

Table measured_table(const MeasuredRows& rows, const Arm& arm) {
  Table table;
  const std::size_t count = rows.size(), tendons = arm.tendons.size();
  const auto add = [&](const std::string& name, const char* unit, auto value) {
    Column& column = table.columns.emplace_back(Column{name, unit, {}});
    for (std::size_t k = 0; k < count; ++k) column.values.push_back(value(k));
  };
  // millimetres with few digits stay so: 6.12 mm is the double that 6.12 is, not 6.1200000000000001
  const auto in_mm = [](double si) {
    const double mm = si * 1e3, rounded = std::round(mm * 1e9) / 1e9;
    return rounded * 1e-3 == si ? rounded : mm;
  };
  if (!rows.time.empty()) add("time", "s", [&](std::size_t k) { return rows.time[k]; });
  if (!rows.blocks.empty())
    add("block", "", [&](std::size_t k) { return static_cast<double>(rows.blocks[k]); });
  const auto names = tendon_names(arm);
  for (std::size_t i = 0; i < tendons; ++i)
    add(names[i], "mm", [&](std::size_t k) { return in_mm(rows.pulls[k * tendons + i]); });
  for (std::size_t i = 0; i < 3; ++i)
    add(std::string(1, "xyz"[i]), "mm", [&](std::size_t k) { return in_mm(rows.markers[3 * k + i]); });
  return table;
}

}  // namespace sinew::inline v1
