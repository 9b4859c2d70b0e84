/// @file arm_path.hpp
/// Paths of arms, and of platforms on legs of sections, as tables: what holds the tendons, and what became of
/// it.
#pragma once
#include <optional>
#include <string>

#include "request.hpp"
#include "sinew/io/table.hpp"

namespace sinew::cli {

/// `points` of a question, out of a .csv file with a column NAME.tension[N] or NAME.change[m] for tendons
/// (`sections[0].tendons[0].tension[N]`), and fx[N] to mz[N m] for the wrench at the tip. What cannot be
/// read is noted, and nothing then.
std::optional<Node> read_arm_path(const std::string& file, const OpenRobot& robot, Errors& errors);
/// The rows of an answer in SI.
Table arm_path_table(const Answer& answer, const OpenRobot& robot);
/// The same for people: tip and tensions.
std::string show_arm_path(const Answer& answer, const OpenRobot& robot);

}  // namespace sinew::cli
