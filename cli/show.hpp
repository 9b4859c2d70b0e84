/// @file show.hpp
/// Answers as people read them: tables and a closing line of evidence.
#pragma once
#include <string>

#include "request.hpp"

namespace sinew::cli {

/// Names and SI units of a robot's inputs, from its description.
struct InputNames {
  std::vector<std::string> names, units;
};
InputNames input_names(const Answer& description);

std::string show_pose(const Node& pose);
std::string show_legs(const Node& legs);
std::string show_inputs(std::string_view title, const std::vector<double>& values, const InputNames& names,
                        std::string_view per = {});
/// One row a working mode: its bending as `--bending` takes it, and its inputs.
std::string show_modes(const Node& solutions, const InputNames& names);
/// J, K, U, indices, singularities.
std::string show_velocity(const Answer& answer, const InputNames& names);
std::string show_indices(const Answer& answer, const InputNames& names);
std::string show_singularities(const Answer& answer);
/// `converged in 4 iterations, residual 5.0e-14 m`.
std::string show_report(const Answer& answer);

}  // namespace sinew::cli
