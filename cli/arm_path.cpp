#include "arm_path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "io/robots/arm_file.hpp"
#include "option_reader.hpp"
#include "show.hpp"
#include "sinew/base/export.hpp"
#include "sinew/base/numbers.hpp"
#include "terminal.hpp"
#include "text_table.hpp"

namespace sinew::cli {
namespace {

constexpr std::array wrench_columns{"fx", "fy", "fz", "mx", "my", "mz"};
/// What `track --output` tells of each tendon: its column, and where a row of the answer has it.
struct TendonColumn {
  std::string_view name, unit, key;
};
constexpr std::array tendon_columns{
    TendonColumn{"tension", "N", "tensions"}, TendonColumn{"end_tension", "N", "end_tensions"},
    TendonColumn{"change", "m", "changes"}, TendonColumn{"slack", "m", "slack"}};

/// Reads a table as the points of a path.
class PathReader {
 public:
  PathReader(const std::string& file, const Table& table, const OpenRobot& robot, Errors& errors)
      : file_(file),
        table_(table),
        robot_(robot),
        errors_(errors) {}

  Node read() {
    find_columns();
    std::vector<Node> points;
    for (std::size_t k = 0; k < table_.row_count() && errors_.empty(); ++k) points.push_back(point(k));
    if (errors_.empty() && points.empty()) fail("empty_list", "has a heading and no row; a path needs one");
    return list_of(std::move(points));
  }

 private:
  struct Tendon {
    const Column *tension = nullptr, *change = nullptr;
  };

  void fail(std::string_view code, std::string_view what) {
    errors_.push_back({std::string(code), "--points", fmt::format("{} {}.", file_, what)});
  }

  const Column* column(const std::string& name, std::string_view unit) {
    const Column* found = table_.find(name);
    if (found && found->unit != unit)
      fail("wrong_unit",
           fmt::format("has the column {}; its unit is {}: {}[{}]", found->heading(), unit, name, unit));
    return found;
  }

  void find_columns() {
    bool has_any = false;
    for (const Input& input : robot_.inputs) {
      Tendon& tendon = tendons_.emplace_back(
          Tendon{column(input.name + ".tension", "N"), column(input.name + ".change", "m")});
      has_any = has_any || tendon.tension || tendon.change;
      has_tensions_ = has_tensions_ || tendon.tension;
      has_changes_ = has_changes_ || tendon.change;
    }
    for (const char* name : wrench_columns) {
      const Column* found = column(name, name[0] == 'f' ? "N" : "N m");
      has_wrench_ = has_wrench_ || found;
      wrench_.push_back(found);
    }
    for (const Column& one : table_.columns)
      if ((one.name.starts_with("sections[") || one.name.starts_with("legs[")) && !is_known(one.name))
        fail("unknown_column",
             fmt::format("has the column {}, which is of no tendon of {}; tendons are {} to {}, each with "
                         ".tension[N] or .change[m]",
                         one.heading(), robot_.description.text("robot"), robot_.inputs.front().name,
                         robot_.inputs.back().name));
    if (!has_any && errors_.empty())
      fail("missing_column",
           fmt::format("has no column of a tendon; a path needs a heading like {}.tension[N] or "
                       "{}.change[m]",
                       robot_.inputs.front().name, robot_.inputs.front().name));
  }

  bool is_known(std::string_view name) const {
    return std::ranges::any_of(robot_.inputs, [&](const Input& input) {
      return std::ranges::any_of(tendon_columns, [&](const TendonColumn& column) {
        return name == fmt::format("{}.{}", input.name, column.name);
      });
    });
  }

  double number(const Column& column, std::size_t k) {
    if (!std::isfinite(column.values[k]))
      fail("not_a_number", fmt::format("has an empty cell in row {}, column {}", k + 1, column.heading()));
    return column.values[k];
  }

  Node point(std::size_t k) {
    std::vector<Node> tensions, changes;
    for (std::size_t i = 0; i < tendons_.size(); ++i) {
      const auto& [tension, change] = tendons_[i];
      const bool pulls = tension && std::isfinite(tension->values[k]),
                 moves = change && std::isfinite(change->values[k]);
      if (pulls && moves)
        fail("ambiguous", fmt::format("gives a tension and a change of {} in row {}; leave one cell, or one "
                                      "column, out",
                                      robot_.inputs[i].name, k + 1));
      if ((tension || change) && !pulls && !moves) number(tension ? *tension : *change, k);
      tensions.push_back(pulls ? make_node(tension->values[k]) : Node());
      changes.push_back(moves ? make_node(change->values[k]) : Node());
    }
    std::vector<Member> members;
    if (has_tensions_) members.push_back(member_of("tensions", by_section(tensions)));
    if (has_changes_) members.push_back(member_of("changes", by_section(changes)));
    if (has_wrench_) {
      std::vector<Node> wrench;
      for (const Column* one : wrench_) wrench.push_back(make_node(one ? number(*one, k) : 0.0));
      members.push_back(member_of("wrench", list_of(std::move(wrench))));
    }
    return map_of(std::move(members));
  }

