#include "kinematics/chains/arcs.hpp"

#include <cmath>
#include <numbers>

#include "kinematics/chains/chain_analysis.hpp"
#include "sinew/kinematics/forward.hpp"
#include "sinew/robot/assembly.hpp"

namespace sinew::inline v1 {
namespace {

/// First links along the tangents of the arcs, less the half of a link that they stand for.
double first_link(double tangent, double curvature, const PseudoRigid& chain) {
  return tangent - 0.5 * curvature * chain.link_length();
}

void aim_bases(ChainLegs<Planar>& robot, const Arcs& arcs) {
  if (!robot.has_base_motors) return;
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    ChainLeg<Planar>& leg = robot.legs[i];
    const double direction = first_link(arcs.base_tangent[i], arcs.curvature[i], leg.chain);
    leg.base = SE2<double>::from(leg.base.p.x(), leg.base.p.y(), direction - std::numbers::pi / 2);
  }
}
void aim_bases(ChainLegs<Spatial>&, const Arcs&) {}

/// Directions of the first links where θ of each motor is 0, at lengths of tendon 1, as arcs have them. None
/// without motors.
template <class Space>
std::vector<double> first_links(ArcTwin& twin, const ChainLegs<Space>& robot, const AnyPose& pose,
                                Numbers lengths) {
  std::vector<double> inputs, directions;
  if (!robot.has_base_motors) return directions;
  for (const double length : lengths) inputs.insert(inputs.end(), {0, length});
  static_cast<void>(
      coordinates_from_inputs(twin.robot, inputs, twin.work));  // of arcs beyond their domain, too
  const Arcs arcs = arcs_of(twin, pose, twin.work.coordinates);
  for (std::size_t i = 0; i < lengths.size(); ++i)
    directions.push_back(first_link(arcs.base_tangent[i], arcs.curvature[i], robot.legs[i].chain));
  return directions;
}

}  // namespace

Arcs arcs_of(ArcTwin& twin, const AnyPose& pose, std::vector<double> coordinates) {
  Arcs arcs;
  for (const LegState& leg : leg_states(twin.robot, pose, coordinates, twin.work)) {
    arcs.curvature.push_back(leg.curvature);
    arcs.base_tangent.push_back(std::atan2(leg.base_tangent.y(), leg.base_tangent.x()));
  }
  return arcs;
}

Arcs arcs_at(ArcTwin twin, const AnyPose& pose, const InverseOptions& branch) {
  const Inverse solved = inverse(twin.robot, pose, branch, twin.work);
  if (!solved.ok()) return {solved.report, {}, {}};
  return arcs_of(twin, pose, {solved.coordinates.begin(), solved.coordinates.end()});
}

template <class Space>
Report rest_near(ChainLegs<Space>& robot, const AnyPose& pose, const Arcs& arcs, bool holds_lengths,
                 ChainState<Space>& state) {
  if (!arcs.report.ok()) return arcs.report;
  aim_bases(robot, arcs);
  return unloaded_equilibrium(robot, std::get<typename Space::Pose>(pose), arcs.curvature, holds_lengths,
                              state);
}

TendonConstraint hold_of_input(const PseudoRigid& chain, double length) {
  const bool is_inner = length <= chain.length;
  return {is_inner ? 0 : 1, is_inner ? length : 2 * chain.length - length, {}};
}

template <class Space>
HeldInputs hold_inputs(ArcTwin twin, const ChainLegs<Space>& robot, Numbers inputs,
                       const std::optional<AnyPose>& start, int max_iterations) {
  const Forward found =
      forward(twin.robot, inputs, {.start = start, .max_iterations = max_iterations}, twin.work);
  const bool is_redundant = robot.legs.size() > static_cast<std::size_t>(Space::dof);
  if (!found.ok() && !(is_redundant && coordinates_from_inputs(twin.robot, inputs, twin.work).ok()))
    return {found.pose, {found.report, {}, {}}, {}};
  HeldInputs held{found.ok() ? found.pose : start.value_or(home(twin.robot)), {}, {}};
  held.arcs = arcs_of(twin, held.pose, twin.work.coordinates);
  const std::size_t own = robot.has_base_motors ? 2 : 1;
  for (std::size_t i = 0; i < robot.legs.size(); ++i)
    held.hold.push_back(hold_of_input(robot.legs[i].chain, inputs[own * i + own - 1]));
  return held;
}

template <class Space>
Report unloaded(ChainLegs<Space>& robot, const HeldInputs& held, ChainState<Space>& state, ChainWork& work,
                const ChainOptions& options) {
  const Report report = rest_near(robot, held.pose, held.arcs, false, state);
  if (!report.ok()) return report;
  return equilibrium(robot, held.hold, Vec<double, Space::dof>::Zero().eval(), state, work, options);
}

template <class Space>
std::vector<double> inputs_of(ArcTwin twin, const ChainLegs<Space>& robot, const ChainState<Space>& state) {
  std::vector<double> lengths, inputs;
  for (const ChainLegState& leg : state.legs) lengths.push_back(leg.tendon_length[0]);
  const std::vector<double> at_zero = first_links(twin, robot, state.pose, lengths);
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    if constexpr (Space::dimension == 2)
      if (robot.has_base_motors)
        inputs.push_back(wrap_angle(robot.legs[i].base.angle() + std::numbers::pi / 2 - at_zero[i]));
    inputs.push_back(lengths[i]);
  }
  return inputs;
}

template <class Space>
InputRows<Space> rows_of_inputs(ArcTwin twin, const ChainLegs<Space>& robot, const ChainState<Space>& state,
                                ChainWork& work) {
  InputRows<Space> found;
  found.needed_wrench = input_wrench_jacobian(robot, state, work);
  found.sensitivity = input_sensitivity(robot, state, work);
  std::vector<double> shorter;
  for (const auto& leg : robot.legs) shorter.push_back(0.9 * leg.chain.length);
  const std::vector<double> turned = first_links(twin, robot, state.pose, shorter);
  for (auto* rows : {&found.needed_wrench, &found.sensitivity}) {
    Eigen::Index column = 0;
    for (std::size_t i = 0; i < robot.legs.size() && rows->cols() > 0; ++i) {
      const int held = state.hold[i].length_of;
      column += robot.has_base_motors ? 1 : 0;
      if (held == 1) rows->col(column) *= -1;
      if (held >= 0 && robot.has_base_motors)  // first links are affine in the length
        rows->col(column) += rows->col(column - 1) * turned[i] / (shorter[i] - robot.legs[i].chain.length);
      column += held >= 0 ? 1 : 2;
    }
  }
  return found;
}

#define SINEW_OF(Space)                                                                                     \
  template Report rest_near(ChainLegs<Space>&, const AnyPose&, const Arcs&, bool, ChainState<Space>&);      \
  template HeldInputs hold_inputs(ArcTwin, const ChainLegs<Space>&, Numbers, const std::optional<AnyPose>&, \
                                  int);                                                                     \
  template Report unloaded(ChainLegs<Space>&, const HeldInputs&, ChainState<Space>&, ChainWork&,            \
                           const ChainOptions&);                                                            \
  template std::vector<double> inputs_of(ArcTwin, const ChainLegs<Space>&, const ChainState<Space>&);       \
  template InputRows<Space> rows_of_inputs(ArcTwin, const ChainLegs<Space>&, const ChainState<Space>&,      \
                                           ChainWork&);
SINEW_OF(Planar)
SINEW_OF(Spatial)
#undef SINEW_OF

}  // namespace sinew::inline v1
