/// @file arm_weight.hpp
/// Whether gravity does something to arms.
#pragma once
#include <algorithm>

#include "sinew/robot/arm.hpp"
#include "sinew/robot/arm_legs.hpp"

namespace sinew::inline v1 {

inline bool has_weight(const Arm& arm) {
  return arm.tip_mass > 0 || std::ranges::any_of(arm.sections, [](const ArmSection& section) {
           return section.start.mass > 0 || section.end.mass > 0 ||
                  (section.discs.count > 0 && section.discs.mass > 0);
         });
}
inline bool has_weight(const ArmLegs& robot) {
  return robot.platform_mass > 0 ||
         std::ranges::any_of(robot.legs, [](const ArmLeg& leg) { return has_weight(leg.arm); });
}

}  // namespace sinew::inline v1
