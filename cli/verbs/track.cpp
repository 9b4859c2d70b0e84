/// track: the inputs along a path of the platform, or an arm along a path of inputs, as a table for people or
/// a file of numbers.
#include <fmt/format.h>

#include "arm_path.hpp"
#include "io/document/visible.hpp"
#include "io/robots/arm_file.hpp"
#include "io/robots/serial_file.hpp"
#include "question.hpp"
#include "sinew/base/numbers.hpp"
#include "sinew/io/table.hpp"
#include "terminal.hpp"

namespace sinew::cli {
namespace {

std::vector<Input> columns_of(const Answer& answer, const OpenRobot& robot) {
  std::vector<Input> columns{{"sample", ""}};
  const auto add = [&](const std::vector<Input>& more) {
    columns.insert(columns.end(), more.begin(), more.end());
  };
  add(pose_columns(robot.is_spatial));
  const Node* angles = answer.find("rows[0].angles");
  add(angles ? angle_columns(*angles, robot) : robot.inputs);
  const auto& legs = robot.description.find("legs")->items;
  for (std::size_t i = 0; !angles && i < legs.size(); ++i)
    if (const Node* type = at(legs[i], "link.type");
        !robot.is_on_rods &&
        (!type || type->text != "rail"))  // a strut does not bend; a rod not by one number
      add({{fmt::format("legs[{}].curvature", i), "1/m"}});
  if (answer.find("rows[0].unstable_directions"))
    add({{"position_index", ""}, {"rotation_index", "1/m"}, {"residual", ""}, {"unstable_directions", ""}});
  else
    add({{"condition", ""}, {"condition_homogenised", ""}, {"closure_error", "m"}});
  return columns;
}

/// The path in SI.
Table path_table(const Answer& answer, const OpenRobot& robot) {
  Table table;
  table.comments = {fmt::format("sinew {}: track {}", version(), answer.text("robot"))};
  for (const Input& column : columns_of(answer, robot))
    table.columns.push_back({column.name, column.unit, {}});
  const auto& rows = answer.find("rows")->items;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    std::vector<double> row{static_cast<double>(k + 1)};
    const auto add = [&](const std::vector<double>& more) {
      row.insert(row.end(), more.begin(), more.end());
    };
    add(pose_values(*rows[k].find("pose")));
    if (const Node* angles = rows[k].find("angles")) {
      add(angle_values(*angles));
    } else {
      add(numbers(rows[k].find("inputs")));
      add(numbers(rows[k].find("curvature")));
    }
    const auto put = [&](std::initializer_list<const char*> paths) {
      for (const char* path : paths) {
        const Node* value = at(rows[k], path);
        row.push_back(value ? value->number : not_a_number);
      }
    };
    if (robot.is_on_rods)
      put({"indices.position", "indices.rotation", "residual", "unstable_directions"});
    else
      put({"indices.condition", "indices.condition_homogenised", "closure_error"});
    table.add_row(row);
  }
  return table;
}

}  // namespace

int run_track(const Arguments& arguments) {
  if (arguments.has("from") && !arguments.has("to"))
    return refuse_question(arguments,
                           {{"missing_option", "--to",
                             fmt::format("--to is missing. Example: {}", find_verb("track")->example)}});
  auto robot = open(arguments);
  if (robot && is_serial(*robot)) robot = open_with_platform(arguments);
  if (!robot) return refuse_question(arguments, robot.error());
  const auto answer = put("track", arguments, *robot);
  if (!answer) return refuse_question(arguments, answer.error());
  const Node* rows = answer->find("rows");
  const bool has_points = is_arm(*robot) || stands_on_arms(*robot);
  std::string shown = !rows || rows->items.empty() ? ""
                      : has_points                 ? show_arm_path(*answer, *robot)
                                                   : show_path(*rows, *robot);
  const std::string* file = arguments.text("output");
  if (rows && file) {
    const auto written =
        write_csv(has_points ? arm_path_table(*answer, *robot) : path_table(*answer, *robot), *file);
    if (!written) return refuse_question(arguments, written.error());
    shown = arguments.has("quiet") ? "" : visible_line(*file) + '\n';
  }
  return conclude(*answer, arguments, shown);
}

}  // namespace sinew::cli
