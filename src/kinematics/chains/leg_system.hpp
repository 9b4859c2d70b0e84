/// @file leg_system.hpp
/// Equations of one leg on a chain, with their derivatives. Theory: docs/theory/chain_equilibrium.md
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/limits.hpp"
#include "kinematics/chains/chain.hpp"
#include "leg/chord.hpp"
#include "leg/closure_curvature.hpp"
#include "leg/strut.hpp"
#include "solve/contraction.hpp"
#include "solve/message.hpp"

namespace sinew::inline v1 {

/// A tendon that pushes by less counts as loose [N].
inline constexpr double slack_tolerance = 1e-9;

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

/// Calls `use` with the closure of a leg.
template <class Space, class Use>
void with_closure(const ChainLeg<Space>& leg, Use&& use) {
  if constexpr (Space::dimension == 2)
    if (leg.has_strut()) return use(Strut{leg.strut});
  use(Chord{});
}

/// The row of a distance over that distance: c = |n| − D, and the closure's second derivatives by the tip
/// across the line on which it pulls. Of that the tip's own rates make those by the angles.
template <class Space>
void close_chain(const ChainLeg<Space>& leg, const typename Space::template Frame<double>& platform,
                 std::span<const double> angles, ChainClosure<Space>& at) {
  using Point = Vec<double, Space::dimension>;
  const auto tip = leg.chain.tip(angles);
  with_closure(leg, [&]<class Closure>(const Closure& closure) {
    const auto anchor =
        anchor_of<Space::dimension>(closure, Tip<double, 2, 2>{tip.position, Mat<double, 2, 2>::Identity()});
    const Point b = platform.rotate(leg.platform_point);
    Point n = platform.p + b - leg.base.p;
    if constexpr (Closure::anchor_is_tip) n -= leg.base.rotate(anchor.position);
    const double distance = std::sqrt(squared_norm(n)), held = std::sqrt(2 * anchor.half_square);
    const double per_distance = 1 / distance;
    at.c = distance - held;
    at.distance = distance;
    at.c_x = Space::line(Point(n * per_distance), b).transpose();
    at.c_xx = per_distance * (distance_line_change<Space>(n, b) - at.c_x * at.c_x.transpose());
    Vec2<double> line;  // along which the tip is pulled, in the axes of the chain
    if constexpr (Closure::anchor_is_tip) {
      const Point beside(-n[1] * per_distance, n[0] * per_distance);
      line = leg.base.rotate_back(n) * per_distance;
      at.sway = per_distance;
      at.turn = -per_distance * (beside.transpose() * Space::point_rate(b)).transpose();
    } else {
      at.sway = -1 / held;
      line = anchor.half_square_rate.transpose() / held;
      at.turn.setZero();
    }
    for (std::size_t j = 0; j < angles.size(); ++j) {
      at.c_q[j] = -dot(line, tip.rate[j]);
      at.across[j] = cross(line, tip.rate[j]);
    }
  });
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

/// The tendon whose length is held, or else the inner one.
template <class Space>
std::size_t fed_tendon(const ChainLeg<Space>& leg, const ChainLegState& state, const TendonConstraint& hold) {
  return hold.length_of >= 0 ? static_cast<std::size_t>(hold.length_of) : inner_tendon(state, leg.chain);
}

template <class Space>
void measure_tendons(const ChainLeg<Space>& leg, ChainLegState& state) {
  for (const int side : {1, -1})
    state.tendon_length[side > 0 ? 0 : 1] =
        leg.chain.tendon_length(state.of(leg.chain), leg.tendon_offset, side);
}

/// Whether a length that is held leaves a leg's joints nothing: one equation for the length, one for the
/// closure, which of evenly bent free ends are the same where there are but two joints.
template <class Space>
bool is_rigid(const ChainLeg<Space>& leg, const TendonConstraint& hold) {
  return hold.length_of >= 0 && leg.chain.joints() <= (leg.has_strut() ? 1 : 2);
}

/// A leg's equations, and their derivatives by its angles, its force f and, of a length that is held, its
/// tension.
template <class Space>
struct LegSystem {
  using Joints = std::array<double, max_chain_joints>;
  int joints = 0;
  bool holds_length = false;
  /// Whether the platform can move against it: neither rigid, nor a straight chain on a chord.
  bool yields = true;
  std::size_t fed = 0;  ///< the tendon whose length is held, or else the inner one
  Joints balance;       ///< of the joints' moments: springs, tendons and the force [N m]
  Joints stiffness;     ///< of springs and tendons alone; what the force adds is f ∂²c/∂q²
  Joints tendon;        ///< of that tendon's length by the angles
  double length_error;  ///< of what is held [m]
  double force;         ///< f
  ChainClosure<Space> closure;
};

/// With the geometric stiffness that (44) leaves out.
template <class Space>
void form(const ChainLeg<Space>& leg, const typename Space::template Frame<double>& platform,
          const ChainLegState& state, const TendonConstraint& hold, LegSystem<Space>& system) {
  const PseudoRigid& chain = leg.chain;
  system.joints = chain.joints();
  system.holds_length = hold.length_of >= 0;
  system.force = state.force;
  close_chain(leg, platform, state.of(chain), system.closure);
  system.fed = fed_tendon(leg, state, hold);
  double length = chain.length, slope = 0;
  for (int joint = 0; joint < system.joints; ++joint) {
    const auto j = static_cast<std::size_t>(joint);
    const std::array bend{chain.tendon_bend(joint, state.angles[j], leg.tendon_offset, 1),
                          chain.tendon_bend(joint, state.angles[j], leg.tendon_offset, -1)};
    system.stiffness[j] =
        leg.spring(joint) + state.tension[0] * bend[0].curvature + state.tension[1] * bend[1].curvature;
    system.balance[j] = leg.spring(joint) * state.angles[j] + state.tension[0] * bend[0].rate +
                        state.tension[1] * bend[1].rate + state.force * system.closure.c_q[j];
    system.tendon[j] = bend[system.fed].rate;
    length += bend[system.fed].change;
    slope = std::max(slope, std::abs(system.closure.c_q[j]));
  }
  system.length_error = system.holds_length ? length - hold.length : 0;
  system.yields = slope > 1e-9 * chain.length && !is_rigid(leg, hold);
}

}  // namespace sinew::inline v1
