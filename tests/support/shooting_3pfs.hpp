/// @file shooting_3pfs.hpp
/// The flexible tripod as the paper states and solves it: 3PFS (20)-(35), 37 unknowns, Newton with a dense
/// 37 × 37 factorisation. It reads nothing of the library, so it can judge it; with `baseline` it is also
/// what a reader of the paper would have written, for benchmarks.
///
///   const Solution home = solve(tripod, lengths, {}, first_guess(tripod, lengths));
///   const Solution there = walk(tripod, {lengths, {}}, {other, wrench}, home.v, 8);
///   const Linear around = linear_around(tripod, other, wrench, there);
///
/// Unknowns (32): rod i has v[5i…] = u_x(0), u_y(0) [1/m], n [N]; then p [m] at 30, quaternion e0…e3 at 33.
/// Residuals (31): rod i has a + p(L) − p − R r [m], u_x(L), u_y(L) [1/m]; then force [N],
/// moment about O [N m], |e|² − 1. Rods leave along +z with q_i(0) = (1, 0, 0, 0), hence u_i(0) is in base
/// axes.
///
/// Left as the paper has it, on purpose: the quaternion as four unknowns, the moment about O, the inert m(L)
/// of (29). Deviation: n' = 0 of (24) is met by holding n constant instead of integrating three zeros.
#pragma once
#include <algorithm>
#include <complex>

#include "tripod_3pfs.hpp"

namespace sinew::test::shooting {

using Eigen::Vector4d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
template <class S>
using Vector37 = Eigen::Matrix<S, 37, 1>;
using Matrix37 = Eigen::Matrix<double, 37, 37>;
using Complex = std::complex<double>;
constexpr double imaginary_step = 1e-30;

enum class Derivative { forward_difference, complex_step };

struct Options {
  Integration rods = {};
  Derivative derivative = Derivative::complex_step;
  double tolerance = 1e-12;  ///< on the largest |g_res|, in its own mixed units
  int iterations = 30;
  bool by_blocks = true;  ///< a difference integrates only the rod that owns the unknown
};
/// The paper's own choice, and the baseline of benchmarks: differences that know nothing of the equations.
inline constexpr Options baseline{.rods = {.method = Method::rk4, .steps = 40},
                                  .derivative = Derivative::forward_difference,
                                  .by_blocks = false};

template <class S>
Section<S> rod_tip(const Tripod& t, double length, const Vector37<S>& v, int i, const Integration& how) {
  const Vector3<S> n = v.template segment<3>(5 * i + 2);
  return tip<S>(n, v[5 * i], v[5 * i + 1], length, t.bending_stiffness, how);
}

template <class S>
PerRod<Section<S>> rod_tips(const Tripod& t, const PerRod<double>& L, const Vector37<S>& v,
                            const Integration& how) {
  PerRod<Section<S>> y;
  for (int i = 0; i < 6; ++i) y[std::size_t(i)] = rod_tip(t, L[std::size_t(i)], v, i, how);
  return y;
}

/// g_res of (31) once the rods are integrated to their tips.
template <class S>
Vector37<S> residual(const Tripod& t, const Wrench& w, const Vector37<S>& v, const PerRod<Section<S>>& tips) {
  Vector37<S> g;
  const Vector3<S> p = v.template segment<3>(30);
  const Eigen::Matrix<S, 3, 3> R = rotation(v[33], v[34], v[35], v[36]);
  Vector3<S> force = -w.force.cast<S>(), moment = -cross<S>(p, w.force.cast<S>()) - w.moment.cast<S>();
  for (int i = 0; i < 6; ++i) {
    const auto k = std::size_t(i);
    const Section<S>& y = tips[k];
    const Vector3<S> b = t.base[k].cast<S>() + Vector3<S>(y[0], y[1], y[2]);
    const Vector3<S> n = v.template segment<3>(5 * i + 2), u(y[7], y[8], S(0));
    const Eigen::Matrix<S, 3, 3> section = rotation(y[3], y[4], y[5], y[6]);
    g.template segment<3>(5 * i) = b - p - R * t.platform[k].cast<S>();
    g[5 * i + 3] = u[0];
    g[5 * i + 4] = u[1];
    force += n;
    moment += cross<S>(b, n) + S(t.bending_stiffness) * (section * u);
  }
  g.template segment<3>(30) = force;
  g.template segment<3>(33) = moment;
  g[36] = v[33] * v[33] + v[34] * v[34] + v[35] * v[35] + v[36] * v[36] - 1.0;
  return g;
}

/// J of (33), column by column. By blocks only the rod that owns an unknown is integrated anew: 36 rods an
/// iteration, not 6 · 38, the most the order (34) of the unknowns can save a reader of the paper.
inline Matrix37 jacobian(const Tripod& t, const PerRod<double>& L, const Wrench& w, const Vector37<double>& v,
                         const PerRod<Section<double>>& tips, const Vector37<double>& g, const Options& how) {
  Matrix37 J;
  PerRod<Section<Complex>> complex_tips;
  for (std::size_t i = 0; i < 6; ++i) std::copy(tips[i].begin(), tips[i].end(), complex_tips[i].begin());
  for (int j = 0; j < 37; ++j) {
    const int i = j / 5;  // 6 and 7: the pose, which moves no rod
    const auto k = std::size_t(i);
    if (how.derivative == Derivative::complex_step) {
      Vector37<Complex> at = v.cast<Complex>();
      at[j] += Complex(0, imaginary_step);
      PerRod<Section<Complex>> moved = complex_tips;
      if (i < 6) moved[k] = rod_tip(t, L[k], at, i, how.rods);
      J.col(j) = residual(t, w, at, moved).imag() / imaginary_step;
    } else {
      Vector37<double> at = v;
      at[j] += 1e-7 * std::max(1.0, std::abs(v[j]));
      PerRod<Section<double>> moved = how.by_blocks ? tips : rod_tips(t, L, at, how.rods);
      if (how.by_blocks && i < 6) moved[k] = rod_tip(t, L[k], at, i, how.rods);
      J.col(j) = (residual(t, w, at, moved) - g) / (at[j] - v[j]);
    }
  }
  return J;
}

/// A⁻¹ B, dense, rows exchanged for the largest pivot; not finite when A is singular. (Eigen's blocked LU
/// takes as long at this size, and costs every test that includes this two or three seconds of compiling.)
template <int columns>
Eigen::Matrix<double, 37, columns> solve_dense(Matrix37 A, Eigen::Matrix<double, 37, columns> B) {
  for (int k = 0; k < 37; ++k) {
    int pivot = k;
    for (int i = k + 1; i < 37; ++i)
      if (std::abs(A(i, k)) > std::abs(A(pivot, k))) pivot = i;
    A.row(k).swap(A.row(pivot));
    B.row(k).swap(B.row(pivot));
    for (int i = k + 1; i < 37; ++i) A(i, k) /= A(k, k);
    for (int j = k + 1; j < 37; ++j)
      for (int i = k + 1; i < 37; ++i) A(i, j) -= A(i, k) * A(k, j);
    for (int j = 0; j < columns; ++j)
      for (int i = k + 1; i < 37; ++i) B(i, j) -= A(i, k) * B(k, j);
  }
  for (int j = 0; j < columns; ++j)
    for (int k = 36; k >= 0; --k) {
      B(k, j) /= A(k, k);
      for (int i = 0; i < k; ++i) B(i, j) -= A(i, k) * B(k, j);
    }
  return B;
}

struct Solution {
  Vector37<double> v;            ///< unknowns (32)
  PerRod<Section<double>> tips;  ///< sections at s = L_i
  double residual;               ///< largest |g_res|; NaN when the iteration left the numbers
  int iterations;                ///< Jacobians factored
  bool converged;

