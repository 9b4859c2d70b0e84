/// @file rods.hpp
/// Handlers of the queries put to robots whose legs bear load.
#pragma once
#include "query/loads.hpp"
#include "sinew/kinematics/equilibrium.hpp"

namespace sinew::inline v0 {

/// Gravity of the question; refused where nothing has a mass.
std::optional<Vec3<double>> read_gravity_of(Context& context);

/// Where a robot of rods is asked to be: at inputs, or at a pose or coordinates that lengths are found for.
struct RodQuery {
  std::vector<double> inputs;
  std::optional<SpatialPose> pose;
  std::optional<IndependentPose> independent;
  EquilibriumOptions options;
};
RodQuery read_configuration_of_rods(Context& context);
Equilibrium solve(Context& context, const RodQuery& asked);

void answer_rods_forward(Context& context);
void answer_rods_inverse(Context& context);
void answer_rods_velocity(Context& context);
void answer_rods_shape(Context& context);
void answer_rods_statics(Context& context);
void answer_rods_track(Context& context);

}  // namespace sinew::inline v0
