/// @file tip_rows.hpp
/// Motions of a serial robot's tip as rows of a bounded least squares problem in the bends of its sections,
/// and in their extensions. Theory: docs/theory/serial_inverse.md
///
/// Unknowns are what sections turn by in all [rad], two a section: about either axis of twin pivots; towards
/// its bend and across it of a neutral backbone, so that the limit of a section bounds one unknown. Where the
/// length of any section varies, the extensions of all follow, as shares of the robot's length.
#pragma once
#include "kinematics/serial/bounded_step.hpp"
#include "sinew/kinematics/serial.hpp"

namespace sinew::inline v1 {

/// Joints that turn about one axis when a component of a bend does.
inline double turns(const Section& section) { return section.is_twin() ? 0.5 * section.segments : 1; }

/// Unit vector of a bend, (1, 0) of none.
inline Bend bend_direction(const Bend& bend) {
  const double size = std::sqrt(squared_norm(bend));
  return size > 0 ? Bend(bend / size) : Bend(1, 0);
}

/// How far the unknowns of a section may go until its limit; 0 lies between.
struct Room {
  double low[2], high[2];
};
Room room(const Section& section, const Bend& bend);

/// What a bend changes by with the unknowns of its section.
Bend bend_change(const Section& section, const Bend& bend, double first, double second);

/// Unknowns of a robot.
int unknowns(const SerialRobot& robot);

/// A and r for the motion (shift [m], turn [rad]) in base axes, after `tip_motion` of the same bends and, of
/// sections of variable length, `extension_jacobians`. Rows 1 to 3: the shift, as a share of `length`. Then
/// nothing, of 3 rows; of 5 the turn about the tip's x and y; of 6 the turn.
void tip_rows(const SerialRobot& robot, std::span<const Bend> bends, const SerialWorkspace& work,
              double length, const Vec3<double>& shift, const Vec3<double>& turn, BoundedStep& system);

}  // namespace sinew::inline v1
