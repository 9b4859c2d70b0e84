/// @file sinew.hpp
/// Everything one needs to load a robot and put questions to it.
#pragma once
#include "sinew/analysis/chord_error.hpp"       // IWYU pragma: export
#include "sinew/analysis/serial_shape.hpp"      // IWYU pragma: export
#include "sinew/analysis/shape.hpp"             // IWYU pragma: export
#include "sinew/analysis/singularity_map.hpp"   // IWYU pragma: export
#include "sinew/analysis/tendon_limits.hpp"     // IWYU pragma: export
#include "sinew/analysis/type_2_distance.hpp"   // IWYU pragma: export
#include "sinew/analysis/velocity.hpp"          // IWYU pragma: export
#include "sinew/analysis/velocity_batch.hpp"    // IWYU pragma: export
#include "sinew/io/robot_file.hpp"              // IWYU pragma: export
#include "sinew/io/serial_file.hpp"             // IWYU pragma: export
#include "sinew/kinematics/assembly_modes.hpp"  // IWYU pragma: export
#include "sinew/kinematics/forward.hpp"         // IWYU pragma: export
#include "sinew/kinematics/inverse.hpp"         // IWYU pragma: export
#include "sinew/kinematics/resolved_rate.hpp"   // IWYU pragma: export
#include "sinew/kinematics/serial.hpp"          // IWYU pragma: export
#include "sinew/kinematics/serial_inverse.hpp"  // IWYU pragma: export
#include "sinew/kinematics/three_arcs.hpp"      // IWYU pragma: export
#include "sinew/kinematics/track.hpp"           // IWYU pragma: export
#include "sinew/query/session.hpp"              // IWYU pragma: export
#include "sinew/robot/parallel.hpp"             // IWYU pragma: export
#include "sinew/tendon/diagram.hpp"             // IWYU pragma: export
