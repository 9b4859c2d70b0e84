/// All solutions of chains that are found.
#include "query/chains/chain_solutions.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kinematics/chain_equilibria.hpp"
#include "sinew/kinematics/forward.hpp"

namespace sinew::inline v1::chains {
namespace {

constexpr double max_inverses = 256;

template <class Space>
Value solution_value(Value begun, const ChainLegs<Space>& robot, const FoundChains<Space>& one) {
  begun["residual"] = one.report.residual;
  begun["stable"] = one.stability.is_stable();
  begun["unstable_directions"] = one.stability.unstable_directions;
  put_number(begun, "potential", one.potential);
  if (!one.report.ok()) begun["slack"] = true;
  begun["legs"] = chain_legs_value(robot, one.state);
  return begun;
}

}  // namespace

template <class Space>
void put_all_equilibria(Context& context, const ChainLegs<Space>& robot, const HeldInputs& held,
                        std::span<const double> inputs, const Load<Space>& load) {
  using Pose = typename Space::Pose;
  std::vector<ChainStart<Space>> starts{{std::get<Pose>(held.pose), held.arcs.curvature}};
  const ArcTwin twin = twin_of(context);
  const AssemblyModes modes = assembly_modes(twin.robot, inputs, twin.work);
  for (const AnyPose& pose : modes.poses) starts.push_back({std::get<Pose>(pose), held.arcs.curvature});
  ChainWork& work = work_of(context);
  Value solutions = Value::list();
  const std::span<const ChainStart<Space>> all(starts);
  for (const auto& one : chain_equilibria(robot, all, held.hold, load.wrench, work, load.options))
    solutions.push_back(
        solution_value({{"pose", pose_value(AnyPose(Space::tidy(one.state.pose)))}}, robot, one));
  put_solutions(context, context.work.stop, std::move(solutions));
}

template <class Space>
void put_all_inverses(Context& context, ChainLegs<Space> robot, const AnyPose& pose, const Branch& branch,
                      const Load<Space>& load) {
  ArcTwin twin = twin_of(context);
  const WorkingModes modes = working_modes(twin.robot, pose, branch.options(), twin.work);
  std::vector<std::vector<double>> ways;
  for (std::size_t k = 0; static_cast<double>(k) < std::min(modes.count, max_inverses); ++k)
    modes.mode(twin.robot, k, ways.emplace_back(twin.work.inputs.size()));
  ChainWork& work = work_of(context);
  std::vector<std::pair<double, Value>> found;
  for (const std::vector<double>& way : ways) {
    if (work.stop.stop_requested()) break;
    FoundChains<Space> one;
    static_cast<void>(coordinates_from_inputs(twin.robot, way, twin.work));
    one.report = rest_near(robot, pose, arcs_of(twin, pose, twin.work.coordinates), true, one.state);
    if (one.report.ok()) one.report = inverse_statics(robot, load.wrench, one.state, work, load.options);
    if (!is_solved(one.report)) continue;
    one.stability = check_stability(robot, one.state, work);
    one.potential = potential(robot, one.state);
    found.emplace_back(one.potential,
                       solution_value({{"inputs", Value(inputs_of(twin, robot, one.state))}}, robot, one));
  }
  std::ranges::stable_sort(found, {},
                           [](const auto& one) { return std::isfinite(one.first) ? one.first : 0; });
  if (modes.count > max_inverses)
    context.answer["message"] =
        fmt::format("{:.0f} branches exist; the first {:.0f} were tried", modes.count, max_inverses);
  Value solutions = Value::list();
  for (auto& [energy, one] : found) solutions.push_back(std::move(one));
  put_solutions(context, context.work.stop, std::move(solutions));
}

#define SINEW_OF(Space)                                                                     \
  template void put_all_equilibria(Context&, const ChainLegs<Space>&, const HeldInputs&,    \
                                   std::span<const double>, const Load<Space>&);            \
  template void put_all_inverses(Context&, ChainLegs<Space>, const AnyPose&, const Branch&, \
                                 const Load<Space>&);
SINEW_OF(Planar)
SINEW_OF(Spatial)
#undef SINEW_OF

}  // namespace sinew::inline v1::chains
