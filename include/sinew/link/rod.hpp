/// @file rod.hpp
/// An elastic rod fed through its base: inextensible, unshearable, isotropic, clamped in direction at the
/// base and free to spin there. Its length is the input. Between a clamped tangent and a moment-free tip it
/// bends in one plane. Theory: docs/theory/elastica.md
#pragma once
#include <numbers>
#include <string_view>

#include "sinew/base/units.hpp"

namespace sinew::inline v0 {

/// Numbers that hold the shape of a rod: the angles of its tangent at so many Gauss nodes.
inline constexpr int rod_nodes = 24;

struct Rod {
  static constexpr std::string_view name = "rod";

  double youngs_modulus = 0;  ///< E [Pa]; in a file under `material`
  double diameter = 0;        ///< of the round solid section [m]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("diameter", self.diameter, Dimension::length, Range::positive(), "diameter of the round rod");
  }

  /// EI = E π d⁴/64 [N m²].
  double bending_stiffness() const {
    const double square = diameter * diameter;
    return youngs_modulus * std::numbers::pi * square * square / 64;
  }
};

}  // namespace sinew::inline v0
