/// @file rod_tangents.hpp
/// Derivatives of the steps of a rod: each stage differentiated, with the quaternion as four numbers. Nothing
/// is neglected, so they are the derivatives of the computed tip, to rounding. Two columns at a time, all
/// their numbers in registers: with all columns at once the same sums take twice as many instructions.
#pragma once
#include <array>
#include <cstddef>

#include "shooting_rod/rod_steps.hpp"

namespace sinew::inline v1::rod_steps {

/// One number's derivatives by two things. What every machine has; GCC and Clang agree on it.
using Lane = double __attribute__((vector_size(16)));
using Lane3 = std::array<Lane, 3>;
using Lane4 = std::array<Lane, 4>;

inline Lane spread(double x) { return Lane{x, x}; }
inline Lane3 spread(const Vec3<double>& x) { return {spread(x[0]), spread(x[1]), spread(x[2])}; }
inline Lane4 spread(const Vec<double, 4>& x) {
  return {spread(x[0]), spread(x[1]), spread(x[2]), spread(x[3])};
}

/// The rows of a matrix.
using Spread = std::array<Lane3, 3>;
inline Spread spread(const Mat<double, 3, 3>& a) {
  return {spread(Vec3<double>(a.row(0))), spread(Vec3<double>(a.row(1))), spread(Vec3<double>(a.row(2)))};
}

inline Lane lane_dot(const Lane3& a, const Lane3& x) { return a[0] * x[0] + a[1] * x[1] + a[2] * x[2]; }

inline Lane3 lane_times(const Spread& a, const Lane3& x) {
  return {lane_dot(a[0], x), lane_dot(a[1], x), lane_dot(a[2], x)};
}

inline Lane3 lane_cross(const Lane3& a, const Lane3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <std::size_t N>
void lane_add(std::array<Lane, N>& to, const std::array<Lane, N>& rate, const Lane& factor) {
#pragma GCC unroll 4
  for (std::size_t i = 0; i < N; ++i) to[i] += factor * rate[i];
}

/// What the columns share of a stage, spread once: to spread a number costs as much as to use it.
struct Linear {
  Linear(const Law<double>& law, const Stage<double>& stage)
      : half_q(spread(Vec<double, 4>(0.5 * stage.q))),
        turn(spread(Vec<double, 4>(stage.q * (2 / stage.q.squaredNorm())))),
        m(spread(stage.m)),
        n(spread(stage.n)),
        half_u(spread(Vec3<double>(0.5 * stage.u))),
        slope(spread(stage.rate.p)),
        bend(spread(Mat<double, 3, 3>(law.bend.asDiagonal() * stage.R.transpose()))),
        stretches(law.stretches) {
    if (stretches)
      stretch = spread(Mat<double, 3, 3>(stage.R * law.stretch.asDiagonal() * stage.R.transpose()));
  }

  Lane4 half_q, turn;  // turn: 2q/|q|²
  Lane3 m, n, half_u, slope;
  Spread bend, stretch;
  bool stretches;
};

/// φ of δq = ½ φ ∘ q, a vector and the growth of |q|²: δ(R x) = φ₀ R x + φ × R x for the R of |q|².
struct LaneTurn {
  LaneTurn(const Lane4& f, const Lane4& dq)  // f = 2q/|q|²
      : growth(f[0] * dq[0] + f[1] * dq[1] + f[2] * dq[2] + f[3] * dq[3]),
        vector{f[0] * dq[1] - f[1] * dq[0] - f[3] * dq[2] + f[2] * dq[3],
               f[0] * dq[2] - f[2] * dq[0] - f[1] * dq[3] + f[3] * dq[1],
               f[0] * dq[3] - f[3] * dq[0] - f[2] * dq[1] + f[1] * dq[2]} {}

  /// δ(R x) of a fixed x, from R x.
  Lane3 turned(const Lane3& Rx) const {
    const Lane3 side = lane_cross(vector, Rx);
    return {side[0] + growth * Rx[0], side[1] + growth * Rx[1], side[2] + growth * Rx[2]};
  }
  /// What Rᵀ is to be applied to for δ(Rᵀx).
  Lane3 turned_back(const Lane3& x, const Lane3& dx) const {
    const Lane3 side = lane_cross(vector, x);
    return {dx[0] + growth * x[0] - side[0], dx[1] + growth * x[1] - side[1],
            dx[2] + growth * x[2] - side[2]};
  }

  Lane growth;
  Lane3 vector;
};

/// Columns: force and moment at the base; turns of the base frame, about its own z (1) or about the base axes
/// (3); length.
template <int turns>
class Tangents {
 public:
  static constexpr int force = 0, moment = 3, turn = 6, length = 6 + turns, columns = 7 + turns;
  static constexpr std::size_t lanes = columns / 2;
  static_assert(columns % 2 == 0);

  Tangents(const RodState<double>& base, const Vec3<double>& load, double rod_length)
      : load_(load),
        length_(rod_length),
        y_{},
        force_{} {
    for (int i = 0; i < 3; ++i)
      force_[static_cast<std::size_t>(i / 2)][static_cast<std::size_t>(i)][i % 2] = 1;
    for (int i = 0; i < 3; ++i) at(moment + i).m[static_cast<std::size_t>(i)][(moment + i) % 2] = 1;
    for (int k = 0; k < turns; ++k) {  // ½ ω ∘ q
      const Vec3<double> axis = turns == 1 ? base.tangent() : Vec3<double>(Vec3<double>::Unit(k));
      const auto dq = SO3<double>{0, axis}.compose(base.R);
      Lane4& q = at(turn + k).q;
      q[0][(turn + k) % 2] = 0.5 * dq.w;
      for (int i = 0; i < 3; ++i) q[static_cast<std::size_t>(i + 1)][(turn + k) % 2] = 0.5 * dq.v[i];
    }
  }

  /// Follows the step that `walk` has just made.
  void step(const Walk<double>& walk) {
    for (std::size_t i = 0; i < stages; ++i) {
      const Linear on(walk.law, walk.stage[i]);
      const double s = (walk.taken - 1 + node[i]) * walk.h;
      for (std::size_t k = 0; k < lanes; ++k) {
        auto& rate = rate_[k];
        Pair here = y_[k];
        sum_stages(coupling[i], i, rate, [&](const Pair& x, double a) {
          const Lane factor = spread(walk.h * a);
          lane_add(here.q, x.q, factor);
          lane_add(here.m, x.m, factor);
        });
        differentiate(on, force_rate(k, s), here, rate[i]);
        if (k == length / 2) feed(walk.stage[i], rate[i]);
      }
    }
    for (std::size_t k = 0; k < lanes; ++k) {
      sum_stages(weight, stages, rate_[k], [&](const Pair& x, double b) {
        const Lane factor = spread(walk.h * b);
        lane_add(y_[k].q, x.q, factor);
        lane_add(y_[k].m, x.m, factor);
        lane_add(y_[k].p, x.p, factor);
      });
    }
  }

  /// Rows of RodTangent.
  Mat<double, 12, columns> rate(const Walk<double>& walk) const {
    const Lane4 f = spread(Vec<double, 4>(walk.y.q * (2 / walk.y.q.squaredNorm())));
    Mat<double, 12, columns> rate;
    for (int c = 0; c < columns; ++c) {
      const Pair& y = y_[static_cast<std::size_t>(c / 2)];
      const LaneTurn turned(f, y.q);
      const Lane3 n = force_rate(static_cast<std::size_t>(c / 2), length_);
      for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<std::size_t>(i);
        rate(RodTangent::position + i, c) = y.p[k][c % 2];
        rate(RodTangent::rotation + i, c) = turned.vector[k][c % 2];
        rate(RodTangent::tip_force + i, c) = n[k][c % 2];
        rate(RodTangent::tip_moment + i, c) = y.m[k][c % 2];
      }
    }
    return rate;
  }

 private:
  struct Pair {
    Lane4 q;
    Lane3 m, p;
  };

  Pair& at(int column) { return y_[static_cast<std::size_t>(column / 2)]; }

  /// δn at s: n = n(0) − s f, and s grows with the length.
  Lane3 force_rate(std::size_t k, double s) const {
    Lane3 rate = force_[k];
    if (k == length / 2)
      for (int i = 0; i < 3; ++i) rate[static_cast<std::size_t>(i)][length % 2] -= load_[i] * s / length_;
    return rate;
  }

  static void differentiate(const Linear& l, const Lane3& n, const Pair& at, Pair& rate) {
    const LaneTurn turned(l.turn, at.q);
    const Lane3 u = lane_times(l.bend, turned.turned_back(l.m, at.m));
    Lane4 half;
    product(at.q, l.half_u, rate.q);
    product(l.half_q, u, half);
    for (std::size_t i = 0; i < 4; ++i) rate.q[i] += half[i];
    rate.p = turned.turned(l.slope);
    if (l.stretches) {
      const Lane3 more = lane_times(l.stretch, turned.turned_back(l.n, n));
      for (std::size_t i = 0; i < 3; ++i) rate.p[i] += more[i];
    }
    const Lane3 by_force = lane_cross(n, l.slope), by_slope = lane_cross(rate.p, l.n);
    for (std::size_t i = 0; i < 3; ++i) rate.m[i] = by_force[i] - by_slope[i];
  }

  /// The steps grow with the length: h′ = h/L.
  void feed(const Stage<double>& on, Pair& rate) const {
    const double share = 1 / length_;
    for (std::size_t i = 0; i < 4; ++i) rate.q[i][length % 2] += on.rate.q[static_cast<int>(i)] * share;
    for (std::size_t i = 0; i < 3; ++i) {
      rate.m[i][length % 2] += on.rate.m[static_cast<int>(i)] * share;
      rate.p[i][length % 2] += on.rate.p[static_cast<int>(i)] * share;
    }
  }

  Vec3<double> load_;
  double length_;
  std::array<Pair, lanes> y_;
  std::array<Lane3, lanes> force_;  // δn(0)
  std::array<std::array<Pair, stages>, lanes> rate_;
};

}  // namespace sinew::inline v1::rod_steps
