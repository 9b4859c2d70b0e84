/// @file question_check.hpp
/// What of a question does not fit the robot, in words, and its refusal.
#pragma once
#include <span>
#include <string>
#include <string_view>

#include "sinew/kinematics/arm_legs.hpp"

namespace sinew::inline v1 {

/// What does not fit the robot, in words; empty if all does. The status is `bad_input`, but `unsupported` of
/// a balance that is not by energy.
Report legs_misfit(const ArmLegs& robot, std::span<const TendonCommand> commands, const ArmLegsLoad& load,
                   const ArmOptions& options, const ArmLegsWorkspace& work);
/// The workspace's state is that the question does not fit: there is none to go on from.
const ArmLegsState& refuse_question(const Report& misfit, ArmLegsWorkspace& work);

/// Whether the robot is one in the plane and the pose is not.
bool leaves_plane(const ArmLegs& robot, const SE3<double>& pose);
/// What is wrong with a pose of the platform, or empty. @param name what the pose is called
std::string pose_misfit(const ArmLegs& robot, const SE3<double>& pose, std::string_view name);

}  // namespace sinew::inline v1
