/// Loads on platforms on chains that grow until they cannot.
#include <algorithm>
#include <cmath>

#include "kinematics/chains/path.hpp"
#include "kinematics/load_problem.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {

std::string_view to_string(ChainLoadEnd end) noexcept {
  constexpr std::string_view names[] = {"limit", "fold", "bifurcation", "slack", "iterations", "stability"};
  return names[static_cast<std::size_t>(end)];
}

template <class Space>
ChainLoadPath follow_load(const ChainLegs<Space>& robot, const Vec<double, Space::dof>& direction,
                          double limit, ChainState<Space>& state, ChainWork& work,
                          const ChainOptions& options) {
  ChainLoadPath path;
  if (!fits(robot, state)) {
    path.report.status = Status::bad_input;
    path.report.message.append("the state is of another robot");
    return path;
  }
  if (!direction.allFinite() || std::isnan(limit)) {
    path.report.status = Status::bad_input;
    path.report.message.append("the direction of the load, or its limit, is not a number");
    return path;
  }
  path.report = check_hold(robot, state.hold);
  if (!path.report.ok()) return path;
  auto& memory = memory_of(work, robot, state, options);
  auto& group = memory.group;
  group.evaluate();
  group.linearise();
  check_regularity(regularity(group), path.report);
  if (!path.report.ok()) return path;
  if (!(limit > 0) || direction.isZero(0)) {  // nothing grows
    path.load = std::max(limit, 0.0);
    return path;
  }
  const GrownLoad grown = grow_load<Space>(group, memory.places, direction, limit, work.stop,
                                           {.iterations = options.max_iterations});
  using End = ChainLoadEnd;
  constexpr End ends[] = {End::limit, End::fold, End::bifurcation, End::stability,
                          End::slack, End::fold, End::iterations,  End::iterations};
  path.end = ends[static_cast<int>(grown.end)];
  path.load = grown.load;
  group.measure();
  state = group.state();
  path.report.residual = group.evaluate() * group.radius();
  path.report.iterations = grown.iterations;
  if (!note_stop(work.stop, path.report) && grown.end == GrowthEnd::ran_out) {
    path.report.status = Status::iteration_limit;
    path.report.message.append("the iterations ran out before the load stopped growing");
  }
  return path;
}

#define SINEW_OF(Space)                                                                               \
  template ChainLoadPath follow_load(const ChainLegs<Space>&, const Vec<double, Space::dof>&, double, \
                                     ChainState<Space>&, ChainWork&, const ChainOptions&);
SINEW_OF(Planar)
SINEW_OF(Spatial)
#undef SINEW_OF

}  // namespace sinew::inline v1
