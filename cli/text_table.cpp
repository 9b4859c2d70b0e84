#include "text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numbers>

#include "io/document/visible.hpp"
#include "terminal.hpp"

namespace sinew::cli {
namespace {

/// Characters a terminal shows: bytes of UTF-8 that begin one.
std::size_t width(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

bool is_number(std::string_view cell) {
  if (cell == "-" || cell == "inf") return true;
  for (std::size_t i = 1; i < cell.size(); ++i)  // `3-rfr-workspace` is a name
    if (cell[i - 1] == '-' && std::isalpha(static_cast<unsigned char>(cell[i])) != 0) return false;
  const std::size_t begin = cell.find_first_not_of("+-");
  return begin != std::string_view::npos && cell[begin] >= '0' && cell[begin] <= '9';
}

/// The words of a text in lines of a width, or of one word where that is longer.
std::vector<std::string> lines_of(std::string_view text, std::size_t most) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t begin = text.find_first_not_of(' ');
    if (begin == std::string_view::npos) break;
    text.remove_prefix(begin);
    const std::string_view word = text.substr(0, text.find(' '));
    if (!lines.empty() && width(lines.back()) + 1 + width(word) <= most)
      lines.back().append(" ").append(word);
    else
      lines.emplace_back(word);
    text.remove_prefix(word.size());
  }
  return lines;
}

/// Exact halves of the last digit shown are common, and the last bit of a double decides them: away from
/// zero.
constexpr double nudge = 1 + 1e-12;

bool has_bare_zero_sign(std::string_view number) {
  return number.starts_with('-') && number.find_first_not_of("-0.") == std::string_view::npos;
}

}  // namespace

void TextTable::add(std::vector<std::string> row) {
  for (std::string& cell : row) cell = visible_line(cell);
  rows_.push_back(std::move(row));
}

std::vector<std::size_t> TextTable::fitted(std::vector<std::size_t> widths, std::size_t line) const {
  std::vector<std::size_t> least(widths.size(), 0);  // the longest word
  for (const auto& row : rows_)
    for (std::size_t j = 0; j < row.size(); ++j)
      for (const std::string& word : lines_of(row[j], 1)) least[j] = std::max(least[j], width(word));
  std::size_t total = width(gap_) * (widths.size() - 1);
  for (const std::size_t one : widths) total += one;
  while (total > line) {  // the widest gives way
    std::size_t widest = widths.size();
    for (std::size_t j = 0; j < widths.size(); ++j)
      if (widths[j] > least[j] && (widest == widths.size() || widths[j] > widths[widest])) widest = j;
    if (widest == widths.size()) break;  // words alone are wider
    --widths[widest], --total;
  }
  return widths;
}

std::string TextTable::text(std::size_t line_width) const {
  std::vector<std::size_t> widths;
  std::vector<char> numeric;
  for (const auto& row : rows_)
    for (std::size_t j = 0; j < row.size(); ++j) {
      if (widths.size() <= j) widths.push_back(0), numeric.push_back(1);
      widths[j] = std::max(widths[j], width(row[j]));
      if (&row != &rows_.front() && !row[j].empty() && !is_number(row[j])) numeric[j] = 0;
    }
  if (line_width > 0) widths = fitted(std::move(widths), line_width);
  std::string text;
  for (const auto& row : rows_) {
    std::vector<std::vector<std::string>> cells;
    std::size_t height = 1;
    for (std::size_t j = 0; j < row.size(); ++j) {
      cells.push_back(width(row[j]) > widths[j] ? lines_of(row[j], widths[j]) : std::vector{row[j]});
      height = std::max(height, cells.back().size());
    }
    for (std::size_t i = 0; i < height; ++i) {
      std::string line;
      for (std::size_t j = 0; j < row.size(); ++j) {
        const std::string cell = i < cells[j].size() ? cells[j][i] : std::string();
        const std::string pad(widths[j] - std::min(widths[j], width(cell)), ' ');
        line += (j ? gap_ : "") + (numeric[j] ? pad + cell : cell + pad);
      }
      line.resize(line.find_last_not_of(' ') + 1);
      text += (&row == &rows_.front() ? styled(line, Style::heading) : line) + '\n';
    }
  }
  return text;
}

Shown shown(std::string_view si_unit) {
  if (si_unit == "m") return {"mm", 1e3};
  if (si_unit == "rad") return {"deg", 180 / std::numbers::pi};
  if (si_unit == "J") return {"mJ", 1e3};
  return {si_unit, 1};
}

std::string heading(std::string_view name, std::string_view si_unit) {
  const Shown people = shown(si_unit);
  return people.unit.empty() ? std::string(name) : fmt::format("{}[{}]", name, people.unit);
}

std::string cell(double si, std::string_view si_unit) {
  std::string text = fmt::format("{:.4f}", si * shown(si_unit).factor * nudge);
  return has_bare_zero_sign(text) ? text.substr(1) : text;
}

std::string six_digits(double value, double scale) {
  return fmt::format("{:.6g}", std::abs(value) <= 1e-12 * scale ? 0.0 : value * nudge + 0.0);
}

}  // namespace sinew::cli
