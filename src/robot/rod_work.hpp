/// @file rod_work.hpp
/// What a workspace keeps for a robot of rods.
#pragma once
#include <variant>

#include "robot/rod_systems.hpp"
#include "sinew/robot/workspace.hpp"

namespace sinew::inline v0 {

/// One state on a curve of equilibria, to come back to.
/// @tparam System one of rod_systems.hpp
template <class System>
struct RodPlace {
  typename System::Snapshot state;
  double lambda = 0;                                ///< parameter of the curve
  Vec<double, 7> tangent = Vec<double, 7>::Zero();  ///< unit, see Tracer
};

/// @tparam System one of rod_systems.hpp
template <class System>
struct RodWorkOf {
  explicit RodWorkOf(const SpatialRobot& robot, const Vec3<double>& gravity = Vec3<double>::Zero())
      : system(robot),
        home(system.snapshot()),
        before(home),
        spare(home),
        places{RodPlace<System>{home}, RodPlace<System>{home}, RodPlace<System>{home},
               RodPlace<System>{home}} {
    if constexpr (requires { system.set_gravity(gravity); }) system.set_gravity(gravity);
  }

  System system;
  typename System::Snapshot home, before, spare;
  std::array<RodPlace<System>, 4> places;  ///< memory of whoever follows a curve by its arc length
  StopToken stop;                          ///< that of the workspace
  bool knows_home = false;                 ///< `home` is in equilibrium
  bool is_solved = false;                  ///< `system` is in equilibrium and linearised there
  Lu6 feeding;  ///< factors of what the inputs do to the wrench, of the last pose that was held
  bool knows_feeding = false;
};

/// Rods that bend in one plane each, without weight ...
using RodWork = RodWorkOf<Mechanism<RodSystem>>;
/// ... others without torque, and all others.
using TangentWork = RodWorkOf<Mechanism<TangentSystem>>;
using GeneralWork = RodWorkOf<Mechanism<GeneralSystem>>;

/// What a workspace keeps of rods: of the quickest kind that holds for all of them.
struct RodWorks {
  explicit RodWorks(const Robot& robot);  ///< of a robot that bears load
  std::variant<RodWork, TangentWork, GeneralWork> kind;
};

/// Calls `use(rods)` with a RodWorkOf, of whichever kind it is, that stops as the workspace does.
template <class Use>
decltype(auto) with_rods(Workspace& work, Use&& use) {
  return std::visit(
      [&]<class System>(RodWorkOf<System>& rods) -> decltype(auto) {
        rods.stop = work.stop;
        return use(rods);
      },
      work.rods->kind);
}

}  // namespace sinew::inline v0
