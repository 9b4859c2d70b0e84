/// @file arm_backbone.hpp
#pragma once
#include "io/document/reader.hpp"
#include "sinew/robot/arm.hpp"

namespace sinew::inline v1 {

/// The backbone of an elastic section, by its sizes and material or by its stiffness: fills `start`, `end`
/// and `round_taper`.
void read_backbone_into(ArmSection& section, Reader& backbone);

}  // namespace sinew::inline v1
