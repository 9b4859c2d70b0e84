/// @file arm.hpp
/// Questions to an arm that bears loads: its equilibrium under tendons and loads, what moves it, what it
/// yields, which inputs take its tip to a place, what pulls at it, and where a growing load ends; and to one
/// that is followed along a path of inputs and loads, where tendons rub at discs or in channels (Coulomb), so
/// that where it is depends on how it came there. Theory: docs/theory/strain_rod.md,
/// docs/theory/tendon_friction.md
#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "sinew/base/export.hpp"
#include "sinew/base/numbers.hpp"
#include "sinew/kinematics/equilibrium.hpp"
#include "sinew/math/se3.hpp"
#include "sinew/math/vec.hpp"
#include "sinew/robot/arm.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// What a motor holds of a tendon.
enum class TendonHeld {
  tension,  ///< [N]
  change,   ///< Δl of its end, > 0 pays out [m]
};
/// How a tendon is held.
struct TendonCommand {
  TendonHeld held = TendonHeld::tension;
  double value = 0;  ///< [N] or [m]
};

/// A load at a place of the backbone.
struct PointLoad {
  double place = 0;                ///< from the base along the backbone [m]
  std::array<double, 6> wrench{};  ///< force and moment about that place [N, N m]
  bool following = false;          ///< in the axes of the place, which it turns with; else in base axes
};

/// What acts on an arm beside its tendons and its weight.
struct ArmLoad {
  std::array<double, 6> wrench{};           ///< at the tip, base axes, about the tip [N, N m]
  std::array<double, 6> following{};        ///< at the tip, in its axes [N, N m]
  std::array<double, 3> along{};            ///< on all of the backbone, base axes [N/m]
  std::array<double, 3> following_along{};  ///< on all of it, in its own axes [N/m]
  std::vector<PointLoad> points = {};
  std::optional<std::array<double, 3>> gravity = {};  ///< in place of the arm's [m/s²]
};

/// How the balance of an arm is written. By energy is what frictionless tendons do; the others are what
/// published codes compute, to meet their numbers; without stability and rates. Theory:
/// docs/theory/arm_models.md
enum class ArmBalance {
  energy,      ///< forces of tendons are the gradient of their lengths
  projected,   ///< discs lose what tendons pull along their normals, but where a tendon ends
  collocated,  ///< projected, and moments balance at the discs before a piece: subsegment_cc, prb
  closed_form  ///< no balance: bending by lengths of tendons alone, without loads: cc
};

/// How an arm's equilibrium is looked for.
struct ArmOptions {
  ArmModel model = ArmModel::subsegment_rod;
  /// Other than by energy: discs in every section, tensions held (in closed form: changes), one resolution.
  ArmBalance balance = ArmBalance::energy;
  /// Of the polynomials of rods, without refinement, at most 2 `elements` − 1; −1: the model's, more where
  /// the answer needs it.
  int order = -1;
  /// Of a section (rod), between discs (subsegment_rod, prb), without refinement; 0: as `order` needs them.
  int elements = 0;
  double accuracy = 1e-6;  ///< of the tip that rods are refined to, over the arm's length; 0: as they are [1]
  double tolerance = 1e-10;  ///< of the residual [1]
  int max_iterations = 200;  ///< of each search; refinement takes several [1]
  bool from_last = false;    ///< from where the workspace is, not from the straight arm
  /// From the shape with these curvatures and torsions, means of as many equal parts [rad/m], in its own
  /// axes; empty: from the straight arm. Outlives the question.
  std::span<const std::array<double, 3>> from_curvatures = {};
};

/// An equilibrium. `tip`, tensions and lengths are those of the best iterate where it is none.
struct ArmState {
  Report report;                 ///< its residual is that of moments over EI/L [1]
  SE3<double> tip;               ///< base axes [m]
  std::vector<double> tensions;  ///< of every tendon [N]
  std::vector<double> changes;   ///< Δl of every tendon, > 0: paid out [m]; with its stretch
  std::vector<double> slack;     ///< what a tendon is longer than its way [m]; 0 where it is taut
  bool stable = true;            ///< as far as `stability_told`
  bool stability_told = true;    ///< false where the balance is not by energy: it has no potential
  double energy = 0;             ///< elastic, of weight, dead forces and of tendons that stretch [J]; motors
                                 ///< that hold tensions are outside of it
  double resolution = 0;         ///< by how much the tip moves with finer polynomials [m]; 0: not asked for
  int coordinates = 0;           ///< of its strain
};

