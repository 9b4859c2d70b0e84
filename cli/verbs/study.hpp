/// @file study.hpp
/// What a study asks and gives, as people read it.
#pragma once
#include <string>
#include <utility>

#include "sinew/study/sweep.hpp"

namespace sinew::cli {

/// `name[unit]`, as in the study's CSV file.
std::string heading(const std::pair<std::string, std::string>& column);
/// Title, robot, samples, axes, columns, sampler: a line each.
std::string show_study(const Study& study, const SweepColumns& columns);

}  // namespace sinew::cli
