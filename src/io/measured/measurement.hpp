/// @file measurement.hpp
/// `measurement` of an arm's file: between motors and tendons, and where a marker is. Format:
/// docs/robot-files.md
#pragma once
#include "io/document/reader.hpp"
#include "sinew/robot/arm.hpp"

namespace sinew::inline v1 {

/// @param arm whose sections and tendons are read already
MeasuringSetup read_measurement(Reader& measurement, const Arm& arm);

/// Tendons that end at each section, in the order of the arm's tendons.
std::vector<std::size_t> tendon_counts(const Arm& arm);

/// `sections[1].tendons[0]` for each tendon.
std::vector<std::string> tendon_names(const Arm& arm);

}  // namespace sinew::inline v1
