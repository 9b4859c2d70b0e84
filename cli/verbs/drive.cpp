/// drive: when a serial robot on a linear stage is where.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "io/document/parse.hpp"
#include "io/document/quantity.hpp"
#include "io/document/visible.hpp"
#include "io/robots/serial_file.hpp"
#include "io/table/posture_table.hpp"
#include "io/table/trajectory_file.hpp"
#include "request.hpp"
#include "serial_robot.hpp"
#include "sinew/study/study.hpp"
#include "terminal.hpp"
#include "text_table.hpp"

namespace sinew::cli {
namespace {

namespace fs = std::filesystem;

struct Limit {
  std::string_view name;
  double TrajectoryLimits::*value;
  Dimension dimension;
};

constexpr std::array all_limits{
    Limit{"stage_speed", &TrajectoryLimits::stage_speed, Dimension::speed},
    Limit{"stage_acceleration", &TrajectoryLimits::stage_acceleration, Dimension::acceleration},
    Limit{"bend_speed", &TrajectoryLimits::bend_speed, Dimension::angular_speed},
    Limit{"bend_acceleration", &TrajectoryLimits::bend_acceleration, Dimension::angular_acceleration},
    Limit{"tendon_speed", &TrajectoryLimits::tendon_speed, Dimension::speed},
    Limit{"tendon_acceleration", &TrajectoryLimits::tendon_acceleration, Dimension::acceleration},
};

/// `stage_speed=10 mm/s`
void set_limit(std::string_view change, TrajectoryLimits& limits, Errors& errors) {
  const std::size_t equals = change.find('=');
  const std::string name(trimmed(change.substr(0, equals)));
  const auto found = std::ranges::find(all_limits, name, &Limit::name);
  if (found == all_limits.end() || equals == std::string_view::npos) {
    std::vector<std::string_view> names;
    for (const Limit& limit : all_limits) names.push_back(limit.name);
    const std::string_view hint = found == all_limits.end() ? closest(name, names) : "";
    errors.push_back(
        {"unknown_choice", "--limits",
         fmt::format("{} is no NAME=VALUE{} There are: {}.", in_quotes(std::string(change)),
                     hint.empty() ? "." : fmt::format("; did you mean {}?", hint), fmt::join(names, ", "))});
    return;
  }
  const auto value = parse_quantity(trimmed(change.substr(equals + 1)), found->dimension);
  if (!value)
    errors.push_back({value.error().front().code, "--limits " + name, value.error().front().message});
  else if (!(*value > 0 && *value < 1e9))
    errors.push_back({"out_of_range", "--limits " + name, "has to be above 0, and below 1e9 in SI"});
  else
    limits.*(found->value) = *value;
}

TrajectoryLimits read_limits(const Arguments& arguments, Errors& errors) {
  TrajectoryLimits limits;
  if (const auto given = arguments.options.find("limits"); given != arguments.options.end())
    for (std::string_view rest : given->second)
      while (!rest.empty()) {
        const std::size_t comma = std::min(rest.find(','), rest.size());
        set_limit(rest.substr(0, comma), limits, errors);
        rest.remove_prefix(std::min(comma + 1, rest.size()));
      }
  return limits;
}

/// Between points [s].
double read_period(const Arguments& arguments, Errors& errors) {
  const std::string* rate = arguments.text("rate");
  if (!rate) return 1.0 / 50;
  const auto value = parse_quantity(*rate, Dimension::number);
  if (value && *value > 0 && *value <= 1e6) return 1 / *value;
  errors.push_back({"out_of_range", "--rate",
                    fmt::format("{} is no number of points a second, above 0", in_quotes(*rate))});
  return 0;
}

std::optional<TendonMotor> read_stage_motor(const Arguments& arguments, Errors& errors) {
  const std::string* text = arguments.text("stage-motor");
  if (!text) return {};
  const auto motor =
      parse_yaml(*text, "--stage-motor").and_then([](const Document& d) { return read_motor(d); });
  if (motor) return *motor;
  errors.insert(errors.end(), motor.error().begin(), motor.error().end());
  return {};
}

/// What it reaches beside what it may.
std::string reached_text(const Trajectory& trajectory, const TrajectoryLimits& limits) {
  TextTable table({"", "greatest", "limit"});
  for (const Limit& limit : all_limits)
    table.add({std::string(limit.name), human(trajectory.greatest.*(limit.value), limit.dimension),
               human(limits.*(limit.value), limit.dimension)});
  return table.text();
}

std::string reached_json(const Trajectory& trajectory) {
  std::string text;
  for (const Limit& limit : all_limits)
    text += fmt::format("{}{}:{}", text.empty() ? "" : ",", json_text(std::string(limit.name)),
                        si_text(trajectory.greatest.*(limit.value)));
  return "{" + text + "}";
}

}  // namespace

int run_drive(const Arguments& arguments) {
  Errors errors;
  const TrajectoryLimits limits = read_limits(arguments, errors);
  const double period = read_period(arguments, errors);
  const auto stage_motor = read_stage_motor(arguments, errors);
  const auto model = tendon_model(arguments);
  if (!model) errors.insert(errors.end(), model.error().begin(), model.error().end());
  const fs::path output = arguments.has("output")
                              ? fs::path(*arguments.text("output"))
                              : fs::path(*arguments.text("along")).replace_extension().concat(".drive.csv");
  const bool is_ros = output.extension() == ".yaml";
  for (const char* option : {"model", "stage-motor"})
    if (is_ros && arguments.has(option))
      errors.push_back({"no_effect", fmt::format("--{}", option),
                        "without effect on a JointTrajectory, which has no counts; leave it out"});
  if (!errors.empty()) return refuse("drive", errors);
  const auto robot = open_serial(arguments);
  if (!robot) return refuse("drive", robot.error());
  const std::string& file = *arguments.text("along");
  auto postures =
      read_result(file).and_then([&](const Table& table) { return read_postures(table, *robot, file); });
  if (!postures) return refuse("drive", postures.error());
  if (arguments.has("reverse")) std::ranges::reverse(*postures);
  const Trajectory trajectory = time_optimal_trajectory(*robot, *postures, limits, period);
  if (!trajectory.report.ok()) {
    const std::string_view why = trajectory.report.message.view();
    if (arguments.has("json"))
      print(fmt::format("{{\"status\":{},\"message\":{}}}\n",
                        json_text(std::string(to_string(trajectory.report.status))),
                        json_text(std::string(why))));
    message(fmt::format("sinew drive: {}: {}", file, why));
    return no_solution;
  }
  Expected<void> written;
  if (is_ros)
    written = write_text(ros_trajectory(*robot, trajectory), output);
  else {
    Table table = trajectory_table(*robot, trajectory, *model, stage_motor);
    table.comments = {fmt::format("sinew {}: drive along {}", version(), fs::path(file).filename().string()),
                      fmt::format("robot: {}", robot->name),
                      fmt::format("duration: {} s", si_text(trajectory.duration))};
    if (robot->motor)
      table.comments.push_back(fmt::format("counts: {}", *model == kernel::Model::exact ? "pcc" : "lsk"));
    written = write_result(table, output);
  }
  if (!written) return refuse("drive", written.error());
  if (arguments.has("json"))
    print(fmt::format(
        "{{\"status\":\"converged\",\"output\":{},\"points\":{},\"duration\":{},\"greatest\":{}}}\n",
        json_text(output.string()), trajectory.points.size(), si_text(trajectory.duration),
        reached_json(trajectory)));
  else if (!arguments.has("quiet"))
    print(reached_text(trajectory, limits) + fmt::format("{}: {} points, {:.2f} s\n",
                                                         visible_line(output.string()),
                                                         trajectory.points.size(), trajectory.duration));
  return solved;
}

}  // namespace sinew::cli
