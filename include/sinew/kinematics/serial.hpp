/// @file serial.hpp
/// Kinematics of serial robots: bends to tendon changes and back, bends to poses and their derivatives, the
/// bends that bring the tip to a target, the rates that move it. Nothing here allocates but a batch of fewer
/// poses than lanes: a workspace holds what answers are read from. Theory: docs/theory/section.md,
/// docs/theory/serial_inverse.md
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "sinew/base/export.hpp"
#include "sinew/base/numbers.hpp"
#include "sinew/robot/serial.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// Makes the sections longer than at rest by so much [m]: all other questions to this workspace are about a
/// robot of these lengths, with tendon changes from those of the straight robot at rest.
/// Values of another number of sections, here and below, make what is answered NaN.
SINEW_API void set_extensions(const SerialRobot& robot, std::span<const double> extensions,
                              SerialWorkspace& work);

/// Changes of all tendons [m], > 0 pays out, at these bends [rad], one a section, into `work.changes`, in one
/// pass over the sections (LSK (5), (12)).
SINEW_API void tendon_changes(std::span<const Bend> bends, kernel::Model model, SerialWorkspace& work);

/// The same of many poses at once, in SIMD lanes: `bends` [rad] is 2M rows (x of section 0, its y, x of
/// section 1, ...), `changes` [m] a row for each tendon, both with one number a pose. Bends that are not
/// finite give changes that are not. The last bits of a pose may depend on those computed beside it, and on
/// the processor.
SINEW_API void tendon_changes_batch(std::span<const double> bends, kernel::Model model,
                                    std::span<double> changes, const SerialWorkspace& work);

/// What all sections of the workspace ask of a tendon that passes them, at these bends [rad]: pull towards x
/// and y, and what all have in common [m].
SINEW_API kernel::Pull<double> pull_of_all(std::span<const Bend> bends, kernel::Model model,
                                           const SerialWorkspace& work);

/// Adds to the changes of all tendons of each section what `more` says of it [m]: > 0 leaves the section
/// slack by as much, as for a fast move; < 0 stiffens it, at most by what the tendons bear. Later sections
/// have tendons of their own. [LSK] section 4.1: exact, or slightly over-tensioned, at rest.
SINEW_API void add_slack(std::span<const double> more, SerialWorkspace& work);

/// Bends that come nearest to what the tendons did, in least squares for each section, into `work.bends`, and
/// what every tendon then has too much (> 0: slack) or too little (< 0: over-tensioned) into `work.slack`.
/// What the tendons of a section of variable length have in common is its extension, within its limits, into
/// `work.extensions`.
///
/// Not converged, with `work.bends` the nearest there is: `unreachable` where a joint would bend by more than
/// half a turn, or where tendons contradict one another by more than the robot's tolerance (over-tensioned);
/// `left_domain` where a section would bend beyond its limit; `slack` where a tendon is longer by more than
/// the tolerance. The message names section and tendon. Theory: [LSK] section 4.1.
SINEW_API Report bends_of_changes(const SerialRobot& robot, Numbers changes, kernel::Model model,
                                  SerialWorkspace& work);

/// `left_domain` and which section it is, where a bend [rad], or an extension [m] if they are given, is
/// beyond its section's limit by more than rounding.
SINEW_API Report check_limits(const SerialRobot& robot, std::span<const Bend> bends,
                              std::span<const double> extensions = {});

/// What a tendon may be off before it counts as slack or over-tensioned [m]: the robot's tolerance, at least
/// rounding.
SINEW_API double tendon_tolerance(const SerialRobot& robot);

/// Pose of every section's end in the base's frame [m], z distal, into `work.ends`, at these bends [rad].
SINEW_API void section_ends(std::span<const Bend> bends, SerialWorkspace& work);

/// The same with the tip's Jacobian in `work.J`: 6 × 2M, twist in base axes per bend rate [m], [1].
SINEW_API void tip_motion(std::span<const Bend> bends, SerialWorkspace& work);

/// How the last section has to bend so that the tip's axis turns towards the tip's own x and y, as one steers
/// by the picture of a camera in the tip: its bend rate [rad/s] is this times the rates of the two turns
/// [rad/s]. After `tip_motion`.
/// @return nothing where no bend turns the axis some way, as of a section bent by half a turn
SINEW_API std::optional<Mat<double, 2, 2>> tip_steering(const SerialWorkspace& work);

/// ∂(changes)/∂(bends) [m/rad] into `work.K`: tendons × 2M.
SINEW_API void tendon_rates(std::span<const Bend> bends, kernel::Model model, SerialWorkspace& work);

/// What extensions do [m/m], into `work.extension_jacobians`; after `section_ends` or `tip_motion` of the
/// same bends.
SINEW_API void extension_motion(std::span<const Bend> bends, kernel::Model model, SerialWorkspace& work);

