#include "robot/arguments.hpp"

#include "base/limits.hpp"
#include "sinew/robot/assembly.hpp"
#include "solve/message.hpp"

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

Report explain_misfit(const Robot& robot, const Workspace& work) {
  Report report = bad_input();
  if (!robot.is_within_limits()) {
    report.message.append("the robot has more constraints or actuators than this build carries, ");
    append_number(report.message, max_rows);
    report.message.append(" of either");
  } else if (work.robot.get() != robot.identity()) {
    report.message.append(
        "the workspace was made for another robot: make one of this robot, Workspace(robot)");
  } else {
    report.status = Status::unsupported;
    report.message.append(
        robot.arm_legs()
            ? "legs of several sections have questions of their own, put to robot.arm_legs(): see "
              "kinematics/arm_legs.hpp"
        : robot.arm()
            ? "an arm has no legs and no platform: its questions are put to robot.arm()"
            : "a serial robot has no legs and no platform: its questions are put to robot.serial(), see "
              "kinematics/serial.hpp");
  }
  return report;
}

Report explain_misfit(const Robot& robot, const AnyPose&, const Workspace& work, std::string_view name) {
  return fits(robot, work) ? wrong_space(is_planar(robot), name) : explain_misfit(robot, work);
}

Report explain_misfit(const Robot& robot, const AnyPose& pose, Numbers coordinates, const Workspace& work) {
  if (!fits(robot, work) || !fits(robot, pose)) return explain_misfit(robot, pose, work, "pose");
  return wrong_coordinates(coordinates.size(), coordinate_count(robot));
}

}  // namespace sinew::inline v1