  Vector3d p() const { return v.segment<3>(30); }
  Vector4d e() const { return v.segment<4>(33); }
  Vector3d n(int i) const { return v.segment<3>(5 * i + 2); }
  Eigen::Vector2d u0(int i) const { return v.segment<2>(5 * i); }
  /// Angle of the tip's tangent from +z [rad], in [0, π].
  double tip_angle(int i) const {
    const auto t = rate<double>(tips[std::size_t(i)], Vector3d::Zero(), 1);
    return std::atan2(std::hypot(t[0], t[1]), t[2]);
  }
  /// ½ EI ∫|u|² ds [J]: by (24) H = ½ EI |u|² + n·t is constant along a rod, hence H L − n·p(L).
  double energy(int i, double length, double EI) const {
    const auto& y = tips[std::size_t(i)];
    return (EI / 2 * u0(i).squaredNorm() + n(i).z()) * length - n(i).dot(Vector3d(y[0], y[1], y[2]));
  }
};

/// Newton (35) from `start`, plain: no line search, as the paper.
inline Solution solve(const Tripod& t, const PerRod<double>& L, const Wrench& w,
                      const Vector37<double>& start, const Options& how = {}) {
  Solution s{start, rod_tips(t, L, start, how.rods), 0, 0, false};
  Vector37<double> g = residual(t, w, s.v, s.tips);
  const auto size = [&] { return g.allFinite() ? g.lpNorm<Eigen::Infinity>() : std::nan(""); };
  for (s.residual = size(); s.residual > how.tolerance && s.iterations < how.iterations; ++s.iterations) {
    const Matrix37 J = jacobian(t, L, w, s.v, s.tips, g, how);
    s.v -= solve_dense<1>(J, g);
    s.tips = rod_tips(t, L, s.v, how.rods);
    g = residual(t, w, s.v, s.tips);
    s.residual = size();
  }
  s.converged = s.residual <= how.tolerance;
  return s;
}

/// A start for the symmetric home, from nothing known before: each rod a cantilever of small deflection,
/// loaded across by 3 EI d/L³; platform level, lower than the rods' mean length by what they bend.
inline Vector37<double> first_guess(const Tripod& t, const PerRod<double>& L) {
  Vector37<double> v = Vector37<double>::Zero();
  v[33] = 1;
  for (int i = 0; i < 6; ++i) {
    const auto k = std::size_t(i);
    Vector3d across = t.platform[k] - t.base[k];
    across.z() = 0;
    const double height = L[k] - 0.6 * across.squaredNorm() / L[k];
    const Vector3d n = 3 * t.bending_stiffness / (L[k] * L[k] * L[k]) * across;
    v.segment<5>(5 * i) << -height * n.y() / t.bending_stiffness, height * n.x() / t.bending_stiffness, n;
    v[32] += height / 6;
  }
  return v;
}

/// What a solution answers to.
struct Task {
  PerRod<double> lengths;  ///< L_i [m]
  Wrench wrench;
};

/// The branch of `start`: from task `from` to `to` along the straight line between them in `pieces` cheap
/// steps, the last of them to `how`. `converged` is false when any of them failed.
inline Solution walk(const Tripod& t, const Task& from, const Task& to, const Vector37<double>& start,
                     int pieces, const Options& how = {}) {
  Options coarse = baseline;
  coarse.rods.steps = 12;
  coarse.tolerance = 1e-5;
  Solution s{start, {}, 0, 0, true};
  for (int k = 1; k <= pieces && s.converged; ++k) {
    const double f = double(k) / pieces;
    PerRod<double> L;
    for (std::size_t i = 0; i < 6; ++i) L[i] = (1 - f) * from.lengths[i] + f * to.lengths[i];
    s = solve(t, L,
              {(1 - f) * from.wrench.force + f * to.wrench.force,
               (1 - f) * from.wrench.moment + f * to.wrench.moment},
              s.v, coarse);
  }
  return s.converged ? solve(t, to.lengths, to.wrench, s.v, how) : s;
}

/// First order around a solution, by the implicit function theorem on (31); twists and wrenches at P, linear
/// part first, base axes.
struct Linear {
  Matrix6 stiffness;  ///< d(F, M)/d(p, θ) at fixed lengths
  Matrix6 length;     ///< d(p, θ)/d(L_1 … L_6) at fixed F, M
};

/// ė = ½ (0, ω) e, fixed axes.
inline Eigen::Matrix<double, 4, 3> quaternion_rate(const Vector4d& e) {
  Eigen::Matrix<double, 4, 3> rate;
  rate << -e[1], -e[2], -e[3], e[0], e[3], -e[2], -e[3], e[0], e[1], e[2], -e[1], e[0];
  return rate / 2;
}

inline Linear linear_around(const Tripod& t, const PerRod<double>& L, const Wrench& w, const Solution& s,
                            const Options& how = {}) {
  const Matrix37 J = jacobian(t, L, w, s.v, s.tips, residual(t, w, s.v, s.tips), how);
  const Eigen::Matrix<double, 4, 3> spin = quaternion_rate(s.e());
  // Every rod closed on a platform moved at will: the upper 30 rows of J, and the twist for the last 7.
  Matrix37 closed = J;
  closed.bottomRows<7>().setZero();
  closed.bottomRightCorner<7, 7>().setIdentity();
  Eigen::Matrix<double, 37, 6> twist = Eigen::Matrix<double, 37, 6>::Zero();
  twist.block<3, 3>(30, 0).setIdentity();
  twist.block<4, 3>(33, 3) = spin;
  Linear answer;
  answer.stiffness = J.middleRows<6>(30).lazyProduct(solve_dense<6>(closed, twist));
  // (29) takes moments about O: 0 = d(Σ b × n) − dp × F − p × dF − dM, and dp × F is in J already.
  for (int j = 0; j < 6; ++j)
    answer.stiffness.col(j).tail<3>() -= cross<double>(s.p(), answer.stiffness.col(j).head<3>());

  Eigen::Matrix<double, 37, 6> by_length;
  for (std::size_t i = 0; i < 6; ++i) {
    PerRod<Section<Complex>> tips;
    for (std::size_t k = 0; k < 6; ++k) std::copy(s.tips[k].begin(), s.tips[k].end(), tips[k].begin());
    const Section<double> on = rate<double>(s.tips[i], s.n(int(i)), t.bending_stiffness);
    for (std::size_t k = 0; k < 9; ++k) tips[i][k] += Complex(0, imaginary_step * on[k]);
    by_length.col(int(i)) = residual<Complex>(t, w, s.v.cast<Complex>(), tips).imag() / imaginary_step;
  }
  const Eigen::Matrix<double, 37, 6> dv = -solve_dense<6>(J, by_length);
  answer.length << dv.middleRows<3>(30), 4 * spin.transpose().lazyProduct(dv.middleRows<4>(33));
  return answer;
}

}  // namespace sinew::test::shooting
