/// Handlers of the queries that solve: forward, inverse, velocity, shape.
#include <fmt/format.h>

#include <cmath>

#include "query/handlers.hpp"
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

/// What legs that bear no load can tell, with the fields of its words.
struct KinematicWants {
  Wants words;
  std::vector<double> twist;   ///< of `velocity`
  std::optional<Along> along;  ///< likewise
  int samples = 0;             ///< of `shape`
};

KinematicWants read_kinematic_wants(Context& context, Wants usual) {
  constexpr Wants known = usual_wants | Wants{Want::velocity, Want::shape, Want::sensitivity, Want::lines};
  KinematicWants wanted{read_wants(context, usual, known), {}, {}, 0};
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

void answer_kinematic_forward(Context& context) {
  Configuration given;
  given.inputs = read_inputs(context, context.query.required("inputs", "in leg order"));
  ForwardOptions options{.max_iterations = context.max_iterations.value_or(100)};
  options.start = read_start(context);
  std::vector<TraceStep> trace;
  if (const auto wanted = context.query.optional("trace"))
    if (wanted->boolean()) trace.resize(max_trace);
  options.trace = trace;
  const bool want_all = read_all(context);
  const KinematicWants wanted = read_kinematic_wants(context, usual_wants);
  refuse_if_asked(context, "wrench", no_load(context));
  refuse_if_asked(context, "until", no_load(context));
  if (!context.ready()) return;

  if (want_all) return put_all_modes(context, wanted, given, options.start.value_or(home(context.robot)));
  if (!options.start) options.start = context.path_start();
  const Forward result = forward(context.robot, *given.inputs, options, context.work);
  context.report(result.report);
  context.remember(result.ok() ? std::optional(result.pose) : std::nullopt);
  if (result.report.status == Status::left_domain) return;  // nothing was solved
  if (result.ok())
    put_wanted(context, wanted, given,
               {result.report, result.pose, {result.coordinates.begin(), result.coordinates.end()}});
  context.answer["residual"] = result.report.residual;
  context.answer["iterations"] = result.report.iterations;
  if (!trace.empty()) context.answer["trace"] = trace_value(trace, result.report.iterations);
}

void answer_kinematic_inverse(Context& context) {
  const AskedPose asked = read_asked_pose(context);
  if (!asked.pose && !context.query.has("independent"))
    context.query.required("pose", "pose of the platform");
  Configuration given;
  given.branch = read_branch(context);
  const bool want_all = read_all(context);
  const KinematicWants wanted = read_kinematic_wants(context, usual_wants);
  refuse_if_asked(context, "wrench", no_load(context));
  std::vector<double> start;
  if (const auto inputs = context.query.optional("start")) start = read_inputs(context, *inputs);
  if (!context.ready()) return;

  InverseOptions options = given.branch.options();
  options.start = start;
  if (!asked.report.ok()) return context.report(asked.report);
  const AnyPose& pose = *asked.pose;
  const Inverse result = inverse(context.robot, pose, options, context.work);
  context.report(result.report);
  if (!result.ok()) return;
  context.answer["inputs"] = result.inputs;
  given.inputs.emplace(result.inputs.begin(), result.inputs.end());
  put_wanted(context, wanted, given,
             {result.report, pose, {result.coordinates.begin(), result.coordinates.end()}});
  context.answer["residual"] = result.report.residual;
  if (want_all) context.answer["solutions"] = all_working_modes(context, pose, given.branch);
}

namespace {

/// Of a configuration that a question gives in whatever way.
void answer_configuration(Context& context, Wants usual) {
  const Configuration given = read_configuration(context);
  const KinematicWants wanted = read_kinematic_wants(context, usual);
  if (!context.ready()) return;
  const Solved at = solve_configuration(context, given);
  if (!context.errors.empty()) return;
  context.report(at.report);
  if (!at.report.ok()) return;
  put_wanted(context, wanted, given, at);
  context.answer["residual"] = at.report.residual;
}

}  // namespace

void answer_kinematic_velocity(Context& context) {
  answer_configuration(context, usual_wants | Wants{Want::velocity});
}

void answer_kinematic_shape(Context& context) { answer_configuration(context, {Want::pose, Want::shape}); }

}  // namespace sinew::inline v1
