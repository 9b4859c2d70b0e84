/// @file robot.hpp
/// Robots: read from files and text, asked what they have; one workspace a thread.
#pragma once
#include "sinew/io/robot_file.hpp"   // IWYU pragma: export
#include "sinew/robot/arm_legs.hpp"  // IWYU pragma: export
#include "sinew/robot/robot.hpp"     // IWYU pragma: export
