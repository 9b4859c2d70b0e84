/// @file theta_is.hpp
/// What the input theta of a leg with a motor at its base is the angle of.
#pragma once
#include "sinew/base/export.hpp"

namespace sinew::inline v1 {

/// Which angle the base motor commands. A joint turns the base tangent; [TDPCR (63)-(66)] take the angle of
/// the chord, which lies half a bend κℓ/2 beside it. Same robot, same J, another K. See docs/errata.md.
enum class ThetaIs { tangent, chord };

}  // namespace sinew::inline v1
