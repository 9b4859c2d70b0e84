/// Handlers of the queries that solve: forward, inverse, velocity, shape.
#include <fmt/format.h>

#include <cmath>

#include "query/chains.hpp"
#include "query/context.hpp"
#include "query/rods.hpp"
#include "query/serial.hpp"
#include "sinew/analysis/shape.hpp"
#include "sinew/kinematics/assembly_modes.hpp"
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
    context.answer["message"] =
        fmt::format("{:.0f} working modes exist; the first {:.0f} are listed", modes.count, max_solutions);
  else if (modes.is_continuum)
    context.answer["message"] =
        "the robot is redundant: at this pose its legs can move; listed are the modes of the curvature asked "
        "for";
  return solutions;
}

Value trace_value(std::span<const TraceStep> trace, int iterations) {
  Value list = Value::list();
  for (const TraceStep& step : trace.first(std::min(trace.size(), static_cast<std::size_t>(iterations) + 1)))
    list.push_back({{"iteration", step.iteration}, {"residual", step.residual}, {"step", step.step}});
  return list;
}

void put_rates(Context& context, const Velocity& result, std::span<const double> twist) {
  const Report found = rates(result, twist, context.work);
  if (found.ok())
    context.answer["rates"] = Value(context.work.rates);
  else
    context.report(found);
}

template <int D>
Value polyline(const PolylineOf<D>& line) {
  Value points = Value::list();
  for (const auto& point : line) points.push_back(Value(point));
  return points;
}

template <int D>
void put_shape_of(Value& answer, const ShapeOf<D>& picture) {
  Value backbones = Value::list(), tendons = Value::list(), lines = Value::list();
  for (const auto& line : picture.backbones) backbones.push_back(polyline<D>(line));
  for (const auto& pair : picture.tendons)
    tendons.push_back(Value::list({polyline<D>(pair[0]), polyline<D>(pair[1])}));
  for (const auto& line : picture.lines) lines.push_back(Value::list({Value(line[0]), Value(line[1])}));
  answer["backbones"] = backbones;
  answer["tendons"] = tendons;
  answer["lines"] = lines;
  answer["platform"] = polyline<D>(picture.platform);
  answer["base"] = polyline<D>(picture.base);
}

