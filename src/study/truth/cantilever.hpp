/// @file cantilever.hpp
/// A rod as an arm without tendons.
#pragma once
#include "sinew/kinematics/arm.hpp"

namespace sinew::inline v1 {

/// A rod that is clamped at its base, begins along z and has one cross-section.
inline Arm cantilever(double length, const CrossSection& section) {
  Arm arm;
  ArmSection one;
  one.length = length;
  one.start = one.end = section;
  arm.sections = {one};
  return arm;
}

}  // namespace sinew::inline v1
