/// Robots on pseudo-rigid chains, as people read them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "show.hpp"
#include "text_table.hpp"

namespace sinew::cli {
namespace {

/// Joints as the paper counts them: the last one is n.
int first_joint(const OpenRobot& robot, std::size_t leg, std::size_t count) {
  const Node* joints = at(robot.description.find("legs")->items.at(leg), "link.joints");
  return joints ? static_cast<int>(joints->number) - static_cast<int>(count) + 1 : 1;
}

std::vector<const Node*> angles_of(const Node& legs) {
  std::vector<const Node*> angles;
  for (const Node& leg : legs.items) angles.push_back(leg.find("angles") ? leg.find("angles") : &leg);
  return angles;
}

/// One row a leg, one column a joint.
std::string per_joint(const std::string& title, const std::vector<std::vector<double>>& legs,
                      const OpenRobot& robot, std::string_view unit) {
  std::vector<std::string> header{title};
  int first = first_joint(robot, 0, legs.front().size()), last = 0;
  for (std::size_t i = 0; i < legs.size(); ++i) {  // legs may be of unlike chains
    const int own = first_joint(robot, i, legs[i].size());
    first = std::min(first, own);
    last = std::max(last, own + static_cast<int>(legs[i].size()) - 1);
  }
  for (int j = first; j <= last; ++j) header.push_back(heading(fmt::format("theta_{}", j), unit));
  TextTable table(std::move(header));
  for (std::size_t i = 0; i < legs.size(); ++i) {
    std::vector<std::string> row{fmt::format("legs[{}]", i)};
    const int own = first_joint(robot, i, legs[i].size());
    row.resize(static_cast<std::size_t>(1 + own - first), "-");
    for (const double value : legs[i]) row.push_back(unit == "rad" ? cell(value, unit) : six_digits(value));
    row.resize(static_cast<std::size_t>(2 + last - first), "-");
    table.add(std::move(row));
  }
  return table.text();
}

/// Numbers of all joints, leg by leg.
std::vector<std::vector<double>> per_leg(const Node& legs, const std::vector<double>& all) {
  std::vector<std::vector<double>> split;
  auto from = all.begin();
  for (const Node* angles : angles_of(legs)) {
    const auto to = from + static_cast<std::ptrdiff_t>(angles->items.size());
    split.emplace_back(from, to);
    from = to;
  }
  return split;
}

std::string show_angles(const Node& legs, const OpenRobot& robot) {
  std::vector<std::vector<double>> angles;
  for (const Node* of : angles_of(legs)) angles.push_back(numbers(of));
  return per_joint("joints", angles, robot, "rad");
}

std::string show_forces(const Node& legs) {
  const bool has_motors = !legs.items.empty() && legs.items.front().find("motor_torque");
  std::vector<std::string> header{"leg",          "tendon_1[mm]", "tendon_2[mm]",
                                  "tension_1[N]", "tension_2[N]", "chord_force[N]"};
  if (has_motors) header.emplace_back("motor_torque[N m]");
  TextTable table(std::move(header));
  for (std::size_t i = 0; i < legs.items.size(); ++i) {
    const Node& leg = legs.items[i];
    const auto value = [&](std::string_view path, std::string_view unit) {
      return cell(number(leg, path), unit);
    };
    std::vector<std::string> row{fmt::format("legs[{}]", i),      value("tendon_lengths[0]", "m"),
                                 value("tendon_lengths[1]", "m"), value("tensions[0]", "N"),
                                 value("tensions[1]", "N"),       value("chord_force", "N")};
    if (has_motors) row.push_back(six_digits(number(leg, "motor_torque")));
    table.add(std::move(row));
  }
  return table.text();
}

/// The loaded pose beside what simpler models make of the load.
std::string show_models(const Answer& answer, const OpenRobot& robot) {
  const auto columns = pose_columns(robot.is_spatial);
  std::vector<std::string> header{"model"};
  for (const Input& column : columns) header.push_back(heading(column.name, column.unit));
  TextTable table(std::move(header));
  if (const Node* pose = answer.find("cc_pose")) {
    std::vector<std::string> row{"bent evenly"};
    const auto values = pose_values(*pose);
    for (std::size_t k = 0; k < values.size(); ++k) row.push_back(cell(values[k], columns[k].unit));
    table.add(std::move(row));
  }
  std::vector<std::string> row{"linear, change"};
  const auto change = numbers(answer.find("linear"));
  for (std::size_t k = 0; k < change.size(); ++k) row.push_back(cell(change[k], columns[k].unit));
  table.add(std::move(row));
  return table.text();
}

std::string show_numbers(const Answer& answer) {
  TextTable table({"quantity", "value"});
  const auto add = [&](std::string_view name, std::string_view path, double factor) {
    if (const auto value = answer.number(path)) table.add({std::string(name), six_digits(*value * factor)});
  };
  add("potential[mJ]", "potential", 1e3);
  add("smallest_eigenvalue", "smallest_eigenvalue", 1);
  if (answer.find("linear_error")) {  // without a load these are what rounding leaves
    add("posture_error[deg]", "posture_error", shown("rad").factor);
    add("linear_error[%]", "linear_error", 100);
    add("cc_gap[uJ]", "cc_gap", 1e6);
    add("cc_gap_estimate[uJ]", "cc_gap_estimate", 1e6);
  }
  return table.text();
}

}  // namespace

bool is_on_chains(const Answer& answer) { return answer.find("legs[0].angles") != nullptr; }

std::vector<Input> angle_columns(const Node& angles, const OpenRobot& robot) {
  std::vector<Input> columns;
  for (std::size_t i = 0; i < angles.items.size(); ++i) {
    const std::size_t count = angles.items[i].items.size();
    const int first = first_joint(robot, i, count);
    for (std::size_t j = 0; j < count; ++j)
      columns.push_back({fmt::format("legs[{}].theta_{}", i, first + static_cast<int>(j)), "rad"});
  }
  return columns;
}

std::vector<double> angle_values(const Node& angles) {
  std::vector<double> values;
  for (const Node& leg : angles.items)
    for (const Node& angle : leg.items) values.push_back(angle.number);
  return values;
}

std::string show_chains(const Answer& answer, const OpenRobot& robot) {
  const Node& legs = *answer.find("legs");
  std::string text = show_pose(*answer.find("pose")) + '\n' + show_forces(legs) + '\n' +
                     show_angles(legs, robot) + '\n' + show_numbers(answer);
  if (answer.find("linear_error")) text += '\n' + show_models(answer, robot);
  if (answer.find("wrench_sensitivity")) text += '\n' + show_wrench(answer);
  if (const Node* margins = answer.find("margins")) text += '\n' + show_margins(*margins);
  if (answer.find("solutions")) text += '\n' + show_equilibria(answer, robot);
  if (answer.find("load"))
    text += fmt::format("\nload: {} times the wrench of --until, {}\n", six_digits(*answer.number("load")),
                        answer.text("why"));
  return text;
}

/// K row by row: a leg's row has columns of its own joints only.
std::string show_chain_velocity(const Answer& answer, const OpenRobot& robot) {
  const Node &legs = *answer.find("legs"), &K = *answer.find("K");
  std::vector<std::string> J{"J"}, rows;
  for (const Input& column : pose_columns(robot.is_spatial))
    J.push_back(fmt::format("{}[{}]", column.name, column.unit == "m" ? "m" : "m^2"));
  std::vector<std::vector<double>> own;
  for (std::size_t i = 0; i < legs.items.size(); ++i) {
    rows.push_back(fmt::format("legs[{}]", i));
    own.push_back(per_leg(legs, numbers(&K.items[i]))[i]);
  }
  std::string text =
      show_pose(*answer.find("pose")) + '\n' + show_angles(legs, robot) + '\n' +
      show_matrix(*answer.find("J"), std::move(J), rows, [](std::size_t, std::size_t) { return 1.0; }) +
      '\n' + per_joint("K", own, robot, "m^2") + '\n';
  TextTable table({"index", "value"});
  const auto add = [&](std::string_view name, std::string_view path, double factor) {
    const auto value = answer.number(path);
    table.add({std::string(name), value ? six_digits(*value * factor) : "-"});
  };
  add(robot.is_spatial ? "determinant[m^9]" : "determinant[m^4]", "determinant", 1);
  add("condition", "indices.condition", 1);
  add("condition_homogenised", "indices.condition_homogenised", 1);
  add("position[mm/deg]", "indices.position", shown("m").factor / shown("rad").factor);
  add("rotation[deg/deg]", "indices.rotation", 1);
  text += table.text() + '\n' + show_singularities(answer);
  if (const Node* rates = answer.find("rates")) {
    text += '\n' + per_joint("rates, rad/s", per_leg(legs, numbers(rates)), robot, "");
  }
  return text;
}

}  // namespace sinew::cli