/// Every assembly mode of the inputs; the one nearest to the start stands for the answer.
void answer_all_modes(Context& context, const std::vector<double>& inputs, const AnyPose& start) {
  const AssemblyModes modes = assembly_modes(context.robot, inputs, context.work);
  context.report(modes.report);
  context.remember({});
  if (modes.report.status == Status::left_domain || modes.report.status == Status::unsupported) return;
  Value solutions = Value::list();
  for (std::size_t k = 0; k < modes.poses.size(); ++k)
    solutions.push_back({{"pose", pose_value(modes.poses[k])},
                         {"legs", legs_value(context.robot, modes.poses[k], modes.coordinates, context.work)},
                         {"residual", modes.residual[k]}});
  for (std::size_t k = 0; k < modes.poses.size(); ++k)
    if (modes.is_double[k]) solutions[k]["double"] = true;  // two modes merge: a type II singularity
  if (!modes.poses.empty()) {
    const std::size_t chosen = nearest_pose(context.robot, modes.poses, start);
    context.remember(modes.poses[chosen]);
    const Value& nearest = solutions[chosen];
    for (const Value::Key key : {Value::Key("pose"), Value::Key("legs"), Value::Key("residual")})
      context.answer[key] = *nearest.find(key.name());
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

void answer_forward(Context& context) {
  if (context.robot.serial()) return answer_serial_forward(SerialContext(context));
  if (has_rods(context.robot)) return answer_rods_forward(context);
  if (context.robot.model() == Model::prb) return answer_chains_forward(context);
  const auto inputs = read_inputs(context, context.query.required("inputs", "in leg order"));
  ForwardOptions options{.max_iterations = context.max_iterations.value_or(100)};
  options.start = read_start(context);
  std::vector<TraceStep> trace;
  if (const auto wanted = context.query.optional("trace"))
    if (wanted->boolean()) trace.resize(max_trace);
  options.trace = trace;
  const auto all = context.query.optional("all");
  const bool want_all = all && all->boolean();
  refuse_if_asked(context, "want",
                  "this robot's legs bear no load; velocity has its indices, leave want out");
  refuse_if_asked(context, "wrench", no_load(context));
  refuse_if_asked(context, "until", no_load(context));
  if (!context.ready()) return;

  if (want_all) return answer_all_modes(context, inputs, options.start.value_or(home(context.robot)));
  if (!options.start) options.start = context.path_start();
  const Forward result = forward(context.robot, inputs, options, context.work);
  context.report(result.report);
  context.remember(result.ok() ? std::optional(result.pose) : std::nullopt);
  if (result.ok()) {
    context.answer["pose"] = pose_value(result.pose);
    context.answer["legs"] = legs_value(context.robot, result.pose, result.coordinates, context.work);
  }
  if (result.report.status == Status::left_domain) return;  // nothing was solved
  context.answer["residual"] = result.report.residual;
  context.answer["iterations"] = result.report.iterations;
  if (!trace.empty()) context.answer["trace"] = trace_value(trace, result.report.iterations);
}

void answer_inverse(Context& context) {
  if (context.robot.serial()) return answer_serial_inverse(SerialContext(context));
  if (has_rods(context.robot)) return answer_rods_inverse(context);
  if (context.robot.model() == Model::prb) return answer_chains_inverse(context);
  const AskedPose asked = read_asked_pose(context);
  if (!asked.pose && !context.query.has("independent"))
    context.query.required("pose", "pose of the platform");
  const Branch branch = read_branch(context);
  const auto all = context.query.optional("all");
  const bool want_all = all && all->boolean();
  refuse_if_asked(context, "want",
                  "this robot's legs bear no load; velocity has its indices, leave want out");
  refuse_if_asked(context, "wrench", no_load(context));
  std::vector<double> start;
  if (const auto given = context.query.optional("start")) start = read_inputs(context, *given);
  if (!context.ready()) return;

  InverseOptions options = branch.options();
  options.start = start;
  if (!asked.report.ok()) return context.report(asked.report);
  const AnyPose& pose = *asked.pose;
  const Inverse result = inverse(context.robot, pose, options, context.work);
  context.report(result.report);
  if (!result.ok()) return;
  context.answer["inputs"] = Value(result.inputs);
  const std::vector<double> coordinates(result.coordinates.begin(), result.coordinates.end());
  context.answer["legs"] = legs_value(context.robot, pose, coordinates, context.work);
  context.answer["pose"] = pose_value(pose);
  context.answer["residual"] = result.report.residual;
  if (want_all) context.answer["solutions"] = all_working_modes(context, pose, branch);
}

void answer_velocity(Context& context) {
  if (context.robot.serial()) return answer_serial_velocity(SerialContext(context));
  if (has_rods(context.robot)) return answer_rods_velocity(context);
  if (context.robot.model() == Model::prb) return answer_chains_velocity(context);
  const Configuration given = read_configuration(context);
  std::vector<double> twist;
  if (const auto asked = context.query.optional("twist"))
    twist = asked->quantities(Dimension::number, {}, static_cast<std::size_t>(dof(context.robot)));
  const std::optional<Along> along = read_along(context);
  refuse_if_asked(
      context, "angles",
      "a constant-curvature model has no joint angles; add model: prb, or give inputs or a branch");
  if (!context.ready()) return;
  const Solved at = solve_configuration(context, given);
  if (!context.errors.empty()) return;
  context.report(at.report);
  if (!at.report.ok()) return;

  const Velocity result = velocity(context.robot, at.pose, at.coordinates, context.work);
  context.report(result.report);
  context.answer["pose"] = pose_value(at.pose);
  context.answer["J"] = Value(result.J);
  context.answer["K"] = Value(result.K);
  if (result.U.rows() > 0) context.answer["U"] = Value(result.U);
  put_number(context.answer, "determinant", result.determinant);
  context.answer["indices"] = indices_value(result.indices);
  context.answer["type_1"] = std::span<const int>(result.type_1);
  context.answer["type_2"] = type_two_value(result.type_2, std::holds_alternative<PlanarPose>(at.pose));
  context.answer["residual"] = result.report.residual;
  if (!twist.empty()) put_rates(context, result, twist);
  context.answer["legs"] = legs_value(context.robot, at.pose, at.coordinates, context.work);
  if (along) put_type_2_distance(context, *along, given, at.pose);
}

void answer_shape(Context& context) {
  if (context.robot.serial()) return answer_serial_shape(SerialContext(context));
  if (has_rods(context.robot)) return answer_rods_shape(context);
  if (context.robot.model() == Model::prb) return answer_chains_shape(context);
  const Configuration given = read_configuration(context);
  const auto samples = context.query.optional("samples");
  const int count = samples ? samples->integer(Range::between(2, 2000)) : 33;
  if (!context.ready()) return;
  const Solved at = solve_configuration(context, given);
  if (!context.errors.empty()) return;
  context.report(at.report);
  if (!at.report.ok()) return;

  context.answer["pose"] = pose_value(at.pose);
  put_shape(context.answer, any_shape(context.robot, at.pose, at.coordinates, count));
  context.answer["frames"] = Value::list({pose_value(at.pose)});
}

}  // namespace sinew::inline v1
