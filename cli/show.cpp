#include "show.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>

#include "sinew/math/se3.hpp"
#include "sinew/solve/report.hpp"
#include "terminal.hpp"
#include "text_table.hpp"

namespace sinew::cli {
namespace {

void add_headings(std::vector<std::string>& header, const std::vector<Input>& columns) {
  for (const Input& column : columns) header.push_back(heading(column.name, column.unit));
}

void add_cells(std::vector<std::string>& row, const std::vector<double>& values,
               const std::vector<Input>& columns) {
  for (std::size_t i = 0; i < values.size(); ++i) row.push_back(cell(values[i], columns.at(i).unit));
}

bool is_spatial(const Node& pose) { return pose.find("position") != nullptr; }

/// The rotation vector of a quaternion. Of half a turn, which has two, the one whose first component other
/// than 0 is positive: rounding must not decide.
Vec3<double> turn_of(const std::vector<double>& q) {
  const Vec3<double> turn = SO3<double>{q.at(0), Vec3<double>(q.at(1), q.at(2), q.at(3))}.log();
  if (turn.norm() < std::numbers::pi - 1e-9) return turn;
  const auto first = std::ranges::find_if(turn, [](double part) { return std::abs(part) > 1e-9; });
  return *first < 0 ? Vec3<double>(-turn) : turn;
}

/// A quantity of legs: heading, unit, and where an answer has it.
struct LegColumn {
  std::string_view name, unit, path;
};

/// What legs may tell of themselves: a planar one its base tangent, one on a rail its slide.
constexpr std::array all_leg_columns{
    LegColumn{"tendon_1", "m", "tendon_lengths[0]"},  LegColumn{"tendon_2", "m", "tendon_lengths[1]"},
    LegColumn{"curvature", "1/m", "curvature"},       LegColumn{"chord", "m", "chord"},
    LegColumn{"joint_1", "rad", "joint_angles[0]"},   LegColumn{"joint_2", "rad", "joint_angles[1]"},
    LegColumn{"base_tangent", "rad", "base_tangent"}, LegColumn{"slide", "m", "slide"},
    LegColumn{"hinge_angle", "rad", "hinge_angle"},
};

constexpr std::array rod_columns{
    LegColumn{"length", "m", "length"},
    LegColumn{"force_x", "N", "force[0]"},
    LegColumn{"force_y", "N", "force[1]"},
    LegColumn{"force_z", "N", "force[2]"},
    LegColumn{"moment_0_x", "N m", "moment_0[0]"},
    LegColumn{"moment_0_y", "N m", "moment_0[1]"},
    LegColumn{"moment_0_z", "N m", "moment_0[2]"},
    LegColumn{"tip_angle", "rad", "tip_angle"},
    LegColumn{"energy", "J", "energy"},
};

const Node* number_of(const Node& leg, const LegColumn& column) {
  const Node* node = at(leg, column.path);
  return node && node->kind == Node::Kind::number ? node : nullptr;
}

/// Those that at least one of the legs has.
std::vector<LegColumn> leg_columns(const Node& legs) {
  std::vector<LegColumn> columns;
  const auto rods =
      std::ranges::count_if(legs.items, [](const Node& leg) { return leg.find("tip_angle") != nullptr; });
  if (rods > 0) columns.assign(rod_columns.begin(), rod_columns.end());
  if (rods == std::ssize(legs.items)) return columns;
  std::ranges::copy_if(all_leg_columns, std::back_inserter(columns), [&](const LegColumn& column) {
    return std::ranges::any_of(legs.items, [&](const Node& leg) { return number_of(leg, column); });
  });
  return columns;
}

}  // namespace

std::vector<Input> pose_columns(bool is_spatial) {
  if (!is_spatial) return {{"x", "m"}, {"y", "m"}, {"phi", "rad"}};
  return {{"x", "m"}, {"y", "m"}, {"z", "m"}, {"rx", "rad"}, {"ry", "rad"}, {"rz", "rad"}};
}

std::vector<double> pose_values(const Node& pose) {
  if (!is_spatial(pose)) return {number(pose, "x"), number(pose, "y"), number(pose, "phi")};
  std::vector<double> values = numbers(pose.find("position"));
  const Vec3<double> turn = turn_of(numbers(pose.find("quaternion")));
  values.insert(values.end(), turn.begin(), turn.end());
  return values;
}

std::string show_pose(const Node& pose) {
  const auto columns = pose_columns(is_spatial(pose));
  std::vector<std::string> header, row;
  add_headings(header, columns);
  add_cells(row, pose_values(pose), columns);
  TextTable table(std::move(header));
  table.add(std::move(row));
  return table.text();
}

std::string show_legs(const Node& legs) {
  const auto columns = leg_columns(legs);
  std::vector<std::string> header{"leg"};
  for (const LegColumn& column : columns) header.push_back(heading(column.name, column.unit));
  TextTable table(std::move(header));
  for (std::size_t i = 0; i < legs.items.size(); ++i) {
    std::vector<std::string> row{fmt::format("legs[{}]", i)};
    for (const LegColumn& column : columns) {
      const Node* value = number_of(legs.items[i], column);
      row.push_back(value ? cell(value->number, column.unit) : "-");
    }
    table.add(std::move(row));
  }
  return table.text();
}

std::string show_inputs(std::string_view title, const std::vector<double>& values, const OpenRobot& robot,
                        std::string_view per) {
  const std::string unit = robot.input_unit();
  std::vector<std::string> header{
      "input", unit.empty() ? std::string(title) : fmt::format("{}[{}{}]", title, shown(unit).unit, per)};
  if (unit.empty()) header.emplace_back("unit");
  TextTable table(std::move(header));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Input& input = robot.inputs.at(i);
    std::vector<std::string> row{input.name, cell(values[i], input.unit)};
    if (unit.empty()) row.push_back(fmt::format("{}{}", shown(input.unit).unit, per));
    table.add(std::move(row));
  }
  return table.text();
}

