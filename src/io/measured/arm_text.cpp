/// Arms as texts of files.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/document/parse.hpp"
#include "io/document/quantity.hpp"
#include "io/measured/measurement.hpp"
#include "io/robots/arm_file.hpp"
#include "sinew/analysis/identify.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/io/table.hpp"

namespace sinew::inline v1 {
namespace {

using Three = std::array<double, 3>;

/// Members of a map on one line.
class Flow {
 public:
  void put(std::string_view key, std::string_view text) {
    text_ += fmt::format("{}{}: {}", text_.empty() ? "" : ", ", key, text);
  }
  void put(std::string_view key, double value) { put(key, si_text(value)); }
  std::string text() const { return '{' + text_ + '}'; }

 private:
  std::string text_;
};

template <class Numbers>
std::string list_text(const Numbers& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + si_text(value);
  return '[' + text + ']';
}

std::string name_text(std::string_view name) {
  std::string text = "\"";
  for (const char c : name) {
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
  return text + '"';
}

/// One number where all have it, else lists of those that end at each section.
std::string per_tendon_text(const std::vector<double>& values, const Arm& arm) {
  if (std::ranges::all_of(values, [&](double value) { return value == values.front(); }))
    return si_text(values.front());
  std::string text;
  auto next = values.begin();
  for (const std::size_t count : tendon_counts(arm)) {
    const auto end = next + static_cast<std::ptrdiff_t>(count);
    text += (text.empty() ? "" : ", ") + list_text(std::vector<double>(next, end));
    next = end;
  }
  return '[' + text + ']';
}

std::string measurement_text(const Arm& arm) {
  if (!arm.measurement || *arm.measurement == MeasuringSetup{}) return {};
  const auto& [drive, marker] = *arm.measurement;
  std::string text = "measurement:\n";
  if (drive != TendonDrive{}) text += "  drive:\n";
  for (const auto& [key, values] :
       {std::pair<std::string_view, const std::vector<double>&>{"gain", drive.gain},
        {"offset", drive.offset},
        {"toe", drive.toe}})
    if (!values.empty()) text += fmt::format("    {}: {}\n", key, per_tendon_text(values, arm));
  if (drive.lag != 0) text += fmt::format("    lag: {}\n", si_text(drive.lag));
  if (drive.play != 0) text += fmt::format("    play: {}\n", si_text(drive.play));
  if (marker != MarkerMount{})
    text += fmt::format("  marker:\n    place: {}\n    base: {}\n    tilt: {}\n", list_text(marker.place),
                        list_text(marker.base), list_text(marker.tilt));
  return text;
}

Flow stiffness(const CrossSection& section) {
  Flow flow;
  if (section.bending_x == section.bending_y)
    flow.put("bending", section.bending_x);
  else
    flow.put("bending", list_text(std::array{section.bending_x, section.bending_y}));
  flow.put("torsion", section.torsion);
  if (section.stretch != 0) flow.put("stretch", section.stretch);
  if (section.shear != 0) flow.put("shear", section.shear);
  flow.put("mass", section.mass);
  return flow;
}

std::string backbone_text(const ArmSection& section) {
  Flow flow = stiffness(section.start);
  if (section.end != section.start || section.round_taper) flow.put("end", stiffness(section.end).text());
  if (section.round_taper) flow.put("taper", "round");
  return flow.text();
}

void put_route(Flow& flow, const TendonRoute& route) {
  flow.put("radius", route.start_radius);
  flow.put("angle", route.start_angle);
  if (route.end_radius != route.start_radius) flow.put("end_radius", route.end_radius);
  if (route.end_angle != route.start_angle) flow.put("turn", route.end_angle - route.start_angle);
}

std::string tendon_text(const ArmTendon& tendon) {
  Flow flow;
  const TendonRoute& own = tendon.routes.back();
  put_route(flow, own);
  flow.put("compliance", tendon.compliance);
  if (tendon.outside != 0) flow.put("outside", tendon.outside);
  if (tendon.friction != 0) flow.put("friction", tendon.friction);
  if (tendon.pretension != 0) flow.put("pretension", tendon.pretension);
  const auto is_parallel = [&](const TendonRoute& route) {
    return route.start_radius == own.start_radius && route.end_radius == own.start_radius &&
           route.start_angle == own.start_angle && route.end_angle == own.start_angle;
  };
  if (!std::all_of(tendon.routes.begin(), tendon.routes.end() - 1, is_parallel)) {
    std::string before;
    for (auto route = tendon.routes.begin(); route != tendon.routes.end() - 1; ++route) {
      Flow one;
      put_route(one, *route);
      before += (before.empty() ? "" : ", ") + one.text();
    }
    flow.put("through", '[' + before + ']');
  }
  return flow.text();
}

std::string section_text(const Arm& arm, std::size_t m) {
  const ArmSection& section = arm.sections[m];
  std::string text = fmt::format("  - type: elastic\n    length: {}\n    backbone: {}\n",
                                 si_text(section.length), backbone_text(section));
  if (section.curvature != Three{})
    text += fmt::format("    precurvature: {}\n", list_text(section.curvature));
  if (section.discs.count > 0) {
    Flow discs;
    discs.put("count", fmt::format("{}", section.discs.count));
    discs.put("mass", section.discs.mass);
    if (section.discs.radius != 0) discs.put("radius", section.discs.radius);
    text += fmt::format("    discs: {}\n", discs.text());
  } else {
    text += "    guides: channel\n";
  }
  if (std::isfinite(section.limit)) text += fmt::format("    limit: {}\n", si_text(section.limit));
  std::string tendons;
  for (const ArmTendon& tendon : arm.tendons)
    if (tendon.section() == static_cast<int>(m)) tendons += fmt::format("      - {}\n", tendon_text(tendon));
  return tendons.empty() ? text : text + "    tendons:\n" + tendons;
}

std::string text_of(const Arm& arm, std::span<const std::string> comments) {
  std::string text;
  for (std::string line : comments) {
    std::ranges::replace_if(
        line, [](unsigned char c) { return c < ' ' || c == 127; }, ' ');
    text += line.empty() ? "#\n" : fmt::format("# {}\n", line);
  }
  text += fmt::format("sinew: 1\nname: {}\nkind: serial\n", name_text(arm.name));
  if (arm.geometry_inferred) text += "geometry: inferred\n";
  if (arm.gravity != Three{}) text += fmt::format("gravity: {}\n", list_text(arm.gravity));
  if (arm.tip_mass != 0 || arm.tip_mass_place != Three{})
    text +=
        fmt::format("tip: {{mass: {}, place: {}}}\n", si_text(arm.tip_mass), list_text(arm.tip_mass_place));
  text += fmt::format("tolerance: {}\n", si_text(arm.tolerance));
  if (arm.motor)
    text += fmt::format("motor: {{lead: {}, counts: {}, gear: {}}}\n", si_text(arm.motor->lead),
                        si_text(arm.motor->counts), si_text(arm.motor->gear));
  text += measurement_text(arm) + "sections:\n";
  for (std::size_t m = 0; m < arm.sections.size(); ++m) text += section_text(arm, m);
  return text;
}

/// What no key says.
Expected<void> check_words(const Arm& arm) {
  const auto names = tendon_names(arm);
  if (arm.measurement)
    for (const auto* values :
         {&arm.measurement->drive.gain, &arm.measurement->drive.offset, &arm.measurement->drive.toe})
      if (!values->empty() && values->size() != arm.tendons.size())
        return failure("wrong_tendon_count", "measurement.drive",
                       fmt::format("there are {} values for {} tendons of the arm; give one for each.",
                                   values->size(), arm.tendons.size()));
  for (std::size_t i = 1; i < arm.tendons.size(); ++i)
    if (arm.tendons[i].section() < arm.tendons[i - 1].section())
      return failure("not_available", names[i],
                     "files list tendons section by section; put those of the first section first.");
  return {};
}

}  // namespace

Expected<std::string> arm_text(const Arm& arm, std::span<const std::string> comments) {
  for (std::size_t i = 0; i < arm.tendons.size(); ++i)
    if (arm.tendons[i].routes.empty() || arm.tendons[i].routes.size() > arm.sections.size())
      return failure("wrong_size", fmt::format("tendons[{}].routes", i),
                     fmt::format("a tendon passes 1 to {} sections here; give a route for each of them.",
                                 arm.sections.size()));
  if (auto can = check_words(arm); !can) return tl::unexpected(can.error());
  std::string text = text_of(arm, comments);
  // what is no arm is no file of one: numbers that are not finite, radii beyond discs
  const auto document = parse_yaml(text, arm.name);
  if (!document) return tl::unexpected(document.error());
  if (const auto read = read_arm(*document); !read) return tl::unexpected(read.error());
  return text;
}

}  // namespace sinew::inline v1
