/// @file handlers.hpp
/// Handlers of queries: a function for each kind of question and of mechanics. The table is in session.cpp.
#pragma once
#include "query/context.hpp"

namespace sinew::inline v1 {

/// @name Legs that bear no load: arcs and rails
/// @{
void answer_kinematic_forward(Context& context);
void answer_kinematic_inverse(Context& context);
void answer_kinematic_velocity(Context& context);
void answer_kinematic_shape(Context& context);
void answer_kinematic_track(Context& context);
/// @}

/// @name Pseudo-rigid chains
/// @{
void answer_chains_forward(Context& context);
void answer_chains_inverse(Context& context);
void answer_chains_velocity(Context& context);
void answer_chains_shape(Context& context);
void answer_chains_statics(Context& context);
void answer_chains_track(Context& context);
/// @}

/// @name Elastic rods
/// @{
void answer_rods_forward(Context& context);
void answer_rods_inverse(Context& context);
void answer_rods_velocity(Context& context);
void answer_rods_shape(Context& context);
void answer_rods_statics(Context& context);
void answer_rods_track(Context& context);
/// @}

/// @name Serial robots
/// @{
void answer_serial_forward(Context& context);
void answer_serial_inverse(Context& context);
void answer_serial_velocity(Context& context);
void answer_serial_shape(Context& context);
void answer_serial_describe(Context& context);
void answer_serial_diagram(Context& context);
/// @}

/// @name Arms
/// @{
void answer_arm_describe(Context& context);
/// @}

/// @name Arms that bear loads
/// @{
void answer_arms_forward(Context& context);
void answer_arms_inverse(Context& context);
void answer_arms_velocity(Context& context);
void answer_arms_shape(Context& context);
void answer_arms_statics(Context& context);
void answer_arms_track(Context& context);
void answer_arms_identify(Context& context);
/// @}

/// @name Platforms on arms
/// @{
void answer_arm_legs_forward(Context& context);
void answer_arm_legs_velocity(Context& context);
void answer_arm_legs_shape(Context& context);
void answer_arm_legs_inverse(Context& context);
void answer_arm_legs_statics(Context& context);
void answer_arm_legs_track(Context& context);
void answer_arm_legs_describe(Context& context);
/// @}

void answer_describe(Context& context);  ///< of robots with a platform

}  // namespace sinew::inline v1
