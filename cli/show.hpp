/// @file show.hpp
/// Answers as people read them: tables and a closing line of evidence.
#pragma once
#include <functional>
#include <string>

#include "io/robots/arm_file.hpp"
#include "io/robots/serial_file.hpp"
#include "request.hpp"

namespace sinew::cli {

/// @name Poses
/// Planar `x y phi`; in space `x y z` and the rotation vector `rx ry rz`.
/// @{
std::vector<Input> pose_columns(bool is_spatial);   ///< names and SI units
std::vector<double> pose_values(const Node& pose);  ///< in their order
std::string show_pose(const Node& pose);
/// @}

std::string show_legs(const Node& legs);
/// A matrix with headings; `factor` of row i and column j takes SI to what the headings say.
std::string show_matrix(const Node& matrix, std::vector<std::string> header,
                        const std::vector<std::string>& rows,
                        const std::function<double(std::size_t, std::size_t)>& factor);
/// One row an input; `per` ends its unit: `/s`.
std::string show_inputs(std::string_view title, const std::vector<double>& values, const OpenRobot& robot,
                        std::string_view per = {});
/// One row a working mode: its bending as `--bending` takes it, and its inputs.
std::string show_working_modes(const Node& solutions, const OpenRobot& robot);
/// One row an assembly mode, and whether these are all.
std::string show_assembly_modes(const Answer& answer);
/// One row a pose of a path: pose, inputs, condition number.
std::string show_path(const Node& rows, const OpenRobot& robot);

/// @name Robots on rods
/// @{
bool is_on_rods(const Answer& answer);
/// What an answer has beside pose and legs: energies and what was wanted.
std::string show_equilibrium(const Answer& answer, const OpenRobot& robot);
/// One row an equilibrium: of the same inputs and load, or of the same pose and load.
std::string show_equilibria(const Answer& answer, const OpenRobot& robot);
std::string show_rod_velocity(const Answer& answer, const OpenRobot& robot);
/// Pose, and the wrench that the rods' forces tell.
std::string show_sensed(const Answer& answer);
std::string show_wrench(const Answer& answer);  ///< that was sensed
std::string show_margins(const Node& margins);
/// @}

/// How often the wrench of --until was added, and why no more.
std::string show_load(const Answer& answer);

/// @name Robots on pseudo-rigid chains
/// @{
bool is_on_chains(const Answer& answer);
/// Pose, tendons, joints, energies, simpler models.
std::string show_chains(const Answer& answer, const OpenRobot& robot);
std::string show_chain_velocity(const Answer& answer, const OpenRobot& robot);
/// Joints of a row of a path: `legs[0].theta_2`.
std::vector<Input> angle_columns(const Node& angles, const OpenRobot& robot);
std::vector<double> angle_values(const Node& angles);
/// @}

/// @name Serial robots
/// @{
bool is_serial(const OpenRobot& robot);
/// What it is made of.
std::string show_serial_robot(const OpenRobot& robot);
/// Sections and their ends; of velocity J, K and indices.
std::string show_serial(const Answer& answer, const OpenRobot& robot);
/// Class, slack, polygons of one section's diagram.
std::string show_diagram(const Answer& answer, const OpenRobot& robot, std::size_t section);
/// @}

/// @name Arms
/// @{
bool is_arm(const OpenRobot& robot);
bool stands_on_arms(const OpenRobot& robot);  ///< of a platform whose legs are arms
std::string show_arm_legs(const Answer& answer, const OpenRobot& robot);
std::string show_arm_legs_robot(const OpenRobot& robot);
/// What it is made of.
std::string show_arm_robot(const OpenRobot& robot);
/// Of a question to an arm.
std::string show_arm(const Answer& answer, const OpenRobot& robot);
/// @}

/// J, K, U, indices, singularities.
std::string show_velocity(const Answer& answer, const OpenRobot& robot);
/// U, or what has its form.
std::string show_sensitivity(std::string_view title, const Node& matrix, const OpenRobot& robot);
std::string show_indices(const Answer& answer, const OpenRobot& robot);
std::string show_singularities(const Answer& answer);
/// `converged in 4 iterations, residual 5.0e-14 m`; of rods `converged in 4 iterations, residual 5.0e-14,
/// stable`.
std::string show_report(const Answer& answer);

}  // namespace sinew::cli
