#include "kinematics/chains/solutions.hpp"

#include <algorithm>
#include <cmath>

#include "sinew/kinematics/forward.hpp"
#include "sinew/robot/assembly.hpp"

namespace sinew::inline v1 {

template <class Space>
std::vector<FoundChains<Space>> equilibria_of_inputs(ArcTwin twin, const ChainLegs<Space>& robot,
                                                     const HeldInputs& held, Numbers inputs,
                                                     const Vec<double, Space::dof>& wrench, ChainWork& work,
                                                     const ChainOptions& options) {
  using Pose = typename Space::Pose;
  std::vector<ChainStart<Space>> starts{{std::get<Pose>(held.pose), held.arcs.curvature}};
  const AssemblyModes modes = assembly_modes(twin.robot, inputs, twin.work);
  for (const AnyPose& pose : modes.poses) starts.push_back({std::get<Pose>(pose), held.arcs.curvature});
  return chain_equilibria(robot, std::span<const ChainStart<Space>>(starts), held.hold, wrench, work,
                          options);
}

template <class Space>
AllChainsAtPose<Space> equilibria_at_pose(ArcTwin twin, const ChainLegs<Space>& robot, const AnyPose& pose,
                                          const InverseOptions& branch, const Vec<double, Space::dof>& wrench,
                                          ChainWork& work, const ChainOptions& options) {
  const WorkingModes modes = working_modes(twin.robot, pose, branch, twin.work);
  AllChainsAtPose<Space> all{{}, modes.count};
  std::vector<std::vector<double>> ways;
  for (std::size_t k = 0; static_cast<double>(k) < std::min(modes.count, max_branches); ++k)
    modes.mode(twin.robot, k, ways.emplace_back(twin.work.inputs.size()));
  for (const std::vector<double>& way : ways) {
    if (work.stop.stop_requested()) break;
    ChainsAtPose<Space> one{{}, robot, {}};
    static_cast<void>(coordinates_from_inputs(twin.robot, way, twin.work));
    one.report = rest_near(one.robot, pose, arcs_of(twin, pose, twin.work.coordinates), true, one.state);
    if (one.report.ok()) one.report = inverse_statics(one.robot, wrench, one.state, work, options);
    if (!is_solved(one.report)) continue;
    one.stability = check_stability(one.robot, one.state, work);
    one.potential = potential(one.robot, one.state);
    one.inputs = inputs_of(twin, one.robot, one.state);
    all.found.push_back(std::move(one));
  }
  std::ranges::stable_sort(all.found, {}, [](const ChainsAtPose<Space>& one) {
    return std::isfinite(one.potential) ? one.potential : 0;
  });
  return all;
}

#define SINEW_OF(Space)                                                                                     \
  template std::vector<FoundChains<Space>> equilibria_of_inputs(                                            \
      ArcTwin, const ChainLegs<Space>&, const HeldInputs&, Numbers, const Vec<double, Space::dof>&,         \
      ChainWork&, const ChainOptions&);                                                                     \
  template AllChainsAtPose<Space> equilibria_at_pose(ArcTwin, const ChainLegs<Space>&, const AnyPose&,      \
                                                     const InverseOptions&, const Vec<double, Space::dof>&, \
                                                     ChainWork&, const ChainOptions&);
SINEW_OF(Planar)
SINEW_OF(Spatial)
#undef SINEW_OF

}  // namespace sinew::inline v1
