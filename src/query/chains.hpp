/// @file chains.hpp
/// Handlers of queries about robots whose links are taken as pseudo-rigid chains (`"model": "prb"`).
#pragma once
#include "query/loads.hpp"
#include "sinew/kinematics/chain_analysis.hpp"
#include "sinew/kinematics/forward.hpp"

namespace sinew::inline v0 {

void answer_chains_forward(Context& context);
void answer_chains_inverse(Context& context);
void answer_chains_velocity(Context& context);
void answer_chains_shape(Context& context);
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
Arcs arcs_of(Context& context, const AnyPose& pose, std::vector<double> coordinates);

template <class Space>
using Wrench = Vec<double, Space::dof>;

/// First links along the tangents of the arcs, less the half of a link that they stand for.
inline double first_link(double tangent, double curvature, const PseudoRigid& chain) {
  return tangent - 0.5 * curvature * chain.link_length();
}
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

/// Rests at a pose near arcs, on whose bases the motors put the first links.
template <class Space>
Report rest_near(ChainRobot<Space>& robot, const AnyPose& pose, const Arcs& arcs, bool holds_lengths,
                 ChainState<Space>& state) {
  if (!arcs.report.ok()) return arcs.report;
  aim_bases(robot, arcs);
  return rest(robot, std::get<typename Space::Pose>(pose), arcs.curvature, holds_lengths, state);
}

/// Rests at a pose on a branch; the report says if the arcs, or the chains, do not reach.
template <class Space>
Report rest_at(Context& context, ChainRobot<Space>& robot, const AnyPose& pose, const Branch& branch,
               bool holds_lengths, ChainState<Space>& state) {
  return rest_near(robot, pose, arcs_at(context, pose, branch), holds_lengths, state);
}

/// Angles as given, or a branch on which chains are at rest.
template <class Space>
class Joints {
 public:
  Joints(Context& context, ChainRobot<Space>& robot, Branch branch) : branch_(std::move(branch)) {
    const auto angles = context.query.optional("angles");
    if (!angles) return;
    given_ = read_angles(*angles, robot);
    if (!branch_.is_default())
      context.query.fail("ambiguous",
                         "bending, curvature and elbow choose among solutions; the angles are given");
  }

  bool are_given() const { return given_.has_value(); }

  Report at(Context& context, ChainRobot<Space>& robot, const AnyPose& pose,
            std::vector<ChainLegState>& legs) const {
    if (given_) {
      legs = *given_;
      return {};
    }
    ChainState<Space> state;
    const Report report = rest_at(context, robot, pose, branch_, false, state);
    legs = std::move(state.legs);
    return report;
  }

 private:
  Branch branch_;
  std::optional<std::vector<ChainLegState>> given_;
};

/// Notes it where angles that were given do not lead to the pose.
void refuse_open_legs(Context& context, double closure_error);

/// What arcs of these inputs say of the chains: where searches begin, and which tendon lengths are held.
/// Motors hold what `arcs` aim the bases at, which the inputs alone decide.
struct HeldInputs {
  AnyPose pose;
  Arcs arcs;
  std::vector<ChainHold> hold;
};
/// Tendon 1 of the arcs' lengths; where it is the outer one the inner is held, whose length is as much
/// shorter. Of more legs than freedoms, whose lengths chains need not agree on, arcs begin where the search
/// does.
template <class Space>
HeldInputs hold_inputs(Context& context, const ChainRobot<Space>& robot, std::span<const double> inputs,
                       const std::optional<AnyPose>& start) {
  const ForwardOptions options{.start = start, .max_iterations = context.max_iterations.value_or(100)};
  const Forward found = forward(context.robot, inputs, options, context.work);
  const bool is_redundant = robot.legs.size() > static_cast<std::size_t>(Space::dof);
  if (!found.ok() && !(is_redundant && command(context.robot, inputs, context.work).ok()))
    return {found.pose, {found.report, {}, {}}, {}};
  HeldInputs held{found.ok() ? found.pose : start.value_or(home(context.robot)), {}, {}};
  held.arcs = arcs_of(context, held.pose, context.work.coordinates);
  const std::size_t own = robot.has_base_motors ? 2 : 1;
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    const double rest_length = robot.legs[i].chain.length, length = inputs[own * i + own - 1];
    const bool is_inner = length <= rest_length;
    held.hold.push_back({is_inner ? 0 : 1, is_inner ? length : 2 * rest_length - length, {}});
  }
  return held;
}

/// What motors hold, without load, from rest near arcs at a pose.
template <class Space>
Report unloaded(ChainRobot<Space>& robot, const AnyPose& start, const Arcs& arcs,
                std::span<const ChainHold> hold, ChainState<Space>& state, ChainWork& work,
                const ChainOptions& options) {
  const Report report = rest_near(robot, start, arcs, false, state);
  if (!report.ok()) return report;
  return equilibrium(robot, hold, Wrench<Space>::Zero().eval(), state, work, options);
}

/// Whether there is an equilibrium; tendons that would have to push are told of, not forbidden.
inline bool is_solved(const Report& report) { return report.ok() || report.status == Status::slack; }

/// Of a solved equilibrium; the report is `unstable` where it does not hold by itself.
template <class Space>
ChainStability<Space> judge(const ChainRobot<Space>& robot, const ChainState<Space>& state, ChainWork& work,
                            Report& report) {
  ChainStability<Space> found = check_stability(robot, state, work);
  if (report.ok() && !found.is_stable()) {
    report.status = Status::unstable;
    report.message.append("the equilibrium does not hold by itself: smallest_eigenvalue is not above 0");
  }
  return found;
}

}  // namespace chains
}  // namespace sinew::inline v0
