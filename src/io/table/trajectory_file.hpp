/// @file trajectory_file.hpp
/// Trajectories of serial robots for what drives them.
#pragma once
#include <optional>
#include <string>

#include "sinew/io/table.hpp"
#include "sinew/kernel/section.h"
#include "sinew/kinematics/trajectory.hpp"

namespace sinew::inline v1 {

/// A row a point: `time[s]`, the columns of a posture, changes of every tendon by both models
/// (`S0_exact_1[m]`, ..., `S0_lsk_1[m]`, ...), and, where the robot or the stage names a motor, its counts
/// from the straight robot and stage 0 (`S0_counts_1`, ..., `stage_counts`).
/// @param model by which motors drive the tendons
Table trajectory_table(const SerialRobot& robot, const Trajectory& trajectory, kernel::Model model,
                       const std::optional<TendonMotor>& stage_motor);

/// A ROS trajectory_msgs/JointTrajectory in YAML: stage, then two joints a section, `S0_beta_1`, `S0_beta_2`
/// of twin pivots, `S0_theta_x`, `S0_theta_y` (θ cos φ, θ sin φ) of neutral backbones; [m], [rad], [s].
std::string ros_trajectory(const SerialRobot& robot, const Trajectory& trajectory);

}  // namespace sinew::inline v1
