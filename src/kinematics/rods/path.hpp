/// @file path.hpp
/// Following an equilibrium of rods while lengths and wrench change together: from a state that is in
/// equilibrium under some wrench to the one that is asked for. Theory: docs/theory/rod_robot.md
#pragma once
#include <limits>

#include "kinematics/load_problem.hpp"
#include "robot/rods/rod_group.hpp"
#include "sinew/solve/report.hpp"
#include "solve/continuation.hpp"

namespace sinew::inline v1 {

/// Where a path leads: a length a rod, an input of each closing leg, and the wrench on the platform.
struct RodTarget {
  std::array<double, max_rods> lengths{};
  Vec<double, 6> wrench = Vec<double, 6>::Zero();
};

/// What counts as solved of a pose held by lengths, in an answer that is to be quick.
inline constexpr double rod_quick_tolerance = 1e-10;

struct RodPathOptions {
  double tolerance = rod_tolerance;
  int max_iterations = 4000;  ///< Newton steps of the whole path
  StopToken stop = {};
  bool may_stray = false;  ///< onto other curves: where any equilibrium at the target will do
};

/// How a path ended.
struct RodPathEnd : ParameterPath {  ///< iterations: Newton steps
  double residual = std::numeric_limits<double>::infinity();
};

/// At fixed lengths and wrench, pose and rods together.
bool correct(RodGroup& system, int& iterations, double& residual, double tolerance = rod_tolerance);

/// From the state of `system`, which must be in equilibrium and linearised, to `target`. Afterwards the
/// system is at the last equilibrium found, linearised there. `spare` is memory.
RodPathEnd follow(RodGroup& system, const RodTarget& target, const RodPathOptions& options, LimbState& spare);

/// What the system is now, as a target.
RodTarget present(const RodGroup& system);

}  // namespace sinew::inline v1
