/// Velocity equations and singularities, as people read them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "show.hpp"
#include "text_table.hpp"

namespace sinew::cli {
namespace {

double largest(const Node& matrix) {
  double result = 0;
  for (const Node& row : matrix.items)
    for (const Node& entry : row.items) result = std::max(result, std::abs(entry.number));
  return result;
}

/// The rows of J and K: one a leg, of a pinned leg one a coordinate; those of planes come last.
struct Rows {
  std::vector<std::string> names;
  int pinned = 0;  ///< rows in [m] instead of [m²]
};

Rows rows_of(const OpenRobot& robot) {
  Rows rows;
  const auto& legs = robot.description.find("legs")->items;
  std::vector<std::string> planes;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    if (at(legs[i], "closure.type")->text == "hinged_strut")
      planes.push_back(fmt::format("legs[{}].plane", i));
    if (at(legs[i], "closure.type")->text != "pin") {
      rows.names.push_back(fmt::format("legs[{}]", i));
      continue;
    }
    for (const char* axis : {"x", "y"}) rows.names.push_back(fmt::format("legs[{}].{}", i, axis));
    rows.pinned += 2;
  }
  rows.names.insert(rows.names.end(), planes.begin(), planes.end());
  rows.pinned += static_cast<int>(planes.size());
  return rows;
}

/// J and K are the paper's: J·(platform velocity) = K·(input rates), rows times the chord, so they stay in
/// SI. Where rows have different units the headings leave them out.
std::string show_equations(const Answer& answer, const OpenRobot& robot) {
  const Rows rows = rows_of(robot);
  const auto si = [](std::size_t, std::size_t) { return 1.0; };
  const auto named = [&](const std::string& name, bool is_length) {
    return rows.pinned ? name : fmt::format("{}[{}]", name, is_length ? "m" : "m^2");
  };
  std::vector<std::string> J{"J"}, K{"K"};
  for (const Input& column : pose_columns(robot.is_spatial))
    J.push_back(named(column.name, column.unit == "m"));
  for (const Input& input : robot.inputs) K.push_back(named(input.name, input.unit == "m"));
  return show_matrix(*answer.find("J"), std::move(J), rows.names, si) + '\n' +
         show_matrix(*answer.find("K"), std::move(K), rows.names, si);
}

std::string in_mm(const Node& point) {
  std::string text;
  constexpr std::string_view axes = "xyz";
  for (std::size_t k = 0; k < point.items.size(); ++k)
    text += fmt::format("{}{} = {} mm", k ? ", " : "", axes.at(k), cell(point.items[k].number, "m"));
  return text;
}

/// How the platform moves with the inputs held, where that is one motion: about an axis, or along it.
std::string screw(const Answer& answer) {
  const Node* axis = answer.find("type_2.axis");
  if (!axis) return {};
  std::string along;
  for (const double part : numbers(axis->find("direction")))
    along += fmt::format("{}{}", along.empty() ? "" : ", ", cell(part, ""));
  const auto pitch = answer.number("type_2.pitch");
  if (!pitch) return fmt::format(": a translation along ({})", along);
  return fmt::format(": a screw of pitch {} mm/rad about the axis along ({}) at {}", cell(*pitch, "m"), along,
                     in_mm(*axis->find("point")));
}

}  // namespace

std::string show_matrix(const Node& matrix, std::vector<std::string> header,
                        const std::vector<std::string>& rows,
                        const std::function<double(std::size_t, std::size_t)>& factor) {
  const double scale = largest(matrix);
  TextTable table(std::move(header));
  for (std::size_t i = 0; i < matrix.items.size(); ++i) {
    std::vector<std::string> row{rows.at(i)};
    for (std::size_t j = 0; j < matrix.items[i].items.size(); ++j) {
      const double entry = matrix.items[i].items[j].number;
      row.push_back(std::abs(entry) <= 1e-12 * scale ? "0" : six_digits(entry * factor(i, j)));
    }
    table.add(std::move(row));
  }
  return table.text();
}

