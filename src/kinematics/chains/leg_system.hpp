/// @file leg_system.hpp
/// Equations of one leg on a chain, with their derivatives. Theory: docs/theory/chain_equilibrium.md
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "sinew/kinematics/chain.hpp"

namespace sinew::inline v0 {

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
/// pose are of the force's line, so that turns keep the order in which they are made. Those by two angles are
/// of the joints' distances w from that line:  ∂²c/∂qⱼ∂qₖ = σ wⱼ wₖ + w_max(j,k).
template <class Space>
struct ChainClosure {
  static constexpr int dof = Space::dof;
  using Joints = std::array<double, max_chain_joints>;
  double c, distance;  ///< of the anchors that chord or strut joins [m]
  Joints c_q;
  Vec<double, dof> c_x;
  double sway;            ///< σ [1/m]: by how much the line turns where the tip moves across it
  Joints across;          ///< w: of the tip, across the line of the chord or the strut [m/rad]
  Vec<double, dof> turn;  ///< v:  ∂²c/∂qⱼ∂x = wⱼ v;  0 of a chord
  Mat<double, dof, dof> c_xx;

  double c_qq(std::size_t j, std::size_t k) const {
    return sway * across[j] * across[k] + across[std::max(j, k)];
  }
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
  if constexpr (dimension == 2)
    if (leg.has_strut()) n -= leg.base.rotate(tip.position);
  at.distance = std::sqrt(squared_norm(n));
  const double per_distance = 1 / at.distance;
  const Point e = n * per_distance;
  const auto r_x = detail::point_rate(b);

  at.c_x = Space::line(e, b).transpose();
  for (int k = 0; k < Space::dof; ++k) {
    const Point across = (r_x.col(k) - dot(e, Point(r_x.col(k))) * e) * per_distance;
    for (int l = 0; l < Space::dof; ++l) at.c_xx(l, k) = dot(Point(r_x.col(l)), across);
  }
  detail::add_turn(e, b, at.c_xx);
  at.turn.setZero();
  Vec2<double> line = tip.position;  // in the axes of the chain
  if constexpr (dimension == 2)
    if (leg.has_strut()) {
      const Vec2<double> beside(-e[1], e[0]);
      line = leg.base.rotate_back(e);
      for (int k = 0; k < Space::dof; ++k) at.turn[k] = -dot(beside, Point(r_x.col(k))) * per_distance;
      at.c = at.distance - leg.strut;
      at.sway = per_distance;
    }
  if (!(dimension == 2 && leg.has_strut())) {
    const double chord = std::sqrt(squared_norm(tip.position)), per_chord = 1 / chord;
    line = line * per_chord;
    at.c = at.distance - chord;
    at.sway = -per_chord;
  }
  for (std::size_t j = 0; j < joints; ++j) {
    const Vec2<double>& rate = tip.rate[j];
    at.c_q[j] = -dot(line, rate);
    at.across[j] = line[0] * rate[1] - line[1] * rate[0];
  }
}

/// ∂c/∂θ of a motor at the base, which turns the whole chain.
inline double motor_slope(const ChainLeg<Planar>& leg, std::span<const double> angles,
                          const ChainClosure<Planar>& at) {
  const Vec2<double> u = leg.base.rotate(leg.chain.tip(angles).position);
  return at.c_x[0] * u[1] - at.c_x[1] * u[0];
}

/// What joints bend by under a moment alone, as shares.
inline double even_bend(const PseudoRigid& chain, int joint) {
  return chain.turn_weight(joint) / chain.spring(joint);
}

/// The tendon on the inside of the bend.
inline std::size_t inner_tendon(const ChainLegState& state, const PseudoRigid& chain) {
  return chain.turn(state.of(chain)) < 0 ? 0 : 1;
}

/// A leg's equations, and their derivatives by its angles, its force f and, of a length that is held, its
/// tension.
template <class Space>
struct LegSystem {
  using Joints = std::array<double, max_chain_joints>;
  int joints = 0;
  bool holds_length = false;
  Joints balance;       ///< of the joints' moments: springs, tendons and the force [N m]
  Joints stiffness;     ///< of springs and tendons alone; what the force adds is f ∂²c/∂q²
  Joints tendon;        ///< of the length that is held by the angles, or else of the inner tendon's
  double length_error;  ///< of what is held [m]
  double force;         ///< f
  ChainClosure<Space> closure;
};

/// With the geometric stiffness that (44) leaves out.
template <class Space>
void form(const ChainLeg<Space>& leg, const typename Space::template Frame<double>& platform,
          const ChainLegState& state, const ChainHold& hold, LegSystem<Space>& system) {
  const PseudoRigid& chain = leg.chain;
  system.joints = chain.joints();
  system.holds_length = hold.length_of >= 0;
  system.force = state.force;
  close_chain(leg, platform, state.of(chain), system.closure);
  const auto tendon =
      system.holds_length ? static_cast<std::size_t>(hold.length_of) : inner_tendon(state, chain);
  double length = chain.length;
  for (int joint = 0; joint < system.joints; ++joint) {
    const auto j = static_cast<std::size_t>(joint);
    const std::array bend{chain.tendon_bend(joint, state.angles[j], leg.tendon_offset, 1),
                          chain.tendon_bend(joint, state.angles[j], leg.tendon_offset, -1)};
    system.stiffness[j] =
        leg.spring(joint) + state.tension[0] * bend[0].curvature + state.tension[1] * bend[1].curvature;
    system.balance[j] = leg.spring(joint) * state.angles[j] + state.tension[0] * bend[0].rate +
                        state.tension[1] * bend[1].rate + state.force * system.closure.c_q[j];
    system.tendon[j] = bend[tendon].rate;
    length += bend[tendon].change;
  }
  system.length_error = system.holds_length ? length - hold.length : 0;
}

}  // namespace sinew::inline v0
