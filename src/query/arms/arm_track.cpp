/// `track` of an arm: along a path of inputs and loads, with the friction of its tendons.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/quantity.hpp"
#include "io/reader.hpp"
#include "query/arms/arms.hpp"
#include "sinew/kinematics/arm.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {

int read_path_steps(Reader& query, const Reader& list, std::size_t points) {
  constexpr int default_steps = 10, max_steps = 10000;
  if (list.is(Node::Kind::list) && list.items().empty())
    list.fail("empty_list", "a path needs at least one point");
  int steps = default_steps;
  if (const auto given = query.optional("steps")) steps = given->integer(Range::between(1, max_steps));
  const auto rows = points * static_cast<std::size_t>(steps);
  if (rows > static_cast<std::size_t>(max_path_samples))
    list.fail("path_too_long",
              fmt::format("{} points of {} steps are {} rows; an answer has at most {}: follow the path in "
                          "parts, with start: last",
                          points, steps, rows, max_path_samples));
  return steps;
}

namespace {

/// The points of the path; what a point does not say is as at the point before, of loads as in the question.
std::vector<ArmStep> read_points(ArmContext& context) {
  Reader& query = context.query;
  const ArmLoad load = read_arm_load(context.robot, query);
  std::vector<ArmStep> path;
  const auto list = query.required("points", "the path: [{tensions or changes, wrench, ...}, ...]");
  for (Reader& point : list.items()) {
    if (!point.is(Node::Kind::map)) {
      point.refuse("wrong_type", "give a map: {tensions: [[1, 0, 0]]}.");
      continue;
    }
    if (point.has("tensions") || point.has("changes"))
      path.push_back({read_arm_commands(context.robot, point), {}});
    else if (!path.empty())
      path.push_back({path.back().commands, {}});
    else
      point.required("tensions", "of the first point; or changes: what holds the tendons");
    ArmLoad at_point = read_arm_load(context.robot, point, load);
    if (!path.empty()) path.back().load = std::move(at_point);
    point.close();
  }
  const int steps = read_path_steps(query, list, path.size());
  for (ArmStep& step : path) step.divisions = steps;
  return path;
}

/// A path of poses, as other robots are given; whether there is one.
bool refuse_poses(Question& question) {
  bool is_given = false;
  for (const char* field : {"poses", "from", "to", "objective"})
    if (question.query.node()->find(field))  // else it is no field of this question
      if (const auto given = question.query.optional(field)) {
        is_given = true;
        given->fail("not_available",
                    "an arm is followed along what holds its tendons: give points: [{tensions: [[1, 0, 0]]}, "
                    "...]; for the tensions that reach a pose ask inverse");
      }
  return is_given;
}

/// Of every tendon the tension where it is fixed.
std::vector<double> end_tensions(const ArmPathPoint& point) {
  std::vector<double> values;
  for (const std::vector<double>& along : point.tensions) values.push_back(along.back());
  return values;
}

void put_point(const Arm& arm, const ArmPathPoint& point, Value& value) {
  const ArmState& state = point.state;
  value["tip"] = pose_value(AnyPose(spatial_pose(state.tip)));
  value["tensions"] = by_end_section(arm, state.tensions);
  value["end_tensions"] = by_end_section(arm, end_tensions(point));
  value["changes"] = by_end_section(arm, state.changes);
  value["slack"] = by_end_section(arm, state.slack);
  put_number(value, "potential", state.energy);
}

/// Of one tendon, as what holds it begins to grow (+1) or to shrink (−1).
Value one_sided(ArmContext& context, std::size_t tendon, double way) {
  std::vector<double> direction(context.robot.tendons.size(), 0.0);
  direction[tendon] = way;
  const ArmPathRates rates = arm_path_rates(context.robot, direction, context.work);
  if (!rates.regular) return {{"message", rates.message.view()}};
  Value value{{"twist", rates.twist}, {"changes", by_end_section(context.robot, rates.changes)}};
  if (std::ranges::all_of(rates.tensions, [](double rate) { return std::isfinite(rate); }))
    value["tensions"] = by_end_section(context.robot, rates.tensions);
  value["slipping"] = rates.slipping;
  return value;
}

/// What is linear around a direction in which tendons move.
Value in_motion(ArmContext& context, std::span<const double> motions) {
  const Arm& arm = context.robot;
  const ArmPathRates rates = arm_path_rates(arm, motions, context.work, true);
  if (!rates.regular) return {{"message", rates.message.view()}};
  const auto m = static_cast<Eigen::Index>(rates.tendons);
  const auto all_known = [](const std::vector<double>& values) {
    return std::ranges::all_of(values, [](double rate) { return std::isfinite(rate); });
  };
  Value value{{"twist", rates.twist}, {"changes", by_end_section(arm, rates.changes)}};
  const bool knows_tensions = all_known(rates.tensions_by_inputs);
  if (knows_tensions) value["tensions"] = by_end_section(arm, rates.tensions);
  value["slipping"] = rates.slipping;
  value["U"] = Value(MatrixView(rates.J.data(), 6, m));
  value["changes_by_inputs"] = Value(MatrixView(rates.changes_by_inputs.data(), m, m));
  if (knows_tensions) value["tensions_by_inputs"] = Value(MatrixView(rates.tensions_by_inputs.data(), m, m));
  value["compliance"] = Value(MatrixView(rates.compliance.data(), 6, 6));
  value["changes_by_wrench"] = Value(MatrixView(rates.changes_by_wrench.data(), m, 6));
  if (knows_tensions) value["tensions_by_wrench"] = Value(MatrixView(rates.tensions_by_wrench.data(), m, 6));
  value["least"] = by_end_section(arm, rates.least);
  value["most"] = by_end_section(arm, rates.most);
  return value;
}

struct ArmTrack {
  ArmOptions options;
  std::vector<ArmStep> path;
  Wants words;
  int samples = 0;
  std::optional<std::vector<double>> motions = {};
};

ArmTrack read_track(ArmContext& context) {
  ArmTrack asked;
  asked.options = read_arm_options(context);
  asked.path = read_points(context);
  read_arm_start(context, asked.options);
  asked.words = read_wants(context, {Want::pose}, {Want::pose, Want::shape, Want::velocity});
  asked.samples = read_samples(context, asked.words, 60, 2000);
  if (const auto given = context.query.optional("motions")) {
    asked.motions = read_arm_motions(context.robot, *given);
    if (context.errors.empty() && std::ranges::all_of(*asked.motions, [](double rate) { return rate == 0; }))
      given->fail("out_of_range", "all tendons rest: give a rate other than 0 for one that moves");
  }
  return asked;
}

void answer_track(ArmContext& context, const ArmTrack& asked) {
  const std::vector<ArmStep>& path = asked.path;
  const std::vector<ArmPathPoint> points = arm_follow(context.robot, path, asked.options, context.work);
  const ArmPathPoint& last = points.back();
  Value& answer = context.answer;
  context.report(last.state.report);
  if (last.tensions.empty()) return;  // refused: no step was tried

  const auto steps = static_cast<std::size_t>(path.front().divisions);
  const bool arrives = last.state.report.ok();
  const std::size_t reached = arrives ? points.size() : points.size() - 1;
  Value rows = Value::list();
  double work = 0, loss = 0, worst = 0;
  int iterations = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    work += points[k].motor_work;
    loss += points[k].friction_loss;
    iterations += points[k].state.report.iterations;
    if (k == reached) break;
    worst = std::max(worst, points[k].state.report.residual);
    Value row{{"point", k / steps},
              {"part", static_cast<double>(k % steps + 1) / static_cast<double>(steps)}};
    put_point(context.robot, points[k], row);
    row["motor_work"] = points[k].motor_work;
    row["friction_loss"] = points[k].friction_loss;
    rows.push_back(std::move(row));
  }
  if (!arrives) {
    answer["message"] =
        fmt::format("the path ends on its way to points[{}], in step {} of {}: {}", reached / steps,
                    reached % steps + 1, steps, last.state.report.message.view());
    answer["reached"] = {{"rows", reached}, {"point", reached / steps}};
  }
  put_point(context.robot, last, answer);  // where it ends
  if (asked.words.has(Want::shape)) {
    Value along = Value::list();
    for (const std::vector<double>& tensions : last.tensions) along.push_back(Value(tensions));
    answer["tensions_along"] = std::move(along);
    put_arm_shape(context, asked.samples);
  }
  if (asked.words.has(Want::velocity) && arrives) {
    Value list = Value::list();
    for (std::size_t i = 0; i < context.robot.tendons.size(); ++i)
      list.push_back({{"growing", one_sided(context, i, 1)}, {"shrinking", one_sided(context, i, -1)}});
    answer["one_sided"] = std::move(list);
  }
  if (asked.motions && arrives) answer["in_motion"] = in_motion(context, *asked.motions);
  answer["motor_work"] = work;
  answer["friction_loss"] = loss;
  answer["residual"] = worst;
  answer["iterations"] = iterations;
  answer["rows"] = std::move(rows);
}

}  // namespace

void answer_arms_track(Context& context) {
  if (!refuse_poses(context)) handle<read_track, answer_track>(context);
}

}  // namespace sinew::inline v1