/// The arm's equilibrium under these tendons and this load.
/// `bad_input`: commands of another number, a tension below 0, a place beyond the tip. `stalled`: no
/// equilibrium was found; `unstable`: it does not hold by itself.
/// @param commands of every tendon, those of the first section first
SINEW_API const ArmState& arm_forward(const Arm& arm, std::span<const TendonCommand> commands,
                                      const ArmLoad& load, const ArmOptions& options, ArmWorkspace& work);

/// @name Of the equilibrium that the workspace is in
/// @{

/// Frames at these places from the base [m], base axes.
SINEW_API std::vector<SE3<double>> arm_frames(const Arm& arm, std::span<const double> places,
                                              const ArmWorkspace& work);
/// Strains there: stretch and shear (v), then curvature and torsion (u) [1, rad/m].
SINEW_API std::vector<std::array<double, 6>> arm_strains(const Arm& arm, std::span<const double> places,
                                                         const ArmWorkspace& work);
/// The mean curvature and torsion of each of so many equal parts, in its own axes [rad/m]: what takes a
/// part's first frame to its last by one turn.
/// @param parts at least 1
SINEW_API std::vector<std::array<double, 3>> arm_curvatures(const Arm& arm, int parts,
                                                            const ArmWorkspace& work);
/// Where every tendon runs: points of its guides, base axes [m].
SINEW_API std::vector<std::vector<Vec3<double>>> arm_tendon_lines(const Arm& arm, const ArmWorkspace& work);

/// Derivatives of an equilibrium. Twists are of the tip, in base axes, linear first [m, rad].
struct ArmRates {
  bool regular = false;  ///< the equilibrium is no fold
  int tendons = 0;
  std::vector<double> J;  ///< twist by what is held of the tendons, 6 rows [m/N or 1, rad/N or rad/m]
  std::vector<double> compliance;  ///< twist by a wrench at the tip, 6 × 6 [m/N, rad/(N m)]
  std::vector<double> answers;     ///< of each tendon what is not held (change [m] or tension [N]) by what is
                                   ///< held of each, square
  std::vector<double> answers_by_wrench;  ///< the same by a wrench at the tip, 6 columns
  double margin = 0;  ///< least ratio of the energy's second variation to the backbone's elastic one [1]: 1
                      ///< of a straight arm without load, 0 where it buckles. Tendons exactly at rest
                      ///< resist where they would be longer
  bool margin_is_bound = false;  ///< more than six tendons are exactly at rest: the margin is at least this
};
/// Rates of the equilibrium in the workspace.
/// @param margin whether it is wanted, which takes longer than all the rest
SINEW_API ArmRates arm_rates(const Arm& arm, ArmWorkspace& work, bool margin = true);
/// @}

/// Where the tip is to be; what is not given is free.
struct ArmTarget {
  std::optional<std::array<double, 3>> position = {};   ///< base axes [m]
  std::optional<std::array<double, 3>> direction = {};  ///< of the tip's z axis, of any length but 0 [1]
  std::optional<std::array<double, 4>> quaternion =
      {};  ///< of the tip, [w, x, y, z], in place of a direction
};
/// How tensions for a target are looked for.
struct ArmInverseOptions {
  ArmOptions arm = {};
  double most_tension = 0;  ///< of a tendon [N]; 0: any
  double precision = 1e-7;  ///< of the tip, over the arm's length; angles [rad] alike
  int starts = 12;          ///< shapes from which the search begins, one after the other
};
/// Tensions that take the tip to a target. What they are free in goes into the least sum of their squares, of
/// those nearby.
struct ArmInverse {
  Report report;   ///< its residual is what the tip is off: place over the arm's length, angle [rad]
  ArmState state;  ///< with tensions, and the changes for motors that hold those
};
/// `unreachable`: the nearest that was found is in `state`.
SINEW_API ArmInverse arm_inverse(const Arm& arm, const ArmTarget& target, const ArmLoad& load,
                                 const ArmInverseOptions& options, ArmWorkspace& work);

