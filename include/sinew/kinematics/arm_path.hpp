/// @file arm_path.hpp
/// An arm followed along a path of inputs and loads: tendons rub at discs or in channels (Coulomb), so that
/// where the arm is depends on how it came there. Theory: docs/theory/tendon_friction.md
#pragma once
#include <array>
#include <span>
#include <vector>

#include "sinew/base/export.hpp"
#include "sinew/kinematics/arm.hpp"

namespace sinew::inline v1 {

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
