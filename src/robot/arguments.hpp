/// @file arguments.hpp
/// Whether what a typed question is given fits its robot. Every public function asks this before it touches a
/// workspace: memory of another robot would be read beyond its end, or tell of that robot. What is wrong is
/// worked out only where something is.
#pragma once
#include "sinew/base/numbers.hpp"
#include "sinew/robot/robot.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

inline bool is_planar(const Robot& robot) { return robot.planar() != nullptr; }

/// Whether questions about platforms may be put to this robot in this workspace.
inline bool fits(const Robot& robot, const Workspace& work) {
  return work.robot.get() == robot.identity() && !robot.serial() && !robot.arm() && !robot.arm_legs() &&
         robot.is_within_limits();
}
inline bool fits(const Robot& robot, const AnyPose& pose) {
  return std::holds_alternative<PlanarPose>(pose) == is_planar(robot);
}

/// @name Why not
/// @{
Report explain_misfit(const Robot& robot, const Workspace& work);
Report explain_misfit(const Robot& robot, const AnyPose& pose, const Workspace& work, std::string_view name);
Report explain_misfit(const Robot& robot, const AnyPose& pose, Numbers coordinates, const Workspace& work);
/// @}

/// `bad_input` where the workspace was made for another robot, or the robot is beyond the limits;
/// `unsupported` of serial robots and arms.
inline Report check_workspace(const Robot& robot, const Workspace& work) {
  return fits(robot, work) ? Report{} : explain_misfit(robot, work);
}

/// ... or the pose is of the other space. @param name what the message calls it: `pose`, `start`
inline Report check_arguments(const Robot& robot, const AnyPose& pose, const Workspace& work,
                              std::string_view name = "pose") {
  return fits(robot, work) && fits(robot, pose) ? Report{} : explain_misfit(robot, pose, work, name);
}

/// ... or there are more or fewer link coordinates than the robot has.
inline Report check_arguments(const Robot& robot, const AnyPose& pose, Numbers coordinates,
                              const Workspace& work) {
  const bool fit = fits(robot, work) && fits(robot, pose) && coordinates.size() == work.coordinates.size();
  return fit ? Report{} : explain_misfit(robot, pose, coordinates, work);
}

}  // namespace sinew::inline v1
