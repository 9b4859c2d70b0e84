/// Handler of shape on pseudo-rigid chains.
#include "analysis/chain_shape.hpp"
#include "io/reader.hpp"
#include "query/chains/chains.hpp"

namespace sinew::inline v1 {
namespace {

using namespace chains;

/// Which chains are to be drawn.
template <class Space>
struct ChainDrawing {
  Configuration at;
  Joints<Space> joints;
  std::optional<Wrench<Space>> wrench = {};
  ChainOptions options = {};

  static ChainDrawing read(ChainContext<Space>& context);
  static void answer(ChainContext<Space>& context, const ChainDrawing& asked);
};

template <class Space>
ChainDrawing<Space> ChainDrawing<Space>::read(ChainContext<Space>& context) {
  Reader& query = context.query;
  Configuration at = read_configuration(context);
  Joints<Space> joints(context, context.chains, at.branch);
  ChainDrawing asked{std::move(at), std::move(joints)};
  if (const auto wrench = query.optional("wrench")) {
    asked.wrench = read_wrench<Space>(*wrench);
    if (asked.joints.are_given())
      wrench->fail("no_effect", "has no effect: the angles say how the chains are bent; remove it");
  }
  if (context.max_iterations) asked.options.max_iterations = *context.max_iterations;
  if (const auto samples = query.optional("samples"))
    samples->fail("no_effect", "has no effect: a chain is drawn by its joints; remove it");
  if (asked.joints.are_given()) query.required("pose", "that the chains of these angles lead to");
  if (asked.at.at.pose && asked.at.inputs)
    query.fail("ambiguous", "pose and inputs both say where the platform is; keep one");
  return asked;
}

/// Rests under the wrench as `forward` has it from inputs, as `inverse` from a pose.
template <class Space>
Report rest_under(Context& context, ChainLegs<Space>& robot, const ChainDrawing<Space>& asked,
                  ChainState<Space>& state) {
  ChainWork& work = work_of(context);
  const Wrench<Space> wrench = asked.wrench.value_or(Wrench<Space>::Zero());
  if (!asked.at.inputs) {
    const Report report = rest_at(context, robot, *asked.at.at.pose, asked.at.branch, true, state);
    return report.ok() ? inverse_statics(robot, wrench, state, work, asked.options) : report;
  }
  const HeldInputs held =
      hold_inputs(context, robot, *asked.at.inputs, asked.at.start ? asked.at.start : context.path_start());
  const Report report = unloaded(robot, held, state, work, asked.options);
  return is_solved(report) ? equilibrium(robot, held.hold, wrench, state, work, asked.options) : report;
}

template <class Space>
void ChainDrawing<Space>::answer(ChainContext<Space>& context, const ChainDrawing& asked) {
  ChainLegs<Space>& robot = context.chains;
  ChainState<Space> state;
  Report report;
  if (asked.joints.are_given()) {
    state.pose = std::get<typename Space::Pose>(*asked.at.at.pose);
    report = asked.joints.at(context, robot, *asked.at.at.pose, state.legs);
    refuse_open_legs(context, chain_rates(robot, state.pose, state.legs).closure_error);
    if (!context.errors.empty()) return;
  } else {
    report = rest_under(context, robot, asked, state);
  }
  const bool is_found = is_solved(report);
  if (is_found && !asked.joints.are_given()) note_stability(robot, state, work_of(context), report);
  context.report(report);
  context.remember({});
  if (!is_found) return;
  const AnyPose pose = Space::tidy(state.pose);
  context.remember(pose);
  context.answer["pose"] = pose_value(pose);
  put_shape(context.answer, chain_shape(robot, state.pose, state.legs));
  context.answer["frames"] = Value::list({pose_value(pose)});
}

}  // namespace

void answer_chains_shape(Context& context) { handle_chains<ChainDrawing>(context); }

}  // namespace sinew::inline v1
