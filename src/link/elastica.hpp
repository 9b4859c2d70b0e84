/// @file elastica.hpp
/// The planar elastica: an inextensible rod, clamped at its base, whose tip takes a force and no moment. Base
/// at the origin, base tangent along w (axial), d lateral; θ is the tangent's angle from w towards d. Unit
/// length and unit bending stiffness: forces in EI/L², curvatures in 1/L, energies in EI/L (`ElasticaUnits`).
/// Theory: docs/theory/elastica.md
///
///   θ″ = −fd cos θ + fw sin θ     θ(0) = 0     θ′(1) = 0     d′ = sin θ     w′ = cos θ
///
/// In the tip's own frame the same equation starts from rest. Every equilibrium is therefore one point of the
/// plane of *local forces* (n, t): the tip force's components across the tip tangent (towards d at θ = 0) and
/// along it. Shape, tip and force are analytic in (n, t), straight and force-free states included. With σ the
/// arc length from the tip and v(σ) = sd(√f σ)/√f,
///
///   v′² = 1 + t v² − ¼n²v⁴     θ − θ_tip = −4 atan(½ n v(σ/2)²)     θ′ = n v
///
/// which doubling formulas carry from a short piece to the whole rod: no elliptic integral, no step control.
#pragma once
#include <cmath>
#include <limits>
#include <span>

#include "sinew/math/vec.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1 {

/// An equilibrium of the rod of unit length and stiffness.
template <class S>
struct ElasticaState {
  Vec2<S> tip;       ///< (d, w)
  Vec2<S> force;     ///< (fd, fw), of whatever holds the tip on the rod
  S tip_angle;       ///< θ(1) [rad], not wrapped
  S base_curvature;  ///< θ′(0)
  S energy;          ///< ½∫θ′² ds
};

/// Largest |local force| that is answered; NaN beyond. Errors of tip and angle were measured to be below
/// 2e-14 for |f| ≤ 45 and below 1e-13 for |f| ≤ 3000 (against 34 digits).
inline constexpr double elastica_force_limit = 1e4;

namespace detail {

/// The piece of length σ at the tip, as functions of (t, n²) alone. θ′ = n v, X = ∫cos(θ − θ_tip) and
/// Y = ∫sin(θ − θ_tip) follow: X = σ + n²m, Y = −n(½l + t m).
template <class S>
struct ElasticaPiece {
  S v;  ///< sd(√f σ)/√f
  S p;  ///< v′
  S l;  ///< ∫v² dσ
  S m;  ///< −∫ω dσ, ω = (1 + ½t v² − p)/f² = ¼v⁴/(p + 1 + ½t v²)
};

/// Power series at f σ² ≤ 1e-3: what is left out is below eps/10.
template <class S>
ElasticaPiece<S> elastica_series(const S& t, const S& nn, double sigma) {
  const double q = sigma * sigma, cube = q * sigma;
  const S half_cubic = nn * -0.5;  // v″ = t v − ½n²v³
  const S a1 = t * (1.0 / 6);
  const S a2 = (t * a1 + half_cubic) * (1.0 / 20);
  const S a3 = (t * a2 + half_cubic * a1 * 3.0) * (1.0 / 42);
  const S a4 = (t * a3 + half_cubic * (a2 + a1 * a1) * 3.0) * (1.0 / 72);
  const S l1 = a1 * (2.0 / 5), l2 = (a2 * 2.0 + a1 * a1) * (1.0 / 7);
  const S l3 = (a3 + a1 * a2) * (2.0 / 9), l4 = ((a4 + a1 * a3) * 2.0 + a2 * a2) * (1.0 / 11);
  const S m2 = a2 * 1.5 + a1 * a1 * 6.0 - t * a1 * 0.5 - t * t * (1.0 / 12);  // ω = ⅛σ⁴(1 + tσ²/6 + m2 σ⁴ …)
  return {((((a4 * q + a3) * q + a2) * q + a1) * q + 1.0) * sigma,
          (((a4 * (9 * q) + a3 * 7.0) * q + a2 * 5.0) * q + a1 * 3.0) * q + 1.0,
          ((((l4 * q + l3) * q + l2) * q + l1) * q + 1.0 / 3) * cube,
          ((m2 * (q / 9) + a1 * (1.0 / 7)) * q + 0.2) * (-0.125 * cube * q)};
}

/// The piece of twice the length. Nothing cancels but where p changes sign; v keeps its relative error.
template <class S>
ElasticaPiece<S> elastica_doubled(const ElasticaPiece<S>& x, const S& t, const S& nn) {
  const S square = x.v * x.v, fourth = square * square;
  const S c = nn * fourth * 0.25, stretch = t * square;
  const S even = 1.0 - c, inverse = 1.0 / (c + 1.0);
  const S sum = x.p + 1.0 + stretch * 0.5;
  // Where p nears −1 the quotient for ω becomes 0/0, and the difference is large.
  const S omega =
      real_part(sum) > 0.5 ? S(fourth * 0.25 / sum) : S((1.0 + stretch * 0.5 - x.p) / (t * t + nn));
  const S v = x.v * x.p * inverse * 2.0;
  return {v, (even * (even + stretch * 2.0) - c * 4.0) * inverse * inverse, x.l * 2.0 + square * v,
          x.m * 2.0 - x.v * omega * (x.p + 2.0) * inverse * 2.0};
}

template <class S>
struct ElasticaNumbers {
  S d, w, force_d, force_w, tip_angle, base_curvature, energy;
};

template <class S>
ElasticaNumbers<S> elastica_numbers(const S& n, const S& t) {
  using std::atan;
  const double f = std::hypot(real_part(n), real_part(t));
  if (!(f <= elastica_force_limit)) {
    const S nan(std::numeric_limits<double>::quiet_NaN());
    return {nan, nan, nan, nan, nan, nan, nan};
  }
  double sigma = 0.5;
  while (f * sigma * sigma > 1e-3) sigma *= 0.5;
  const S nn = n * n;
  ElasticaPiece<S> piece = elastica_series(t, nn, sigma);
  for (; sigma < 0.5; sigma *= 2) piece = elastica_doubled(piece, t, nn);
  const S g = n * piece.v * piece.v * 0.5;  // tan(θ_tip/4)
  const ElasticaPiece<S> rod = elastica_doubled(piece, t, nn);

  const S scale = 1.0 / (1.0 + g * g), sin_half = g * scale * 2.0, cos_half = (1.0 - g * g) * scale;
  const S sin = sin_half * cos_half * 2.0, cos = (cos_half - sin_half) * (cos_half + sin_half);
  const S x = 1.0 + nn * rod.m;
  // From θ′(0) = n X − t Y: in tension the other form loses e^√f.
  const S y = real_part(t) > 4 ? S(n * (x - rod.v) / t) : S(n * (rod.l * 0.5 + t * rod.m) * -1.0);
  return {x * sin + y * cos, x * cos - y * sin, n * cos + t * sin, t * cos - n * sin,
          atan(g) * 4.0,     n * rod.v,         nn * rod.l * 0.5};
}

}  // namespace detail

