/// @file tendon_limits.hpp
/// What tendons and joints of a serial robot can do and have to: travel, sensitivity, limits of the bend,
/// stretch and what a tendon's length is uncertain by. Theory: docs/theory/model_error.md
#pragma once
#include <optional>
#include <vector>

#include "sinew/robot/serial.hpp"

namespace sinew::inline v1 {

/// Bend of the whole section for each length that a tendon in the bending plane is drawn in, 1/r [rad/m]. Of
/// two axes both bend: of N/2 twin pivots by N/2·β.
/// @implements LSK (23), which prints 23.38 deg/mm for 23.386
SINEW_API double bend_per_length(const Section& section);

/// Between which changes a tendon moves while all sections it passes go everywhere within their limits.
struct TendonTravel {
  double least = 0;                             ///< smallest Δl [m], ≤ 0: drawn in most
  double most = 0;                              ///< largest Δl [m], ≥ 0: paid out most
  double span() const { return most - least; }  ///< what its drive needs [m]
};

/// Of every tendon, section by section. Sections bend independently, so that extremes add up; those of one
/// joint are in closed form but for the root of a monotone function. A twin pivot's tendon at angle d needs
/// |cos d| + |sin d| times the travel of one axis. Joints bend half a turn at most.
SINEW_API std::vector<TendonTravel> tendon_travel(const SerialRobot& robot, kernel::Model model);

/// Travel of a tendon that lies in the one plane in which all sections bend, LSK, of each section [m].
/// @implements LSK (24), which takes this for the largest there is
SINEW_API std::vector<double> one_axis_travel(const SerialRobot& robot);

// ---------------------------------------------------------------- limits of a joint

/// Bend of one joint at which its discs touch at the rim, L/r_disc [rad]; infinite without a disc. A section
/// with a neutral backbone bends N times as much.
SINEW_API double contact_bend(const Section& section);

/// Largest strain of a round backbone, d/2 times the curvature; of twin pivots of the joint that bends more.
/// @param diameter d of the backbone, or of each of the two of a twin pivot [m]
SINEW_API double backbone_strain(const Section& section, const Bend& bend, double diameter);

/// Bend of one joint at which its backbone has that strain [rad].
SINEW_API double bend_at_strain(const Section& section, double strain, double diameter);

// ---------------------------------------------------------------- stretch and tolerance

/// Length of a tendon of that section from its motor to its end, robot straight and as long as it can be [m].
/// @param outside between motor and robot [m]
SINEW_API double tendon_length(const SerialRobot& robot, int section, double outside);

/// What a tendon of that section becomes longer by [m]: T l/EA, with the part outside the robot. Absent where
/// the robot does not say how stiff its tendons are.
SINEW_API std::optional<double> tendon_stretch(const SerialRobot& robot, int section, double tension);

/// Forces on a tendon [N].
struct TendonForces {
  double tension = 0;   ///< by how much its tension varies and nothing makes up for the stretch
  double friction = 0;  ///< lost on its way: by that much the tension inside is not known
};

/// Parts of a tendon's tolerance [m].
struct ToleranceParts {
  double step = 0;      ///< one count of the encoder; 0: the robot has no motor
  double stretch = 0;   ///< by the tension; 0: the robot has no stiffness
  double friction = 0;  ///< by the friction, either way
  double sum() const { return step + stretch + friction; }  ///< all of them
};

/// What `SerialRobot::tolerance` should at least be for the tendons of that section.
SINEW_API ToleranceParts tolerance_parts(const SerialRobot& robot, int section, const TendonForces& forces);

}  // namespace sinew::inline v1
