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
  template <class Robot>
  explicit RodWorkOf(const Robot& robot)
      : system(robot),
        home(system.snapshot()),
        before(home),
        spare(home),
        places{RodPlace<System>{home}, RodPlace<System>{home}, RodPlace<System>{home},
               RodPlace<System>{home}} {}

  System system;
  typename System::Snapshot home, before, spare;
  std::array<RodPlace<System>, 4> places;  ///< memory of whoever follows a curve by its arc length
  StopToken stop;                          ///< that of the workspace
  bool knows_home = false;                 ///< `home` is in equilibrium
  bool is_solved = false;                  ///< `system` is in equilibrium and linearised there
  Lu6 feeding;  ///< factors of what the inputs do to the wrench, of the last pose that was held
  bool knows_feeding = false;
};

/// The rods of a robot alone, in the order of its legs; their places are those in the whole robot. Allocates.
ParallelRobot<RodLeg> rods_of(const AnyRobot& robot);

/// Rods that bend in one plane each ...
struct RodWork : RodWorkOf<RodSystem> {
  using RodWorkOf::RodWorkOf;
};
/// ... and others, which may be heavy.
template <class System>
struct HeavyWork : RodWorkOf<System> {
  template <class Robot>
  explicit HeavyWork(const Robot& robot, const Vec3<double>& gravity = Vec3<double>::Zero())
      : RodWorkOf<System>(robot) {
    this->system.set_gravity(gravity);
  }
};
using TangentWork = HeavyWork<TangentSystem>;  ///< without torque
using GeneralWork = HeavyWork<GeneralSystem>;
using MixedWork = HeavyWork<MixedSystem<TangentSystem>>;  ///< with closing legs beside them
using MixedGeneralWork = HeavyWork<MixedSystem<GeneralSystem>>;

/// The closing legs of a robot.
std::vector<ClosingLeg> closing_legs_of(const AnyRobot& robot);

/// What a workspace keeps of rods: of the quickest kind that holds for all of them.
struct RodWorks {
  explicit RodWorks(const AnyRobot& robot);  ///< of a robot that bears load
  std::variant<RodWork, TangentWork, GeneralWork, MixedWork, MixedGeneralWork> kind;
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
