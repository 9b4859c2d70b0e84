/// @file leg_system.hpp
/// Equations of one leg on a chain, with their derivatives. Theory: docs/theory/chain_equilibrium.md
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "sinew/kinematics/chain.hpp"

namespace sinew::inline v0 {

inline constexpr int most_unknowns = max_chain_joints + 2;  ///< angles, force, tension

/// The larger size; NaN stays.
inline double worse(double a, double b) {
  return std::isfinite(b) ? std::max(a, std::abs(b)) : std::numeric_limits<double>::quiet_NaN();
}

/// `legs[2]`, then what is wrong there.
inline void say_leg(Report& report, Status status, std::size_t leg, std::string_view what) {
  report.status = status;
  report.message = {};
  report.message.append("legs[");
  append_number(report.message, static_cast<int>(leg));
  report.message.append("]");
  report.message.append(what);
}

/// A leg's closure c = 0 [m] in its angles q and the pose x, with first and second derivatives. Those by the
/// pose are of the force's line, so that turns keep the order in which they are made.
template <class Space>
struct ChainClosure {
  static constexpr int dof = Space::dof;
  double c, distance;  ///< of the anchors that chord or strut joins [m]
  std::array<double, max_chain_joints> c_q;
  Vec<double, dof> c_x;
  std::array<std::array<double, max_chain_joints>, max_chain_joints> c_qq;
  std::array<Vec<double, dof>, max_chain_joints> c_qx;  ///< 0 of a chord
  Mat<double, dof, dof> c_xx;
};

namespace detail {

/// ∂r/∂x of a platform point: r_x = (1, E b) in the plane, (1, −[b]×) in space.
inline Mat<double, 2, 3> point_rate(const Vec2<double>& b) {
  Mat<double, 2, 3> rate;
  rate << 1, 0, -b[1], 0, 1, b[0];
  return rate;
}
inline Mat<double, 3, 6> point_rate(const Vec3<double>& b) {
  Mat<double, 3, 6> rate;
  rate << 1, 0, 0, 0, b[2], -b[1], 0, 1, 0, -b[2], 0, b[0], 0, 0, 1, b[1], -b[0], 0;
  return rate;
}

/// What the line along e through b changes by with a turn of b alone.
inline void add_turn(const Vec2<double>& e, const Vec2<double>& b, Mat<double, 3, 3>& c_xx) {
  c_xx(2, 2) -= dot(e, b);
}
inline void add_turn(const Vec3<double>& e, const Vec3<double>& b, Mat<double, 6, 6>& c_xx) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) c_xx(3 + i, 3 + j) += b[i] * e[j];
    c_xx(3 + i, 3 + i) -= dot(e, b);
  }
}

}  // namespace detail

template <class Space>
void close_chain(const ChainLeg<Space>& leg, const typename Space::template Frame<double>& platform,
                 std::span<const double> angles, ChainClosure<Space>& at) {
  constexpr int dimension = Space::dimension;
  using Point = Vec<double, dimension>;
  const auto tip = leg.chain.tip(angles);
  const std::size_t joints = angles.size();
  const Point b = platform.rotate(leg.platform_point);
  Point n = platform.p + b - leg.base.p;
  std::array<Point, max_chain_joints> u_q;  // of a strut, base axes
  const bool has_strut = dimension == 2 && leg.has_strut();
  if constexpr (dimension == 2)
    if (has_strut) {
      n -= leg.base.rotate(tip.position);
      for (std::size_t j = 0; j < joints; ++j) u_q[j] = leg.base.rotate(tip.rate[j]);
    }
  at.distance = std::sqrt(squared_norm(n));
  const double per_distance = 1 / at.distance;
  const Point e = n * per_distance;
  const auto across = [&](const Point& v) -> Point { return (v - dot(e, v) * e) * per_distance; };
  const auto r_x = detail::point_rate(b);
  std::array<Point, Space::dof> across_x;
  for (int k = 0; k < Space::dof; ++k) across_x[static_cast<std::size_t>(k)] = across(Point(r_x.col(k)));

  at.c_x = Space::line(e, b).transpose();
  for (int k = 0; k < Space::dof; ++k)
    for (int l = 0; l < Space::dof; ++l)
      at.c_xx(k, l) = dot(Point(r_x.col(k)), across_x[static_cast<std::size_t>(l)]);
  detail::add_turn(e, b, at.c_xx);
  if constexpr (dimension == 2)
    if (has_strut) {
      at.c = at.distance - leg.strut;
      for (std::size_t j = 0; j < joints; ++j) {
        at.c_q[j] = -dot(e, u_q[j]);
        for (std::size_t k = 0; k < static_cast<std::size_t>(Space::dof); ++k)
          at.c_qx[j][static_cast<Eigen::Index>(k)] = -dot(u_q[j], across_x[k]);
        const Point across_j = across(u_q[j]);
        for (std::size_t k = 0; k <= j; ++k)  // the outer joint turns what the inner one moved
          at.c_qq[j][k] = at.c_qq[k][j] = dot(across_j, u_q[k]) - dot(e, Point(-u_q[j][1], u_q[j][0]));
      }
      return;
    }
  const double chord = std::sqrt(squared_norm(tip.position)), per_chord = 1 / chord;
  at.c = at.distance - chord;
  for (std::size_t j = 0; j < joints; ++j) {
    at.c_q[j] = -dot(tip.position, tip.rate[j]) * per_chord;
    at.c_qx[j].setZero();
    for (std::size_t k = 0; k <= j; ++k)
      at.c_qq[j][k] = at.c_qq[k][j] =
          -(dot(tip.rate[j], tip.rate[k]) - at.c_q[j] * at.c_q[k] +
            dot(tip.position, tip.rate_rate(static_cast<int>(j), static_cast<int>(k)))) *
          per_chord;
  }
}

