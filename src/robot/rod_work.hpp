/// @file rod_work.hpp
/// What a workspace keeps for a robot of rods.
#pragma once
#include "robot/rod_system.hpp"

namespace sinew::inline v0 {

struct RodWork {
  explicit RodWork(const ParallelRobot<RodLeg>& robot)
      : system(robot),
        home(system.snapshot()),
        before(home),
        spare(home) {}

  RodSystem system;
  RodSystem::Snapshot home, before, spare;
  bool knows_home = false;  ///< `home` is in equilibrium
  bool is_solved = false;   ///< `system` is in equilibrium and linearised there
};

}  // namespace sinew::inline v0
