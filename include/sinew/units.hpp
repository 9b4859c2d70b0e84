/// @file units.hpp
/// Dimensions of quantities: every number inside is SI, angles are radians.
#pragma once
#include "sinew/base/units.hpp"  // IWYU pragma: export
