/// `describe` of serial robots.
#include <array>

#include "query/questions.hpp"
#include "query/serial/serial.hpp"
#include "sinew/base/export.hpp"

namespace sinew::inline v1 {

namespace {

struct SerialDescription : SerialContext {
  using SerialContext::SerialContext;
  void read() {}
  void tell();
};

void SerialDescription::tell() {
  Value sections = Value::list(), coordinates = Value::list(), inputs = Value::list();
  for (std::size_t m = 0; m < robot.sections.size(); ++m) {
    const Section& section = robot.sections[m];
    const std::string place = joined("sections", m);
    Value one{
        {"type", section.is_twin() ? "tpcj" : "neutral"},
        {"segments", section.segments},
        {"joint", section.joint},
        {"tendons",
         {{"count", section.tendons}, {"radius", section.tendon_radius}, {"angle", section.tendon_angle}}},
        {"length", section.length()}};
    if (section.disc_radius > 0)
      one["disc"] = {{"height", section.disc_height}, {"radius", section.disc_radius}};
    if (std::isfinite(section.limit)) one["limit"] = section.limit;
    if (section.is_extensible()) one["extension"] = {section.min_extension, section.max_extension};
    sections.push_back(std::move(one));
    for (const char* name : section.is_twin() ? std::array{"beta_1", "beta_2"} : std::array{"theta", "phi"})
      coordinates.push_back({{"name", joined(place, name)}, {"unit", "rad"}});
    if (section.is_extensible()) coordinates.push_back({{"name", joined(place, "extension")}, {"unit", "m"}});
    for (int i = 0; i < section.tendons; ++i)
      inputs.push_back(
          {{"name", joined(joined(place, "tendons"), static_cast<std::size_t>(i))}, {"unit", "m"}});
  }
  answer["status"] = "converged";
  answer["kind"] = "serial";
  answer["space"] = "spatial";
  answer["inputs"] = inputs;
  answer["configuration"] = coordinates;
  answer["sections"] = sections;
  answer["length"] = robot.length();
  answer["tolerance"] = robot.tolerance;
  if (const auto& motor = robot.motor)
    answer["motor"] = {{"lead", motor->lead}, {"counts", motor->counts}, {"gear", motor->gear}};
  if (const auto& stretch = robot.stretch)
    answer["stretch"] = {{"stiffness", stretch->stiffness}, {"outside", stretch->outside}};
  answer["models"] = Value::list({"pcc", "lsk"});
  answer["model"] = "pcc";
  answer["geometry"] = robot.geometry_inferred ? "inferred" : "given";
  answer["versions"] = {{"sinew", version()}, {"protocol", 1}};
}

}  // namespace

void answer_serial_describe(Context& context) { answer_question<SerialDescription>(context); }

}  // namespace sinew::inline v1
