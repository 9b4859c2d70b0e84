/// @file arm_sections.hpp
/// An arm as sections of constant curvature, whose shape the lengths of its tendons give. Theory:
/// docs/theory/section.md
#pragma once
#include "sinew/base/error.hpp"
#include "sinew/robot/arm.hpp"

namespace sinew::inline v1 {

/// Every section an arc from disc to disc, without loads and stiffness. An error says what of the arm pcc and
/// lsk have no place for: each section needs three or more tendons of its own, evenly spread and parallel to
/// the backbone, and where others pass it they run at the same radius.
Expected<SerialRobot> constant_curvature_sections(const Arm& arm);

}  // namespace sinew::inline v1
