/// @file text_table.hpp
/// Tables for people: aligned columns, the unit in the header, lengths in mm and angles in deg.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace sinew::cli {

/// Columns of numbers are aligned to the right, columns of words to the left. Columns stay apart at white
/// space, so that awk can read what people read.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> header, std::string_view gap = "  ") : gap_(gap) {
    add(std::move(header));
  }
  void add(std::vector<std::string> row);  ///< a cell stays on its line, whatever its text has
  /// @param width of a line, as `line_width` has it: columns of words are then broken at blanks, as far as
  /// words allow. 0: lines as long as they are.
  std::string text(std::size_t width = 0) const;

 private:
  /// The widths of columns that fit into a line, or come closest to that.
  std::vector<std::size_t> fitted(std::vector<std::size_t> widths, std::size_t line) const;

  std::string gap_;
  std::vector<std::vector<std::string>> rows_;
};

/// What an SI number is multiplied with for people, and the unit it then has.
struct Shown {
  std::string_view unit;
  double factor;
};
/// mm for m, deg for rad, mJ for J, anything else as it is.
Shown shown(std::string_view si_unit);

/// `name[mm]`.
std::string heading(std::string_view name, std::string_view si_unit);
/// A number of this SI unit as tables have it: four decimals, and no "-0.0000".
std::string cell(double si, std::string_view si_unit);
/// Six digits; zero where it is nothing beside `scale`.
std::string six_digits(double value, double scale = 0);

}  // namespace sinew::cli
