/// @file spatial_rod.hpp
/// The general elastic rod: bending, torsion, and by its section's law shear and stretch; precurved, stiffer
/// one way than the other, loaded along its length. s is the arc length of the unstressed rod, 0 … L; the
/// section's frame R has the tangent of the unsheared rod as its z axis. n and m are what the part beyond s
/// exerts on the part before it. Theory: docs/theory/spatial_rod.md
///
///   p′ = R v     R′ = R [u]     n′ = −f     m′ = −p′ × n
///   v = e₃ + K_se⁻¹ Rᵀn         u = u* + K_bt⁻¹ Rᵀm
///
/// Body axes: u, v, u*, the section's numbers. Base axes, that is those of whoever asks: p, R, n, m, f.
#pragma once
#include "sinew/math/vec.hpp"

namespace sinew::inline v1 {

/// What a section resists with infinite stiffness: shear and stretch (Kirchhoff), or nothing (Cosserat).
enum class RodLaw { kirchhoff, cosserat };

struct SpatialRod {
  Vec2<double> bending_stiffness{0, 0};  ///< EI about the section's x and y [N m²]
  double torsion_stiffness = 0;          ///< GJ [N m²]
  Vec2<double> shear_compliance{0, 0};   ///< 1/GA along x and y [1/N]; 0: does not shear
  double extension_compliance = 0;       ///< 1/EA [1/N]; 0: does not stretch
  Vec3<double> precurvature{0, 0, 0};    ///< u*: curvature about x and y, twist, of the rod at rest [1/m]
  Vec3<double> load{0, 0, 0};            ///< f, dead force per unstressed length, base axes [N/m]

  /// A round solid section. @param youngs_modulus E [Pa] @param shear_modulus G [Pa] @param diameter [m]
  static SpatialRod round(double youngs_modulus, double shear_modulus, double diameter,
                          RodLaw law = RodLaw::kirchhoff);

  /// A rectangular solid section: `width` along its x, `height` along its y [m].
  static SpatialRod strip(double youngs_modulus, double shear_modulus, double width, double height,
                          RodLaw law = RodLaw::kirchhoff);

  /// Finite numbers, stiffnesses positive, compliances not negative.
  bool is_valid() const;
  /// Neither shears nor stretches.
  bool is_kirchhoff() const { return shear_compliance.isZero(0) && extension_compliance == 0; }
  /// The section does not tell its x from its y: turned about its tangent it is the same rod.
  bool is_isotropic() const;
};

/// What the ends leave free. Wherever a turn is free, its moment is zero.
struct RodEnds {
  enum class Base { held, spins };          ///< `spins`: the base turns about its own tangent
  enum class Tip { ball, clamp, tangent };  ///< `tangent`: held in direction, turns about its own tangent
  Base base = Base::held;
  Tip tip = Tip::clamp;
};

}  // namespace sinew::inline v1
