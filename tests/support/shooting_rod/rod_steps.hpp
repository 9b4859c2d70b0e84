/// @file rod_steps.hpp
/// One rod, stepped from base to tip: the explicit Runge-Kutta method of order 8 in 11 stages by Cooper and
/// Verner (SIAM J. Numer. Anal. 9, 1972), in ℝ⁴ for the quaternion, which is normalised once, at the tip.
/// The force is n(0) − s f. Position and energies feed nothing back, and four of the last stages carry them.
#pragma once
#include <array>
#include <cstddef>

#include "shooting_rod/shooting_rod.hpp"

namespace sinew::inline v1::rod_steps {

inline constexpr std::size_t stages = 11;
inline constexpr double r21 = 4.582575694955840006588;  // √21

inline constexpr std::array<double, stages> node = {
    0, 0.5, 0.5, (7 + r21) / 14, (7 + r21) / 14, 0.5, (7 - r21) / 14, (7 - r21) / 14, 0.5, (7 + r21) / 14, 1};
inline constexpr std::array<double, stages> weight = {0.05, 0,          0,         0,          0,   0,
                                                      0,    49.0 / 180, 16.0 / 45, 49.0 / 180, 0.05};
inline constexpr std::array<std::array<double, stages>, stages> coupling = {{
    {},
    {0.5},
    {0.25, 0.25},
    {1.0 / 7, (-7 - 3 * r21) / 98, (21 + 5 * r21) / 49},
    {(11 + r21) / 84, 0, (18 + 4 * r21) / 63, (21 - r21) / 252},
    {(5 + r21) / 48, 0, (9 + r21) / 36, (-231 + 14 * r21) / 360, (63 - 7 * r21) / 80},
    {(10 - r21) / 42, 0, (-432 + 92 * r21) / 315, (633 - 145 * r21) / 90, (-504 + 115 * r21) / 70,
     (63 - 13 * r21) / 35},
    {1.0 / 14, 0, 0, 0, (14 - 3 * r21) / 126, (13 - 3 * r21) / 63, 1.0 / 9},
    {1.0 / 32, 0, 0, 0, (91 - 21 * r21) / 576, 11.0 / 72, (-385 - 75 * r21) / 1152, (63 + 13 * r21) / 128},
    {1.0 / 14, 0, 0, 0, 1.0 / 9, (-733 - 147 * r21) / 2205, (515 + 111 * r21) / 504, (-51 - 11 * r21) / 56,
     (132 + 28 * r21) / 245},
    {0, 0, 0, 0, (-42 + 7 * r21) / 18, (-18 + 28 * r21) / 45, (-273 - 53 * r21) / 72, (301 + 53 * r21) / 72,
     (28 - 28 * r21) / 45, (49 - 7 * r21) / 18},
}};

/// A rod with its compliances in the section's axes.
template <class S>
struct Law {
  explicit Law(const SpatialRod& rod)
      : precurvature(rod.precurvature.cast<S>()),
        bend(S(1 / rod.bending_stiffness[0]), S(1 / rod.bending_stiffness[1]), S(1 / rod.torsion_stiffness)),
        stretch(S(rod.shear_compliance[0]), S(rod.shear_compliance[1]), S(rod.extension_compliance)),
        load(rod.load.cast<S>()),
        stretches(!rod.is_kirchhoff()) {}

