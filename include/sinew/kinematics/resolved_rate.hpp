/// @file resolved_rate.hpp
/// Rates of bends and tendons that move a serial robot's tip as commanded, within the limits of its sections.
/// Theory: docs/theory/serial_inverse.md
#pragma once
#include <vector>

#include "sinew/kinematics/serial.hpp"

namespace sinew::inline v1 {

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
/// `max_sections` sections.
SINEW_API ResolvedRate resolved_rate(const SerialRobot& robot, std::span<const Bend> bends,
                                     const TipTwist& twist, const ResolvedRateOptions& options,
                                     SerialWorkspace& work);

}  // namespace sinew::inline v1
