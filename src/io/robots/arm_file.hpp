/// @file arm_file.hpp
/// Files of tendon-driven arms that bear loads: `kind: serial` with sections of `type: elastic`. Format:
/// docs/robot-files.md
#pragma once
#include "sinew/base/error.hpp"
#include "sinew/io/node.hpp"
#include "sinew/robot/arm.hpp"

namespace sinew::inline v1 {

/// Whether a document is of a serial robot and one of its sections is elastic.
bool is_arm(const Document& document);

/// The arm a document describes; or every error of it at once. Codes beside those of every file:
/// `mixed_sections`, `no_tendon`, `too_many_tendons`, `guide_beyond_tip`, `missing_guide`.
Expected<Arm> read_arm(const Document& document);

}  // namespace sinew::inline v1
