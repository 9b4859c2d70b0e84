/// @file rod_work.hpp
/// What a workspace keeps for a robot of rods.
#pragma once
#include "robot/tangent_system.hpp"

namespace sinew::inline v0 {

/// @tparam System RodSystem or TangentSystem
template <class System>
struct RodWorkOf {
  explicit RodWorkOf(const ParallelRobot<RodLeg>& robot)
      : system(robot),
        home(system.snapshot()),
        before(home),
        spare(home) {}

  System system;
  typename System::Snapshot home, before, spare;
  bool knows_home = false;  ///< `home` is in equilibrium
  bool is_solved = false;   ///< `system` is in equilibrium and linearised there
  Lu6 feeding;              ///< factors of what the inputs do to the wrench, of the last pose that was held
  bool knows_feeding = false;
};

/// Rods that bend in one plane each ...
struct RodWork : RodWorkOf<RodSystem> {
  using RodWorkOf::RodWorkOf;
};
/// ... and others.
struct TangentWork : RodWorkOf<TangentSystem> {
  explicit TangentWork(const ParallelRobot<RodLeg>& robot, const Vec3<double>& gravity = Vec3<double>::Zero())
      : RodWorkOf(robot) {
    system.set_gravity(gravity);
  }
};

}  // namespace sinew::inline v0
