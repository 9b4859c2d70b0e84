/// @file serial.hpp
/// Kinematics of serial robots: bends to tendon changes and back, bends to poses and their derivatives.
/// Nothing here allocates but a batch of fewer poses than lanes: a workspace holds what answers are read
/// from. Theory: docs/theory/section.md
#pragma once
#include <optional>
#include <span>

#include "sinew/base/export.hpp"
#include "sinew/base/numbers.hpp"
#include "sinew/robot/serial_workspace.hpp"
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

}  // namespace sinew::inline v1
