/// @file solve.hpp
/// Typed questions about one configuration: each solved with a report, without heap in warm use.
#pragma once
#include "sinew/analysis/identify.hpp"             // IWYU pragma: export
#include "sinew/analysis/shape.hpp"                // IWYU pragma: export
#include "sinew/analysis/singularity.hpp"          // IWYU pragma: export
#include "sinew/analysis/tendon_limits.hpp"        // IWYU pragma: export
#include "sinew/analysis/velocity.hpp"             // IWYU pragma: export
#include "sinew/kinematics/arm.hpp"                // IWYU pragma: export
#include "sinew/kinematics/arm_legs.hpp"           // IWYU pragma: export
#include "sinew/kinematics/equilibrium.hpp"        // IWYU pragma: export
#include "sinew/kinematics/equilibrium_curve.hpp"  // IWYU pragma: export
#include "sinew/kinematics/forward.hpp"            // IWYU pragma: export
#include "sinew/kinematics/inverse.hpp"            // IWYU pragma: export
#include "sinew/kinematics/serial.hpp"             // IWYU pragma: export
#include "sinew/kinematics/trajectory.hpp"         // IWYU pragma: export
#include "sinew/tendon/diagram.hpp"                // IWYU pragma: export
