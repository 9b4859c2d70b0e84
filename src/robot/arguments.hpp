/// @file arguments.hpp
/// Whether what a typed question is given fits its robot. Every public function asks this before it touches a
/// workspace: memory of another robot would be read beyond its end, or tell of that robot.
#pragma once
#include "sinew/base/numbers.hpp"
#include "sinew/robot/workspace.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

bool is_planar(const Robot& robot);

/// `bad_input` where the workspace was made for another robot.
Report check_workspace(const Robot& robot, const Workspace& work);

/// ... or the pose is of the other space. @param name what the message calls it: `pose`, `start`
Report check_arguments(const Robot& robot, const AnyPose& pose, const Workspace& work,
                       std::string_view name = "pose");

/// ... or there are more or fewer link coordinates than the robot has.
Report check_arguments(const Robot& robot, const AnyPose& pose, Numbers coordinates, const Workspace& work);

}  // namespace sinew::inline v1
