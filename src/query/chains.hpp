/// @file chains.hpp
/// Handlers of queries about robots whose links are taken as pseudo-rigid chains (`"model": "prb"`).
#pragma once
#include "query/context.hpp"
#include "sinew/kinematics/chain.hpp"

namespace sinew::inline v0 {

void answer_chains_forward(Context& context);
void answer_chains_inverse(Context& context);
void answer_chains_velocity(Context& context);
void answer_chains_track(Context& context);
void answer_statics(Context& context);

/// What the handlers share.
namespace chains {

/// `law`: M0w, M0 or M1.
ChainModel read_law(Context& context);

/// The robot on chains; null, with errors noted, where it has none.
std::optional<AnyChainRobot> read_robot(Context& context, ChainModel law);

/// Curvatures, and directions of clamped or motor-driven bases, of the legs at a pose on a branch, by
/// constant curvature: where searches for chains begin.
struct Arcs {
  Report report;
  std::vector<double> curvature, base_tangent;
};
Arcs arcs_at(Context& context, const AnyPose& pose, const Branch& branch);

/// First links along the tangents of the arcs, less the half of a link that they stand for.
void aim_bases(ChainRobot<Planar>& robot, const Arcs& arcs);
inline void aim_bases(ChainRobot<Spatial>&, const Arcs&) {}

/// Angles per leg, from the first sprung joint; before them the direction of the first link where a motor
/// turns it, which goes into the robot.
template <class Space>
std::vector<ChainLegState> read_angles(const Reader& list, ChainRobot<Space>& robot) {
  std::vector<ChainLegState> legs(robot.legs.size());
  const auto items = list.items(robot.legs.size());
  for (std::size_t i = 0; i < std::min(items.size(), legs.size()); ++i) {
    auto& leg = robot.legs[i];
    const auto joints = static_cast<std::size_t>(leg.chain.joints());
    const std::size_t motors = robot.has_base_motors ? 1 : 0;
    const auto angles = items[i].quantities(Dimension::angle, Range::turn(), joints + motors);
    std::copy(angles.begin() + static_cast<std::ptrdiff_t>(motors), angles.end(), legs[i].angles.begin());
    if constexpr (Space::dimension == 2)
      if (motors > 0)
        leg.base = SE2<double>::from(leg.base.p.x(), leg.base.p.y(), angles[0] - std::numbers::pi / 2);
  }
  return legs;
}

/// The same of an answer.
template <class Space>
Json angles_json(const ChainRobot<Space>& robot, std::span<const ChainLegState> legs) {
  Json list = Json::array();
  for (std::size_t i = 0; i < legs.size(); ++i) {
    Json angles = to_json(legs[i].of(robot.legs[i].chain));
    if constexpr (Space::dimension == 2)
      if (robot.has_base_motors)
        angles.insert(angles.begin(), wrap_angle(robot.legs[i].base.angle() + std::numbers::pi / 2));
    list.push_back(std::move(angles));
  }
  return list;
}

/// Rests at a pose on a branch; the report says if the arcs, or the chains, do not reach.
template <class Space>
Report rest_at(Context& context, ChainRobot<Space>& robot, const AnyPose& pose, const Branch& branch,
               bool holds_lengths, ChainState<Space>& state) {
  const Arcs arcs = arcs_at(context, pose, branch);
  if (!arcs.report.ok()) return arcs.report;
  aim_bases(robot, arcs);
  return rest(robot, std::get<typename Space::Pose>(pose), arcs.curvature, holds_lengths, state);
}

}  // namespace chains
}  // namespace sinew::inline v0
