/// @file identify.hpp
/// Identification of an arm: what its stiffness, tendons, drive and marker are, from measured rows. Theory:
/// docs/theory/identification.md
#pragma once
#include <Eigen/Core>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/base/error.hpp"
#include "sinew/base/export.hpp"
#include "sinew/robot/arm.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// An arm, what moves it and what is measured of it.
struct MeasuredArm {
  Arm arm;
  TendonDrive drive;
  MarkerMount marker;
};

/// An arm with what its file says of how it is measured; with nothing between motors and tendons and the
/// marker at the tip where it says nothing.
SINEW_API MeasuredArm measured(const Arm& arm);

/// An arm as its file would have it: `measurement` is what stands beside it.
SINEW_API Arm as_file(const MeasuredArm& arm);

/// Measured: by how much each tendon is drawn in, and where the marker is. In the order of time.
struct MeasuredRows {
  std::vector<double> time;     ///< [s]; empty: at rest
  std::vector<double> pulls;    ///< rows × tendons, counted at the motors, positive where drawn in [m]
  std::vector<double> markers;  ///< rows × 3 [m]
  std::vector<int> blocks;      ///< rows of one number belong together; empty: each is on its own

  std::size_t size() const { return markers.size() / 3; }  ///< rows
};

/// What a fit can change.
enum class ArmQuantity {
  bending,      ///< EI of a section, both
  bending_x,    ///< about x
  bending_y,    ///< about y
  torsion,      ///< GJ of a section
  curvature_x,  ///< of a section at rest [rad/m]
  curvature_y,
  angle,       ///< of a tendon in a section [rad]
  radius,      ///< of a tendon in a section [m]
  compliance,  ///< of a tendon [m/N]
  pretension,  ///< [N]
  toe,         ///< of a tendon [m]
  offset,      ///< of a drive [m]
  gain,
  lag,   ///< of all drives [s]
  play,  ///< of all drives [m]
  gravity_x,
  gravity_y,
  gravity_z,  ///< [m/s²]
  mass,       ///< of backbone and discs, a factor
  tip_mass,   ///< [kg]
  marker_x,
  marker_y,
  marker_z,  ///< [m]
  base_x,
  base_y,
  base_z,  ///< [m]
  tilt_x,
  tilt_y,
  tilt_z,  ///< [rad]
};

/// A quantity of a section, of a tendon, of a tendon in a section, or of the arm; −1 where that is not asked.
struct ArmField {
  ArmQuantity quantity;
  int section = -1;
  int tendon = -1;
};

/// A number that a fit may change. It changes all its fields alike: those that are positive by a factor, the
/// others by an addition. Coordinates are the factor's logarithm, and what is added.
struct FitParameter {
  std::string name;
  std::string unit;              ///< of its value
  std::vector<ArmField> fields;  ///< at least one
  bool is_factor = false;
  double lower = 0;  ///< bound of the coordinate, in its unit
  double upper = 0;  ///< its other bound, in its unit
  double prior = 0;  ///< standard deviation of the coordinate about its start; 0: no prior
};

/// @param names `bending,sections.angle,tendons.gain,passages.radius,marker`: a quantity that all have in
/// common, or one for each section, each tendon, each tendon in each section that it passes; `curvature`,
/// `gravity`, `marker`, `base`, `tilt` are all of their components. With the usual bounds and priors. Codes:
/// `unknown_name`, `not_available`, `duplicate_name`.
SINEW_API Expected<std::vector<FitParameter>> fit_parameters(const MeasuredArm& arm, std::string_view names);

/// What rows can usually tell of this arm, as `fit_parameters` takes it: of each section the stiffness, and
/// the angle, compliance and curvature; of each tendon offset and toe; marker, base and tilt. Weight where
/// the arm has masses, the lag where rows have a time.
SINEW_API std::string usual_fit(const MeasuredArm& arm, const MeasuredRows& rows,
                                ArmModel model = ArmModel::cc);

/// How a fit is done.
struct IdentifyOptions {
  ArmModel model = ArmModel::cc;
  double noise = 0;        ///< of a marker's coordinate [m]; 0: estimated from what is left
  double robust = 2.5;     ///< Huber's limit, as multiple of the noise; beyond it a row counts less [1]
  double correlated = 30;  ///< rows that are worth one independent one, against the priors [1]
  int max_iterations = 60;
  double tolerance = 3e-4;       ///< of the relative decrease of the cost [1]
  std::vector<bool> held_out{};  ///< rows that the fit does not see; empty: none
  StopToken stop{};  ///< then the best so far is the answer, with the errors of rows it was fitted to
  /// Told after each step: how many there were, and the root mean square of the distances so far [m].
  std::function<void(int steps, double rms)> progress{};
};