/// Where the tip is wanted, in the base's frame. Of `direction` and `rotation` at most one.
struct TipTarget {
  Vec3<double> position;                       ///< [m]
  std::optional<Vec3<double>> direction = {};  ///< of the tip's z axis, of any length but 0: no unit
  std::optional<SO3<double>> rotation = {};    ///< of the tip, a unit quaternion
};

/// Where the search begins and ends.
struct SerialInverseOptions {
  /// [rad], tried first, brought within the limits; empty: the straight robot
  std::span<const Bend> start = {};
  /// Of the sections [m], with it; empty: their lengths at rest
  std::span<const double> start_extensions = {};
  int starts = 128;          ///< others tried after it, at most: a fixed set spread over the limits
  int max_iterations = 100;  ///< of each start
  double tolerance = 1e-12;  ///< on the residual, as a share of the robot's length
};

/// A target has finitely many solutions or a continuum of them; this is the one that `start` leads to: near
/// it where there is one near it, but in general not the nearest.
struct SerialInverse {
  /// Residual: the larger of position error and, times the robot's length, angle error [m].
  Report report;
  std::span<const Bend> bends;         ///< [rad], within the limits, view into the workspace
  std::span<const double> extensions;  ///< of the sections [m], within the limits, view into the workspace
  double position_error = 0;           ///< [m]
  double angle_error = 0;              ///< of the direction or the rotation, where one was wanted [rad]
  int start = 0;                       ///< which start led here: 0 the first, k the k-th of the fixed set

  /// `report.ok()`: converged.
  bool ok() const noexcept { return report.ok(); }
};

/// Damped least squares within the limits of every section, from one start after the other until one
/// converges. No heap, no throw, bounded work, and the same answer to the same question always.
///
/// Not converged, with the nearest bends found: `unreachable` where the target lies farther away than the
/// robot can be long; else `stalled` or `iteration_limit`, as the best start ended: none of the starts led to
/// the target, which may be out of reach for all that is known. `work.bends`, `work.extensions`, `work.ends`
/// and `work.J` are those of the answer. At most 12 sections.
SINEW_API SerialInverse inverse(const SerialRobot& robot, const TipTarget& target,
                                const SerialInverseOptions& options, SerialWorkspace& work);

/// Motion of the tip: velocity of its origin [m/s] and angular velocity [rad/s].
struct TipTwist {
  Vec3<double> linear = Vec3<double>(0, 0, 0);   ///< [m/s]
  Vec3<double> angular = Vec3<double>(0, 0, 0);  ///< [rad/s]
};

/// Whose axes the twist is given in; it is always that of the tip's origin.
enum class TipFrame { base, tip };
/// What of the twist counts: the linear part; turns of the tip's axis too; all.
enum class TipTask { position, axis, whole };

/// What counts, and what the robot may do.
struct ResolvedRateOptions {
  TipFrame frame = TipFrame::base;
  TipTask task = TipTask::whole;
  /// What is given up near singular shapes: motions whose square is below this share of Σ of the squares of
  /// the Jacobian, in shares of the robot's length and rad per rad a section turns. ≥ 1e-12.
  double damping = 1e-9;
  double fastest = std::numeric_limits<double>::infinity();  ///< a section may turn about either axis [rad/s]
  double tolerance = 1e-6;  ///< what may be missed and still count as followed, as a share of the twist
  kernel::Model model = kernel::Model::exact;  ///< of the tendons
};

/// Rates that move the tip, section by section.
struct ResolvedRate {
  /// `left_domain` where limits, or `fastest`, keep the tip from following; `singular` where the shape does;
  /// the rates are then those that come nearest. Residual: what is missed, the larger of velocity and, times
  /// the robot's length, angular velocity [m/s]. Its iterations are 0.
  Report report;
  std::span<const double> bends;       ///< [rad/s], two a section; view of `work.bend_rates`
  std::span<const double> extensions;  ///< [m/s], one a section; view of `work.extension_rates`
  std::span<const double> tendons;     ///< of Δl [m/s], > 0 pays out; view of `work.tendon_rates`
  int held = 0;  ///< bends' components, and extensions, that a limit, or `fastest`, holds

  /// `report.ok()`: converged.
  bool ok() const noexcept { return report.ok(); }
};

/// The slowest rates that give the tip this twist, in least squares; a section at its limit does not turn
/// further outwards, nor lengthen. `bends` [rad], one a section, and the extensions in `work`, are within the
/// limits. Leaves the tip's Jacobian in `work.J`, the tendons' in `work.K`. No heap, no throw. At most
/// 12 sections.
SINEW_API ResolvedRate resolved_rate(const SerialRobot& robot, std::span<const Bend> bends,
                                     const TipTwist& twist, const ResolvedRateOptions& options,
                                     SerialWorkspace& work);

}  // namespace sinew::inline v1
