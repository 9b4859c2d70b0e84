#include "query/context.hpp"

#include <fmt/format.h>

#include <cmath>

#include "io/document/reader.hpp"
#include "io/robots/read_pose.hpp"
#include "math/tilt.hpp"
#include "sinew/kinematics/forward.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::inline v1 {

AnyPose read_pose(const Context& context, Reader pose) {
  if (std::holds_alternative<PlanarPose>(home(context.robot))) return read_planar_pose(std::move(pose));
  return read_spatial_pose(std::move(pose));
}

std::optional<AnyPose> read_start(Context& context) {
  auto start = context.query.optional("start");
  if (!start) return {};
  context.names_start = true;
  if (!start->is(Node::Kind::string)) return read_pose(context, std::move(*start));
  if (start->text() != "last")
    start->refuse("unknown_choice", "give a pose, or last: the pose last answered to a query with a start");
  else if (!context.last || context.continues == Continues::always)
    start->refuse("no_effect", "in a study path says where searches begin; leave it out");
  else if (*context.last && (*context.last)->index() == home(context.robot).index())  // or set has changed it
    context.starts_at_last = true;
  return context.starts_at_last ? *context.last : std::nullopt;
}

AskedPose read_asked_pose(Context& context) {
  AskedPose asked;
  auto pose = context.query.optional("pose");
  if (pose) asked.pose = read_pose(context, std::move(*pose));
  auto independent = context.query.optional("independent");
  if (!independent) return asked;
  const IndependentPose free{
      independent->required("z", "height of the platform").quantity(Dimension::length, PoseRange::coordinate),
      independent->required("e1", "a number").number(PoseRange::component),
      independent->required("e2", "a number").number(PoseRange::component)};
  OperationMode mode = OperationMode::tilt;
  if (const auto word = independent->optional("mode"))
    mode = word->choice_of<OperationMode>(
        {{"tilt", OperationMode::tilt}, {"half_turn", OperationMode::half_turn}});
  if (independent->is(Node::Kind::map)) independent->close();
  if (pose) context.query.fail("ambiguous", "pose and independent both say where the platform is; keep one");
  if (plane_count(context.robot) != 3) {
    independent->fail(
        "not_available",
        "z, e1 and e2 belong to a platform that three hinges hold in planes, such as a 3-PRS; give "
        "the pose");
    return asked;
  }
  asked.independent = {free, mode};
  const ConstrainedPose found = constrained_pose(context.robot, free, mode);
  asked.pose = found.pose;
  asked.report = found.report;
  return asked;
}

namespace {

/// One sign a leg.
std::vector<int> read_signs(const Reader& list, std::size_t legs, std::string_view rule) {
  std::vector<int> signs;
  for (const Reader& sign : list.items(legs)) {
    const int value = sign.integer();
    if (value != 1 && value != -1) sign.refuse("out_of_range", rule);
    signs.push_back(value);
  }
  signs.resize(legs, 1);
  return signs;
}

}  // namespace

Branch read_branch(Context& context) {
  Branch branch;
  const auto legs = static_cast<std::size_t>(leg_count(context.robot));
  const auto refuse_without_arc = [&](const Reader& asked) {
    if (!has_arc(context.robot))
      asked.fail("no_effect", "has no effect: no leg of this robot has a curvature; remove it");
  };
  if (const auto bending = context.query.optional("bending")) {
    branch.bending = read_signs(*bending, legs, "give 1 or -1, the sign of the curvature");
    refuse_without_arc(*bending);
  }
  if (const auto elbow = context.query.optional("elbow")) {
    branch.elbow = read_signs(*elbow, legs, "give 1 or -1, the side to which the strut turns");
    if (!has_elbow(context.robot))
      elbow->fail("no_effect", "has no effect: no leg of this robot has an elbow; remove it");
  }
  if (const auto curvature = context.query.optional("curvature")) {
    branch.curvature = curvature->quantities(Dimension::curvature, {}, legs);
    refuse_without_arc(*curvature);
    if (!branch.bending.empty())
      curvature->fail("ambiguous", "bending and curvature both choose a branch; keep one");
  }
  return branch;
}

std::vector<double> read_inputs(Context& context, const Reader& inputs) {
  const auto kinds = inputs_of(context.robot);
  const auto items = inputs.items(kinds.size());
  std::vector<double> values;
  for (std::size_t k = 0; k < items.size() && k < kinds.size(); ++k)
    values.push_back(items[k].quantity(kinds[k].dimension));
  values.resize(kinds.size());
  return values;
}

