/// `track` of robots on rods: curves of equilibria along inputs, loads or poses, through folds.
#include <fmt/format.h>

#include "io/read_pose.hpp"
#include "io/reader.hpp"
#include "query/curves.hpp"
#include "query/rods/rods.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {
namespace {

struct RodCurveQuery {
  RodQuery begin;
  CurveOptions how;
  std::optional<SpatialWrench> wrench;  ///< at the target
};

/// What changes: `to`.
void read_target(Context& context, RodCurveQuery& asked) {
  Reader to = context.query.required("to", "{inputs, or pose, and wrench}: what changes along the curve");
  const auto inputs = to.optional("inputs"), wrench = to.optional("wrench");
  auto pose = to.optional("pose");
  if (inputs) asked.how.inputs = read_inputs(context, *inputs);
  if (wrench) asked.wrench = read_wrench<Spatial>(*wrench);
  if (pose && inputs) pose->fail("ambiguous", "inputs and pose both say where the curve leads; keep one");
  if (pose && (input_count(context.robot) != 6 || has_ties(context.robot)))
    pose->fail("not_available", "a pose is held by six inputs, each of one leg; give inputs");
  if (pose) asked.how.pose = read_spatial_pose(std::move(*pose));
  if (to.is(Node::Kind::map)) {
    if (!inputs && !wrench && !asked.how.pose)
      to.fail("missing_key", "give inputs, pose or wrench: what changes along the curve");
    to.close();
  }
}

RodCurveQuery read_rod_curve(Context& context) {
  RodCurveQuery asked;
  asked.begin = read_configuration_of_rods(context);
  read_target(context, asked);
  read_extent(context, asked.how);
  return asked;
}

}  // namespace

std::string curve_in_words(CurveEnd end, const double* fold) {
  const std::string ends = fmt::format("the curve ends: {}", to_string(end));
  if (!fold) return ends;
  return fmt::format("the curve folds at {:.6g} of the way and does not come to its target; {}", *fold, ends);
}

void note_stopped_curve(Context& context) {
  if (Report stopped; note_stop(context.work.stop, stopped)) context.report(stopped);
}

namespace {

void answer_curve(Context& context, const RodCurveQuery& asked) {
  const Equilibrium begin = solve(context, asked.begin);
  context.report(begin.report);
  if (!begin.is_solved()) return;
  CurveOptions how = asked.how;
  if (asked.wrench) how.added_wrench = *asked.wrench - asked.begin.options.wrench;
  const auto curves = equilibrium_curves(context.robot, how, context.work);
  if (curves.empty())
    return context.query.fail(
        "no_effect",
        "nothing changes between the beginning and `to`, or its inputs are beyond what the legs "
        "can do; give other values");
  put_curves(context, curves, [](const CurvePoint& point) {
    return Value{{"pose", pose_value(point.pose)}, {"inputs", Value(std::span<const double>(point.inputs))}};
  });
}

}  // namespace

void answer_rods_track(Context& context) {
  if (context.query.has("from") || context.query.has("poses")) return answer_rods_path(context);
  handle<read_rod_curve, answer_curve>(context);
}

}  // namespace sinew::inline v1
