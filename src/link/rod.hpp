/// @file rod.hpp
/// An elastic rod fed through its base, clamped in direction there. Its length is the input.
/// Theory: docs/theory/elastica.md, docs/theory/tangent_rod.md, docs/theory/spatial_rod.md
#pragma once
#include <numbers>
#include <string_view>

#include "sinew/math/vec.hpp"
#include "sinew/units.hpp"

namespace sinew::inline v1 {

/// Numbers that hold the shape of a rod: the angles of its tangent at so many Gauss nodes.
inline constexpr int rod_nodes = 24;
/// Points whose tangents or sections hold it where it does not bend in one plane: the nodes of four spectral
/// elements, base and tip among them.
inline constexpr int rod_tangents = 33;

struct Rod {
  static constexpr std::string_view name = "rod";

  double youngs_modulus = 0;     ///< E [Pa]; in a file under `material`
  double diameter = 0;           ///< of the round solid section [m]; 0 where it is a strip
  double width = 0, height = 0;  ///< of a strip, a rectangular solid section: along its x and its y [m]
  double shear_modulus = 0;      ///< G [Pa]; asked for only where the rod twists, or shears and stretches
  double density = 0;            ///< [kg/m³]; 0: the rod weighs nothing
  /// The section's law: Cosserat's, which shears and stretches, or Kirchhoff's, which only bends.
  bool is_cosserat = false;
  /// u* of the rod at rest: curvature about the section's x and y, twist about its z, the tangent [1/m].
  Vec3<double> precurvature{0, 0, 0};
  /// Dead force per unstretched length, base axes [N/m]: beside the rod's weight.
  Vec3<double> load{0, 0, 0};

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    if (self.is_round())
      visit("diameter", self.diameter, Dimension::length, Range::positive(), "diameter of the round rod");
  }

  bool is_round() const { return !(width > 0); }
  /// Of the section [m²].
  double area() const { return is_round() ? std::numbers::pi * diameter * diameter / 4 : width * height; }
  double mass_per_length() const { return density * area(); }  ///< [kg/m]
  /// 1/GA and 1/EA − 1/GA [1/N]: p′ = t (1 + β n·t) + n/GA. Both 0 under Kirchhoff's law.
  double shear_compliance() const { return is_cosserat ? 1 / (shear_modulus * area()) : 0; }
  double stretch_compliance() const {
    return is_cosserat ? 1 / (youngs_modulus * area()) - shear_compliance() : 0;
  }

  /// EI = E π d⁴/64; of a strip that of its softer way, E b h³/12 [N m²].
  double bending_stiffness() const {
    if (!is_round()) {
      const double thin = width < height ? width : height;
      return youngs_modulus * area() * thin * thin / 12;
    }
    const double square = diameter * diameter;
    return youngs_modulus * std::numbers::pi * square * square / 64;
  }
};

}  // namespace sinew::inline v1
