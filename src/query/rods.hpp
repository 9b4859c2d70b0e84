/// @file rods.hpp
/// Handlers of the queries put to robots whose legs bear load.
#pragma once
#include "query/context.hpp"

namespace sinew::inline v0 {

/// Gravity of the question; refused where nothing has a mass.
std::optional<Vec3<double>> read_gravity_of(Context& context);

void answer_rods_forward(Context& context);
void answer_rods_inverse(Context& context);
void answer_rods_velocity(Context& context);
void answer_rods_shape(Context& context);
void answer_rods_statics(Context& context);

}  // namespace sinew::inline v0
