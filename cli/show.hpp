/// @file show.hpp
/// Answers as people read them: tables and a closing line of evidence.
#pragma once
#include <string>

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
/// One row an input; `per` ends its unit: `/s`.
std::string show_inputs(std::string_view title, const std::vector<double>& values, const Robot& robot,
                        std::string_view per = {});
/// One row a working mode: its bending as `--bending` takes it, and its inputs.
std::string show_working_modes(const Node& solutions, const Robot& robot);
/// One row an assembly mode, and whether these are all.
std::string show_assembly_modes(const Answer& answer);
/// One row a pose of a path: pose, inputs, condition number.
std::string show_path(const Node& rows, const Robot& robot);
/// J, K, U, indices, singularities.
std::string show_velocity(const Answer& answer, const Robot& robot);
std::string show_indices(const Answer& answer, const Robot& robot);
std::string show_singularities(const Answer& answer);
/// `converged in 4 iterations, residual 5.0e-14 m`.
std::string show_report(const Answer& answer);

}  // namespace sinew::cli
