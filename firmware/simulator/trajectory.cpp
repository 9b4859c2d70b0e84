#include "simulator/trajectory.hpp"
#include "io/document/reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace sinew::firmware {
namespace {

std::vector<std::string> cells_of(std::string line) {
  if (!line.empty() && line.back() == '\r') line.pop_back();
  std::vector<std::string> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    const std::size_t first = std::min(line.find_first_not_of(' ', begin), end);
    std::string cell = line.substr(first, end - first);
    cell.erase(cell.find_last_not_of(' ') + 1);
    cells.push_back(std::move(cell));
    begin = end + 1;
  }
  return cells;
}

/// Which column holds what; -1 where there is none.
class Columns {
 public:
  explicit Columns(std::vector<std::string> names) : names_(std::move(names)) {}

  int find(const std::string& name) const {
    const auto found = std::ranges::find(names_, name);
    return found == names_.end() ? -1 : static_cast<int>(found - names_.begin());
  }
  int require(const std::string& name) const {
    const int column = find(name);
    if (column < 0) throw std::runtime_error("there is no column " + name);
    return column;
  }
  std::size_t count() const { return names_.size(); }

 private:
  std::vector<std::string> names_;
};

double number(const std::string& cell) {
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value))
    throw std::runtime_error("\"" + cell + "\" is no number");
  return value;
}
std::int32_t count(const std::string& cell) {
  const double value = number(cell);
  if (value != std::round(value) || std::abs(value) > 2147483647.0)
    throw std::runtime_error("\"" + cell + "\" is no count");
  return static_cast<std::int32_t>(value);
}

/// A file's columns, and how to read a row of them.
class Reader {
 public:
  explicit Reader(const Columns& columns) : time_(columns.require("time[s]")), width_(columns.count()) {
    for (int m = 0; m < section_count; ++m) {
      const std::string section = "S" + std::to_string(m);
      const bool is_polar = columns.find(section + "_theta[rad]") >= 0;
      bends_.push_back({is_polar, columns.require(section + (is_polar ? "_theta[rad]" : "_beta_1[rad]")),
                        columns.require(section + (is_polar ? "_phi[rad]" : "_beta_2[rad]"))});
    }
    stage_ = columns.find("stage_counts");
    if (columns.find("S0_counts_1") < 0) return;
    for (int i = 0; i < tendon_drives; ++i)
      counts_.push_back(columns.require("S" + std::to_string(i / tendon_count) + "_counts_" +
                                        std::to_string(i % tendon_count + 1)));
  }

  Trajectory::Row row(const std::vector<std::string>& cells) const {
    if (cells.size() != width_)
      throw std::runtime_error(std::to_string(cells.size()) + " cells, the header has " +
                               std::to_string(width_));
    const auto cell = [&](int column) { return cells[static_cast<std::size_t>(column)]; };
    Trajectory::Row row;
    row.time = number(cell(time_));
    for (Uint8 m = 0; m < section_count; ++m) {
      const Bend& bend = bends_[m];
      double x = number(cell(bend.first)), y = number(cell(bend.second));
      if (bend.is_polar) {
        const double theta = x, phi = y;
        x = theta * std::cos(phi);
        y = theta * std::sin(phi);
      }
      row.pose.bends[m] = {Angle(x), Angle(y)};
    }
    if (stage_ >= 0) row.pose.stage = count(cell(stage_));
    for (const int column : counts_) row.counts.push_back(count(cell(column)));
    if (!counts_.empty()) row.counts.push_back(row.pose.stage);
    return row;
  }
  bool has_counts() const { return !counts_.empty(); }
  bool has_stage_counts() const { return stage_ >= 0; }

 private:
  struct Bend {
    bool is_polar;
    int first, second;
  };
  int time_, stage_ = -1;
  std::size_t width_;
  std::vector<Bend> bends_;
  std::vector<int> counts_;
};

}  // namespace

Trajectory read_trajectory(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path.string() + ": cannot be read");
  Trajectory trajectory;
  std::vector<Reader> reader;  // one, once the header has come
  std::size_t line_number = 0;
  try {
    for (std::string line; std::getline(file, line);) {
      ++line_number;
      if (line.empty() || line == "\r" || line[0] == '#') continue;
      if (reader.empty()) {
        reader.emplace_back(Columns(cells_of(line)));
        trajectory.has_counts = reader[0].has_counts();
        trajectory.has_stage_counts = reader[0].has_stage_counts();
        continue;
      }
      trajectory.rows.push_back(reader[0].row(cells_of(line)));
      const auto& rows = trajectory.rows;
      if (rows.size() > 1 && !(rows.back().time > rows[rows.size() - 2].time))
        throw std::runtime_error("times have to grow");
    }
    if (trajectory.rows.empty()) throw std::runtime_error("there is no row");
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(path.string() + ":" + std::to_string(line_number) + ": " + error.what());
  }
  return trajectory;
}

}  // namespace sinew::firmware
