#include "sinew/kinematics/forward.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/modes/hinged_modes.hpp"
#include "kinematics/modes/planar_modes.hpp"
#include "kinematics/modes/spatial_modes.hpp"
#include "kinematics/reaches.hpp"
#include "robot/pose.hpp"

namespace sinew::inline v1 {
namespace {

template <class Found>
void put(AssemblyModes& modes, const Found& found) {
  modes.report = found.report;
  for (std::size_t k = 0; k < static_cast<std::size_t>(found.count); ++k) {
    modes.poses.emplace_back(found.poses[k]);
    modes.residual.push_back(found.residual[k]);
    modes.is_double.push_back(found.is_double[k]);
  }
}

void put(AssemblyModes& modes, const SpatialModes& found) {
  modes.report = found.report;
  modes.poses.assign(found.poses.begin(), found.poses.end());
  modes.residual = found.residual;
  modes.is_double.assign(found.poses.size(), false);
  modes.is_complete = found.is_complete();
}

void put_modes(AssemblyModes& modes, std::span<const PlatformConstraint<2>> reaches, StopToken) {
  put(modes, planar_modes(reaches));
}
void put_modes(AssemblyModes& modes, std::span<const PlatformConstraint<3>> reaches, StopToken stop) {
  const bool has_plane =
      std::ranges::any_of(reaches, [](const PlatformConstraint<3>& reach) { return reach.has_plane(); });
  if (has_plane && !are_hinged(reaches)) {
    modes.report.status = Status::unsupported;
    modes.report.message.append(
        "all modes are known of three hinged legs, or of legs without hinges, not of both mixed");
    modes.is_complete = false;
    return;
  }
  if (!has_plane) return put(modes, spatial_modes(reaches, {.stop = stop}));
  const HingedModes found = hinged_modes(reaches);
  put(modes, found);
  modes.is_complete = found.is_complete;
}

}  // namespace

AssemblyModes assembly_modes(const Robot& robot, Numbers inputs, Workspace& work) {
  AssemblyModes modes{.report = coordinates_from_inputs(robot, inputs, work),
                      .poses = {},
                      .residual = {},
                      .is_double = {},
                      .is_complete = true,
                      .coordinates = work.coordinates};
  if (modes.report.ok())
    with_legs(robot,
              [&](const auto& r) { put_modes(modes, reaches_of(r, work.coordinates).view(), work.stop); });
  return modes;
}

std::size_t nearest_pose(const Robot& robot, std::span<const AnyPose> poses, const AnyPose& start) {
  return with_legs(robot, [&]<class LegT>(const ParallelRobot<LegT>& r) {
    using Space = typename LegT::Space;
    std::size_t best = 0;
    const auto gap_of = [&](std::size_t k) {
      return gap(in_space<Space>(poses[k]), in_space<Space>(start), r.platform_radius);
    };
    for (std::size_t k = 1; k < poses.size(); ++k)
      if (gap_of(k) < gap_of(best)) best = k;
    return best;
  });
}

}  // namespace sinew::inline v1
