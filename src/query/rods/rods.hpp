/// @file rods.hpp
/// What handlers of questions to robots on rods share.
#pragma once
#include "io/document/reader.hpp"
#include "query/handlers.hpp"
#include "query/loads.hpp"
#include "sinew/kinematics/equilibrium.hpp"

namespace sinew::inline v1 {

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

/// Robots on rods are spatial.
std::optional<SpatialPose> read_spatial_start(Context& context);
/// Whether the rods still are in the equilibrium that a question named by `"start": "last"`: it then goes on
/// from there, and the pose they would have to be laid to is not asked.
bool holds_last(const Context& context);
/// As Question's, of an equilibrium that the workspace holds.
void remember_held(Context& context, const std::optional<SpatialPose>& found);

/// @name In files of their own
/// @{
void answer_rods_statics(Context& context);
void answer_rods_track(Context& context);
/// @}

/// `track` along poses, or along coordinates that three inputs hold: `poses`, or `from` and `to`.
void answer_rods_path(Context& context);

/// A twist that is wanted, or rates of the inputs.
struct RodMotion {
  std::vector<double> twist, rates;
};
/// What a question wants of an equilibrium, with the fields of its words.
struct RodWants {
  Wants words;
  RodMotion motion;  ///< of `velocity`
  int samples = 0;   ///< of `shape`
};
RodWants read_rod_wants(Context& context);
/// Of the equilibrium that the workspace holds, under this gravity.
void put_rod_wants(Context& context, const Equilibrium& found, const RodWants& wanted,
                   const std::optional<Vec3<double>>& gravity);

/// Of position and rotation; one that is infinite, where the platform is not held, is left out.
Value indices_value(const RodAnalysis& analysis);

/// `{z, e1, e2}` of robots with three inputs.
IndependentPose read_independent(const Context& context, Reader& asked);
/// What rods are asked by but where they are: wrench, gravity, most iterations.
EquilibriumOptions read_equilibrium_options(Context& context);

/// Where a search for lengths begins, by `start`: lengths, a pose, three coordinates, or `last`.
struct RodStart {
  std::vector<double> inputs;
  std::optional<SpatialPose> pose;
  std::optional<IndependentPose> independent;
};
RodStart read_start_of_inverse(Context& context);
/// Puts the rods there; whether they then are somewhere to go on from. Else the report says why not.
bool begin_at(Context& context, const RodStart& start, const EquilibriumOptions& options, Report& report);

}  // namespace sinew::inline v1
