#include "io/table/trajectory_file.hpp"

#include <fmt/format.h>

#include <cmath>

#include "io/document/quantity.hpp"
#include "io/table/posture_table.hpp"
#include "sinew/kinematics/serial.hpp"

namespace sinew::inline v1 {
namespace {

using Values = std::vector<double>;

/// A column for each tendon, `S0_exact_1`.
void add_tendon_columns(const SerialRobot& robot, std::string_view what, std::string_view unit,
                        Table& table) {
  for (std::size_t m = 0; m < robot.sections.size(); ++m)
    for (int i = 1; i <= robot.sections[m].tendons; ++i)
      table.columns.push_back({fmt::format("S{}_{}_{}", m, what, i), std::string(unit), {}});
}

void add_counts(const Values& changes, const TendonMotor& motor, Values& row) {
  for (const double change : changes) row.push_back(std::nearbyint(change * motor.counts_per_length()));
}

/// Of positions, speeds or accelerations.
std::string joints_text(double stage, const std::vector<Bend>& bends) {
  std::string text = "[" + si_text(stage);
  for (const Bend& bend : bends) text += fmt::format(", {}, {}", si_text(bend[0]), si_text(bend[1]));
  return text + "]";
}

std::string time_text(double time) {
  const auto nanoseconds = std::llround(time * 1e9);
  return fmt::format("{{sec: {}, nanosec: {}}}", nanoseconds / 1'000'000'000, nanoseconds % 1'000'000'000);
}

}  // namespace

Table trajectory_table(const SerialRobot& robot, const Trajectory& trajectory, kernel::Model model,
                       const std::optional<TendonMotor>& stage_motor) {
  Table table;
  table.columns = {{"time", "s", {}}, {"stage", "m", {}}};
  for (std::size_t m = 0; m < robot.sections.size(); ++m)
    for (const std::string& name : bend_names(robot.sections[m], m))
      table.columns.push_back({name, "rad", {}});
  add_tendon_columns(robot, "exact", "m", table);
  add_tendon_columns(robot, "lsk", "m", table);
  if (robot.motor) add_tendon_columns(robot, "counts", "", table);
  if (stage_motor) table.columns.push_back({"stage_counts", "", {}});
  SerialWorkspace work(robot);
  for (const TrajectoryPoint& point : trajectory.points) {
    const SerialPosture& posture = point.posture;
    Values row{point.time, posture.stage};
    for (std::size_t m = 0; m < robot.sections.size(); ++m)
      for (const double angle : bend_angles(robot.sections[m], posture.bends[m])) row.push_back(angle);
    tendon_changes(posture.bends, kernel::Model::exact, work);
    const Values exact = work.changes;
    tendon_changes(posture.bends, kernel::Model::linear, work);
    row.insert(row.end(), exact.begin(), exact.end());
    row.insert(row.end(), work.changes.begin(), work.changes.end());
    if (robot.motor) add_counts(model == kernel::Model::exact ? exact : work.changes, *robot.motor, row);
    if (stage_motor) add_counts({posture.stage}, *stage_motor, row);
    table.add_row(row);
  }
  return table;
}

std::string ros_trajectory(const SerialRobot& robot, const Trajectory& trajectory) {
  std::string names = "stage";
  for (std::size_t m = 0; m < robot.sections.size(); ++m) {
    const bool is_twin = robot.sections[m].is_twin();
    names += fmt::format(", S{0}_{1}, S{0}_{2}", m, is_twin ? "beta_1" : "theta_x",
                         is_twin ? "beta_2" : "theta_y");
  }
  std::string text = fmt::format(
      "# trajectory_msgs/msg/JointTrajectory; m, rad, s\n"
      "header:\n  stamp: {{sec: 0, nanosec: 0}}\n  frame_id: ''\njoint_names: [{}]\npoints:\n",
      names);
  for (const TrajectoryPoint& point : trajectory.points)
    text += fmt::format(
        "- positions: {}\n  velocities: {}\n  accelerations: {}\n  effort: []\n  time_from_start: {}\n",
        joints_text(point.posture.stage, point.posture.bends),
        joints_text(point.stage_speed, point.bend_speeds),
        joints_text(point.stage_acceleration, point.bend_accelerations), time_text(point.time));
  return text;
}

}  // namespace sinew::inline v1
