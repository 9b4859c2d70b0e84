/// @file rod_rates.hpp
/// Velocities of a platform on rods, and rates of the inputs that cause them, at an equilibrium and under a
/// load that stays. Theory: docs/theory/rod_robot.md
#pragma once
#include "sinew/kinematics/equilibrium.hpp"

namespace sinew::inline v1 {

/// Rates of the inputs [m/s] that move the platform so, into `rates`: those for which K·(rates) = J·(twist),
/// of fewer rows where legs close beside the rods. `singular` where none do, within 1e-9.
/// @param twist six numbers [m/s, rad/s], base axes; or three, of a robot with three inputs: ż, ωx, ωy, the
/// others follow. No heap.
SINEW_API Report rod_rates(const RodAnalysis& analysis, Numbers twist, std::span<double> rates);

/// What the platform does at these rates of the inputs [m/s]: U·(rates) [m/s, rad/s], base axes. `singular`
/// where the platform can move with all inputs held. No heap.
SINEW_API Report rod_twist(const RodAnalysis& analysis, Numbers rates, std::span<double, 6> twist);

}  // namespace sinew::inline v1
