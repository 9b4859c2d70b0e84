/// forward, inverse, velocity and shape of robots whose legs bear no load.
#include <fmt/format.h>

#include <cmath>

#include "query/batch/sampler.hpp"
#include "query/kinematic/kinematics.hpp"
#include "query/loads.hpp"
#include "query/questions.hpp"
#include "sinew/analysis/shape.hpp"

namespace sinew::inline v1 {
namespace {

constexpr double max_solutions = 256;
constexpr std::size_t max_trace = 1000;

void refuse_if_asked(Context& context, std::string_view key, std::string_view why) {
  if (const auto asked = context.query.optional(key)) asked->fail("not_available", why);
}

std::string_view no_load(const Context& context) {
  return context.robot.model() == Model::cc
             ? "constant curvature bears no load; add model: prb, or ask statics, or leave it out"
             : "this robot's legs bear no load; leave it out";
}

Value all_working_modes(Context& context, const AnyPose& pose, const Branch& branch) {
  const WorkingModes modes = working_modes(context.robot, pose, branch.options(), context.work);
  Value solutions = Value::list();
  std::vector<double> inputs(context.work.inputs.size());
  for (std::size_t k = 0; static_cast<double>(k) < std::min(modes.count, max_solutions); ++k) {
    modes.mode(context.robot, k, inputs);
    coordinates_from_inputs(context.robot, inputs, context.work);
    const std::vector<double> coordinates = context.work.coordinates;
    solutions.push_back(
        {{"inputs", Value(inputs)}, {"legs", legs_value(context.robot, pose, coordinates, context.work)}});
  }
  if (modes.count > max_solutions)
    context.add_message(
        fmt::format("{:.0f} working modes exist; the first {:.0f} are listed", modes.count, max_solutions));
  else if (modes.is_continuum)
    context.add_message(
        "the robot is redundant: at this pose its legs can move; listed are the modes of the curvature asked "
        "for");
  return solutions;
}

Value trace_value(std::span<const TraceStep> trace, int iterations) {
  Value list = Value::list();
  for (const TraceStep& step : trace.first(std::min(trace.size(), static_cast<std::size_t>(iterations) + 1)))
    list.push_back({{"iteration", step.iteration}, {"residual", step.residual}, {"step", step.step}});
  return list;
}

KinematicWants read_kinematic_wants(Context& context) {
  KinematicWants wanted{read_wants(context), {}, {}, 0};
  if (wanted.words.has(Want::velocity)) {
    if (const auto asked = context.query.optional("twist"))
      wanted.twist = asked->quantities(Dimension::number, {}, static_cast<std::size_t>(dof(context.robot)));
    wanted.along = read_along(context);
    refuse_if_asked(
        context, "angles",
        "a constant-curvature model has no joint angles; add model: prb, or give inputs or a branch");
  }
  refuse_without(context, wanted.words, Want::velocity, {"twist", "along", "limit"});
  wanted.samples = read_samples(context, wanted.words, 33, 2000);
  return wanted;
}

void put_rates(Context& context, const Velocity& result, std::span<const double> twist) {
  const Report found = rates(result, twist, context.work);
  if (found.ok())
    context.answer["rates"] = Value(context.work.rates);
  else
    context.add_report(found);
}

template <int D>
Value polyline(const PolylineOf<D>& line) {
  Value points = Value::list();
  for (const auto& point : line) points.push_back(Value(point));
  return points;
}

template <class Lines>
void put_lines(Value& answer, const Lines& lines) {
  Value list = Value::list();
  for (const auto& line : lines) list.push_back(Value::list({Value(line[0]), Value(line[1])}));
  answer["lines"] = std::move(list);
}

template <int D>
void put_shape_of(Value& answer, const ShapeOf<D>& picture) {
  Value backbones = Value::list(), tendons = Value::list();
  for (const auto& line : picture.backbones) backbones.push_back(polyline<D>(line));
  for (const auto& pair : picture.tendons)
    tendons.push_back(Value::list({polyline<D>(pair[0]), polyline<D>(pair[1])}));
  answer["backbones"] = backbones;
  answer["tendons"] = tendons;
  put_lines(answer, picture.lines);
  answer["platform"] = polyline<D>(picture.platform);
  answer["base"] = polyline<D>(picture.base);
}

void put_velocity(Context& context, const AnyPose& pose, const Velocity& result,
                  std::span<const double> twist) {
  Value& answer = context.answer;
  answer["J"] = result.J;
  answer["K"] = result.K;
  if (result.U.rows() > 0) answer["U"] = result.U;
  put_number(answer, "determinant", result.determinant);
  answer["indices"] = indices_value(result.indices);
  answer["type_1"] = std::span<const int>(result.type_1);
  answer["type_2"] = type_two_value(result.type_2, std::holds_alternative<PlanarPose>(pose));
  if (!twist.empty()) put_rates(context, result, twist);
}

/// All that is wanted of a configuration, which is solved.
void put_wanted(Context& context, const KinematicWants& wanted, const Configuration& given,
                const Solved& at) {
  const Wants words = wanted.words;
  Value& answer = context.answer;
  if (words.has(Want::pose)) answer["pose"] = pose_value(at.pose);
  if (!(words & Wants{Want::velocity, Want::sensitivity}).is_empty()) {
    const Velocity result = velocity(context.robot, at.pose, at.coordinates, context.work);
    context.add_report(result.report);
    if (words.has(Want::velocity)) put_velocity(context, at.pose, result, wanted.twist);
    if (words.has(Want::sensitivity) && result.U.rows() > 0) answer["sensitivity"] = result.U;
  }
  if (words.has(Want::legs))
    answer["legs"] = legs_value(context.robot, at.pose, at.coordinates, context.work);
  if (!(words & Wants{Want::shape, Want::lines}).is_empty()) {
    const AnyShape picture = any_shape(context.robot, at.pose, at.coordinates, std::max(2, wanted.samples));
    if (words.has(Want::shape)) {
      put_shape(answer, picture);
      answer["frames"] = Value::list({pose_value(at.pose)});
    } else {
      std::visit([&](const auto& one) { put_lines(answer, one.lines); }, picture);
    }
  }
  if (wanted.along) put_type_2_distance(context, *wanted.along, given, at.pose);
}

}  // namespace

Value type_two_value(const TypeTwo& type, bool is_planar) {
  Value object{{"singular", type.singular}, {"class", to_string(type.kind)}, {"rank", type.rank}};
  if (type.point)
    object["point"] = is_planar ? Value(Vec2<double>(type.point->head<2>())) : Value(*type.point);
  if (type.screw) {
    put_number(object, "pitch", type.screw->pitch);
    object["axis"] = {{"point", Value(type.screw->point)}, {"direction", Value(type.screw->direction)}};
  }
  return object;
}

void put_shape(Value& answer, const AnyShape& picture) {
  std::visit([&](const auto& one) { put_shape_of(answer, one); }, picture);
}

/// Of robots that bear none.
void KinematicQuestion::read_loads() {
  refuse_if_asked(*this, "wrench", no_load(*this));
  if (ask == Ask::forward) refuse_if_asked(*this, "until", no_load(*this));
}

void KinematicQuestion::read() {
  if (ask == Ask::forward) {
    given.inputs = read_inputs(*this, query.required("inputs", "in leg order"));
    given.start = read_start(*this);
    if (const auto trace = query.optional("trace")) wants_trace = trace->boolean();
    wants_all = read_all(*this);
  } else if (ask == Ask::inverse) {
    given.at = read_asked_pose(*this);
    if (!given.at.pose && !query.has("independent")) query.required("pose", "pose of the platform");
    given.branch = read_branch(*this);
    if (const auto inputs = query.optional("start")) near_inputs = read_inputs(*this, *inputs);
    wants_all = read_all(*this);
  } else {
    given = read_configuration(*this);
  }
  wanted = read_kinematic_wants(*this);
  if (ask == Ask::forward || ask == Ask::inverse) read_loads();
}

void KinematicQuestion::solve_forward() {
  trace_.resize(wants_trace ? max_trace : 0);
  const ForwardOptions options{.start = given.start ? given.start : path_start(),
                               .max_iterations = max_iterations.value_or(100),
                               .trace = trace_};
  const Forward result = forward(robot, *given.inputs, options, work);
  found_ = {result.report, result.pose, {result.coordinates.begin(), result.coordinates.end()}};
  is_searched_ = result.report.status != Status::left_domain;
  remember(result.ok() ? std::optional(result.pose) : std::nullopt);
}

/// Every assembly mode of the inputs; the one nearest to the start stands for the answer.
void KinematicQuestion::find_modes() {
  modes_ = assembly_modes(robot, *given.inputs, work);
  found_ = {modes_->report, {}, {modes_->coordinates.begin(), modes_->coordinates.end()}};
  has_pose_ = !modes_->poses.empty();
  if (!has_pose_) {
    remember({});
    return;
  }
  const std::size_t chosen = nearest_pose(robot, modes_->poses, given.start.value_or(home(robot)));
  found_.pose = modes_->poses[chosen];
  found_.report.residual = modes_->residual[chosen];
  remember(found_.pose);
}

void KinematicQuestion::solve_inverse() {
  found_.report = given.at.report;
  if (!found_.report.ok()) return;
  InverseOptions options = given.branch.options();
  options.start = near_inputs;
  const Inverse result = inverse(robot, *given.at.pose, options, work);
  found_ = {result.report, *given.at.pose, {result.coordinates.begin(), result.coordinates.end()}};
  inputs_ = result.inputs;
  if (wanted.along) given.inputs = std::vector(inputs_.begin(), inputs_.end());  // where it begins to look
}

void KinematicQuestion::solve() {
  if (ask == Ask::forward && wants_all) return find_modes();
  if (ask == Ask::forward)
    solve_forward();
  else if (ask == Ask::inverse)
    solve_inverse();
  else
    found_ = solve_configuration(*this, given);
  has_pose_ = found_.report.ok();
}

void KinematicQuestion::tell() {
  const Report& found = found_.report;
  report(found);
  if (!has_pose_ && !is_searched_) return;
  if (ask == Ask::inverse) answer["inputs"] = inputs_;
  if (has_pose_) put_wanted(*this, wanted, given, found_);
  answer["residual"] = found.residual;
  if (!is_searched_) return;
  answer["iterations"] = found.iterations;
  if (!trace_.empty()) answer["trace"] = trace_value(trace_, found.iterations);
}

void KinematicQuestion::tell_all() {
  if (modes_)
    tell_modes();
  else if (has_pose_)
    answer["solutions"] = all_working_modes(*this, found_.pose, given.branch);
}

void KinematicQuestion::tell_modes() {
  if (modes_->report.status == Status::left_domain || modes_->report.status == Status::unsupported) return;
  Value solutions = Value::list();
  for (std::size_t k = 0; k < modes_->poses.size(); ++k) {
    solutions.push_back({{"pose", pose_value(modes_->poses[k])},
                         {"legs", legs_value(robot, modes_->poses[k], found_.coordinates, work)},
                         {"residual", modes_->residual[k]}});
    if (modes_->is_double[k]) solutions.back()["double"] = true;  // two modes merge: a type II singularity
  }
  answer["count"] = modes_->poses.size();
  answer["complete"] = modes_->is_complete;
  answer["solutions"] = std::move(solutions);
}

constexpr Handlers kinematic_handlers{
    .robots = "legs that bear no load",
    .wants = usual_wants | Wants{Want::velocity, Want::shape, Want::sensitivity, Want::lines},
    .answers = {.forward = answer_question<KinematicQuestion>,
                .inverse = answer_question<KinematicQuestion>,
                .velocity = answer_question<KinematicQuestion>,
                .shape = answer_question<KinematicQuestion>,
                .track = answer_kinematic_track,
                .describe = describe_platform},
    .plan = plan_poses};

}  // namespace sinew::inline v1