  Node by_section(std::vector<Node>& values) const {
    if (stands_on_arms(robot_)) return by_section_of_legs(values);
    std::vector<std::vector<Node>> lists(robot_.description.find("sections")->items.size());
    const auto& tendons = robot_.description.find("tendons")->items;
    for (std::size_t i = 0; i < values.size(); ++i)
      lists[static_cast<std::size_t>(cli::number(tendons[i], "section"))].push_back(std::move(values[i]));
    std::vector<Node> sections;
    for (std::vector<Node>& list : lists) sections.push_back(list_of(std::move(list)));
    return list_of(std::move(sections));
  }

  Node by_section_of_legs(std::vector<Node>& values) const {
    std::vector<Node> sections;
    auto next = values.begin();
    for (const Node& leg : robot_.description.find("legs")->items)
      for (const Node& section : at(leg, "link.sections")->items) {
        const auto after = next + static_cast<std::ptrdiff_t>(cli::number(section, "tendons"));
        sections.push_back(list_of(std::vector<Node>(next, after)));
        next = after;
      }
    return list_of(std::move(sections));
  }

  const std::string& file_;
  const Table& table_;
  const OpenRobot& robot_;
  Errors& errors_;
  std::vector<Tendon> tendons_;
  std::vector<const Column*> wrench_;
  bool has_tensions_ = false, has_changes_ = false, has_wrench_ = false;
};

/// Numbers of all tendons, whatever section they end in.
std::vector<double> of_tendons(const Node& row, std::string_view key) {
  std::vector<double> values;
  if (!row.find(key)) return values;
  for (const Node& section : row.find(key)->items)
    for (const Node& value : section.items) values.push_back(value.number);
  return values;
}

/// What is known of rubbing tendons alone is not told of a platform on legs of sections.
bool is_told(std::string_view name, bool is_of_legs) {
  return !is_of_legs || (name != "end_tension" && name != "motor_work" && name != "friction_loss");
}
constexpr std::array energy_columns{"potential", "motor_work", "friction_loss"};

}  // namespace

std::optional<Node> read_arm_path(const std::string& file, const OpenRobot& robot, Errors& errors) {
  const Expected<Table> table = read_csv(file);
  if (!table) {
    errors.insert(errors.end(), table.error().begin(), table.error().end());
    return {};
  }
  if (!is_arm(robot) && !stands_on_arms(robot)) {
    errors.push_back({"not_available", "--points",
                      fmt::format("{} is no arm: its path is one of poses, --poses or --from and --to.",
                                  robot.description.text("robot"))});
    return {};
  }
  return PathReader(file, *table, robot, errors).read();
}

Table arm_path_table(const Answer& answer, const OpenRobot& robot) {
  Table table;
  const bool is_of_legs = stands_on_arms(robot);
  table.comments = {fmt::format("sinew {}: track {}", version(), answer.text("robot"))};
  const auto add = [&](std::string_view name, std::string_view unit) {
    table.columns.push_back({std::string(name), std::string(unit), {}});
  };
  add("point", "");
  add("part", "");
  for (const Input& column : pose_columns(true)) add(column.name, column.unit);
  for (const Input& input : robot.inputs)
    for (const TendonColumn& column : tendon_columns)
      if (is_told(column.name, is_of_legs)) add(fmt::format("{}.{}", input.name, column.name), column.unit);
  for (const char* name : energy_columns)
    if (is_told(name, is_of_legs)) add(name, "J");
  for (const Node& from : answer.find("rows")->items) {
    std::vector<double> row{number(from, "point"), number(from, "part")};
    const auto pose = pose_values(*from.find(is_of_legs ? "pose" : "tip"));
    row.insert(row.end(), pose.begin(), pose.end());
    std::array<std::vector<double>, tendon_columns.size()> states;
    for (std::size_t c = 0; c < states.size(); ++c) states[c] = of_tendons(from, tendon_columns[c].key);
    for (std::size_t i = 0; i < robot.inputs.size(); ++i)
      for (const auto& state : states)
        if (!state.empty()) row.push_back(state[i]);
    for (const char* name : energy_columns)
      if (is_told(name, is_of_legs)) row.push_back(number(from, name));
    table.add_row(row);
  }
  return table;
}

std::string show_arm_path(const Answer& answer, const OpenRobot& robot) {
  std::vector<std::string> header{"point", "part", "x[mm]", "y[mm]", "z[mm]"};
  for (const Input& input : robot.inputs) header.push_back(heading(input.name + ".tension", "N"));
  const bool is_of_legs = stands_on_arms(robot);
  if (!is_of_legs) header.push_back(heading("friction_loss", "J"));
  TextTable table(std::move(header));
  for (const Node& row : answer.find("rows")->items) {
    std::vector<std::string> cells{fmt::format("{}", number(row, "point")), six_digits(number(row, "part"))};
    for (const double place : numbers(at(row, is_of_legs ? "pose.position" : "tip.position")))
      cells.push_back(cell(place, "m"));
    for (const double tension : of_tendons(row, "tensions")) cells.push_back(cell(tension, "N"));
    if (!is_of_legs) cells.push_back(cell(number(row, "friction_loss"), "J"));
    table.add(std::move(cells));
  }
  if (is_of_legs) return table.text();
  return table.text() + fmt::format("\nmotors put in {} mJ, friction took {} mJ\n",
                                    six_digits(1000 * answer.number("motor_work").value_or(0)),
                                    six_digits(1000 * answer.number("friction_loss").value_or(0)));
}

}  // namespace sinew::cli
