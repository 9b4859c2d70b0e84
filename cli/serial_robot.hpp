/// @file serial_robot.hpp
/// The serial robot of a command line, for verbs that ask typed functions.
#pragma once
#include "sinew/base/error.hpp"
#include "sinew/robot/serial.hpp"
#include "verbs.hpp"

namespace sinew::cli {

/// The serial robot that the command line names, as `--set` changes it; an error where it is none.
Expected<SerialRobot> open_serial(const Arguments& arguments);

/// By which model of `--model` motors drive the tendons: lsk, the default, or pcc.
Expected<kernel::Model> tendon_model(const Arguments& arguments);

}  // namespace sinew::cli
