/// @file rod_solve.hpp
/// The questions put to rods, in terms of their system alone: equilibrium.hpp is their public face.
#pragma once
#include <optional>

#include "kinematics/rod_path.hpp"
#include "robot/rod_work.hpp"
#include "sinew/base/numbers.hpp"

namespace sinew::inline v0 {

/// What is asked; see EquilibriumOptions.
struct RodQuestion {
  RodSystem::Wrench wrench = RodSystem::Wrench::Zero();
  std::optional<SE3<double>> start = {};
  bool resume = false;
  int max_iterations = 4000;
  bool judge = true;  ///< stability and resolution of a resumed answer too
};

/// Brings the system to rest at these inputs.
Report solve_rods(RodWork& work, const SE3<double>& home, Numbers inputs, const RodQuestion& question);

/// Coordinates a robot with three inputs can be asked for.
struct RodCoordinates {
  double z, e1, e2;
};

/// Brings the system to rest at these coordinates; lengths and the other coordinates follow.
Report solve_rods_at(RodWork& work, const SE3<double>& home, const RodCoordinates& wanted,
                     const RodQuestion& question);

/// Lays the rods to a pose at these lengths and finds the wrench that holds them so; false where a rod cannot
/// be laid, the state is then at rest with lengths of its own. See rest_at for what it needs.
bool lay_rods(RodWork& work, const SE3<double>& pose, Numbers inputs);

}  // namespace sinew::inline v0
