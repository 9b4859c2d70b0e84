/// @file rod_work.hpp
/// What a workspace keeps for a robot of rods.
#pragma once
#include <memory>

#include "robot/rod_group.hpp"
#include "sinew/robot/workspace.hpp"

namespace sinew::inline v0 {

/// The rods of a robot that bears load, with the legs that close beside them: of the quickest kind that holds
/// for all of them.
std::unique_ptr<RodGroup> rod_group(const Robot& robot);

/// One state on a curve of equilibria, to come back to.
struct RodPlace {
  struct State {
    LimbState limbs;
    SE3<double> platform;
  };
  State state;
  double lambda = 0;                                ///< parameter of the curve
  Vec<double, 7> tangent = Vec<double, 7>::Zero();  ///< unit, see Tracer
};

struct RodWork {
  explicit RodWork(std::unique_ptr<RodGroup> rods) : system(std::move(rods)) {
    for (RodPlace& place : places) place.state = {system->state(), system->platform()};
  }

  std::unique_ptr<RodGroup> system;
  LimbState home = system->state(), before = system->state(), spare = system->state();
  std::array<RodPlace, 4> places;  ///< memory of whoever follows a curve by its arc length
  StopToken stop;                  ///< that of the workspace
  bool knows_home = false;         ///< `home` is in equilibrium
  bool is_solved = false;          ///< `system` is in equilibrium and linearised there
  SmallLu<6> feeding;  ///< factors of what the inputs do to the wrench, of the last pose that was held
  bool knows_feeding = false;
};

/// Those of a workspace, which stop as it does.
inline RodWork& rods_of(Workspace& work) {
  work.rods->stop = work.stop;
  return *work.rods;
}

}  // namespace sinew::inline v0
