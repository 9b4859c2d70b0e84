/// @file arm_legs.hpp
/// Questions to a platform on arms: its equilibrium under tendons and loads. Theory: docs/theory/arm_legs.md
#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "sinew/base/export.hpp"
#include "sinew/kinematics/arm.hpp"
#include "sinew/kinematics/equilibrium.hpp"
#include "sinew/robot/arm_legs.hpp"

namespace sinew::inline v1 {

/// A load at a place of a leg's backbone.
struct ArmLegsPointLoad {
  std::size_t leg = 0;             ///< from 0
  double place = 0;                ///< from the leg's base along its backbone [m]
  std::array<double, 6> wrench{};  ///< force and moment about that place [N, N m]
  bool following = false;          ///< in the axes of the place, which it turns with; else in base axes
};

/// What acts on the robot beside its weight. What follows, and in space any moment, has no potential: an
/// equilibrium under it counts as stable where the symmetric part of its stiffness, legs included, is
/// positive definite. That is enough, but not needed.
struct ArmLegsLoad {
  std::array<double, 6> wrench{};  ///< on the platform, about its reference point, base axes [N, N m]
  std::optional<std::array<double, 3>> gravity = {};  ///< in place of the robot's [m/s²]
  std::array<double, 3> along{};                      ///< on all backbones, base axes [N/m]
  std::vector<ArmLegsPointLoad> points = {};          ///< on backbones
  std::array<double, 6> following{};        ///< on the platform, in its axes, with which it turns [N, N m]
  std::array<double, 3> following_along{};  ///< on all backbones, in their own axes, z along them [N/m]
};

/// An equilibrium; tendons are those of leg 0 first. Of the best iterate where it is none.
struct ArmLegsState {
  Report report;                                 ///< its residual is the worst of all equations' [1]
  SE3<double> platform;                          ///< base axes [m]
  std::vector<double> tensions;                  ///< of every tendon [N]
  std::vector<double> changes;                   ///< Δl of every tendon, > 0: paid out [m]; with its stretch
  std::vector<double> slack;                     ///< what a tendon is longer than its way [m]; 0: it is taut
  std::vector<std::array<double, 6>> tip_loads;  ///< of the platform on every tip, base axes [N, N m]
  bool stable = false;
  double energy = 0;      ///< elastic, of weight, of forces that keep their direction and of tendons that
                          ///< stretch [J]
  double resolution = 0;  ///< by how much tips move with finer polynomials [m]; 0: not asked for
  double reached = 0;     ///< share of inputs and loads up to which there was an equilibrium that holds [1]
};

/// The equilibrium into which the rest grows as inputs and loads do, together from nothing. With
/// `options.from_last` the one into which that of the workspace changes, as what is held and loads do;
/// where there is none, or the way to it gives way, that of the rest, and in the latter case `message` says
/// so. `bad_input`: commands of another number, a tension below 0, a load where there is no leg.
/// `unsupported`: what is not built for legs, as a balance that is not by energy.
/// `stalled`: up to `reached` of inputs and loads there was an equilibrium that holds, and beyond none was
/// found: it may have given way. Under loads without a potential it may be that beyond none is known to hold.
/// `iteration_limit`: as many of Newton's steps as `options.max_iterations` were taken, all stages of the
/// search together, and `reached` tells how far they led.
/// @param commands of every tendon, those of leg 0 first, in it those of the first section first
SINEW_API const ArmLegsState& arm_legs_forward(const ArmLegs& robot, std::span<const TendonCommand> commands,
                                               const ArmLegsLoad& load, const ArmOptions& options,
                                               ArmLegsWorkspace& work);

/// Where a search begins: near a shape of all legs.
struct ArmLegsStart {
  SE3<double> platform;  ///< base axes [m]
  /// Of each leg the mean curvatures and torsion of as many equal parts, in its own axes [rad/m].
  std::vector<std::vector<std::array<double, 3>>> curvatures;
};
/// The equilibrium that Newton's method finds from there, at once under all that acts; it may be unstable,
/// and the report is then `unstable`. `stalled`: none was found. `bad_input`, too: curvatures of not every
/// leg, or none of one.
SINEW_API const ArmLegsState& arm_legs_forward_from(const ArmLegs& robot, const ArmLegsStart& start,
                                                    std::span<const TendonCommand> commands,
                                                    const ArmLegsLoad& load, const ArmOptions& options,
                                                    ArmLegsWorkspace& work);

/// One of many equilibria.
struct ArmLegsEquilibrium {
  ArmLegsState state;  ///< its report is `unstable` where it does not hold by itself
  ArmLegsStart start;  ///< from where arm_legs_forward_from() finds it again
};
/// Equilibria under these inputs and loads, that of the lowest potential, motors' work with it, first. They
/// are found from other poses of the platform and under loads and pulls that then go, and need not be all.
/// Where there is none it is the one report of arm_legs_forward(). The workspace is left in the first.
/// @param starts how many beginnings, ≥ 1
SINEW_API std::vector<ArmLegsEquilibrium> arm_legs_equilibria(const ArmLegs& robot,
                                                              std::span<const TendonCommand> commands,
                                                              const ArmLegsLoad& load,
                                                              const ArmOptions& options, int starts,
                                                              ArmLegsWorkspace& work);

/// A platform that is held at a pose.
struct ArmLegsHeld {
  /// An equilibrium under the wrench below; `stable` is of the platform when it is let go under it.
  ArmLegsState state;
  std::array<double, 6> wrench{};  ///< that holds it beside weight and load, base axes [N, N m]
};
/// The wrench that holds the platform at a pose, tendons and loads being given. It goes there evenly from
/// where it is without a wrench, or with `options.from_last` from the last equilibrium, what is held going
/// along. `stalled`: the legs do not reach the pose, or one of them gives way before; or stiffness is not
/// finite.
/// @param pose of the platform, base axes [m]
/// @param commands of every tendon, those of leg 0 first, in it those of the first section first
SINEW_API ArmLegsHeld arm_legs_hold(const ArmLegs& robot, const SE3<double>& pose,
                                    std::span<const TendonCommand> commands, const ArmLegsLoad& load,
                                    const ArmOptions& options, ArmLegsWorkspace& work);

/// Derivatives of an equilibrium, its platform's twist in base axes, linear first [m, rad].
struct ArmLegsRates {
  bool regular = false;  ///< the equilibrium is no fold
  /// Tendons that do not stretch pull against one another with tensions that nothing determines: what is told
  /// of changes and tensions is of one of them with the others following.
  bool opposed = false;
  /// The platform's stiffness is finite: else a leg that does not stretch is straight.
  bool has_stiffness = false;
  std::array<double, 36> stiffness{};  ///< wrench by twist, inputs held, rows first [N/m, N, N m]
  std::vector<double> compliance;      ///< twist by wrench, inputs held, 6 × 6 [m/N, rad/N, rad/(N m)]
  std::vector<double> J;        ///< twist by what is held of every tendon, 6 rows [m/N or 1, rad/N or rad/m]
  std::vector<double> answers;  ///< of each tendon what is not held (change [m] or tension [N]) by what is
                                ///< held of each, square
  std::vector<double> answers_by_wrench;  ///< the same by a wrench on the platform, 6 columns
};
/// Of the equilibrium in the workspace.
SINEW_API ArmLegsRates arm_legs_rates(const ArmLegs& robot, ArmLegsWorkspace& work);

/// Tensions that hold the platform at a target.
struct ArmLegsInverse {
  Report report;       ///< its residual is what the platform is off: place over the longest leg, angle [rad]
  ArmLegsState state;  ///< with tensions, and the changes for motors that hold those
};
/// Tensions ≥ 0 that hold the platform at a target. What they are free in goes into the least sum of their
/// squares, of those nearby: there may be less elsewhere.
/// `unreachable`: the nearest that was found is in `state`.
/// @param target of the platform's reference point and axes; what is not given is free
SINEW_API ArmLegsInverse arm_legs_inverse(const ArmLegs& robot, const ArmTarget& target,
                                          const ArmLegsLoad& load, const ArmInverseOptions& options,
                                          ArmLegsWorkspace& work);

/// What is measured of a platform on arms; what is not a number is not known.
struct ArmLegsMeasurement {
  std::vector<TendonCommand> held = {};  ///< of every tendon, taken as exact
  std::vector<double> answers = {};      ///< of every tendon what is not held: tension [N] or change [m]
  std::optional<std::array<double, 3>> position = {};    ///< of the platform, base axes [m]
  std::optional<std::array<double, 4>> quaternion = {};  ///< of its axes, [w, x, y, z] [1]
  double tension_deviation = 0.05;                       ///< standard deviation of tensions [N]
  double change_deviation = 2e-5;                        ///< of changes [m]
  double position_deviation = 5e-4;                      ///< of a coordinate of the position [m]
  double angle_deviation = 5e-3;                         ///< of the axes about each of them [rad]
};
/// A wrench on the platform that explains what was measured.
struct ArmLegsSensed {
  Report report;                        ///< `singular` where the measurement does not tell
  std::array<double, 6> wrench{};       ///< beside weight and load, base axes [N, N m]
  std::array<double, 36> covariance{};  ///< of it; of a force alone the moment's part is 0 [N², N² m, N² m²]
  /// Root mean square of what stays, in standard deviations [1]; not a number where nothing was compared.
  double misfit = not_a_number;
  /// How much better the best known direction of the wrench is known than the worst, moments over the longest
  /// leg [1].
  double condition = 0;
  ArmLegsState state;
};
/// Where the pose is known exactly, arm_legs_hold() tells the wrench at once.
/// @param force_alone no moment is looked for
SINEW_API ArmLegsSensed arm_legs_sense(const ArmLegs& robot, const ArmLegsMeasurement& measured,
                                       const ArmLegsLoad& load, bool force_alone, const ArmOptions& options,
                                       ArmLegsWorkspace& work);

/// What a path comes to.
struct ArmLegsStep {
  std::vector<TendonCommand> commands = {};  ///< of every tendon; of a step to a pose they do not count
  ArmLegsLoad load = {};
  std::optional<SE3<double>> pose = {};  ///< which tensions hold, each row with the least [m]
  int divisions =
      1;  ///< into how many equal parts the way to it is divided, ≥ 1; each has a point of its own
};
/// From the equilibrium with nothing pulled, under the first step's weight without its wrench, or where
/// `options.arm.from_last` says so from the last one: to each step inputs, loads and a pose change evenly. A
/// point for every division; the answer ends with the first that was not reached, whose report says why and
/// whose state is the last on the way there.
SINEW_API std::vector<ArmLegsState> arm_legs_track(const ArmLegs& robot, std::span<const ArmLegsStep> steps,
                                                   const ArmInverseOptions& options, ArmLegsWorkspace& work);

/// Where a growing load ended.
struct ArmLegsLoadPath {
  ArmLegsState state;  ///< the last equilibrium that holds, with the load that was reached
  double load = 0;     ///< factor of the direction that was reached [1]
  LoadEnd end = LoadEnd::stalled;
  double definite_until = -1;  ///< see LoadPath [1]
};
/// Adds `direction` times a growing factor to the wrench of the equilibrium in the workspace, up to `limit`,
/// or to where it gives way; at the polynomials that it was found with. Where there is none, or its stiffness
/// is not finite, the end is `stalled` at 0.
SINEW_API ArmLegsLoadPath arm_legs_follow_load(const ArmLegs& robot, const std::array<double, 6>& direction,
                                               double limit, ArmLegsWorkspace& work);

/// The arm of a leg in the shape of the equilibrium, for arm_frames, arm_strains and arm_tendon_lines, in
/// base axes.
SINEW_API const ArmWorkspace& arm_legs_shape(const ArmLegsWorkspace& work, std::size_t leg);

}  // namespace sinew::inline v1
