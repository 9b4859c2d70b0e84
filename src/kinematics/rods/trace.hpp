/// @file trace.hpp
/// A curve of equilibria followed by its arc length: through folds, where no path along the parameter goes
/// on. Theory: docs/theory/rod_robot.md
#pragma once
#include <vector>

#include "kinematics/rods/solve.hpp"
#include "sinew/kinematics/equilibrium_curve.hpp"

namespace sinew::inline v1 {

/// What changes along a curve, linearly in its parameter λ: 0 where it begins, 1 at `target`.
struct RodWay {
  RodTarget begin, target;
  bool holds_pose = false;  ///< the platform goes a given way and the lengths, all free, hold it there
  SE3<double> from, to;     ///< of the platform, where it is held

  RodTarget at(double parameter, int rods) const;  ///< the lengths only where the pose is free
  SE3<double> pose(double parameter) const;
};

/// From the system's state, in equilibrium and linearised at λ = 0. Afterwards the system is at the last
/// point.
std::vector<EquilibriumCurve> trace_rods(RodWork& work, const RodWay& way, const CurveOptions& how);

/// Where the parameter turns back.
struct RodFold {
  bool is_found = false;
  bool arrived = false;  ///< at λ = 1, without one
  double parameter = 0, residual = 0;
  SE3<double> platform;
};

/// From a state at `parameter` on by arc length, to where λ turns back or is 1. The system stays where it was
/// unless it arrived.
RodFold find_fold(RodWork& work, const RodWay& way, double parameter);

/// From there on, through the fold, to λ = 1 on another branch, if the curve leads there before long. If not,
/// the system stays where it was.
bool pass_fold(RodWork& work, const RodWay& way, double parameter);

}  // namespace sinew::inline v1
