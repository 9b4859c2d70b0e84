/// @file read_material.hpp
#pragma once
#include <optional>

#include "io/document/reader.hpp"

namespace sinew::inline v1 {

/// Shear modulus [Pa] of a map with `G`, or `poisson` in its place; none where it has neither.
/// @param young Young's modulus [Pa]
std::optional<double> read_shear_modulus(Reader& material, double young);

}  // namespace sinew::inline v1