/// ∂c/∂θ of a motor at the base, which turns the whole chain.
inline double motor_slope(const ChainLeg<Planar>& leg, std::span<const double> angles,
                          const ChainClosure<Planar>& at) {
  const Vec2<double> u = leg.base.rotate(leg.chain.tip(angles).position);
  return at.c_x[0] * u[1] - at.c_x[1] * u[0];
}

/// Linearised: A δz + B δx = −r in z = angles, force and, of a length that is held, its tension.
template <class Space>
struct LegSystem {
  int size = 0, joints = 0;
  std::array<std::array<double, most_unknowns>, most_unknowns> A;
  std::array<Vec<double, Space::dof>, most_unknowns> B;
  std::array<double, most_unknowns> r;
  std::array<double, max_chain_joints> per_tension;  ///< of the joints' balance by the inner tendon's tension
  ChainClosure<Space> closure;
};

/// What joints bend by under a moment alone, as shares.
inline double even_bend(const PseudoRigid& chain, int joint) {
  return chain.turn_weight(joint) / chain.spring(joint);
}

/// The tendon on the inside of the bend.
inline std::size_t inner_tendon(const ChainLegState& state, const PseudoRigid& chain) {
  return chain.turn(state.of(chain)) < 0 ? 0 : 1;
}

/// With the geometric stiffness that (44) leaves out.
template <class Space>
void form(const ChainLeg<Space>& leg, const typename Space::template Frame<double>& platform,
          const ChainLegState& state, const ChainHold& hold, LegSystem<Space>& system) {
  const PseudoRigid& chain = leg.chain;
  const int joints = chain.joints();
  const auto n = static_cast<std::size_t>(joints);
  const bool holds_length = hold.length_of >= 0;
  const std::size_t inner = inner_tendon(state, chain);
  system.joints = joints;
  system.size = joints + (holds_length ? 2 : 1);
  close_chain(leg, platform, state.of(chain), system.closure);
  const auto& at = system.closure;
  double length = chain.length;
  for (std::size_t j = 0; j < n; ++j) {
    const int joint = static_cast<int>(j);
    const std::array bend{chain.tendon_bend(joint, state.angles[j], leg.tendon_offset, 1),
                          chain.tendon_bend(joint, state.angles[j], leg.tendon_offset, -1)};
    for (std::size_t k = 0; k < n; ++k) system.A[j][k] = state.force * at.c_qq[j][k];
    system.A[j][j] +=
        leg.spring(joint) + state.tension[0] * bend[0].curvature + state.tension[1] * bend[1].curvature;
    system.r[j] = leg.spring(joint) * state.angles[j] + state.tension[0] * bend[0].rate +
                  state.tension[1] * bend[1].rate + state.force * at.c_q[j];
    system.A[j][n] = system.A[n][j] = at.c_q[j];
    system.B[j] = state.force * at.c_qx[j];
    system.per_tension[j] = bend[inner].rate;
    if (holds_length) {
      const auto& held = bend[static_cast<std::size_t>(hold.length_of)];
      length += held.change;
      system.A[j][n + 1] = system.A[n + 1][j] = held.rate;
    }
  }
  system.A[n][n] = 0;
  system.B[n] = at.c_x;
  system.r[n] = at.c;
  if (holds_length) {
    system.A[n][n + 1] = system.A[n + 1][n] = system.A[n + 1][n + 1] = 0;
    system.B[n + 1].setZero();
    system.r[n + 1] = length - hold.length;
  }
}

/// The same where all joints of the chain bend in proportion: one unknown in place of the angles.
template <class Space>
void bend_evenly(const PseudoRigid& chain, LegSystem<Space>& system) {
  const auto n = static_cast<std::size_t>(system.joints), rest = static_cast<std::size_t>(system.size) - n;
  std::array<double, max_chain_joints> w;
  for (std::size_t j = 0; j < n; ++j) w[j] = even_bend(chain, static_cast<int>(j));
  double stiffness = 0, balance = 0, tension = 0;
  Vec<double, Space::dof> coupling = Vec<double, Space::dof>::Zero();
  std::array<double, 2> edge{};
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t k = 0; k < n; ++k) stiffness += w[j] * system.A[j][k] * w[k];
    for (std::size_t k = 0; k < rest; ++k) edge[k] += w[j] * system.A[j][n + k];
    balance += w[j] * system.r[j];
    tension += w[j] * system.per_tension[j];
    coupling += w[j] * system.B[j];
  }
  for (std::size_t k = 0; k < rest; ++k) {
    system.B[1 + k] = system.B[n + k];
    system.r[1 + k] = system.r[n + k];
    system.A[0][1 + k] = system.A[1 + k][0] = edge[k];
    for (std::size_t l = 0; l < rest; ++l) system.A[1 + k][1 + l] = 0;
  }
  system.A[0][0] = stiffness;
  system.r[0] = balance;
  system.per_tension[0] = tension;
  system.B[0] = coupling;
  system.joints = 1;
  system.size = static_cast<int>(1 + rest);
}

}  // namespace sinew::inline v0
