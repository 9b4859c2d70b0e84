/// @file assembly.hpp
/// What assembly makes of the legs: `J·δx = K·δa + s` (x platform, a inputs). Forward, inverse and
/// differential kinematics, singularities and sensitivities all read it. Theory: docs/theory/leg.md;
/// of rods docs/theory/rod_robot.md
#pragma once
#include <string_view>

#include "sinew/base/numbers.hpp"
#include "sinew/math/vec.hpp"
#include "sinew/robot/robot.hpp"
#include "sinew/solve/report.hpp"
#include "sinew/units.hpp"

namespace sinew::inline v1 {

/// Rows in the papers' raw form (multiplied by the closure's distance). Views into the workspace. On rods
/// the rows are the platform's balance: J its stiffness, K what feeding the rods does to the wrench, s the
/// wrench that is missing [N, N m].
struct Reduced {
  MatrixView J;               ///< rows × dof: stack of g_x, each row a Plücker line
  MatrixView K;               ///< rows × inputs: −∂g/∂a, block diagonal where no legs are tied
  std::span<const double> s;  ///< rows: −g [m²], of pins and planes [m]
  /// Largest distance by which a leg fails to close [m], infinite where not finite; of rods the error of
  /// their own equations, no unit, NaN where not finite.
  double closure_error = 0;
  int worst_leg = 0;  ///< the leg that does; 0 of rods
};

/// J, K and s at a platform pose and link coordinates (of an arc its curvature κ [1/m], of a swivelled one θ
/// [rad] and κ, of a rail its slide ρ [m]), leg by leg, the rows of planes last. Where the arguments do not
/// fit the robot, and by the model prb, J and K are null.
SINEW_API Reduced assemble(const Robot& robot, const AnyPose& pose, Numbers coordinates, Workspace& work);

/// J with its rows scaled to unit lines and their moments divided by the platform radius, and K scaled alike,
/// in `work.unit_J` and `work.unit_K`: numbers of one size, whatever the robot's. A row without direction
/// becomes 0. View of `work.unit_J`.
SINEW_API MatrixView homogenise(const Robot& robot, const Reduced& reduced, Workspace& work);

/// Link coordinates that the inputs ([m], [rad], in leg order) command, into `work.coordinates`. The report
/// says which input is missing, not finite or outside the link's domain.
SINEW_API Report coordinates_from_inputs(const Robot& robot, Numbers inputs, Workspace& work);

/// What people want to know of each leg that closes, in SI, at a pose and link coordinates as `assemble`
/// takes them; those of rods are left as they were. View of `work.legs`; empty where the arguments do not fit
/// the robot, and by the model prb.
SINEW_API std::span<const LegState> leg_states(const Robot& robot, const AnyPose& pose, Numbers coordinates,
                                               Workspace& work);

SINEW_API AnyPose home(const Robot& robot);            ///< where solvers start when told nothing else
SINEW_API double platform_radius(const Robot& robot);  ///< homogenises moments in the indices [m]
SINEW_API int leg_count(const Robot& robot);           ///< in file order; 0 of a serial robot
SINEW_API int input_count(const Robot& robot);         ///< motors: what `forward` takes
SINEW_API bool has_ties(const Robot& robot);           ///< legs share inputs
/// Numbers that describe all links: what `assemble` takes.
SINEW_API int coordinate_count(const Robot& robot);
SINEW_API int row_count(const Robot& robot);  ///< of J and K
SINEW_API int dof(const Robot& robot);        ///< freedoms of a free platform: 3 in the plane, 6 in space
/// A leg can move while the platform stands still.
SINEW_API bool has_redundant_leg(const Robot& robot);
SINEW_API bool has_elbow(const Robot& robot);   ///< a leg's strut may lead to either side
SINEW_API bool has_arc(const Robot& robot);     ///< a leg has a curvature
SINEW_API int plane_count(const Robot& robot);  ///< rows of planes, the last of all

/// An input of the robot, as messages and tables name it: `legs[0].tendon_1`.
struct InputOfLeg {
  int leg;                ///< in file order
  std::string_view name;  ///< of what the motor commands: `tendon_1`
  Dimension dimension;    ///< of that, in SI
};
/// The inputs in their order; where legs share one, that of the first.
SINEW_API std::vector<InputOfLeg> inputs_of(const Robot& robot);

}  // namespace sinew::inline v1
