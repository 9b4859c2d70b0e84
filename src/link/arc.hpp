/// @file arc.hpp
/// Constant-curvature link in its bending plane. Base at the origin, base tangent along +y, positive
/// curvature bends towards +x (the tangent turns clockwise). Theory: docs/theory/arc.md
///
/// With half the bend angle x = κℓ/2, TDPCR (7), (9), (25)-(27) have removable singularities at κ = 0 and
/// cancel near it ((9) as printed is 8 % off at κ = 1e-6); written on sinc they are entire and one sin/cos
/// call serves all:
///   ρ = ℓ sinc x       α = ∂ρ/∂κ = (ℓ²/2) sinc′x
///   u = ρ (sin x, cos x)      ∂u/∂κ = (ℓ²/2) (sinc′x (sin x, cos x) + sinc x (cos x, −sin x))
#pragma once
#include <numbers>
#include <string_view>

#include "link/tip.hpp"
#include "math/inverse_sinc.hpp"
#include "sinew/math/entire.hpp"
#include "sinew/units.hpp"

namespace sinew::inline v1 {

struct Arc {
  static constexpr std::string_view name = "arc";
  static constexpr int dimension = 2;
  static constexpr int coordinates = 1;  ///< the signed curvature κ [1/m]
  static constexpr bool has_base_joint = false;

  double length = 0;  ///< backbone length ℓ [m], > 0

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("length", self.length, Dimension::length, Range::size(), "backbone length");
  }

  /// Distance ρ from base to tip [m].  @implements TDPCR (7)
  template <Scalar S>
  S chord(S curvature) const {
    return length * sinc(half_bend(curvature));
  }

  /// α = ∂ρ/∂κ [m²].  @implements TDPCR (8)-(9)
  template <Scalar S>
  S chord_rate(S curvature) const {
    return (0.5 * length * length) * dsinc(half_bend(curvature));
  }

  /// Tip u(κ) and its rate.  @implements TDPCR (25)-(27)
  template <Scalar S>
  Tip<S, 2, 1> tip(S curvature) const {
    const SincPair<S> x = sinc_pair(half_bend(curvature));
    const S ahead = length * x.value;
    const S gain = S(0.5 * length * length);
    return {Vec2<S>(ahead * x.sin, ahead * x.cos),
            Vec2<S>(gain * (x.rate * x.sin + x.value * x.cos), gain * (x.rate * x.cos - x.value * x.sin))};
  }

  template <Scalar S>
  Tip<S, 2, 1> tip(const Vec<S, 1>& q) const {
    return tip(S(q[0]));
  }

  /// @name Of the backbone, as any link has them
  /// @{
  const Arc& arc() const { return *this; }
  double curvature(const Vec<double, 1>& q) const { return q[0]; }
  /// @}

  /// The coordinate that tells solutions of a leg apart: the curvature [1/m].
  double branch(const Vec<double, 1>& q) const { return q[0]; }
  double size() const { return length; }             ///< a length to compare errors with [m]
  double domain() const { return bounds().domain; }  ///< branch coordinates lie in (−domain, domain)
  static constexpr std::string_view beyond_domain =  ///< what an input does that leaves the domain
      "bends the link to a full turn, or a tendon to its centre of curvature";

  /// The two curvatures ±κ [1/m] whose chord is ρ have this magnitude; NaN where ρ exceeds the length.
  double curvature_from_chord(double chord_length) const {
    return (2.0 / length) * inverse_sinc(chord_length / length);
  }

  /// Angle from the chord to the base tangent, κℓ/2 [rad], counter-clockwise.
  double tangent_lead(double curvature) const { return half_bend(curvature); }

  /// Point of the backbone at arc length s [m]: the tip of a shorter arc of the same curvature.
  Vec2<double> point(double curvature, double s) const { return Arc{s}.tip(curvature).position; }

  /// Unit normal of the backbone at arc length s, on the side of tendon 1.
  Vec2<double> side(double curvature, double s) const {
    return {std::cos(curvature * s), -std::sin(curvature * s)};
  }

  /// From u = ∫₀^ℓ (sin κs, cos κs) ds: |u| ≤ ℓ, |u′| ≤ ℓ²/2, |u″| ≤ ℓ³/3. Beyond a full turn a link is
  /// folded.
  TipBounds bounds() const {
    constexpr double turn =
        2 * std::numbers::pi * (1 - 1e-15);  // a full turn is beyond, however it is rounded
    return {length, length * length / 2, length * length * length / 3, turn / length};
  }

 private:
  template <Scalar S>
  S half_bend(S curvature) const {
    return (0.5 * length) * curvature;
  }
};

}  // namespace sinew::inline v1
