/// @file arm_load_path.hpp
/// A load on an arm's tip that grows until the arm no longer holds: buckling and snap-through. Theory:
/// docs/theory/strain_rod.md
#pragma once
#include <array>
#include <span>

#include "sinew/base/export.hpp"
#include "sinew/kinematics/arm.hpp"
#include "sinew/kinematics/equilibrium.hpp"

namespace sinew::inline v1 {

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

}  // namespace sinew::inline v1
