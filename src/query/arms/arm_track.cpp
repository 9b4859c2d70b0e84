/// `track` of arms and of platforms on arms, along a path of inputs and loads: of an arm with the friction of
/// its tendons, of a platform to poses, too.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/document/reader.hpp"
#include "query/arms/arms.hpp"
#include "query/questions.hpp"

namespace sinew::inline v1 {

namespace {

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

/// @name What tells the two apart
/// @{

constexpr std::string_view not_along_poses(const Arm&) {
  return "an arm is followed along what holds its tendons: give points: [{tensions: [[1, 0, 0]]}, ...]; for "
         "the "
         "tensions that reach a pose ask inverse";
}
constexpr std::string_view not_along_poses(const ArmLegs&) {
  return "legs of sections are followed along points: [{pose: ...}, ...], or tensions, changes and loads";
}
constexpr std::string_view form_of_points(const Arm&) {
  return "the path: [{tensions or changes, wrench, ...}, ...]";
}
constexpr std::string_view form_of_points(const ArmLegs&) {
  return "the path: [{tensions, changes or pose, wrench, ...}, ...]";
}
constexpr std::string_view form_of_the_first(const Arm&) {
  return "of the first point; or changes: what holds the tendons";
}
constexpr std::string_view form_of_the_first(const ArmLegs&) {
  return "of the first point; or changes, or a pose";
}

/// Where inputs are to lead, which a point of a platform's path may say in their place. Whether it does.
bool read_pose_of_step(const Arm&, Reader&, ArmStep&, bool) { return false; }
bool read_pose_of_step(const ArmLegs& robot, Reader& point, ArmLegsStep& step, bool has_inputs) {
  if (has_inputs) step.pose.reset();
  auto pose = point.optional("pose");
  if (!pose) return step.pose.has_value();
  if (has_inputs) pose->fail("ambiguous", "the point gives a pose and what holds tendons; keep one");
  step.pose = read_pose_of(robot.is_planar, std::move(*pose));
  return true;
}

/// @}

/// The points of the path; what a point does not say is as at the point before, of loads as in the question.
template <class Arms>
std::vector<typename ArmTypes<Arms>::Step> read_points(ArmContextOf<Arms>& context) {
  using Step = typename ArmTypes<Arms>::Step;
  Reader& query = context.query;
  const Arms& robot = context.robot;
  const auto load = read_arm_load(robot, query);
  std::vector<Step> path;
  const auto list = query.required("points", form_of_points(robot));
  for (Reader& point : list.items()) {
    if (!point.is(Node::Kind::map)) {
      point.refuse("wrong_type", "give a map: {tensions: [[1, 0, 0]]}.");
      continue;
    }
    Step step = path.empty() ? Step{} : path.back();
    const bool has_inputs = point.has("tensions") || point.has("changes");
    if (has_inputs) step.commands = read_arm_commands(tendon_counts(robot), point);
    if (!read_pose_of_step(robot, point, step, has_inputs) && !has_inputs && path.empty())
      point.required("tensions", form_of_the_first(robot));
    step.load = read_arm_load(robot, point, load);
    point.close();
    path.push_back(std::move(step));
  }
  const int steps = read_path_steps(query, list, path.size());
  for (Step& step : path) step.divisions = steps;
  return path;
}

/// Of every tendon the tension where it is fixed.
std::vector<double> end_tensions(const ArmPathPoint& point) {
  std::vector<double> values;
  for (const std::vector<double>& along : point.tensions) values.push_back(along.back());
  return values;
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

const ArmState& state_of(const ArmPathPoint& point) { return point.state; }
const ArmLegsState& state_of(const ArmLegsState& point) { return point; }

/// A row's numbers, or those of where a path ends.
void put_point(Value& value, const Arm& arm, const ArmPathPoint& point) {
  put_arm_numbers(value, arm, point.state);
  value["end_tensions"] = by_end_section(arm, end_tensions(point));
}
void put_point(Value& value, const ArmLegs& robot, const ArmLegsState& point) {
  put_arm_numbers(value, robot, point);
}
void put_work(Value& row, const ArmPathPoint& point) {
  row["motor_work"] = point.motor_work;
  row["friction_loss"] = point.friction_loss;
}
void put_work(Value&, const ArmLegsState&) {}

/// @tparam Arms Arm or ArmLegs
template <class Arms>
struct ArmPath : ArmContextOf<Arms> {
  using Step = typename ArmTypes<Arms>::Step;
  using Point = typename ArmTypes<Arms>::Point;
  using ArmContextOf<Arms>::ArmContextOf;
  using ArmContextOf<Arms>::robot;
  using Question::answer;

  void read();
  void solve();
  void tell();

 private:
  void read_wanted();
  void tell_last(const Report& report);

  ArmInverseOptions options_ = {};
  std::vector<Step> path_ = {};
  Wants words_ = {};
  int samples_ = 0;
  std::optional<std::vector<double>> motions_ = {};  ///< of an arm
  std::vector<Point> points_ = {};
  bool arrives_ = false;
};

template <>
void ArmPath<Arm>::read_wanted() {
  words_ = read_wants(*this, {Want::pose}, {Want::pose, Want::shape, Want::velocity});
  const auto motions = query.optional("motions");
  if (!motions) return;
  motions_ = read_arm_motions(robot, *motions);
  if (errors.empty() && std::ranges::all_of(*motions_, [](double rate) { return rate == 0; }))
    motions->fail("out_of_range", "all tendons rest: give a rate other than 0 for one that moves");
}
template <>
void ArmPath<ArmLegs>::read_wanted() {
  if (const auto motions = query.optional("motions"))
    motions->fail("not_available", "tendons of legs of sections do not rub; ask velocity for their rates");
  words_ = read_wants(*this);
}

template <class Arms>
void ArmPath<Arms>::read() {
  options_.arm = read_arm_options(*this, ArmTypes<Arms>::usual_iterations);
  path_ = read_points(*this);
  read_arm_start(*this, options_.arm);
  read_wanted();
  samples_ = read_samples(*this, words_, 60, 2000);
}

template <>
void ArmPath<Arm>::solve() {
  points_ = arm_follow(robot, path_, options_.arm, work);
}
template <>
void ArmPath<ArmLegs>::solve() {
  points_ = arm_legs_track(robot, path_, options_, work);
}

/// Where it ends.
template <>
void ArmPath<Arm>::tell_last(const Report& report) {
  const ArmPathPoint& end = points_.back();
  put_point(answer, robot, end);
  if (words_.has(Want::shape)) {
    Value along = Value::list();
    for (const std::vector<double>& tensions : end.tensions) along.push_back(Value(tensions));
    answer["tensions_along"] = std::move(along);
    put_arm_shape(*this, end.state, samples_);
  }
  if (words_.has(Want::velocity) && arrives_) {
    Value list = Value::list();
    for (std::size_t i = 0; i < robot.tendons.size(); ++i)
      list.push_back({{"growing", one_sided(*this, i, 1)}, {"shrinking", one_sided(*this, i, -1)}});
    answer["one_sided"] = std::move(list);
  }
  if (motions_ && arrives_) answer["in_motion"] = in_motion(*this, *motions_);
  double of_motors = 0, of_friction = 0;
  for (const ArmPathPoint& point : points_) {
    of_motors += point.motor_work;
    of_friction += point.friction_loss;
  }
  answer["motor_work"] = of_motors;
  answer["friction_loss"] = of_friction;
  answer["residual"] = report.residual;
  answer["iterations"] = report.iterations;
}
template <>
void ArmPath<ArmLegs>::tell_last(const Report& report) {
  Report of_end = report;
  if (!arrives_) of_end.residual = points_.back().report.residual;  // of the nearest that was found
  put_arm_state(*this, points_.back(), of_end);
  if (has_friction(robot)) add_message(without_friction(robot));
  if (arrives_) put_arm_wants(*this, points_.back(), words_, samples_);
}

template <class Arms>
void ArmPath<Arms>::tell() {
  Report report = state_of(points_.back()).report;
  arrives_ = report.ok();
  this->report(report);
  if (points_.back().tensions.empty()) return;  // refused: no step was tried

  const auto steps = static_cast<std::size_t>(path_.front().divisions);
  const std::size_t reached = arrives_ ? points_.size() : points_.size() - 1;
  Value rows = Value::list();
  double worst = 0;
  report.iterations = 0;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    const auto& state = state_of(points_[k]);
    report.iterations += state.report.iterations;
    if (k == reached) break;
    worst = std::max(worst, state.report.residual);
    Value row{{"point", k / steps},
              {"part", static_cast<double>(k % steps + 1) / static_cast<double>(steps)}};
    put_point(row, robot, points_[k]);
    put_work(row, points_[k]);
    rows.push_back(std::move(row));
  }
  report.residual = worst;
  if (!arrives_)
    answer["message"] = fmt::format("the path ends on its way to points[{}], in step {} of {}: {}",
                                    reached / steps, reached % steps + 1, steps, report.message.view());
  tell_last(report);
  if (!arrives_) answer["reached"] = {{"rows", reached}, {"point", reached / steps}};
  answer["rows"] = std::move(rows);
}

}  // namespace

template <class Arms>
void answer_arms_track(Context& context) {
  bool is_along_poses = false;
  for (const char* field : {"poses", "from", "to", "objective"})  // of other robots' paths
    if (context.query.node()->find(field))                        // else it is no field of this question
      if (const auto given = context.query.optional(field)) {
        is_along_poses = true;
        given->fail("not_available", not_along_poses(ArmTypes<Arms>::of(context.robot)));
      }
  if (!is_along_poses) answer_question<ArmPath<Arms>>(context);
}
template void answer_arms_track<Arm>(Context&);
template void answer_arms_track<ArmLegs>(Context&);

}  // namespace sinew::inline v1
