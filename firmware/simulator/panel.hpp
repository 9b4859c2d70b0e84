/// @file panel.hpp
/// A simulated controller as an operator's panel finds a real one: on a serial port, in real time, with an
/// arm on its drives.
#pragma once

#include <optional>
#include <string>

#include "io/robots/arm_file.hpp"
#include "simulator/controller.hpp"
#include "simulator/drives.hpp"
#include "simulator/simulated_arm.hpp"

namespace sinew::firmware {

/// Throws std::runtime_error with what is wrong with the file.
/// @param motor its own in the place of the file's, as under `motor:`; may be empty
SerialRobot read_arm(const std::string& robot, const std::string& motor);

/// Until stdin ends or says `quit`, or a signal ends it. True unless the controller crashed.
/// @param robot whose arm is on the drives, with its motor; without one they follow at once
bool serve_terminal(Controller& controller, Drives& drives, const std::optional<SerialRobot>& robot,
                    unsigned seed, const std::string& link);

}  // namespace sinew::firmware
