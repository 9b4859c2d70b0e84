#include "robot/arms/arm_sections.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace sinew::inline v1 {
namespace {

constexpr double close_by = 1e-9;  ///< [rad], and of lengths their share

bool is_same_length(double a, double b) { return std::abs(a - b) <= close_by * std::max(a, b); }
bool is_same_angle(double a, double b) {
  return std::abs(std::remainder(a - b, 2 * std::numbers::pi)) <= close_by;
}

tl::unexpected<Errors> lacking(std::string place, std::string_view found) {
  return failure(
      "not_available", std::move(place),
      fmt::format("{}; pcc and lsk are of sections that are straight at rest, with three or more "
                  "tendons of their own, evenly spread and parallel to the backbone at one radius. "
                  "Ask by a model of loaded backbones: cc, subsegment_cc, rod.",
                  found));
}

std::string tendon_place(const Arm& arm, std::size_t tendon) {
  const int section = arm.tendons[tendon].section();
  std::size_t first = 0;
  while (arm.tendons[first].section() != section) ++first;
  return fmt::format("sections[{}].tendons[{}]", section, tendon - first);
}

/// Radius, angle and sense of the tendons of a section; all that pass it run at its radius.
Expected<void> read_tendons(const Arm& arm, std::size_t m, Section& section) {
  const std::string here = fmt::format("sections[{}].tendons", m);
  std::vector<double> angles;
  section.tendon_radius = 0;
  for (std::size_t i = 0; i < arm.tendons.size(); ++i) {
    const ArmTendon& tendon = arm.tendons[i];
    if (tendon.routes.size() <= m) continue;
    const TendonRoute& route = tendon.routes[m];
    if (section.tendon_radius == 0) section.tendon_radius = route.start_radius;
    if (!is_same_length(route.start_radius, route.end_radius) || route.start_angle != route.end_angle)
      return lacking(tendon_place(arm, i),
                     fmt::format("it is not parallel to the backbone in sections[{}]", m));
    if (!is_same_length(route.start_radius, section.tendon_radius))
      return lacking(tendon_place(arm, i),
                     fmt::format("it runs at another radius than others in sections[{}]", m));
    if (!is_same_angle(route.start_angle, tendon.routes.back().start_angle))
      return lacking(tendon_place(arm, i), fmt::format("it runs at another angle in sections[{}]", m));
    if (tendon.routes.size() == m + 1) angles.push_back(route.start_angle);
  }
  const auto count = static_cast<int>(angles.size());
  if (count < 3) return lacking(here, fmt::format("there {} {}", count == 1 ? "is" : "are", count));
  section.tendons = count;
  section.tendon_angle = angles.front();
  section.is_clockwise = !is_same_angle(angles[1], section.angle_of(1));
  for (int k = 0; k < count; ++k)
    if (!is_same_angle(angles[static_cast<std::size_t>(k)], section.angle_of(k)))
      return lacking(here, "they are not evenly spread, one after the other");
  return {};
}

}  // namespace

Expected<SerialRobot> constant_curvature_sections(const Arm& arm) {
  SerialRobot robot;
  robot.name = arm.name;
  robot.geometry_inferred = arm.geometry_inferred;
  robot.tolerance = arm.tolerance;
  robot.motor = arm.motor;
  for (std::size_t m = 0; m < arm.sections.size(); ++m) {
    const ArmSection& from = arm.sections[m];
    if (from.curvature != std::array<double, 3>{})
      return lacking(fmt::format("sections[{}].precurvature", m), "it is bent at rest");
    Section section{
        .backbone = kernel::Backbone::neutral, .disc_radius = from.discs.radius, .limit = from.limit};
    section.segments = arc_count(from.discs);
    section.joint = from.length / section.segments;
    if (auto fits = read_tendons(arm, m, section); !fits) return tl::unexpected(fits.error());
    robot.sections.push_back(section);
  }
  return robot;
}

}  // namespace sinew::inline v1