namespace {

/// The signs of one number of each leg, as the options take them: `"+,-,+"`.
std::string signs(const Node& solution, std::string_view key) {
  std::string text;
  for (const Node& leg : solution.find("legs")->items)
    text += fmt::format("{}{}", text.empty() ? "" : ",", number(leg, key) < 0 ? '-' : '+');
  return '"' + text + '"';
}

}  // namespace

std::string show_working_modes(const Node& solutions, const OpenRobot& robot) {
  const auto first_leg_has = [&](std::string_view path) {
    return !solutions.items.empty() && at(solutions.items.front(), path);
  };
  const bool has_elbows = first_leg_has("legs[0].elbow"), has_bending = first_leg_has("legs[0].curvature");
  std::vector<std::string> header{"mode"};
  if (has_bending) header.emplace_back("bending");
  if (has_elbows) header.emplace_back("elbow");
  add_headings(header, robot.inputs);
  TextTable table(std::move(header));
  for (std::size_t k = 0; k < solutions.items.size(); ++k) {
    const Node& solution = solutions.items[k];
    std::vector<std::string> row{fmt::format("{}", k + 1)};
    if (has_bending) row.push_back(signs(solution, "curvature"));
    if (has_elbows) row.push_back(signs(solution, "elbow"));
    add_cells(row, numbers(solution.find("inputs")), robot.inputs);
    table.add(std::move(row));
  }
  return table.text();
}

std::string show_assembly_modes(const Answer& answer) {
  const auto& solutions = answer.find("solutions")->items;
  if (solutions.empty()) return {};
  const auto columns = pose_columns(is_spatial(*solutions.front().find("pose")));
  std::vector<std::string> header{"mode"};
  add_headings(header, columns);
  TextTable table(std::move(header));
  for (std::size_t k = 0; k < solutions.size(); ++k) {
    std::vector<std::string> row{fmt::format("{}", k + 1)};
    add_cells(row, pose_values(*solutions[k].find("pose")), columns);
    table.add(std::move(row));
  }
  const bool is_complete = answer.find("complete")->boolean;
  return table.text() + fmt::format("{}{} assembly mode{}{}\n", is_complete ? "" : "at least ",
                                    solutions.size(), solutions.size() == 1 ? "" : "s",
                                    is_complete ? ", all there are" : "");
}

std::string show_path(const Node& rows, const OpenRobot& robot) {
  const auto columns = pose_columns(robot.is_spatial);
  std::vector<std::string> header{"sample"};
  add_headings(header, columns);
  const Node* first = rows.items.front().find("angles");
  const auto moved = first ? angle_columns(*first, robot) : robot.inputs;
  add_headings(header, moved);
  const bool is_equilibrium = rows.items.front().find("unstable_directions") != nullptr;
  header.emplace_back(is_equilibrium ? "unstable_directions" : "condition");
  TextTable table(std::move(header));
  for (std::size_t k = 0; k < rows.items.size(); ++k) {
    const Node& from = rows.items[k];
    std::vector<std::string> row{fmt::format("{}", k + 1)};
    add_cells(row, pose_values(*from.find("pose")), columns);
    add_cells(row, first ? angle_values(*from.find("angles")) : numbers(from.find("inputs")), moved);
    const Node* condition = at(from, is_equilibrium ? "unstable_directions" : "indices.condition");
    row.push_back(condition ? six_digits(condition->number) : "-");
    table.add(std::move(row));
  }
  return table.text();
}

std::string show_report(const Answer& answer) {
  Report report;
  report.residual = answer.number("residual").value_or(0);
  report.iterations = static_cast<int>(answer.number("iterations").value_or(0));
  const bool is_known = answer.number("residual").has_value();
  std::string text = is_known ? to_string(report) : "converged";  // else in closed form
  const bool is_of_arm = (answer.find("tip") || answer.find("reached")) && answer.find("potential");
  if (is_on_rods(answer) || is_of_arm || (answer.find("wrench_sensitivity") && !is_on_chains(answer)) ||
      answer.find("curves") || answer.find("rows[0].unstable_directions")) {
    if (!answer.find("curves") && (!is_of_arm || answer.find("stable")))
      text += ", stable";  // else the answer is not a converged one
  } else if (is_known) {
    text += " m";  // of rods and arms it is relative, and has no unit
  }
  return styled(text, Style::good) + '\n';
}

}  // namespace sinew::cli
