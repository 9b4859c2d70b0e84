#include "robot/arguments.hpp"

#include "sinew/base/limits.hpp"
#include "sinew/robot/assembly.hpp"

namespace sinew::inline v1 {
namespace {

Report bad_input() {
  Report report;
  report.status = Status::bad_input;
  return report;
}

Report wrong_space(bool is_planar, std::string_view name) {
  Report report = bad_input();
  report.message.append("the ");
  report.message.append(name);
  report.message.append(is_planar ? " is spatial and the robot is planar: give a PlanarPose"
                                  : " is planar and the robot is spatial: give a SpatialPose");
  return report;
}

Report wrong_coordinates(std::size_t found, int needed) {
  Report report = bad_input();
  report.message.append("the robot has ");
  append_number(report.message, needed);
  report.message.append(" link coordinates, ");
  append_number(report.message, static_cast<int>(found));
  report.message.append(" were given");
  return report;
}

}  // namespace

bool is_planar(const Robot& robot) { return robot.planar() != nullptr; }

Report check_workspace(const Robot& robot, const Workspace& work) {
  const bool fits = robot.is_within_limits() && work.robot && work.robot.get() == robot.identity();
  if (fits && !robot.serial()) return {};
  Report report = bad_input();
  if (fits) {
    report.status = Status::unsupported;
    report.message.append(
        "a serial robot has no legs and no platform: its questions are put to robot.serial(), see "
        "kinematics/serial.hpp");
    return report;
  }
  if (!robot.is_within_limits()) {
    report.message.append("the robot has more constraints or actuators than this build carries, ");
    append_number(report.message, max_rows);
    report.message.append(" of either");
    return report;
  }
  report.message.append("the workspace was made for another robot: make one of this robot, Workspace(robot)");
  return report;
}

Report check_arguments(const Robot& robot, const AnyPose& pose, const Workspace& work,
                       std::string_view name) {
  if (Report report = check_workspace(robot, work); !report.ok()) return report;
  if (std::holds_alternative<PlanarPose>(pose) == is_planar(robot)) return {};
  return wrong_space(is_planar(robot), name);
}

Report check_arguments(const Robot& robot, const AnyPose& pose, Numbers coordinates, const Workspace& work) {
  if (Report report = check_arguments(robot, pose, work); !report.ok()) return report;
  const int needed = coordinate_count(robot);
  if (coordinates.size() == static_cast<std::size_t>(needed)) return {};
  return wrong_coordinates(coordinates.size(), needed);
}

}  // namespace sinew::inline v1
