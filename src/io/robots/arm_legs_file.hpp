/// @file arm_legs_file.hpp
/// Files of platforms on arms: legs whose link is of `type: elastic`. Format: docs/robot-files.md
#pragma once
#include "io/document/reader.hpp"
#include "sinew/base/error.hpp"
#include "sinew/robot/arm_legs.hpp"

namespace sinew::inline v1 {

/// Whether the link of any leg of this robot, whose legs are listed, is elastic.
bool stands_on_arms(const Node& robot);

/// The platform and its arms; or every error of the file at once. Codes beside those of every file:
/// `mixed_legs`, `too_many_legs`, `too_many_tendons`, and those of arms.
/// @param whole the same with all defaults merged into the legs
Expected<ArmLegs> read_arm_legs(const Document& document, const Document& whole);

/// `sections` and `stretch` of the link of a leg, as those of an arm.
Arm read_arm_of_leg(Reader& link, const Errors& errors);

}  // namespace sinew::inline v1
