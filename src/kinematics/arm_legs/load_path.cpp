/// A load on the platform that grows until the equilibrium is no longer stable.
#include <algorithm>

#include "kinematics/arm_legs/legs_work.hpp"
#include "kinematics/load_problem.hpp"

namespace sinew::inline v1 {
namespace {

/// Newton's steps of a whole load path [1]: so many that something else ends it.
constexpr int most_path_iterations = 100000;

}  // namespace

ArmLegsLoadPath arm_legs_follow_load(const ArmLegs& robot, const std::array<double, 6>& direction,
                                     double limit, ArmLegsWorkspace& work) {
  ArmLegsWorkspace::Impl& impl = work.impl();
  ArmLegsLoadPath path;
  path.state = impl.state;
  ArmGroup::Wrench load;
  std::copy(direction.begin(), direction.end(), load.begin());
  if (!impl.has_last() || !load.allFinite() || load.isZero(0) || !(limit > 0)) return path;
  if (robot.is_planar && !load.segment<3>(2).isZero(0)) return path;
  ArmGroup& group = impl.group();
  group.evaluate();
  if (!group.linearise()) return path;
  auto places = places_of<Spatial>(group);
  const GrownLoad grown =
      grow_load<Spatial>(group, places, load, limit, work.stop, {.iterations = most_path_iterations});
  constexpr LoadEnd ends[] = {LoadEnd::limit, LoadEnd::fold,    LoadEnd::bifurcation, LoadEnd::stability,
                              LoadEnd::limit, LoadEnd::stalled, LoadEnd::iterations,  LoadEnd::stopped};
  path.end = ends[static_cast<int>(grown.end)];
  path.load = grown.load;
  path.definite_until = grown.definite_until;
  impl.state.report.residual = group.evaluate();
  impl.state.report.iterations += grown.iterations;
  write_legs_state(robot, group, impl.state);
  path.state = impl.state;
  return path;
}

}  // namespace sinew::inline v1
