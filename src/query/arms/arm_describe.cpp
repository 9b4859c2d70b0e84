/// Handler of `describe` of arms.
#include <cmath>

#include "query/arms/arms.hpp"
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

}  // namespace

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

namespace {

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

void describe_arm(Context& context) {
  const Arm& arm = *context.robot.arm();
  Value inputs = Value::list(), sections = Value::list(), tendons = Value::list();
  for (const ArmSection& section : arm.sections) sections.push_back(section_value(section));
  std::vector<std::size_t> counts(arm.sections.size());
  for (const ArmTendon& tendon : arm.tendons) {
    const auto section = static_cast<std::size_t>(tendon.section());
    const std::string name = joined(joined("sections", section) + ".tendons", counts[section]++);
    inputs.push_back({{"name", name}, {"unit", "m"}});
    tendons.push_back(tendon_value(tendon));
  }
  Value& answer = context.answer;
  answer["status"] = "converged";
  answer["kind"] = "arm";
  answer["space"] = "spatial";
  answer["inputs"] = inputs;
  answer["sections"] = sections;
  answer["tendons"] = tendons;
  answer["length"] = arm.length();
  answer["gravity"] = arm.gravity;
  answer["tip"] = {{"mass", arm.tip_mass}, {"place", arm.tip_mass_place}};
  answer["tolerance"] = arm.tolerance;
  if (const auto& motor = arm.motor)
    answer["motor"] = {{"lead", motor->lead}, {"counts", motor->counts}, {"gear", motor->gear}};
  if (arm.measurement) answer["measurement"] = measurement_value(*arm.measurement, arm.tendons.size());
  answer["models"] = Value::list({"rod", "subsegment_rod", "subsegment_cc", "cc", "prb"});
  answer["model"] = "subsegment_rod";
  answer["geometry"] = arm.geometry_inferred ? "inferred" : "given";
  answer["versions"] = {{"sinew", version()}, {"protocol", 1}};
}

}  // namespace

void answer_arm_describe(Context& context) { tell<describe_arm>(context); }

}  // namespace sinew::inline v1
