/// @file diagram_figure.hpp
/// What the tendons of one section leave it free to do, drawn over its two bends.
#pragma once
#include "io/figure/figure.hpp"
#include "request.hpp"

namespace sinew::cli {

/// Of `--section`, default the first.
std::size_t section_of(const Arguments& arguments);

/// The answer to `diagram`, one with a class.
Figure diagram_figure(const Answer& answer, const OpenRobot& robot, std::size_t section);

}  // namespace sinew::cli
