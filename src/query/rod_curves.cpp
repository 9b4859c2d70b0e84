/// `track` of robots on rods: curves of equilibria along inputs, loads or poses, through folds.
#include <fmt/format.h>

#include "query/rods.hpp"
#include "sinew/io/read_pose.hpp"
#include "sinew/kinematics/equilibrium_curve.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v0 {
namespace {

constexpr int most_points = 20000;

struct CurveQuery {
  RodQuery begin;
  CurveOptions how;
  std::optional<SpatialWrench> wrench;  ///< at the target
};

/// What changes: `to`.
void read_target(Context& context, CurveQuery& asked) {
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

CurveQuery read_curve(Context& context) {
  CurveQuery asked;
  asked.begin = read_configuration_of_rods(context);
  read_target(context, asked);
  if (const auto range = context.query.optional("range")) {
    const auto ends = range->items(2);
    if (ends.size() == 2) {
      asked.how.lowest = ends[0].number({.high = 0});
      asked.how.highest = ends[1].number({.low = 0});
    }
  }
  if (const auto samples = context.query.optional("samples"))
    asked.how.max_points = samples->integer(Range::between(2, most_points));
  if (const auto backward = context.query.optional("backward")) {
    asked.how.is_backward = backward->boolean();
    if (asked.how.is_backward && asked.how.lowest == 0)
      backward->fail("no_effect", "the curve would leave its range at once; give range, from below 0");
  }
  if (const auto branches = context.query.optional("branches"))
    asked.how.follows_branches = branches->boolean();
  return asked;
}

Json row_json(const CurvePoint& point) {
  Json row{{"parameter", point.parameter},
           {"pose", to_json(point.pose)},
           {"inputs", to_json(std::span<const double>(point.inputs))},
           {"stable", point.unstable_directions == 0},
           {"unstable_directions", point.unstable_directions},
           {"residual", point.residual}};
  put_number(row, "potential", point.potential);
  if (point.event != CurveEvent::none) row["event"] = to_string(point.event);
  return row;
}

Json curve_json(const EquilibriumCurve& curve) {
  Json answer;
  if (curve.from_curve >= 0) answer["from"] = {{"curve", curve.from_curve}, {"row", curve.from_point}};
  answer["why"] = to_string(curve.end);
  Json rows = Json::array();
  for (const CurvePoint& point : curve.points) rows.push_back(row_json(point));
  answer["rows"] = std::move(rows);
  return answer;
}

/// The first curve in words, where it does not come to its target.
std::string in_words(const EquilibriumCurve& curve) {
  const auto fold = std::ranges::find(curve.points, CurveEvent::fold, &CurvePoint::event);
  const std::string ends = fmt::format("the curve ends: {}", to_string(curve.end));
  if (fold == curve.points.end()) return ends;
  return fmt::format("the curve folds at {:.6g} of the way and does not come to its target; {}",
                     fold->parameter, ends);
}

/// Every equilibrium with the inputs and load of the target.
Json equilibria_json(std::span<const EquilibriumCurve> curves) {
  Json equilibria = Json::array();
  for (std::size_t c = 0; c < curves.size(); ++c)
    for (std::size_t k = 0; k < curves[c].points.size(); ++k)
      if (const CurvePoint& point = curves[c].points[k]; point.event == CurveEvent::target)
        equilibria.push_back({{"curve", c},
                              {"row", k},
                              {"pose", to_json(point.pose)},
                              {"inputs", to_json(std::span<const double>(point.inputs))},
                              {"stable", point.unstable_directions == 0},
                              {"unstable_directions", point.unstable_directions}});
  return equilibria;
}

}  // namespace

void answer_rods_track(Context& context) {
  for (const char* key : {"from", "poses"})
    if (const auto given = context.query.optional(key)) {
      given->fail("not_available",
                  "a robot on rods is followed by what changes: give inputs, pose or independent, where the "
                  "curve begins, and to: {inputs, or pose, and wrench}; the verb is sinew branches");
      return;
    }
  CurveQuery asked = read_curve(context);
  if (!context.ready()) return;
  const Equilibrium begin = solve(context, asked.begin);
  context.report(begin.report);
  if (!begin.is_solved()) return;
  if (asked.wrench) asked.how.added_wrench = *asked.wrench - asked.begin.options.wrench;
  const auto curves = equilibrium_curves(context.robot, asked.how, context.work);
  if (curves.empty()) {
    context.query.fail(
        "no_effect",
        "nothing changes between the beginning and `to`, or its inputs are beyond what the legs "
        "can do; give other values");
    return;
  }
  Json& answer = context.answer;
  const Json equilibria = equilibria_json(curves);
  const bool arrives = std::ranges::any_of(equilibria, [](const Json& one) { return one["curve"] == 0; });
  answer["status"] = to_string(arrives ? Status::converged : Status::singular);
  answer.erase("message");
  if (!arrives) answer["message"] = in_words(curves.front());
  const auto was_stopped = [](const EquilibriumCurve& curve) { return curve.end == CurveEnd::stopped; };
  if (Report stopped; std::ranges::any_of(curves, was_stopped) && note_stop(context.work.stop, stopped))
    context.report(stopped);
  double worst = 0;
  for (const EquilibriumCurve& curve : curves)
    for (const CurvePoint& point : curve.points) worst = std::max(worst, point.residual);
  answer["residual"] = worst;
  answer["equilibria"] = equilibria;
  Json list = Json::array();
  for (const EquilibriumCurve& curve : curves) list.push_back(curve_json(curve));
  answer["curves"] = std::move(list);
}

}  // namespace sinew::inline v0
