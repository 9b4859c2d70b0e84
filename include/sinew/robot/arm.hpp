/// @file arm.hpp
/// An arm: elastic sections one after the other, pulled by tendons, that bear loads; and memory for questions
/// to it. Theory: docs/theory/strain_rod.md
#pragma once
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sinew/base/export.hpp"
#include "sinew/math/vec.hpp"
#include "sinew/robot/serial.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// What a cross-section resists with, and its mass. Axes are those of the section: z along it.
struct CrossSection {
  double bending_x = 0;  ///< EI about x [N m²], > 0
  double bending_y = 0;  ///< EI about y [N m²], > 0
  double torsion = 0;    ///< GJ [N m²], > 0
  double stretch = 0;    ///< EA [N]; 0: it does not stretch
  double shear = 0;      ///< GA, with its shear factor [N]; 0: it does not shear
  double mass = 0;       ///< of a length [kg/m], ≥ 0

  bool operator==(const CrossSection&) const = default;
};

/// What a backbone is made of.
struct Material {
  double young = 0;    ///< E [Pa], > 0
  double shear = 0;    ///< G [Pa], > 0
  double density = 0;  ///< [kg/m³], ≥ 0
};

/// A round wire or tube.
/// @param diameter outer one [m], > 0
/// @param hole inner one [m], ≥ 0, less than the outer one
SINEW_API CrossSection round_section(const Material& material, double diameter, double hole = 0);
/// A rectangle of these widths along x and y [m], > 0.
SINEW_API CrossSection rectangular_section(const Material& material, double along_x, double along_y);

/// Discs that guide tendons, evenly along a section, the last one at its end; or none: a channel in the
/// backbone guides them everywhere.
struct Discs {
  int count = 0;      ///< 0: tendons run in channels
  double mass = 0;    ///< of each [kg], ≥ 0
  double radius = 0;  ///< of each [m]; 0: not known
};

/// Arcs of a section of constant curvature [1]: from disc to disc; a channel counts as a thousand discs,
/// whose chords are shorter than their arcs by 1e-7 of what a tendon is pulled.
inline int arc_count(const Discs& discs) { return discs.count > 0 ? discs.count : 1000; }

/// One section of an arm.
struct ArmSection {
  double length = 0;        ///< along its backbone, straight and at rest [m], > 0
  CrossSection start, end;  ///< at its ends
  /// Of a round backbone that tapers: the fourth power of the diameter, which is linear, rules EI between the
  /// ends; where false all that `start` and `end` have is linear between them.
  bool round_taper = false;
  std::array<double, 3> curvature{0, 0, 0};  ///< at rest, about x and y and as torsion [rad/m]
  Discs discs;
  /// Largest bend [rad], of what is asked of it as a section of constant curvature; loads know none.
  double limit = std::numeric_limits<double>::infinity();
};

/// How a tendon runs through a section: its distance from the backbone and the angle there, from +x about z.
struct TendonRoute {
  double start_radius = 0;  ///< at the section's start [m], > 0
  double end_radius = 0;    ///< at its end [m], > 0
  double start_angle = 0;   ///< at the section's start [rad]
  double end_angle = 0;     ///< at its end [rad]; a helix where they differ
};

/// A tendon, fixed at the end of a section.
struct ArmTendon {
  std::vector<TendonRoute> routes;  ///< through its section and all before it, base first
  double compliance = 0;  ///< of all of it, what lies outside of the arm, too [m/N]; 0: it does not stretch
  double friction = 0;    ///< Coulomb's, at discs or in the channel, ≥ 0 [1]
  double pretension = 0;  ///< at no change of its length, straight and without load [N], ≥ 0
  /// Share of its compliance that lies between its motor and the arm, 0 to 1; matters where it rubs.
  double outside = 0;

  /// Index of the section at whose end it is fixed.
  int section() const { return static_cast<int>(routes.size()) - 1; }
};

/// Between what a motor counts and the end of its tendon. Without numbers a tendon's gain is 1, its offset
/// and toe 0.
struct TendonDrive {
  std::vector<double> gain;    ///< of each tendon: drawn in by what is counted, > 0 [1]
  std::vector<double> offset;  ///< of each: drawn in where 0 is counted [m]
  std::vector<double> toe;     ///< of each: up to this stretch its tension grows with its square [m], ≥ 0
  double lag = 0;              ///< time constant with which the tendon follows [s], ≥ 0
  double play = 0;             ///< lost when a motor turns back, half of it either way [m], ≥ 0

  bool operator==(const TendonDrive&) const = default;
};

/// Where the marker is on the arm, and the arm in the axes of the measurement.
struct MarkerMount {
  std::array<double, 3> place{0, 0, 0};  ///< of the marker in the tip's axes [m]
  std::array<double, 3> base{0, 0, 0};   ///< of the arm's base in those of the measurement [m]
  /// Of the arm's axes in those of the measurement, a rotation vector [rad].
  std::array<double, 3> tilt{0, 0, 0};

  bool operator==(const MarkerMount&) const = default;
};

/// How an arm is measured: counts of motors in, the place of a marker out. Only `identify` looks at it.
struct MeasuringSetup {
  TendonDrive drive = {};
  MarkerMount marker = {};

  bool operator==(const MeasuringSetup&) const = default;
};

/// Constant once built, and shared between threads.
struct Arm {
  std::string name;
  std::vector<ArmSection> sections;
  std::vector<ArmTendon> tendons;                 ///< those of the first section first
  std::array<double, 3> gravity{0, 0, 0};         ///< in base axes [m/s²]
  double tip_mass = 0;                            ///< at the tip [kg], ≥ 0
  std::array<double, 3> tip_mass_place{0, 0, 0};  ///< of its centre in the tip's axes [m]
  bool geometry_inferred = false;                 ///< not printed in its source but inferred from results
  double tolerance = 0;                           ///< of a tendon's length [m]: encoder step, backlash; ≥ 0
  std::optional<TendonMotor> motor;
  std::optional<MeasuringSetup> measurement = {};  ///< where the file tells
  /// One for a robot and its copies; by it a workspace knows the robot that it was made for.
  std::shared_ptr<const char> identity = std::make_shared<const char>();

  /// From base to tip [m].
  double length() const {
    double sum = 0;
    for (const ArmSection& section : sections) sum += section.length;
    return sum;
  }
};

/// How the strain of an arm's backbone is taken.
enum class ArmModel {
  rod,             ///< polynomials along a section; discs guide tendons as a channel would
  subsegment_rod,  ///< polynomials from disc to disc
  subsegment_cc,   ///< constant from disc to disc
  cc,              ///< constant along a section
  prb,             ///< rigid links and sprung joints
};

/// Memory for questions to one arm; one per thread.
class ArmWorkspace {
 public:
  /// For this arm and its copies.
  SINEW_API explicit ArmWorkspace(const Arm& arm);
  SINEW_API ~ArmWorkspace();
  SINEW_API ArmWorkspace(ArmWorkspace&&) noexcept;
  SINEW_API ArmWorkspace& operator=(ArmWorkspace&&) noexcept;

  StopToken stop;  ///< searches end with `stopped` once it is requested

  struct Impl;
  /// What solvers keep in it.
  Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace sinew::inline v1