/// What is measured of an arm; what is not a number is not known.
struct ArmMeasurement {
  std::vector<TendonCommand> held = {};  ///< of every tendon, taken as exact
  std::vector<double> answers;           ///< of every tendon what is not held: tension [N] or change [m]
  std::optional<std::array<double, 3>> tip = {};  ///< its place, base axes [m]
  double tension_deviation = 0.05;                ///< standard deviation of tensions [N]
  double change_deviation = 2e-5;                 ///< of changes [m]
  double tip_deviation = 5e-4;                    ///< of the tip's place [m]
};
/// A wrench at the tip that explains what was measured.
struct ArmSensed {
  Report report;                        ///< `singular` where the measurement does not tell
  std::array<double, 6> wrench{};       ///< base axes [N, N m]
  std::array<double, 36> covariance{};  ///< of it; of a force alone the moment's part is 0 [N², N² m, N² m²]
  /// Root mean square of what stays, in standard deviations [1]; not a number where nothing was compared.
  double misfit = not_a_number;
  /// How much better the best known direction of the wrench is known than the worst, moments over the arm's
  /// length [1].
  double condition = 0;
  ArmState state;
};
/// @param force_alone no moment at the tip is looked for
SINEW_API ArmSensed arm_sense(const Arm& arm, const ArmMeasurement& measured, const ArmLoad& load,
                              bool force_alone, const ArmOptions& options, ArmWorkspace& work);

/// One of many equilibria.
struct ArmEquilibrium {
  ArmState state;
  /// Of its shape, see arm_curvatures [rad/m]: a search that begins there ends there.
  std::vector<std::array<double, 3>> curvatures = {};
  bool continuum = false;  ///< one of infinitely many, as where a straight arm may bend to any side
};
/// Equilibria found from many shapes, that of the lowest potential first. They need not be all; of a
/// continuum there is one.
/// @param starts how many shapes
SINEW_API std::vector<ArmEquilibrium> arm_equilibria(const Arm& arm, std::span<const TendonCommand> commands,
                                                     const ArmLoad& load, const ArmOptions& options,
                                                     int starts, ArmWorkspace& work);

/// The last equilibrium of a growing load.
struct ArmLoadPath {
  double load = 0;  ///< how many times the direction was added [1]
  /// Why it ended: `limit`, `bifurcation` (it buckles: another curve crosses), `fold` (it snaps: there is no
  /// equilibrium near by beyond), `stability` (a load without potential drives it away), `iterations`,
  /// `stalled`, `stopped`.
  LoadEnd end = LoadEnd::limit;
  ArmState state;     ///< there
  double margin = 0;  ///< there to buckling, as ArmRates::margin [1]
  /// Without a potential: from here on the stiffness' symmetric part is not definite [1]; below 0 where that
  /// is not so.
  double definite_until = -1;
  int steps = 0;  ///< equilibria on the way
};

/// Adds `direction`, force and moment at the tip in base axes [N, N m], times a growing factor to the load,
/// up to `limit` times. Tendons are held as `commands` say. Afterwards the workspace holds the last
/// equilibrium. Where there is none under `load` alone, its report says why, the factor is 0 and the end
/// `stalled`.
SINEW_API ArmLoadPath arm_follow_load(const Arm& arm, std::span<const TendonCommand> commands,
                                      const ArmLoad& load, const std::array<double, 6>& direction,
                                      double limit, const ArmOptions& options, ArmWorkspace& work);

/// What a path comes to.
struct ArmStep {
  std::vector<TendonCommand> commands;  ///< of every tendon, those of the first section first
  ArmLoad load;
  int divisions =
      1;  ///< into how many equal parts the way to it is divided, ≥ 1; each has a point of its own
};

