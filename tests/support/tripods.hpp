/// @file tripods.hpp
/// Tripods on legs of two sections, what holds their tendons, and a load.
#pragma once
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <vector>

#include "sinew/kinematics/arm_legs.hpp"

namespace sinew::test::tripods {

inline Arm leg_of_sections(int sections = 2) {
  Arm arm;
  arm.name = "leg";
  const Material nitinol{.young = 54e9, .shear = 20.8e9, .density = 6450};
  for (int m = 0; m < sections; ++m) {
    ArmSection& section = arm.sections.emplace_back();
    section.length = 0.1;
    section.start = section.end = round_section(nitinol, 1.4e-3);
    section.discs = {.count = 5, .mass = 1e-3};
    for (int k = 0; k < 3; ++k) {
      const double angle = std::numbers::pi / 2 + 2 * std::numbers::pi * k / 3;
      const TendonRoute route{8e-3, 8e-3, angle, angle};
      ArmTendon& tendon = arm.tendons.emplace_back();
      tendon.routes.assign(static_cast<std::size_t>(m + 1), route);
      tendon.compliance = 1e-4;
      tendon.pretension = 0.2;
    }
  }
  return arm;
}

/// Three legs, turned by a third of a circle each.
inline ArmLegs tripod(bool is_clamped, bool weighs = true) {
  ArmLegs robot;
  robot.name = "tripod";
  robot.home.position = {0, 0, 0.2};
  if (weighs) robot.gravity = {0, 0, -9.81};
  robot.platform_mass = 0.02;
  for (int k = 0; k < 3; ++k) {
    const double angle = 2 * std::numbers::pi * k / 3;
    ArmLeg& leg = robot.legs.emplace_back();
    leg.arm = leg_of_sections();
    leg.base.R = SO3<double>::exp({0, 0, angle});
    leg.base.p = leg.base.R.rotate({0.08, 0, 0});
    leg.platform_point = leg.base.R.rotate({0.05, 0, 0});
    leg.is_clamped = is_clamped;
    leg.mount = leg.base.R;
  }
  return robot;
}

/// The same with legs that stand upright at home, where tips and platform meet.
inline ArmLegs upright(bool is_clamped, bool weighs) {
  ArmLegs robot = tripod(is_clamped, weighs);
  for (ArmLeg& leg : robot.legs) leg.platform_point = leg.base.p;
  return robot;
}

inline std::vector<TendonCommand> tensions(std::initializer_list<double> values) {
  std::vector<TendonCommand> commands;
  for (const double value : values) commands.push_back({TendonHeld::tension, value});
  return commands;
}
inline const std::vector<TendonCommand> uneven =
    tensions({1, 0, .3, 0, .5, 0, .2, .1, 0, 0, .7, 0, 0, .4, .2, .6, 0, .1});
/// Lengths of some tendons, one of which goes slack, and tensions of others.
inline std::vector<TendonCommand> mixed() {
  auto commands = uneven;
  for (const std::size_t k : {0U, 1U, 4U, 8U, 10U, 15U})
    commands[k] = {TendonHeld::change, k == 1 ? 4e-3 : -1e-3 * (1 + static_cast<double>(k % 3))};
  return commands;
}
inline const ArmLegsLoad pushed{.wrench = {0.05, -0.1, -0.2, 0.004, -0.003, 0.002}};

inline double distance(const SE3<double>& a, const SE3<double>& b) {
  return (a.p - b.p).norm() + (a.R.inverse().compose(b.R)).log().norm();
}

}  // namespace sinew::test::tripods