Configuration read_configuration(Context& context) {
  Configuration configuration;
  configuration.branch = read_branch(context);
  configuration.at = read_asked_pose(context);
  if (const auto inputs = context.query.optional("inputs"))
    configuration.inputs = read_inputs(context, *inputs);
  configuration.start = read_start(context);
  if (!configuration.at.pose && !configuration.inputs)
    context.query.fail("missing_key", "give a pose, or inputs, or both");
  if (configuration.inputs && !configuration.branch.is_default())
    context.query.fail(
        "ambiguous",
        "bending, curvature and elbow choose among solutions; the inputs are given, remove them");
  if (configuration.at.pose && context.names_start)
    context.query.fail("ambiguous",
                       "start is where a search for the pose begins; the pose is given, remove it");
  return configuration;
}

Solved solve_configuration(Context& context, const Configuration& given) {
  Workspace& work = context.work;
  const std::optional<AnyPose>& pose = given.at.pose;
  if (!given.at.report.ok()) return {given.at.report, *pose, {}};
  if (!given.inputs) {
    const Inverse solved = inverse(context.robot, *pose, given.branch.options(), work);
    return {solved.report, *pose, {solved.coordinates.begin(), solved.coordinates.end()}};
  }
  if (!pose) {
    ForwardOptions options{.start = given.start, .max_iterations = context.max_iterations.value_or(100)};
    if (!given.start) options.start = context.path_start();
    const Forward solved = forward(context.robot, *given.inputs, options, work);
    context.remember(solved.ok() ? std::optional(solved.pose) : std::nullopt);
    return {solved.report, solved.pose, {solved.coordinates.begin(), solved.coordinates.end()}};
  }
  Report report = coordinates_from_inputs(context.robot, *given.inputs, work);
  Solved solved{report, *pose, work.coordinates};
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

Value pose_value(const AnyPose& pose) {
  if (const auto* planar = std::get_if<PlanarPose>(&pose))
    return {{"x", planar->x}, {"y", planar->y}, {"phi", wrap_angle(planar->phi)}};
  const auto& spatial = std::get<SpatialPose>(pose);
  return {{"position", {spatial.position[0], spatial.position[1], spatial.position[2]}},
          {"quaternion", spatial.quaternion}};
}

namespace {

/// Of what has a quaternion.
void add_tilt_of(Value* pose) {
  const Value* quaternion = pose ? pose->find("quaternion") : nullptr;
  if (!quaternion) return;
  const std::span<const double> q = quaternion->block()->numbers();
  const TiltTorsion angles = tilt_torsion({q[0], Vec3<double>(q[1], q[2], q[3])});
  (*pose)["tilt"] = angles.tilt;
  (*pose)["azimuth"] = angles.azimuth;
  (*pose)["torsion"] = angles.torsion;
}

}  // namespace

void add_tilt(Value& answer) {
  add_tilt_of(answer.find("pose"));
  add_tilt_of(answer.find("tip"));
  if (Value* solutions = answer.find("solutions"))
    for (std::size_t k = 0; k < solutions->size(); ++k)
      for (const char* key : {"pose", "tip"}) add_tilt_of((*solutions)[k].find(key));
}

void put_number(Value& object, Value::Key key, double value) {
  if (std::isfinite(value)) object[key] = value;
}

Value indices_value(const Indices& indices) {
  Value object = Value::map();
  put_number(object, "condition", indices.condition);
  put_number(object, "condition_homogenised", indices.condition_homogenised);
  put_number(object, "position", indices.position);
  put_number(object, "rotation", indices.rotation);
  return object;
}

Value legs_value(const Robot& robot, const AnyPose& pose, std::span<const double> coordinates,
                 Workspace& work) {
  const bool is_planar = std::holds_alternative<PlanarPose>(pose);
  Value legs = Value::list();
  for (const LegState& leg : leg_states(robot, pose, coordinates, work)) {
    Value object = Value::map();
    if (std::isnan(leg.curvature)) {
      object.add("slide") = leg.slide;
      object.add("carriage") = Value(leg.carriage);
      object.add("hinge_angle") = leg.hinge_angle;
    } else {
      object.add("curvature") = leg.curvature;
      object.add("chord") = leg.chord;
      object.add("tendon_lengths") = leg.tendon_lengths;
      if (is_planar)
        object.add("base_tangent") = wrap_angle(std::atan2(leg.base_tangent.y(), leg.base_tangent.x()));
      else
        object.add("base_tangent") = Value(leg.base_tangent);
      if (!is_planar) object.add("joint_angles") = leg.joint_angles;
    }
    if (leg.elbow != 0) object.add("elbow") = leg.elbow;
    legs.push_back(std::move(object));
  }
  return legs;
}

}  // namespace sinew::inline v1
