#include "query/context.hpp"

#include <fmt/format.h>

#include "sinew/kinematics/forward.hpp"

namespace sinew::inline v0 {

PlanarPose read_pose(Reader pose) {
  PlanarPose result;
  result.x = pose.required("x").quantity(Dimension::length, Range::place());
  result.y = pose.required("y").quantity(Dimension::length, Range::place());
  result.phi = pose.required("phi").quantity(Dimension::angle);
  pose.close();
  return result;
}

Branch read_branch(Context& context) {
  Branch branch;
  const auto legs = static_cast<std::size_t>(leg_count(context.robot));
  if (const auto bending = context.query.optional("bending")) {
    for (const Reader& sign : bending->items(legs)) {
      const int value = sign.integer();
      if (value != 1 && value != -1) sign.refuse("out_of_range", "give 1 or -1, the sign of the curvature");
      branch.bending.push_back(value);
    }
    branch.bending.resize(legs, 1);
  }
  if (const auto curvature = context.query.optional("curvature")) {
    branch.curvature = curvature->quantities(Dimension::curvature, {}, legs);
    if (!branch.bending.empty())
      curvature->fail("ambiguous", "bending and curvature both choose a branch; keep one");
  }
  return branch;
}

std::vector<double> read_inputs(Context& context, const Reader& inputs) {
  return inputs.quantities(Dimension::length, {}, static_cast<std::size_t>(input_count(context.robot)));
}

Configuration read_configuration(Context& context) {
  Configuration configuration;
  configuration.branch = read_branch(context);
  if (auto pose = context.query.optional("pose")) configuration.pose = read_pose(std::move(*pose));
  if (const auto inputs = context.query.optional("inputs"))
    configuration.inputs = read_inputs(context, *inputs);
  if (auto start = context.query.optional("start")) configuration.start = read_pose(std::move(*start));
  if (!configuration.pose && !configuration.inputs)
    context.query.fail("missing_key", "give a pose, or inputs, or both");
  if (configuration.inputs && !configuration.branch.is_default())
    context.query.fail("ambiguous",
                       "bending or curvature choose among solutions; the inputs are given, remove them");
  if (configuration.pose && configuration.start)
    context.query.fail("ambiguous",
                       "start is where a search for the pose begins; the pose is given, remove it");
  return configuration;
}

Solved solve_configuration(Context& context, const Configuration& given) {
  Workspace& work = context.work;
  if (!given.inputs) {
    const Inverse solved = inverse(context.robot, *given.pose, given.branch.options(), work);
    return {solved.report, *given.pose, {solved.coordinates.begin(), solved.coordinates.end()}};
  }
  if (!given.pose) {
    const Forward solved =
        forward(context.robot, *given.inputs,
                {.start = given.start, .max_iterations = context.max_iterations.value_or(100)}, work);
    return {solved.report, solved.pose, {solved.coordinates.begin(), solved.coordinates.end()}};
  }
  Report report = command(context.robot, *given.inputs, work);
  Solved solved{report, *given.pose, work.coordinates};
  if (!report.ok()) return solved;
  const Reduced reduced = assemble(context.robot, solved.pose, solved.coordinates, work);
  solved.report.residual = reduced.closure_error;
  if (reduced.closure_error > 1e-9)
    context.query.fail(
        "not_closed",
        fmt::format("pose and inputs contradict each other: legs[{}] misses by {:.3g} m; leave one of them "
                    "out to have it solved",
                    reduced.worst_leg, reduced.closure_error));
  return solved;
}

Json to_json(const AnyPose& pose) {
  if (const auto* planar = std::get_if<PlanarPose>(&pose))
    return {{"x", planar->x}, {"y", planar->y}, {"phi", wrap_angle(planar->phi)}};
  const auto& spatial = std::get<SpatialPose>(pose);
  return {{"position", {spatial.position[0], spatial.position[1], spatial.position[2]}},
          {"quaternion", spatial.quaternion}};
}

Json to_json(std::span<const double> values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(value);
  return list;
}

Json to_json(const MatrixView& matrix) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    rows.push_back(
        to_json(std::span(matrix.data() + i * matrix.cols(), static_cast<std::size_t>(matrix.cols()))));
  return rows;
}

Json to_json(const Vec2<double>& point) { return {point.x(), point.y()}; }

Json legs_json(const AnyRobot& robot, const AnyPose& pose, std::span<const double> coordinates,
               Workspace& work) {
  Json legs = Json::array();
  for (const LegState& leg : leg_states(robot, pose, coordinates, work))
    legs.push_back({{"curvature", leg.curvature},
                    {"chord", leg.chord},
                    {"tendon_lengths", leg.tendon_lengths},
                    {"base_tangent", leg.base_tangent}});
  return legs;
}

}  // namespace sinew::inline v0
