/// @file solve.hpp
/// The questions put to rods, in terms of their system alone: equilibrium.hpp is their public face.
#pragma once
#include <optional>

#include "kinematics/rods/path.hpp"
#include "robot/rods/rod_work.hpp"
#include "sinew/base/numbers.hpp"

namespace sinew::inline v1 {

/// What is asked; see EquilibriumOptions.
struct RodQuestion {
  Vec<double, 6> wrench = Vec<double, 6>::Zero();
  std::optional<SE3<double>> start = {};
  bool warm_start = false;
  int max_iterations = 4000;
  bool check_stability = true;  ///< stability and resolution of a resumed answer too
  bool may_stray = false;       ///< see RodPathOptions
};

/// Brings the system to rest at these inputs.
Report solve_rods(RodWork& work, const SE3<double>& home, Numbers inputs, const RodQuestion& question);

}  // namespace sinew::inline v1
