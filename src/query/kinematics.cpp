/// Handlers of the queries that solve: forward, inverse, velocity, shape.
#include <fmt/format.h>

#include <cmath>

#include "query/context.hpp"
#include "sinew/analysis/shape.hpp"
#include "sinew/kinematics/forward.hpp"

namespace sinew::inline v0 {
namespace {

constexpr double most_solutions = 256;
constexpr std::size_t most_trace = 1000;

void refuse_if_asked(Context& context, std::string_view key, std::string_view why) {
  if (const auto asked = context.query.optional(key)) asked->fail("not_available", why);
}

Json all_working_modes(Context& context, const AnyPose& pose) {
  const WorkingModes modes = working_modes(context.robot, pose, context.work);
  Json solutions = Json::array();
  std::vector<double> inputs(context.work.inputs.size());
  for (std::size_t k = 0; static_cast<double>(k) < std::min(modes.count, most_solutions); ++k) {
    modes.mode(k, inputs);
    command(context.robot, inputs, context.work);
    const std::vector<double> coordinates = context.work.coordinates;
    solutions.push_back(
        {{"inputs", to_json(inputs)}, {"legs", legs_json(context.robot, pose, coordinates, context.work)}});
  }
  if (modes.count > most_solutions)
    context.answer["message"] =
        fmt::format("{:.0f} working modes exist; the first {:.0f} are listed", modes.count, most_solutions);
  return solutions;
}

Json trace_json(std::span<const TraceStep> trace, int iterations) {
  Json list = Json::array();
  for (const TraceStep& step : trace.first(std::min(trace.size(), static_cast<std::size_t>(iterations) + 1)))
    list.push_back({{"iteration", step.iteration}, {"residual", step.residual}, {"step", step.step}});
  return list;
}

void put_number(Json& object, const char* key, double value) {  // NaN and infinity never appear in an answer
  if (std::isfinite(value)) object[key] = value;
}

Json indices_json(const Indices& indices) {
  Json object = Json::object();
  put_number(object, "condition", indices.condition);
  put_number(object, "condition_homogenised", indices.condition_homogenised);
  put_number(object, "position", indices.position);
  put_number(object, "rotation", indices.rotation);
  return object;
}

Json type_two_json(const TypeTwo& type) {
  Json object{{"singular", type.singular}, {"class", to_string(type.kind)}, {"rank", type.rank}};
  if (type.kind == LineClass::concurrent) object["point"] = to_json(type.point);
  return object;
}

void put_rates(Context& context, const Velocity& result, std::span<const double> twist) {
  const Report found = rates(result, twist, context.work);
  if (found.ok())
    context.answer["rates"] = to_json(context.work.rates);
  else
    context.report(found);
}

Json polylines(const std::vector<Polyline>& lines) {
  Json list = Json::array();
  for (const Polyline& line : lines) {
    Json points = Json::array();
    for (const Vec2<double>& point : line) points.push_back(to_json(point));
    list.push_back(points);
  }
  return list;
}

}  // namespace

void answer_forward(Context& context) {
  const auto inputs = read_inputs(context, context.query.required("inputs", "in leg order"));
  ForwardOptions options{.max_iterations = context.max_iterations.value_or(100)};
  if (auto start = context.query.optional("start")) options.start = read_pose(std::move(*start));
  std::vector<TraceStep> trace;
  if (const auto wanted = context.query.optional("trace"))
    if (wanted->boolean()) trace.resize(most_trace);
  options.trace = trace;
  if (const auto all = context.query.optional("all"))
    if (all->boolean())
      all->fail("not_available",
                "all assembly modes are not available in this version; give a start for each mode");
  refuse_if_asked(context, "wrench", "a constant-curvature model bears no load; leave the wrench out");
  refuse_if_asked(context, "until", "a constant-curvature model bears no load; leave until out");
  if (!context.ready()) return;

  const Forward result = forward(context.robot, inputs, options, context.work);
  context.report(result.report);
  if (result.ok()) {
    context.answer["pose"] = to_json(result.pose);
    context.answer["legs"] = legs_json(context.robot, result.pose, result.coordinates, context.work);
  }
  if (result.report.status == Status::left_domain) return;  // nothing was solved
  context.answer["residual"] = result.report.residual;
  context.answer["iterations"] = result.report.iterations;
  if (!trace.empty()) context.answer["trace"] = trace_json(trace, result.report.iterations);
}

void answer_inverse(Context& context) {
  const AnyPose pose = read_pose(context.query.required("pose", "{x, y, phi}"));
  const Branch branch = read_branch(context);
  const auto all = context.query.optional("all");
  const bool want_all = all && all->boolean();
  refuse_if_asked(context, "wrench", "a constant-curvature model bears no load; leave the wrench out");
  if (const auto start = context.query.optional("start"))  // closed form needs none, but it is no mistake
    read_inputs(context, *start);
  if (!context.ready()) return;

  const Inverse result = inverse(context.robot, pose, branch.options(), context.work);
  context.report(result.report);
  if (!result.ok()) return;
  context.answer["inputs"] = to_json(result.inputs);
  const std::vector<double> coordinates(result.coordinates.begin(), result.coordinates.end());
  context.answer["legs"] = legs_json(context.robot, pose, coordinates, context.work);
  context.answer["pose"] = to_json(pose);
  context.answer["residual"] = result.report.residual;
  if (want_all) context.answer["solutions"] = all_working_modes(context, pose);
}

void answer_velocity(Context& context) {
  const Configuration given = read_configuration(context);
  std::vector<double> twist;
  if (const auto asked = context.query.optional("twist"))
    twist = asked->quantities(Dimension::number, {}, static_cast<std::size_t>(dof(context.robot)));
  refuse_if_asked(context, "angles",
                  "a constant-curvature model has no joint angles; give inputs or a branch");
  if (!context.ready()) return;
  const Solved at = solve_configuration(context, given);
  if (!context.errors.empty()) return;
  context.report(at.report);
  if (!at.report.ok()) return;

  const Velocity result = velocity(context.robot, at.pose, at.coordinates, context.work);
  context.report(result.report);
  context.answer["pose"] = to_json(at.pose);
  context.answer["J"] = to_json(result.J);
  context.answer["K"] = to_json(result.K);
  if (result.U.rows() > 0) context.answer["U"] = to_json(result.U);
  put_number(context.answer, "determinant", result.determinant);
  context.answer["indices"] = indices_json(result.indices);
  context.answer["type_1"] = std::vector<int>(result.type_1.begin(), result.type_1.end());
  context.answer["type_2"] = type_two_json(result.type_2);
  context.answer["residual"] = result.report.residual;
  if (!twist.empty()) put_rates(context, result, twist);
  context.answer["legs"] = legs_json(context.robot, at.pose, at.coordinates, context.work);
}

void answer_shape(Context& context) {
  const Configuration given = read_configuration(context);
  const auto samples = context.query.optional("samples");
  const int count = samples ? samples->integer(Range::between(2, 2000)) : 33;
  if (!context.ready()) return;
  const Solved at = solve_configuration(context, given);
  if (!context.errors.empty()) return;
  context.report(at.report);
  if (!at.report.ok()) return;

  const PlanarShape picture = shape(context.robot, at.pose, at.coordinates, count);
  context.answer["pose"] = to_json(at.pose);
  context.answer["backbones"] = polylines(picture.backbones);
  Json tendons = Json::array(), lines = Json::array();
  for (const auto& pair : picture.tendons) tendons.push_back(polylines({pair[0], pair[1]}));
  for (const auto& line : picture.lines) lines.push_back({to_json(line[0]), to_json(line[1])});
  context.answer["tendons"] = tendons;
  context.answer["lines"] = lines;
  context.answer["platform"] = polylines({picture.platform})[0];
  context.answer["base"] = polylines({picture.base})[0];
  context.answer["frames"] = Json::array({to_json(at.pose)});
}

}  // namespace sinew::inline v0
