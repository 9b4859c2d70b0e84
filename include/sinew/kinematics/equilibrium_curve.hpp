/// @file equilibrium_curve.hpp
/// Curves of equilibria along inputs and loads, followed by arc length: where they turn back, where others
/// branch off, and every equilibrium on them that has the inputs and the load asked for.
/// Theory: docs/theory/rod_robot.md
#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "sinew/kinematics/equilibrium.hpp"

namespace sinew::inline v1 {

/// Where a curve leads, and how far it is followed. Inputs, wrench, or pose change linearly in a parameter
/// that is 0 at its beginning and 1 here.
struct CurveOptions {
  std::vector<double> inputs = {};                     ///< rod lengths [m], at 1; none: as at the beginning
  SpatialWrench added_wrench = SpatialWrench::Zero();  ///< [N, N m] at 1, to that of the beginning
  /// At 1, instead of inputs: the platform is moved there, on a straight line and about one axis, and the
  /// inputs follow. For robots of six inputs.
  std::optional<SpatialPose> pose = {};
  double lowest = 0;         ///< the curve ends where its parameter, a ratio, falls below this, ≤ 0 ...
  double highest = 1;        ///< ... or rises above this ratio, ≥ 0
  int max_points = 500;      ///< on each curve
  bool is_backward = false;  ///< begins with a falling parameter
  /// The curves that leave a bifurcation are followed too; those that leave these are not.
  bool follows_branches = false;
  /// No other curve is begun where all have as many points; those left out are told by `not_followed`.
  int max_total_points = 200000;
};

/// What is special about a point of a curve.
enum class CurveEvent {
  none,
  begin,        ///< the parameter is that of the beginning, 0: an equilibrium with the same inputs and load
  target,       ///< ... or of the target, 1
  fold,         ///< the parameter turns back: two equilibria meet and vanish
  bifurcation,  ///< another curve crosses
  rod_bifurcation,  ///< a rod buckles by itself, which the platform does not feel at first
  stability,        ///< the equilibrium gains or loses stability at fixed inputs, with neither
};
/// Its name: `fold`.
SINEW_API std::string_view to_string(CurveEvent event) noexcept;

/// An equilibrium on a curve.
struct CurvePoint {
  double parameter = 0;  ///< ratio of the change that is asked for: 0 at the beginning, 1 at the target
  CurveEvent event = CurveEvent::none;
  SpatialPose pose;
  std::vector<double> inputs;   ///< [m]
  int unstable_directions = 0;  ///< at fixed inputs and load; at a fold or bifurcation those before it
  double residual = 0;          ///< as that of `equilibrium`, no unit
  double potential = 0;         ///< of rods and load [J]
};

/// Why a curve ended.
enum class CurveEnd {
  left_range,  ///< of the parameter
  closed,      ///< it came back to where it began
  max_points,
  straight,      ///< a rod is pulled straight
  sharp,         ///< the rods bend more sharply than is resolved
  far,           ///< a rod has grown to ten times what any was
  stalled,       ///< none of these, and no step however short succeeds
  stopped,       ///< on request
  not_followed,  ///< all curves have `max_total_points`: its one point is where this one, or more, would
                 ///< leave
};
/// Its name: `left_range`.
SINEW_API std::string_view to_string(CurveEnd end) noexcept;

/// Points in the order of the curve.
struct EquilibriumCurve {
  std::vector<CurvePoint> points;
  CurveEnd end = CurveEnd::stalled;
  int from_curve = -1, from_point = -1;  ///< the bifurcation it leaves; −1 of the first curve
};

/// Curves through the equilibrium the workspace holds; the first is the one it was asked for. Empty where it
/// holds none, or where what is asked for is not finite, does not fit the robot, or is what it begins with.
/// On chains a curve leads to a wrench or to inputs that hold the same tendons as its beginning (no leg bends
/// to the other side, and no motor turns a base), not to a pose; residuals are in m. Afterwards the workspace
/// holds none. Allocates.
SINEW_API std::vector<EquilibriumCurve> equilibrium_curves(const Robot& robot, const CurveOptions& how,
                                                           Workspace& work);

}  // namespace sinew::inline v1