/// U maps inputs to the platform. Inputs of one unit: a ratio of lengths is one in any unit, the rest is in
/// degrees and mm. Mixed inputs: rows and columns each have theirs.
std::string show_sensitivity(std::string_view title, const Node& matrix, const OpenRobot& robot) {
  const auto platform = pose_columns(robot.is_spatial);
  const std::string unit = robot.input_unit();
  std::vector<std::string> header{std::string(title)}, rows;
  for (const Input& input : robot.inputs)
    header.push_back(unit.empty() ? fmt::format("{}[1/{}]", input.name, shown(input.unit).unit) : input.name);
  for (const Input& row : platform)
    rows.push_back(unit.empty() ? heading(row.name, row.unit)
                                : fmt::format("{}[{}/{}]", row.name, shown(row.unit).unit, shown(unit).unit));
  return show_matrix(matrix, header, rows, [&](std::size_t i, std::size_t j) {
    return shown(platform[i].unit).factor / shown(robot.inputs[j].unit).factor;
  });
}

std::string show_indices(const Answer& answer, const OpenRobot& robot) {
  TextTable table({"index", "value"});
  const auto row = [&](std::string_view name, std::optional<double> number, double factor) {
    // beyond what doubles resolve a condition number is noise
    table.add({std::string(name), !number ? "-" : *number > 1e15 ? "inf" : six_digits(*number * factor)});
  };
  const Rows rows = rows_of(robot);
  const int power = static_cast<int>(rows.names.size()) - rows.pinned + (robot.is_spatial ? 3 : 1);
  if (const auto determinant = answer.number("determinant"))  // of a square J
    row(power == 1 ? "determinant[m]" : fmt::format("determinant[m^{}]", power), determinant,
        answer.text("type_2.singular") == "true" ? 0 : 1);
  row("condition", answer.number("indices.condition"), 1);
  row("condition_homogenised", answer.number("indices.condition_homogenised"), 1);
  const std::string unit = robot.input_unit();  // mixed inputs have no norm in mm or degrees
  const Shown input = shown(unit), length = shown("m"), turn = shown("rad");
  const auto sensitivity = [&](std::string_view name, const Shown& of) {
    const auto number = answer.number(fmt::format("indices.{}", name));
    if (unit.empty()) return row(fmt::format("{}[SI]", name), number, 1);
    row(fmt::format("{}[{}/{}]", name, of.unit, input.unit), number, of.factor / input.factor);
  };
  sensitivity("position", length);
  sensitivity("rotation", turn);
  return table.text();
}

std::string show_singularities(const Answer& answer) {
  std::vector<std::string> lost;
  for (const double leg : numbers(answer.find("type_1"))) lost.push_back(fmt::format("legs[{}]", leg));
  std::string text =
      "type I: " + (lost.empty() ? std::string("none")
                                 : fmt::format("{}, whose input moves nothing", fmt::join(lost, ", ")));
  const std::string kind = answer.text("type_2.class");
  text += "\ntype II: ";
  if (answer.text("type_2.singular") != "true")
    return text + "none, the lines of the legs are " + kind + "\n";
  const bool has_number = !kind.empty() && kind.front() >= '1' && kind.front() <= '5';  // a class of space
  text += has_number ? fmt::format("singular, the lines of the legs have rank {}, class {}",
                                   answer.text("type_2.rank"), kind)
                     : fmt::format("singular, the lines of the legs are {}", kind);
  if (const Node* point = answer.find("type_2.point")) text += " at " + in_mm(*point);
  return text + "; the platform moves with the inputs held" + screw(answer) + "\n";
}

std::string show_velocity(const Answer& answer, const OpenRobot& robot) {
  if (is_on_rods(answer)) return show_rod_velocity(answer, robot);
  if (is_on_chains(answer)) return show_chain_velocity(answer, robot);
  std::string text = show_pose(*answer.find("pose")) + '\n' + show_equations(answer, robot) + '\n';
  if (const Node* U = answer.find("U")) text += show_sensitivity("U", *U, robot) + '\n';
  text += show_indices(answer, robot) + '\n' + show_singularities(answer);
  if (const Node* rates = answer.find("rates"))
    text += '\n' + show_inputs("rate", numbers(rates), robot, "/s");
  return text;
}

}  // namespace sinew::cli
