#include "figure/table_status.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <sstream>

#include "figure/table_grid.hpp"

namespace sinew::cli {
namespace {

constexpr std::string_view name = "status", good = "converged";

/// `0 unreachable, 1 left_domain` after `status:`, of a comment of the table.
std::vector<std::pair<double, std::string>> words_of(const Table& table) {
  std::vector<std::pair<double, std::string>> all;
  for (const std::string& comment : table.comments) {
    if (!comment.starts_with("status:")) continue;
    std::istringstream words(comment.substr(std::string_view("status:").size()));
    double code = 0;
    for (std::string word; words >> code >> word; all.emplace_back(code, word))
      if (word.ends_with(',')) word.pop_back();
    break;
  }
  const bool has_good =
      std::ranges::find(all, good, [](const auto& entry) { return entry.second; }) != all.end();
  return has_good ? all : std::vector<std::pair<double, std::string>>();
}

}  // namespace

Statuses::Statuses(const Table& table) {
  const Column* column = table.find(name);
  if (!column) return;
  rows_ = column->values.size();
  for (const auto& [code, word] : words_of(table)) {
    const auto count = std::ranges::count(column->values, code);
    if (count == 0) continue;
    codes_.push_back(code);
    words_.push_back(word);
    counts_.push_back(static_cast<std::size_t>(count));
  }
}

bool Statuses::has_others() const {
  return std::ranges::any_of(words_, [](const std::string& word) { return word != good; });
}

void Statuses::leave_out(Table& table, const std::string* x) const {
  const auto found = std::ranges::find(words_, good);
  const double converged = found == words_.end() ? std::numeric_limits<double>::quiet_NaN()
                                                 : codes_[static_cast<std::size_t>(found - words_.begin())];
  const std::vector<double> statuses = table.find(name)->values;
  const GridAxes axes = grid_axes(table);
  for (Column& column : table.columns) {
    const bool is_place = column.name == name || (x && column.name == *x) ||
                          std::ranges::find(axes.columns, &column) != axes.columns.end();
    if (is_place) continue;
    for (std::size_t row = 0; row < statuses.size(); ++row)
      if (statuses[row] != converged) column.values[row] = std::numeric_limits<double>::quiet_NaN();
  }
}

void Statuses::number(Table& table) const {
  if (words_.empty()) return;
  for (Column& column : table.columns)
    if (column.name == name)
      for (double& value : column.values) {
        const auto found = std::ranges::find(codes_, value);
        value = found == codes_.end() ? std::numeric_limits<double>::quiet_NaN()
                                      : static_cast<double>(found - codes_.begin());
      }
}

std::string Statuses::remark(bool draws_all) const {
  if (!has_others()) return {};
  std::size_t converged = 0;
  std::string others;
  for (std::size_t k = 0; k < words_.size(); ++k) {
    if (words_[k] == good)
      converged = counts_[k];
    else
      others += fmt::format("{}{} {}", others.empty() ? "" : ", ", counts_[k], words_[k]);
  }
  return fmt::format("{} of {} samples converged; {}: {}", converged, rows_,
                     draws_all ? "also drawn" : "not drawn", others);
}

}  // namespace sinew::cli