/// An equilibrium of a path.
struct ArmPathPoint {
  ArmState state;  ///< tensions are those at the motors; energy: elastic, of weight, dead forces, stretch
  /// Of each tendon: between motor and arm, then from guide to guide to its end [N].
  std::vector<std::vector<double>> tensions;
  /// Of each tendon by how much it turns at the base, then at every guide but the last [rad].
  std::vector<std::vector<double>> angles;
  double motor_work = 0;     ///< of the tendons' ends since the point before [J]
  double friction_loss = 0;  ///< at guides since then [J]
  int parts = 0;             ///< equilibria that were found on the way, this one too
};

/// From the straight arm, free of tensions but for pretension, or where `options.from_last` says so from the
/// end of the path that the workspace remembers: to each step inputs and loads change evenly. A tendon that
/// was held otherwise begins at the tension, or the change, that it has. Steps are cut where they have to be;
/// divisions tell more of what slips first, and make sums of work exact.
///
/// Strains have one resolution along a path: that of `options.order` and `elements`; else, where `accuracy`
/// is not 0, finer than the coarsest. What a tendon does not stretch by is known: without friction the
/// equilibria are those of arm_forward(). arm_rates() does not know those of tendons that rub;
/// arm_path_rates() does.
///
/// A point for every division. The answer ends with the first one that was not reached: `stalled` where no
/// equilibrium was found, `iteration_limit` after ten times `options.max_iterations` for one; its state is
/// the last one that was, from where a path may go on.
SINEW_API std::vector<ArmPathPoint> arm_follow(const Arm& arm, std::span<const ArmStep> steps,
                                               const ArmOptions& options, ArmWorkspace& work);

/// What changes at once as what holds the tendons begins to change, at the end of a path.
struct ArmPathRates {
  bool regular = false;           ///< they are known; else `message` says why not
  FixedText<240> message;         ///< empty where they are
  std::array<double, 6> twist{};  ///< of the tip, base axes, linear first [m/s, rad/s]
  std::vector<double> tensions;   ///< at the motors; not a number where one jumps as its motor starts [N/s]
  std::vector<double> changes;    ///< of the tendons [m/s]
  int slipping = 0;               ///< guides at which tendons slip [1]

  /// @name Around that direction, while the same guides slip: where they are asked for
  /// `twist` is J times the direction, `changes` and `tensions` alike; so it is for every direction between
  /// `least` and `most`, one rate at a time, and for factors > 0 of these.
  /// @{
  int tendons = 0;
  std::vector<double> J;  ///< twist by what is held of the tendons, 6 rows [m/N or 1, rad/N or rad/m]
  std::vector<double> changes_by_inputs;   ///< of each tendon by what is held of each, square [m/N or 1]
  std::vector<double> tensions_by_inputs;  ///< the same of tensions at the motors [1 or N/m]
  std::vector<double> compliance;          ///< twist by a wrench at the tip, 6 × 6 [m/N, rad/(N m)]
  std::vector<double> changes_by_wrench;   ///< of each tendon by that, 6 columns [m/N, 1/N]
  std::vector<double> tensions_by_wrench;  ///< the same of tensions at the motors [1, 1/m]
  /// Rate of each input down to which the same guides slip, the others as they are; may be infinite [N/s,
  /// m/s].
  std::vector<double> least;
  std::vector<double> most;  ///< up to which they do [N/s, m/s]
  /// @}
};

/// Rates at the end of the path that the workspace remembers, loads staying. They are one-sided: a guide that
/// slips as a motor goes on sticks as it turns back, so rates of the opposite direction are others, and those
/// of two motors do not add up. Only multiples of one direction are multiples. Around a direction in which
/// tendons move, though, they are linear: as long as the same guides slip.
/// @param direction of what is held of every tendon by the path's last step, tension [N/s] or change [m/s]
/// @param matrices what is linear around it is wanted as well
SINEW_API ArmPathRates arm_path_rates(const Arm& arm, std::span<const double> direction, ArmWorkspace& work,
                                      bool matrices = false);

}  // namespace sinew::inline v1
