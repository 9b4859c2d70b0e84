/// @file arms.hpp
/// Arms that tests share.
#pragma once
#include <cmath>
#include <numbers>
#include <vector>

#include "sinew/kinematics/arm.hpp"

namespace sinew::test {

inline ArmTendon tendon_at(int section, double radius, double angle, double compliance = 0) {
  ArmTendon tendon;
  tendon.routes.assign(static_cast<std::size_t>(section) + 1, {radius, radius, angle, angle});
  tendon.compliance = compliance;
  return tendon;
}

/// One section with four tendons in channels, gravity across (tests/data/field/tendon_rod_*.json).
inline Arm tendon_rod(double compliance = 0) {
  Arm arm;
  ArmSection section;
  section.length = 0.5;
  section.start = section.end = round_section({2e11, 8e10, 8000}, 0.002);
  arm.sections = {section};
  for (int i = 0; i < 4; ++i)
    arm.tendons.push_back(tendon_at(0, 0.01506, i * std::numbers::pi / 2, compliance));
  arm.gravity = {9.81, 0, 0};
  return arm;
}

/// Sections of 0.2 m with so many discs, three tendons each; those of the second pass the first.
inline Arm two_sections(int discs = 10, double compliance = 0) {
  Arm arm;
  for (int m = 0; m < 2; ++m) {
    ArmSection section;
    section.length = 0.2;
    section.start = section.end = round_section({54e9, 54e9 / 2.6, 0}, 0.0014);
    section.discs.count = discs;
    arm.sections.push_back(section);
    for (const double angle : {90.0, -30.0, 210.0})
      arm.tendons.push_back(tendon_at(m, 0.01, angle * std::numbers::pi / 180, compliance));
  }
  return arm;
}

/// A rod without tendons, clamped at its base, that begins along z.
inline Arm cantilever(double length, const CrossSection& section) {
  Arm arm;
  ArmSection one;
  one.length = length;
  one.start = one.end = section;
  arm.sections = {one};
  return arm;
}

inline std::vector<TendonCommand> tensions(const std::vector<double>& values) {
  std::vector<TendonCommand> commands;
  for (const double value : values) commands.push_back({TendonHeld::tension, value});
  return commands;
}
inline std::vector<TendonCommand> changes(const std::vector<double>& values) {
  std::vector<TendonCommand> commands;
  for (const double value : values) commands.push_back({TendonHeld::change, value});
  return commands;
}

}  // namespace sinew::test
