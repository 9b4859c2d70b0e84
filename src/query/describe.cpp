/// `describe`: what a robot with a platform has.
#include "io/document/quantity.hpp"
#include "leg/input_limits.hpp"
#include "query/context.hpp"
#include "query/handlers.hpp"
#include "query/questions.hpp"
#include "robot/parallel.hpp"
#include "tendon/input_kind.hpp"
#include "tendon/theta_is.hpp"

namespace sinew::inline v1 {
namespace {

/// Writes the fields of a part into a JSON object, in SI.
struct FieldWriter {
  Value& object;
  template <class T>
  void operator()(Value::Key key, const T& value, Dimension, Range, std::string_view) const {
    object[key] = value;
  }
  template <class T>
  void operator()(Value::Key key, const std::optional<T>& value, Dimension, Range, std::string_view) const {
    if (value) object[key] = *value;
  }
};

template <class LegT>
Value base_value(const LegT& leg) {
  Value base{{"point", Value(leg.base.p)}};
  if constexpr (LegT::dimension == 3) {
    const Value axis(leg.base.rotate(Vec3<double>(1, 0, 0)));
    if constexpr (HasSlide<typename LegT::Link>)
      base["hinge_axis"] = axis;
    else
      base["first_axis"] = axis;
    base["direction"] = Value(leg.base.rotate(Vec3<double>(0, 1, 0)));
  } else if constexpr (LegT::is_clamped) {
    base["direction"] = wrap_angle(leg.base.angle() + std::numbers::pi / 2);
  }
  return base;
}

template <class LegT>
Value leg_value(const LegT& leg, const LegPlace& place) {
  Value link{{"type", LegT::Link::name}}, closure{{"type", LegT::Closure::name}}, actuated = Value::list();
  LegT::Link::fields(leg.link, FieldWriter{link});
  LegT::Drive::fields(leg.drive, FieldWriter{link});
  if constexpr (requires { leg.drive.theta_is; })
    link["theta_is"] = leg.drive.theta_is == ThetaIs::chord ? "chord" : "tangent";
  Backbone::fields(leg.backbone, FieldWriter{link});
  if (leg.backbone.youngs_modulus) link["material"] = {{"E", *leg.backbone.youngs_modulus}};
  LegT::Closure::fields(leg.closure, FieldWriter{closure});
  for (const InputKind& kind : LegT::Drive::input_kinds) actuated.push_back(kind.name);
  return {{"base", base_value(leg)}, {"link", link},
          {"closure", closure},      {"platform_point", Value(leg.platform_point)},
          {"actuated", actuated},    {"input", place.input}};
}

Value leg_value(const RodLeg& leg, const LegPlace& place) {
  Value link{{"type", Rod::name}};
  Rod::fields(leg.link, FieldWriter{link});
  if (!leg.link.is_round()) link["section"] = {{"width", leg.link.width}, {"height", leg.link.height}};
  if (!leg.link.precurvature.isZero(0)) link["precurvature"] = Value(leg.link.precurvature);
  if (!leg.link.load.isZero(0)) link["load"] = Value(leg.link.load);
  link["material"] = {{"E", leg.link.youngs_modulus}};
  if (leg.link.shear_modulus > 0) link["material"]["G"] = leg.link.shear_modulus;
  if (leg.link.density > 0) link["material"]["density"] = leg.link.density;
  link["law"] = leg.link.is_cosserat ? "cosserat" : "kirchhoff";
  Value closure{{"type", leg.is_clamped ? Clamp::name : Ball::name}};
  if (leg.is_clamped) closure["direction"] = Value(leg.platform_tangent);
  Value base{{"point", Value(leg.base.p)}, {"direction", Value(leg.tangent())}};
  if (leg.is_spin_held) base["spin"] = "held";
  if (leg.is_tip_spin_free) closure["spin"] = "free";
  if (!leg.is_torque_free()) {  // how the section lies counts
    base["section_x"] = Value(leg.base.rotate(Vec3<double>(1, 0, 0)));
    if (leg.is_clamped) closure["section_x"] = Value(leg.platform_across);
  }
  return {{"base", base},
          {"link", link},
          {"closure", closure},
          {"platform_point", Value(leg.platform_point)},
          {"actuated", Value::list({RodLengthDrive::input_kinds[0].name})},
          {"input", place.input}};
}

/// Name, unit and, of tendons, limits: the ends of the curvature's domain. A rail has none.
template <class LegT>
void add_inputs(Value& inputs, const LegT& leg, std::size_t index) {
  for (const InputKind& kind : LegT::Drive::input_kinds) {
    Value input{{"name", joined(joined("legs", index), kind.name)}, {"unit", unit(kind.dimension)}};
    if (HasArc<typename LegT::Link> && kind.dimension == Dimension::length)
      input["limits"] = {input_limits(leg)[0], input_limits(leg)[1]};
    inputs.push_back(std::move(input));
  }
}

void add_inputs(Value& inputs, const RodLeg&, std::size_t index) {
  inputs.push_back(
      {{"name", joined(joined("legs", index), RodLengthDrive::input_kinds[0].name)}, {"unit", "m"}});
}

Value pose_coordinates(bool is_planar) {
  if (is_planar)
    return Value::list(
        {{{"name", "x"}, {"unit", "m"}}, {{"name", "y"}, {"unit", "m"}}, {{"name", "phi"}, {"unit", "rad"}}});
  return Value::list({{{"name", "position"}, {"unit", "m"}, {"size", 3}},
                      {{"name", "quaternion"}, {"unit", ""}, {"size", 4}}});
}

struct PlatformDescription : Context {
  explicit PlatformDescription(const Context& context) : Context(context) {}
  void read() {}
  void tell();
};

void PlatformDescription::tell() {
  Value inputs = Value::list(), legs = Value::list();
  with_legs(robot, [&](const auto& typed) {
    typed.for_each_leg([&](const auto& leg, const LegPlace& place, int i) {
      if (!place.is_tied) add_inputs(inputs, leg, static_cast<std::size_t>(i));
      legs.push_back(leg_value(leg, place));
    });
  });
  const bool is_planar = std::holds_alternative<PlanarPose>(home(robot));
  answer["status"] = "converged";
  answer["kind"] = "parallel";
  answer["space"] = is_planar ? "planar" : "spatial";
  answer["inputs"] = inputs;
  answer["pose"] = pose_coordinates(is_planar);
  answer["home"] = pose_value(home(robot));
  answer["platform"] = {{"radius", platform_radius(robot)}};
  if (has_rods(robot)) {
    answer["platform"]["mass"] = robot.weight().platform_mass;
    answer["gravity"] = Value(robot.weight().gravity);
  }
  answer["freedoms"] = {
      {"platform", dof(robot)}, {"constraints", row_count(robot)}, {"actuators", input_count(robot)}};
  answer["legs"] = legs;
  const bool has_arcs = robot.model() == Model::cc || robot.model() == Model::prb;
  Value models = Value::list({to_string(has_arcs ? Model::cc : robot.model())});
  if (has_arcs && robot.as(Model::prb)) models.push_back("prb");
  answer["models"] = std::move(models);
  answer["model"] = to_string(robot.model());
  answer["geometry"] = robot.geometry_inferred() ? "inferred" : "given";
  answer["versions"] = {{"sinew", version()}, {"protocol", 1}};
}

}  // namespace

void describe_platform(Context& context) { answer_question<PlatformDescription>(context); }

}  // namespace sinew::inline v1
