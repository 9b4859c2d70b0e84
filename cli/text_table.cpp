#include "text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sinew::cli {
namespace {

/// Characters a terminal shows: bytes of UTF-8 that begin one.
std::size_t width(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

bool is_number(std::string_view cell) {
  if (cell == "-" || cell == "inf") return true;
  const std::size_t begin = cell.find_first_not_of("+-");
  return begin != std::string_view::npos && cell[begin] >= '0' && cell[begin] <= '9';
}

/// Exact halves of the last digit shown are common, and the last bit of a double decides them: away from
/// zero.
constexpr double nudge = 1 + 1e-12;

bool has_bare_zero_sign(std::string_view number) {
  return number.starts_with('-') && number.find_first_not_of("-0.") == std::string_view::npos;
}

}  // namespace

std::string TextTable::text() const {
  std::vector<std::size_t> widths;
  std::vector<char> numeric;
  for (const auto& row : rows_)
    for (std::size_t j = 0; j < row.size(); ++j) {
      if (widths.size() <= j) widths.push_back(0), numeric.push_back(1);
      widths[j] = std::max(widths[j], width(row[j]));
      if (&row != &rows_.front() && !row[j].empty() && !is_number(row[j])) numeric[j] = 0;
    }
  std::string text;
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t j = 0; j < row.size(); ++j) {
      const std::string pad(widths[j] - width(row[j]), ' ');
      line += (j ? gap_ : "") + (numeric[j] ? pad + row[j] : row[j] + pad);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
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
