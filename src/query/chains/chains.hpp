/// @file chains.hpp
/// What handlers of questions to pseudo-rigid chains share.
#pragma once
#include "io/document/reader.hpp"
#include "kinematics/chains/arcs.hpp"
#include "kinematics/chains/chain_analysis.hpp"
#include "query/handlers.hpp"
#include "query/loads.hpp"
#include "query/questions.hpp"

namespace sinew::inline v1 {

/// @name Handlers in files of their own
/// @{
void answer_chains_velocity(Context& context);
void answer_chains_shape(Context& context);
void answer_chains_track(Context& context);
void answer_chains_curves(Context& context);   ///< `track` along loads and what tendons hold
void answer_chains_sensing(Context& context);  ///< `statics` with tensions that are measured
/// @}

/// What the handlers share.
namespace chains {

template <class Space>
using Wrench = Vec<double, Space::dof>;

/// A question put to chains in the plane or in space.
template <class Space>
struct ChainContext : Context {
  ChainLegs<Space> chains;  ///< the robot's: a copy, into which directions of motors go that a question gives
  explicit ChainContext(const Context& context) : Context(context), chains(chains_of<Space>(context.robot)) {}
};

/// A question in the plane or in space.
template <template <class> class Asked>
void answer_chains(Context& context) {
  if (context.robot.planar_chains())
    answer_question<Asked<Planar>>(context);
  else
    answer_question<Asked<Spatial>>(context);
}

/// Angles per leg, from the first sprung joint; before them the direction of the first link where a motor
/// turns it, which goes into the robot.
template <class Space>
std::vector<ChainLegState> read_angles(const Reader& list, ChainLegs<Space>& robot) {
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
Value::List angles_value(const ChainLegs<Space>& robot, std::span<const ChainLegState> legs) {
  Value::List list;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    Value angles = legs[i].of(robot.legs[i].chain);
    if constexpr (Space::dimension == 2)
      if (robot.has_base_motors)
        angles.push_front(wrap_angle(robot.legs[i].base.angle() + std::numbers::pi / 2));
    list.push_back(std::move(angles));
  }
  return list;
}

inline ArcTwin twin_of(const Context& context) { return {context.robot, context.work}; }
/// The solvers' memory.
inline ChainWork& work_of(const Context& context) {
  context.work.chains.stop = context.work.stop;
  return context.work.chains;
}

/// Rests at a pose on a branch; the report says if the arcs, or the chains, do not reach.
template <class Space>
Report rest_at(const Context& context, ChainLegs<Space>& robot, const AnyPose& pose, const Branch& branch,
               bool holds_lengths, ChainState<Space>& state) {
  return rest_near(robot, pose, arcs_at(twin_of(context), pose, branch.options()), holds_lengths, state);
}

/// Angles as given, or a branch on which chains are at rest.
template <class Space>
struct Joints {
  Branch branch = {};
  std::optional<std::vector<ChainLegState>> given = {};

  bool are_given() const { return given.has_value(); }

  Report at(const Context& context, ChainLegs<Space>& robot, const AnyPose& pose,
            std::vector<ChainLegState>& legs) const {
    if (given) {
      legs = *given;
      return {};
    }
    ChainState<Space> state;
    const Report report = rest_at(context, robot, pose, branch, false, state);
    legs = std::move(state.legs);
    return report;
  }
};
template <class Space>
Joints<Space> read_joints(Context& context, ChainLegs<Space>& robot, Branch branch) {
  Joints<Space> joints{std::move(branch)};
  const auto angles = context.query.optional("angles");
  if (!angles) return joints;
  joints.given = read_angles(*angles, robot);
  if (!joints.branch.is_default())
    context.query.fail("ambiguous",
                       "bending, curvature and elbow choose among solutions; the angles are given");
  return joints;
}

/// Notes it where angles that were given do not lead to the pose.
void refuse_open_legs(Context& context, double closure_error);

template <class Space>
HeldInputs hold_inputs(const Context& context, const ChainLegs<Space>& robot, Numbers inputs,
                       const std::optional<AnyPose>& start) {
  return hold_inputs(twin_of(context), robot, inputs, start, context.max_iterations.value_or(100));
}

}  // namespace chains
}  // namespace sinew::inline v1
