/// @file path.hpp
/// Following an equilibrium of rods while lengths and wrench change together: from a state that is in
/// equilibrium under some wrench to the one that is asked for. Theory: docs/theory/rod_robot.md
#pragma once
#include <limits>

#include "robot/rod_systems.hpp"
#include "sinew/solve/report.hpp"
#include "solve/continuation.hpp"

namespace sinew::inline v0 {

/// Estimated error of a shape at its tip, over the length, from which a path and a resumed answer take the
/// fine nodes.
inline constexpr double coarse_truncation = 1e-12;

/// Where a path leads: a length a rod, an input of each closing leg, and the wrench on the platform.
struct RodTarget {
  std::array<double, max_rods> lengths{};
  Vec<double, 6> wrench = Vec<double, 6>::Zero();
};

/// From pose to pose as one twist.
inline Vec<double, 6> between(const SE3<double>& from, const SE3<double>& to) {
  Vec<double, 6> twist;
  twist << to.p - from.p, to.R.compose(from.R.inverse()).log();
  return twist;
}

/// On RodSystem::evaluate: what counts as solved, and below which Newton's method can only lose to rounding.
inline constexpr double rod_tolerance = 1e-12, rod_rounding = 2e-13;
/// ... of a pose held by lengths, in an answer that is to be quick.
inline constexpr double rod_quick_tolerance = 1e-10;

struct RodPathOptions {
  double tolerance = rod_tolerance;
  int max_iterations = 4000;  ///< Newton steps of the whole path
  StopToken stop = {};
  bool may_stray = false;  ///< onto other curves: of whoever looks for any equilibrium at the target
};

/// How a path ended.
struct RodPathEnd : ParameterPath {  ///< iterations: Newton steps
  double residual = std::numeric_limits<double>::infinity();
};

/// At fixed lengths and wrench, pose and rods together ...
/// @tparam System RodSystem, TangentSystem or GeneralSystem
template <class System>
bool correct(System& system, int& iterations, double& residual, double tolerance = rod_tolerance);
/// ... or the rods alone, the platform held.
template <class System>
bool correct_rods(System& system, int& iterations, double& residual, double tolerance);

/// From the state of `system`, which must be in equilibrium and linearised, to `target`. Afterwards the
/// system is at the last equilibrium found, linearised there. `spare` is memory.
template <class System>
RodPathEnd follow(System& system, const RodTarget& target, const RodPathOptions& options,
                  typename System::Snapshot& spare);

/// What the system is now, as a target.
template <class System>
RodTarget present(const System& system);

/// What does not change on a smooth piece of a curve of equilibria, at fixed inputs and load.
struct RodSigns {
  int unstable = 0;     ///< directions of the whole robot
  int own = 0;          ///< ... of its rods, tips held; as `unstable` has them
  bool is_odd = false;  ///< the sign of the determinant of the whole, rods and platform
  bool operator==(const RodSigns& other) const {
    return unstable == other.unstable && is_odd == other.is_odd;
  }
};
template <class System>
RodSigns signs_of(const System& system);

/// Unstable directions of the whole robot: the second variation with every rod free to move. After
/// `linearise`.
template <class System>
int unstable_directions(const System& system);

/// Every rod as it rests at a pose that nothing but the joints' side forces holds: the length at which it
/// neither pulls nor pushes, along its guide or, of those that do not bend in one plane, along the line to
/// its tip. False where a rod's tip lies on its guide's line or behind it.
bool rest_at(RodSystem& system, const SE3<double>& platform);
bool rest_at(TangentSystem& system, const SE3<double>& platform);
bool rest_at(GeneralSystem& system, const SE3<double>& platform);
/// ... with the inputs that close the other legs. False also where one cannot be closed.
template <class Rods>
bool rest_at(Mechanism<Rods>& system, const SE3<double>& platform);

}  // namespace sinew::inline v0
