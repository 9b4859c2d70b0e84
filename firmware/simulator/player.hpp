/// @file player.hpp
/// Plays a trajectory to the firmware in binary frames, as a host does, and holds every reply to what this
/// machine makes of the same table.
#pragma once

#include <filesystem>

#include "simulator/controller.hpp"

namespace sinew::firmware {

/// Prints what came of it; whether every reply and the drives at the end are right to the count. Throws
/// std::runtime_error where the file cannot be read, or where the firmware is another robot's or does not
/// answer.
/// @param rate rows a second, whatever their times; 0 for at their times
bool play(Controller& controller, const std::filesystem::path& trajectory, double rate);

}  // namespace sinew::firmware