  Vec3<S> precurvature, bend, stretch, load;
  bool stretches;
};

/// What is integrated over s; also its derivative by s. The moment stands for the paper's curvature.
/// 3PFS (20).
template <class S>
struct State {
  Vec<S, 4> q;  ///< [w, x, y, z]
  Vec3<S> m;
  Vec3<S> p;
  S energy;     ///< elastic
  S potential;  ///< ∫ s f·p′, all but f·p of that of the load
};

/// |q|² times the rotation matrix: polynomials, so that a step has the derivative of a polynomial.
/// 3PFS (22).
template <class S>
Mat<S, 3, 3> matrix(const Vec<S, 4>& q) {
  const S ww = q[0] * q[0], xx = q[1] * q[1], yy = q[2] * q[2], zz = q[3] * q[3];
  const S xy = q[1] * q[2], xz = q[1] * q[3], yz = q[2] * q[3];
  const S wx = q[0] * q[1], wy = q[0] * q[2], wz = q[0] * q[3];
  Mat<S, 3, 3> R;
  R << ww + xx - yy - zz, S(2) * (xy - wz), S(2) * (xz + wy),  //
      S(2) * (xy + wz), ww - xx + yy - zz, S(2) * (yz - wx),   //
      S(2) * (xz - wy), S(2) * (yz + wx), ww - xx - yy + zz;
  return R;
}

/// q ∘ u, twice q′: of numbers, or of lanes of derivatives.  3PFS (23), torsion included
template <class Q, class U, class Out>
void product(const Q& q, const U& u, Out& out) {
  out[0] = -(q[1] * u[0] + q[2] * u[1] + q[3] * u[2]);
  out[1] = q[0] * u[0] + q[2] * u[2] - q[3] * u[1];
  out[2] = q[0] * u[1] + q[3] * u[0] - q[1] * u[2];
  out[3] = q[0] * u[2] + q[1] * u[1] - q[2] * u[0];
}

/// The equations at one stage, with what their derivatives need again.
template <class S>
struct Stage {
  Vec<S, 4> q;
  Vec3<S> m, n;
  Mat<S, 3, 3> R;
  Vec3<S> u;
  State<S> rate;
};

/// The right-hand sides.  3PFS (21), in base axes, for m and with the section's whole law
template <class S>
void evaluate(const Law<S>& law, const S& s, Stage<S>& at) {
  at.R = matrix(at.q);
  const Vec3<S> moment = at.R.transpose() * at.m, bend = law.bend.cwiseProduct(moment);
  at.u = law.precurvature + bend;
  product(at.q, Vec3<S>(at.u * S(0.5)), at.rate.q);
  S energy = dot(moment, bend);
  at.rate.p = at.R.col(2);
  if (law.stretches) {
    const Vec3<S> force = at.R.transpose() * at.n, stretch = law.stretch.cwiseProduct(force);
    at.rate.p += at.R * stretch;
    energy += dot(force, stretch);
  }
  at.rate.m = cross(at.n, at.rate.p);
  at.rate.energy = energy * S(0.5);
  at.rate.potential = s * dot(law.load, at.rate.p);  // −∫f·(p − p(0)) by parts
}

/// Sums of stages: `add(rate, factor)` where the table has a number.
template <class Rates, class Add>
void sum_stages(const std::array<double, stages>& table, std::size_t count, const Rates& rates, Add&& add) {
  for (std::size_t j = 0; j < count; ++j)
    if (table[j] != 0) add(rates[j], table[j]);
}

/// The state that walks along the rod, and the stages of its last step.
template <class S>
struct Walk {
  Walk(const SpatialRod& rod, const S& length, const RodState<S>& base, int steps)
      : law(rod),
        n0(base.n),
        h(length / S(steps)) {
    y.q << base.R.w, base.R.v;
    y.m = base.m;
    y.p = Vec3<S>(S(0), S(0), S(0));  // from the base: nothing is lost far from the origin
    y.energy = y.potential = S(0);
  }

  Vec3<S> force(const S& s) const { return n0 - law.load * s; }

  void step() {
    const S s0 = h * S(taken);
    for (std::size_t i = 0; i < stages; ++i) {
      Stage<S>& at = stage[i];
      at.q = y.q;
      at.m = y.m;
      sum_stages(coupling[i], i, stage, [&](const Stage<S>& k, double a) {
        at.q += k.rate.q * (h * a);
        at.m += k.rate.m * (h * a);
      });
      const S s = s0 + h * node[i];
      at.n = force(s);
      evaluate(law, s, at);
    }
    sum_stages(weight, stages, stage, [&](const Stage<S>& k, double b) {
      y.q += k.rate.q * (h * b);
      y.m += k.rate.m * (h * b);
      y.p += k.rate.p * (h * b);
      y.energy += k.rate.energy * (h * b);
      y.potential += k.rate.potential * (h * b);
    });
    ++taken;
  }

  RodState<S> state(const RodState<S>& base) const {
    const SO3<S> R{y.q[0], Vec3<S>(y.q[1], y.q[2], y.q[3])};
    return {Vec3<S>(base.p + y.p), R.normalised(), force(h * S(taken)), y.m};
  }

  Law<S> law;
  Vec3<S> n0;
  S h;
  int taken = 0;
  State<S> y;
  std::array<Stage<S>, stages> stage;
};

}  // namespace sinew::inline v1::rod_steps
