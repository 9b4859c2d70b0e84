/// Handlers of the queries that solve: forward, inverse, velocity, shape.
#include <fmt/format.h>

#include <cmath>

#include "query/batch/sampler.hpp"
#include "query/kinematic/kinematics.hpp"
#include "query/loads.hpp"
#include "sinew/analysis/shape.hpp"
#include "sinew/kinematics/forward.hpp"

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

/// Every assembly mode of the inputs; the one nearest to the start stands for the answer.
void put_all_modes(Context& context, const KinematicWants& wanted, const Configuration& given,
                   const AnyPose& start) {
  const AssemblyModes modes = assembly_modes(context.robot, *given.inputs, context.work);
  context.report(modes.report);
  context.remember({});
  if (modes.report.status == Status::left_domain || modes.report.status == Status::unsupported) return;
  Value solutions = Value::list();
  for (std::size_t k = 0; k < modes.poses.size(); ++k) {
    solutions.push_back({{"pose", pose_value(modes.poses[k])},
                         {"legs", legs_value(context.robot, modes.poses[k], modes.coordinates, context.work)},
                         {"residual", modes.residual[k]}});
    if (modes.is_double[k]) solutions.back()["double"] = true;  // two modes merge: a type II singularity
  }
  if (!modes.poses.empty()) {
    const std::size_t chosen = nearest_pose(context.robot, modes.poses, start);
    context.remember(modes.poses[chosen]);
    put_wanted(context, wanted, given,
               {{}, modes.poses[chosen], {modes.coordinates.begin(), modes.coordinates.end()}});
    context.answer["residual"] = modes.residual[chosen];
  }
  context.answer["count"] = modes.poses.size();
  context.answer["complete"] = modes.is_complete;
  context.answer["solutions"] = std::move(solutions);
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

namespace {

struct KinematicForward {
  Configuration given;
  int max_iterations;
  bool wants_trace = false, wants_all = false;
  KinematicWants wanted;
};

KinematicForward read_forward(Context& context) {
  KinematicForward asked{.given = {}, .max_iterations = context.max_iterations.value_or(100), .wanted = {}};
  asked.given.inputs = read_inputs(context, context.query.required("inputs", "in leg order"));
  asked.given.start = read_start(context);
  if (const auto trace = context.query.optional("trace")) asked.wants_trace = trace->boolean();
  asked.wants_all = read_all(context);
  asked.wanted = read_kinematic_wants(context);
  refuse_if_asked(context, "wrench", no_load(context));
  refuse_if_asked(context, "until", no_load(context));
  return asked;
}

void answer_forward(Context& context, const KinematicForward& asked) {
  const Configuration& given = asked.given;
  if (asked.wants_all)
    return put_all_modes(context, asked.wanted, given, given.start.value_or(home(context.robot)));
  std::vector<TraceStep> trace(asked.wants_trace ? max_trace : 0);
  const ForwardOptions options{.start = given.start ? given.start : context.path_start(),
                               .max_iterations = asked.max_iterations,
                               .trace = trace};
  const Forward result = forward(context.robot, *given.inputs, options, context.work);
  context.report(result.report);
  context.remember(result.ok() ? std::optional(result.pose) : std::nullopt);
  if (result.report.status == Status::left_domain) return;  // nothing was solved
  if (result.ok())
    put_wanted(context, asked.wanted, given,
               {result.report, result.pose, {result.coordinates.begin(), result.coordinates.end()}});
  context.answer["residual"] = result.report.residual;
  context.answer["iterations"] = result.report.iterations;
  if (!trace.empty()) context.answer["trace"] = trace_value(trace, result.report.iterations);
}

void answer_inverse(Context& context, const KinematicInverse& asked) {
  InverseOptions options = asked.branch.options();
  options.start = asked.start;
  if (!asked.at.report.ok()) return context.report(asked.at.report);
  const AnyPose& pose = *asked.at.pose;
  const Inverse result = inverse(context.robot, pose, options, context.work);
  context.report(result.report);
  if (!result.ok()) return;
  context.answer["inputs"] = result.inputs;
  Configuration given;
  if (asked.wanted.along)  // which alone asks how it was given
    given = {.inputs = std::vector(result.inputs.begin(), result.inputs.end()), .branch = asked.branch};
  put_wanted(context, asked.wanted, given,
             {result.report, pose, {result.coordinates.begin(), result.coordinates.end()}});
  context.answer["residual"] = result.report.residual;
  if (asked.wants_all) context.answer["solutions"] = all_working_modes(context, pose, asked.branch);
}

/// Of a configuration that a question gives in whatever way.
void answer_configuration(Context& context, const KinematicConfiguration& asked) {
  const Solved at = solve_configuration(context, asked.given);
  if (!context.errors.empty()) return;
  context.report(at.report);
  if (!at.report.ok()) return;
  put_wanted(context, asked.wanted, asked.given, at);
  context.answer["residual"] = at.report.residual;
}

}  // namespace

KinematicInverse read_kinematic_inverse(Context& context) {
  KinematicInverse asked;
  asked.at = read_asked_pose(context);
  if (!asked.at.pose && !context.query.has("independent"))
    context.query.required("pose", "pose of the platform");
  asked.branch = read_branch(context);
  asked.wants_all = read_all(context);
  asked.wanted = read_kinematic_wants(context);
  refuse_if_asked(context, "wrench", no_load(context));
  if (const auto inputs = context.query.optional("start")) asked.start = read_inputs(context, *inputs);
  return asked;
}

KinematicConfiguration read_kinematic_configuration(Context& context) {
  KinematicConfiguration asked{read_configuration(context), {}};
  asked.wanted = read_kinematic_wants(context);
  return asked;
}

constexpr Handlers kinematic_handlers{
    .robots = "legs that bear no load",
    .wants = usual_wants | Wants{Want::velocity, Want::shape, Want::sensitivity, Want::lines},
    .answers = {.forward = handle<read_forward, answer_forward>,
                .inverse = handle<read_kinematic_inverse, answer_inverse>,
                .velocity = handle<read_kinematic_configuration, answer_configuration>,
                .shape = handle<read_kinematic_configuration, answer_configuration>,
                .track = answer_kinematic_track,
                .describe = tell<describe_platform>},
    .plan = plan_poses};

}  // namespace sinew::inline v1
