/// Handler of `describe`: what a robot has.
#include "query/context.hpp"
#include "sinew/io/quantity.hpp"

namespace sinew::inline v0 {
namespace {

/// Writes the fields of a part into a JSON object, in SI.
struct FieldWriter {
  Json& object;
  template <class T>
  void operator()(std::string_view key, const T& value, Dimension, Range, std::string_view) const {
    object[std::string(key)] = value;
  }
  template <class T>
  void operator()(std::string_view key, const std::optional<T>& value, Dimension, Range,
                  std::string_view) const {
    if (value) object[std::string(key)] = *value;
  }
};

template <class LegT>
Json leg_json(const LegT& leg) {
  Json link{{"type", LegT::Link::name}}, closure{{"type", LegT::Closure::name}};
  LegT::Link::fields(leg.link, FieldWriter{link});
  LegT::Drive::fields(leg.drive, FieldWriter{link});
  Backbone::fields(leg.backbone, FieldWriter{link});
  if (leg.backbone.youngs_modulus) link["material"] = {{"E", *leg.backbone.youngs_modulus}};
  LegT::Closure::fields(leg.closure, FieldWriter{closure});
  Json base{{"point", to_json(leg.base.p)}};
  if (!LegT::Closure::base_turns) base["direction"] = wrap_angle(leg.base.angle() + std::numbers::pi / 2);
  return {{"base", base},
          {"link", link},
          {"closure", closure},
          {"platform_point", to_json(leg.platform_point)},
          {"actuated", {LegT::Drive::input_name}}};
}

template <class LegT>
Json input_json(const LegT& leg, std::size_t index) {
  const double end = leg.domain();
  const double a = leg.input(-end), b = leg.input(end);
  return {{"name", joined(joined("legs", index), LegT::Drive::input_name)},
          {"unit", unit(LegT::Drive::input_dimension)},
          {"limits", {std::min(a, b), std::max(a, b)}}};
}

}  // namespace

void answer_describe(Context& context) {
  if (!context.ready()) return;
  Json inputs = Json::array(), legs = Json::array();
  double radius = 0;
  std::visit(
      [&](const auto& robot) {
        radius = robot.platform_radius;
        for (std::size_t i = 0; i < robot.legs.size(); ++i) {
          with_leg(robot.legs[i], [&](const auto& leg) {
            if (robot.input_of_leg[i] == static_cast<int>(inputs.size()))
              inputs.push_back(input_json(leg, i));
            legs.push_back(leg_json(leg));
            legs.back()["input"] = robot.input_of_leg[i];
          });
        }
      },
      context.robot.model);
  Json& answer = context.answer;
  answer["status"] = "converged";
  answer["kind"] = "parallel";
  answer["space"] = "planar";
  answer["inputs"] = inputs;
  answer["pose"] = Json::array(
      {{{"name", "x"}, {"unit", "m"}}, {{"name", "y"}, {"unit", "m"}}, {{"name", "phi"}, {"unit", "rad"}}});
  answer["home"] = to_json(home(context.robot));
  answer["platform"] = {{"radius", radius}};
  answer["legs"] = legs;
  answer["models"] = {"cc"};
  answer["model"] = "cc";
  answer["geometry"] = context.robot.geometry_inferred ? "inferred" : "given";
  answer["versions"] = {{"sinew", version()}, {"protocol", 1}};
}

}  // namespace sinew::inline v0
