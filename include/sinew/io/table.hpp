/// @file table.hpp
/// Tables of numbers with named columns and units, and their CSV form:
///
///     # sinew 0.1.0
///     k,eta,x[m],phi[rad],condition
///     0,0,0,0,14.661461344404344
///     59,1,0.03,1.0471975511965976,
///
/// Comma, `\n`, the shortest digits that read back as the same number; an empty cell where there is no value.
/// Then tables of measured rows, from which an arm is identified. Format: docs/identify.md
#pragma once
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/base/error.hpp"
#include "sinew/base/numbers.hpp"

namespace sinew::inline v1 {

struct Arm;           // robot/arm.hpp
struct MeasuredRows;  // analysis/identify.hpp

/// One column. A value that is not finite is missing.
struct Column {
  std::string name;            ///< without brackets
  std::string unit;            ///< `m`, `rad/m`; empty for a plain number
  std::vector<double> values;  ///< one a row, in `unit`

  /// `x[m]`, or the name alone where there is no unit.
  SINEW_API std::string heading() const;

  /// Name and unit as written in a heading.
  SINEW_API static Column named(std::string_view heading);
};

/// Columns of the same length, left to right.
struct Table {
  std::vector<std::string> comments;  ///< lines at the top, without the `#`: what this is and whence
  std::vector<Column> columns;

  Table() = default;
  /// @param headings `{"k", "x[m]"}`
  SINEW_API explicit Table(std::initializer_list<std::string_view> headings);

  /// Rows, as many as the first column has values.
  std::size_t row_count() const { return columns.empty() ? 0 : columns.front().values.size(); }

  /// @param row a value for every column
  SINEW_API void add_row(Numbers row);

  /// The column of that name, or none.
  SINEW_API const Column* find(std::string_view name) const;
};

/// The table as CSV text.
SINEW_API std::string to_csv(const Table& table);

/// Appends one row, a number in the unit of each column, as `to_csv` writes it: for tables that are longer
/// than memory.
SINEW_API void append_csv_row(std::string& text, Numbers row);

/// The table in a CSV text. A comment is a line that starts with `#`; empty lines are skipped.
/// Codes: `no_heading`, `duplicate_column`, `wrong_cell_count`, `not_a_number`, `csv_syntax`.
/// @param source names the text in errors
SINEW_API Expected<Table> parse_csv(std::string_view text, const std::string& source);

/// Codes: `file_unwritable`.
SINEW_API Expected<void> write_csv(const Table& table, const std::filesystem::path& path);

/// Codes: those of `parse_csv`, `file_missing`, `file_unreadable`.
SINEW_API Expected<Table> read_csv(const std::filesystem::path& path);

/// Write a whole file, making the folders above it. Codes: `file_unwritable`.
SINEW_API Expected<void> write_text(std::string_view text, const std::filesystem::path& path);

/// Measured rows in a table with the columns `sections[0].tendons[0][mm]` for each tendon, drawn in where
/// positive, `x[mm]`, `y[mm]`, `z[mm]` of the marker, and, where wanted, `time[s]` and `block`. Units may be
/// others of their kind; columns of other names are left aside. Codes: `missing_column`, `missing_unit`,
/// `wrong_dimension`, `unknown_unit`, `not_a_number`, `not_whole`, `out_of_range`, `not_in_order`,
/// `too_many_tendons`, `no_rows`.
/// @param file names the table in errors
SINEW_API Expected<MeasuredRows> read_measured_rows(const Table& table, const Arm& arm,
                                                    const std::string& file);

/// The same rows as a table in mm and s.
SINEW_API Table measured_table(const MeasuredRows& rows, const Arm& arm);

}  // namespace sinew::inline v1
