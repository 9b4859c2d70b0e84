/// @file rod.hpp
/// An elastic rod fed through its base: round, straight when free, clamped in direction at the base and free
/// to spin there. Its length is the input. Theory: docs/theory/elastica.md, docs/theory/tangent_rod.md
#pragma once
#include <numbers>
#include <string_view>

#include "sinew/base/units.hpp"

namespace sinew::inline v0 {

/// Numbers that hold the shape of a rod: the angles of its tangent at so many Gauss nodes.
inline constexpr int rod_nodes = 24;
/// Points whose tangents hold it where it does not bend in one plane: the nodes of four spectral elements,
/// base and tip among them.
inline constexpr int rod_tangents = 33;

struct Rod {
  static constexpr std::string_view name = "rod";

  double youngs_modulus = 0;  ///< E [Pa]; in a file under `material`
  double diameter = 0;        ///< of the round solid section [m]
  double shear_modulus = 0;   ///< G [Pa]; asked for only where the rod shears and stretches
  double density = 0;         ///< [kg/m³]; 0: the rod weighs nothing
  /// The section's law: Cosserat's, which shears and stretches, or Kirchhoff's, which only bends.
  bool is_cosserat = false;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("diameter", self.diameter, Dimension::length, Range::positive(), "diameter of the round rod");
  }

  double area() const { return std::numbers::pi * diameter * diameter / 4; }  ///< of the section [m²]
  double mass_per_length() const { return density * area(); }                 ///< [kg/m]
  /// 1/GA and 1/EA − 1/GA [1/N]: p′ = t (1 + β n·t) + n/GA. Both 0 under Kirchhoff's law.
  double shear_compliance() const { return is_cosserat ? 1 / (shear_modulus * area()) : 0; }
  double stretch_compliance() const {
    return is_cosserat ? 1 / (youngs_modulus * area()) - shear_compliance() : 0;
  }

  /// EI = E π d⁴/64 [N m²].
  double bending_stiffness() const {
    const double square = diameter * diameter;
    return youngs_modulus * std::numbers::pi * square * square / 64;
  }
};

}  // namespace sinew::inline v0
