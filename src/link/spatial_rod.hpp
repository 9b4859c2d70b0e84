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
#include <span>

#include "sinew/math/so3.hpp"
#include "sinew/math/vec.hpp"
#include "sinew/solve/report.hpp"

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
  SINEW_API static SpatialRod round(double youngs_modulus, double shear_modulus, double diameter,
                                    RodLaw law = RodLaw::kirchhoff);

  /// A rectangular solid section: `width` along its x, `height` along its y [m].
  SINEW_API static SpatialRod strip(double youngs_modulus, double shear_modulus, double width, double height,
                                    RodLaw law = RodLaw::kirchhoff);

  /// Finite numbers, stiffnesses positive, compliances not negative.
  SINEW_API bool is_valid() const;
  /// Neither shears nor stretches.
  bool is_kirchhoff() const { return shear_compliance.isZero(0) && extension_compliance == 0; }
  /// The section does not tell its x from its y: turned about its tangent it is the same rod.
  SINEW_API bool is_isotropic() const;
};

/// A cross-section and what is beyond it.
template <Scalar S>
struct RodState {
  Vec3<S> p = Vec3<S>(S(0), S(0), S(0));  ///< [m]
  SO3<S> R;                               ///< section to base axes
  Vec3<S> n = Vec3<S>(S(0), S(0), S(0));  ///< internal force [N]
  Vec3<S> m = Vec3<S>(S(0), S(0), S(0));  ///< internal moment [N m]

  Vec3<S> tangent() const { return R.rotate(Vec3<S>(S(0), S(0), S(1))); }  ///< third axis of the section
};

/// How finely a rod is integrated.
struct RodSteps {
  int steps = 0;             ///< even steps of order 8; 0: as many as the tolerance asks for
  double tolerance = 1e-12;  ///< on the estimated error, of L and in rad; where steps are not given
};

inline constexpr int max_rod_steps = 1024;

/// The far end of a rod that starts with a given state.
struct RodTip {
  Status status =
      Status::left_domain;  ///< `iteration_limit`: the tolerance asks for more than `max_rod_steps`
  int steps = 0;            ///< taken
  double error = 0;         ///< estimated, of p over L and of R in rad; 0 where the steps were given
  RodState<double> state;
  /// Elastic energy plus the potential of the load, −∫f·(p − p(0)) ds [J].
  double energy = 0;
  double potential = 0;  ///< the second part alone [J]
};

/// Starts at `base`, whose n and m are those at s = 0. @param length L [m], > 0
SINEW_API RodTip integrate(const SpatialRod& rod, double length, const RodState<double>& base,
                           const RodSteps& how = {});

/// The far end with its derivatives. Rows: position, rotation vector (base axes), force, moment. Columns:
/// force and moment at the base (base axes), axial rotation of the base frame about its own z at these,
/// length. They are the derivatives of the numbers computed, steps held, to rounding.
struct RodTangent {
  static constexpr int force = 0, moment = 3, axial_rotation = 6, length = 7;      // columns
  static constexpr int position = 0, rotation = 3, tip_force = 6, tip_moment = 9;  // rows
  RodTip tip;
  Mat<double, 12, 8> rate;
};

SINEW_API RodTangent integrate_tangent(const SpatialRod& rod, double length, const RodState<double>& base,
                                       const RodSteps& how = {});

/// The sections at even arc lengths, the first at the base and the last at the tip; at least two.
SINEW_API Status rod_sections(const SpatialRod& rod, double length, const RodState<double>& base,
                              std::span<RodState<double>> out, const RodSteps& how = {});

}  // namespace sinew::inline v1