/// The equilibrium of this local force (n, t): every equilibrium is reached by exactly one. Analytic; NaN
/// beyond `elastica_force_limit` and for NaN. S: double, std::complex<double> or a derivative type.
/// @implements 3PFS (24), in its plane and from the tip
template <Scalar S>
ElasticaState<S> elastica(const Vec2<S>& local_force) {
  const auto x = detail::elastica_numbers<S>(local_force[0], local_force[1]);
  return {{x.d, x.w}, {x.force_d, x.force_w}, x.tip_angle, x.base_curvature, x.energy};
}

/// The local force of the polar coordinates f and χ, the angle of the tip's tangent from the force [rad]: χ =
/// 0 is tension along the tip, χ = π compression.
inline Vec2<double> elastica_local_force(double magnitude, double chi) {
  return {-magnitude * std::sin(chi), magnitude * std::cos(chi)};
}

/// An equilibrium with its exact derivatives by the local force.
struct ElasticaTangent {
  ElasticaState<double> state;
  Mat<double, 2, 2> tip_rate;  ///< ∂(d, w)/∂(n, t); singular where equilibria of one tip merge, or straight
  Mat<double, 2, 2> force_rate;  ///< ∂(fd, fw)/∂(n, t); singular where equilibria of one force merge
  Vec2<double> tip_angle_rate, base_curvature_rate, energy_rate;

  /// ∂(d, w)/∂(fd, fw), symmetric; not finite where `force_rate` is singular.
  Mat<double, 2, 2> compliance() const;
  /// ∂(fd, fw)/∂(d, w), symmetric; not finite where `tip_rate` is singular.
  Mat<double, 2, 2> stiffness() const;
};

ElasticaTangent elastica_tangent(const Vec2<double>& local_force);

/// The rod under a given tip force.
struct ElasticaTip {
  Status status = Status::left_domain;  ///< `singular`: found, but the compliance is infinite (buckling)
  int iterations = 0;
  Vec2<double> local_force;      ///< of the last iterate
  ElasticaState<double> state;   ///< its force is the given one to rounding
  Mat<double, 2, 2> compliance;  ///< ∂(d, w)/∂(fd, fw), exact

  /// ∂(d, w)·L/∂L at constant force in N: the tip of a rod that is fed.
  Vec2<double> length_rate() const { return state.tip + 2 * (compliance * state.force); }
};

/// The rod without inflection: the state that continues the one under tension, stable under a dead force.
/// Where the force is purely axial and compresses beyond π²/4, that which is buckled towards d > 0.
ElasticaTip elastica_under_force(const Vec2<double>& force);

/// The solution Newton's method finds from this tip angle [rad]: of several, one nearby.
ElasticaTip elastica_under_force(const Vec2<double>& force, double near_tip_angle);

struct ElasticaSection {
  Vec2<double> position;  ///< (d, w)
  double angle;           ///< θ [rad]
  double curvature;       ///< θ′
};

/// The cross-sections at arc lengths s ∈ [0, 1] from the base, into `out` (of the same size).
void elastica_sections(const Vec2<double>& local_force, std::span<const double> s,
                       std::span<ElasticaSection> out);

/// What the unit rod's numbers are multiplied by for a rod of length L [m] and bending stiffness EI [N m²].
struct ElasticaUnits {
  double length, bending_stiffness;

  double force() const { return bending_stiffness / (length * length); }               ///< [N]
  double stiffness() const { return bending_stiffness / (length * length * length); }  ///< [N/m]
  double energy() const { return bending_stiffness / length; }                         ///< [J]; moments [N m]
  double curvature() const { return 1 / length; }                                      ///< [1/m]
};

}  // namespace sinew::inline v1
