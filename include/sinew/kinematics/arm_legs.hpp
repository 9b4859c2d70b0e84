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

/// What acts on the platform beside its weight.
struct ArmLegsLoad {
  std::array<double, 6> wrench{};  ///< on the platform, about its reference point, base axes [N, N m]
  std::optional<std::array<double, 3>> gravity = {};  ///< in place of the robot's [m/s²]
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
  double energy = 0;      ///< elastic, of weight, of the load's force and of tendons that stretch [J]
  double resolution = 0;  ///< by how much tips move with finer polynomials [m]; 0: not asked for
  double reached = 0;     ///< share of inputs and loads up to which there was an equilibrium that holds [1]
};

/// The equilibrium into which the rest grows as inputs and loads do, together from nothing.
/// `bad_input`: commands of another number, a tension below 0. `unsupported`: what is not built for legs.
/// `stalled`: up to `reached` of inputs and loads there was an equilibrium that holds, and beyond none was
/// found: it may have given way.
/// @param commands of every tendon, those of leg 0 first, in it those of the first section first
SINEW_API const ArmLegsState& arm_legs_forward(const ArmLegs& robot, std::span<const TendonCommand> commands,
                                               const ArmLegsLoad& load, const ArmOptions& options,
                                               ArmLegsWorkspace& work);

/// Derivatives of an equilibrium, its platform's twist in base axes, linear first [m, rad].
struct ArmLegsRates {
  bool regular = false;                ///< the platform's stiffness is finite and not singular
  std::array<double, 36> stiffness{};  ///< wrench by twist, inputs held, rows first [N/m, N, N m]
  std::vector<double> J;               ///< twist by what is held of every tendon, 6 rows [m/N or 1]
};
/// Of the equilibrium in the workspace.
SINEW_API ArmLegsRates arm_legs_rates(const ArmLegs& robot, ArmLegsWorkspace& work);

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