/// Of the distances between markers, measured and computed.
struct MarkerErrors {
  int rows = 0, failed = 0;  ///< failed: without an equilibrium, not counted
  double rms = 0;            ///< root mean square [m]
  double median = 0;         ///< half are smaller [m]
  double max = 0;            ///< the largest [m]
};

/// A parameter after a fit.
struct FittedParameter {
  double start = 0;                 ///< its value before the fit, in its unit
  double value = 0;                 ///< of its first field; of masses the factor, in its unit
  double deviation = 0;             ///< standard one of the value, rows and prior together, in its unit
  double coordinate = 0;            ///< in which it was fitted, in its unit
  double coordinate_deviation = 0;  ///< standard one of it, in its unit
  bool at_bound = false;
  double prior_share = 0;  ///< of what is known of it, from its prior; 1: the rows say nothing [1]
};

/// A combination of parameters that the rows hardly tell.
struct FlatDirection {
  double deviation = 0;              ///< along it, in units of the priors
  std::vector<double> coefficients;  ///< of coordinates over their priors; |.| = 1 [1]
};

/// An arm as rows have it, and how well they do.
struct Identified {
  Report report;
  MeasuredArm arm;
  std::vector<FittedParameter> parameters;
  std::vector<FlatDirection> flat;  ///< flattest first
  MarkerErrors before;              ///< of the start, at the rows that the fit sees
  MarkerErrors train, held_out;
  double noise = 0;            ///< [m]
  std::vector<double> errors;  ///< of every row [m]; NaN where it failed, or a stop came before it
  Eigen::MatrixXd covariance;  ///< of coordinates, by blocks of rows, with priors
};

/// Robust least squares with exact sensitivities: Levenberg's and Marquardt's steps within the bounds.
SINEW_API Expected<Identified> identify(const MeasuredArm& start, const std::vector<FitParameter>& parameters,
                                        const MeasuredRows& rows, const IdentifyOptions& options = {});

/// Errors at rows that a fit has not seen.
struct HeldOut {
  MarkerErrors errors;         ///< of all parts together
  std::vector<double> by_row;  ///< of every row [m]; NaN where it failed
  bool is_complete = true;     ///< false where a stop was requested before all parts were done
};

/// As many fits as there are folds: each without one of them, at which it is then judged.
/// @param folds of every row, from 0, see `folds_of`
SINEW_API Expected<HeldOut> hold_out(const MeasuredArm& start, const std::vector<FitParameter>& parameters,
                                     const MeasuredRows& rows, const std::vector<int>& folds,
                                     IdentifyOptions options = {});

/// What the arm would show; rows × 3 [m], NaN where there is no equilibrium, or a stop came
/// before it.
SINEW_API Expected<std::vector<double>> predict_markers(const MeasuredArm& arm, const MeasuredRows& rows,
                                                        ArmModel model = ArmModel::cc, StopToken stop = {});

/// How motors and axes of a measurement belong to an arm's tendons.
struct TendonMap {
  int sign = 1;           ///< −1: what is counted is paid out
  bool mirrored = false;  ///< the tendons run around the arm the other way
  double turn = 0;        ///< of the measurement's axes about z [rad]; add it to the tendons' angles
  double agreement = 0;   ///< correlation of the markers across the arm, computed and measured, 0 to 1 [1]
  double next = 0;        ///< of the next best combination [1]
  double as_given = 0;    ///< of counts and tendons as they are given, not turned, 0 at least [1]
};

/// By the markers that the arm would show, turned, mirrored or pulled the other way. A half turn is not
/// the same as a sign, where tendons are slack at times: they do not push. Else counts are taken as drawn in.
/// After a stop it is what the rows up to there tell.
SINEW_API Expected<TendonMap> map_tendons(const MeasuredArm& arm, const MeasuredRows& rows,
                                          ArmModel model = ArmModel::cc, StopToken stop = {});

/// Every row's fold, of that many: whole blocks, dealt in turn.
SINEW_API std::vector<int> folds_of(const MeasuredRows& rows, int folds);

/// The arm with its tendons where the map says: turned, or run around the other way. The sign is that of
/// rows.
SINEW_API MeasuredArm mapped(const MeasuredArm& arm, const TendonMap& map);

}  // namespace sinew::inline v1
