/// @file study.hpp
/// What a study asks and gives, as people read it.
#pragma once
#include <string>

#include "sinew/study/sweep.hpp"

namespace sinew::cli {

/// Title, robot, samples, axes, columns, sampler: a line each.
std::string show_study(const Study& study, const SweepColumns& columns);

}  // namespace sinew::cli
