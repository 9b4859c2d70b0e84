/// @file batch.hpp
/// Many configurations at once, in vector lanes where the robot has them; any question at many rows.
#pragma once
#include "sinew/analysis/velocity_batch.hpp"  // IWYU pragma: export
#include "sinew/kinematics/equilibrium.hpp"   // IWYU pragma: export
#include "sinew/kinematics/serial.hpp"        // IWYU pragma: export
#include "sinew/query/batch.hpp"              // IWYU pragma: export
