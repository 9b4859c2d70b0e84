/// @file batch.hpp
/// Many configurations at once, in vector lanes where the robot has them.
#pragma once
#include "sinew/analysis/velocity_batch.hpp"  // IWYU pragma: export
#include "sinew/kinematics/equilibrium.hpp"   // IWYU pragma: export
#include "sinew/kinematics/serial.hpp"        // IWYU pragma: export
