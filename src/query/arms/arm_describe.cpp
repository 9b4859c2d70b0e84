/// `describe` of arms and of platforms on arms.
#include <cmath>

#include "query/arms/arms.hpp"
#include "query/questions.hpp"
#include "sinew/base/export.hpp"
#include "sinew/robot/arm.hpp"

namespace sinew::inline v1 {
namespace {

Value cross_section_value(const CrossSection& section) {
  Value value{{"bending", {section.bending_x, section.bending_y}}, {"torsion", section.torsion}};
  if (section.stretch > 0) value["stretch"] = section.stretch;
  if (section.shear > 0) value["shear"] = section.shear;
  value["mass"] = section.mass;
  return value;
}

Value route_value(const TendonRoute& route) {
  Value value{{"radius", route.start_radius}, {"angle", route.start_angle}};
  if (route.end_radius != route.start_radius) value["end_radius"] = route.end_radius;
  if (route.end_angle != route.start_angle) value["turn"] = route.end_angle - route.start_angle;
  return value;
}

Value section_value(const ArmSection& section) {
  Value value{{"type", "elastic"}, {"length", section.length}};
  value["backbone"] = cross_section_value(section.start);
  if (section.end != section.start) value["backbone"]["end"] = cross_section_value(section.end);
  if (section.curvature != std::array<double, 3>{}) value["precurvature"] = section.curvature;
  if (section.discs.count > 0) {
    value["discs"] = {{"count", section.discs.count}, {"mass", section.discs.mass}};
    if (section.discs.radius > 0) value["discs"]["radius"] = section.discs.radius;
  } else {
    value["guides"] = "channel";
  }
  if (std::isfinite(section.limit)) value["limit"] = section.limit;
  return value;
}

Value tendon_value(const ArmTendon& tendon) {
  Value routes = Value::list();
  for (const TendonRoute& route : tendon.routes) routes.push_back(route_value(route));
  return {{"section", tendon.section()},     {"routes", routes},
          {"compliance", tendon.compliance}, {"outside", tendon.outside},
          {"friction", tendon.friction},     {"pretension", tendon.pretension}};
}

/// What the file says of how the arm is measured, with a number for each tendon.
Value measurement_value(const MeasuringSetup& measurement, std::size_t tendons) {
  const auto& [drive, marker] = measurement;
  const auto filled = [&](std::vector<double> values, double usual) {
    values.resize(tendons, usual);
    return values;
  };
  return {{"drive",
           {{"gain", filled(drive.gain, 1)},
            {"offset", filled(drive.offset, 0)},
            {"toe", filled(drive.toe, 0)},
            {"lag", drive.lag},
            {"play", drive.play}}},
          {"marker", {{"place", marker.place}, {"base", marker.base}, {"tilt", marker.tilt}}}};
}

Value point_value(const ArmLegs& robot, const Vec3<double>& point) {
  return robot.is_planar ? Value(Vec2<double>(point.head<2>())) : Value(point);
}
/// As a file has it.
Value base_value(const ArmLegs& robot, const ArmLeg& leg) {
  const Vec3<double> ahead = leg.base.rotate(Vec3<double>(0, 0, 1));
  Value base{{"point", point_value(robot, leg.base.p)}};
  if (robot.is_planar) {
    if (!leg.turns_at_base) base["direction"] = std::atan2(ahead.y(), ahead.x());
    return base;
  }
  base["direction"] = Value(ahead);
  base["section_x"] = Value(leg.base.rotate(Vec3<double>(1, 0, 0)));
  return base;
}
Value closure_value(const ArmLegs& robot, const ArmLeg& leg) {
  if (leg.strut > 0) return {{"type", "strut"}, {"length", leg.strut}};
  const char* joint = !robot.is_planar ? "ball" : leg.turns_at_base ? "chord" : "pin";
  return {{"type", leg.is_clamped ? "clamp" : joint}};
}

/// Of an arm, or of one in a leg, whose place in the file this is.
struct ArmParts {
  Value inputs = Value::list(), sections = Value::list(), tendons = Value::list();

  ArmParts(const Arm& arm, const std::string& path) {
    for (const ArmSection& section : arm.sections) sections.push_back(section_value(section));
    std::vector<std::size_t> counts(arm.sections.size());
    for (const ArmTendon& tendon : arm.tendons) {
      const auto section = static_cast<std::size_t>(tendon.section());
      const std::string name = joined(joined(path, section) + ".tendons", counts[section]++);
      inputs.push_back({{"name", name}, {"unit", "m"}});
      tendons.push_back(tendon_value(tendon));
    }
  }
};

void describe(Value& answer, const Arm& arm) {
  ArmParts parts(arm, "sections");
  answer["kind"] = "arm";
  answer["space"] = "spatial";
  answer["inputs"] = std::move(parts.inputs);
  answer["sections"] = std::move(parts.sections);
  answer["tendons"] = std::move(parts.tendons);
  answer["length"] = arm.length();
  answer["gravity"] = arm.gravity;
  answer["tip"] = {{"mass", arm.tip_mass}, {"place", arm.tip_mass_place}};
  answer["tolerance"] = arm.tolerance;
  if (const auto& motor = arm.motor)
    answer["motor"] = {{"lead", motor->lead}, {"counts", motor->counts}, {"gear", motor->gear}};
  if (arm.measurement) answer["measurement"] = measurement_value(*arm.measurement, arm.tendons.size());
}

void describe(Value& answer, const ArmLegs& robot) {
  Value inputs = Value::list(), legs = Value::list();
  for (std::size_t k = 0; k < robot.legs.size(); ++k) {
    const ArmLeg& leg = robot.legs[k];
    ArmParts parts(leg.arm, joined("legs", k) + ".link.sections");
    for (std::size_t i = 0; i < parts.inputs.size(); ++i) inputs.push_back(std::move(parts.inputs[i]));
    legs.push_back({{"base", base_value(robot, leg)},
                    {"link",
                     {{"type", "elastic"},
                      {"length", leg.arm.length()},
                      {"sections", std::move(parts.sections)},
                      {"tendons", std::move(parts.tendons)}}},
                    {"closure", closure_value(robot, leg)},
                    {"platform_point", point_value(robot, leg.platform_point)}});
  }
  answer["kind"] = "arm_legs";
  answer["space"] = robot.is_planar ? "planar" : "spatial";
  answer["inputs"] = std::move(inputs);
  answer["home"] = pose_value(pose_of(robot.is_planar, SE3<double>::from(robot.home)));
  answer["platform"] = {{"mass", robot.platform_mass}};
  answer["gravity"] = robot.gravity;
  answer["legs"] = std::move(legs);
}

template <class Arms>
struct ArmDescription : ArmContextOf<Arms> {
  using ArmContextOf<Arms>::ArmContextOf;
  using Question::answer;
  void read() {}
  void tell() {
    answer["status"] = "converged";
    describe(answer, this->robot);
    answer["models"] = Value::list({"rod", "subsegment_rod", "subsegment_cc", "cc", "prb"});
    answer["model"] = "subsegment_rod";
    answer["geometry"] = this->robot.geometry_inferred ? "inferred" : "given";
    answer["versions"] = {{"sinew", version()}, {"protocol", 1}};
  }
};

}  // namespace

template <class Arms>
void answer_arms_describe(Context& context) {
  answer_question<ArmDescription<Arms>>(context);
}
template void answer_arms_describe<Arm>(Context&);
template void answer_arms_describe<ArmLegs>(Context&);

}  // namespace sinew::inline v1
