/// @file chain_motion.hpp
/// Redundant inverse kinematics of robots on pseudo-rigid chains: joints that follow a motion of the platform
/// by the least motion of their own, or with their freedom put to use. Theory: docs/theory/chain_velocity.md
#pragma once
#include "kinematics/chains/chain.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::inline v1 {

struct ChainMotionOptions {
  /// Classical Runge-Kutta steps from one pose to the next, as [TDPCR] section 5.1 has them. 0: the flow
  /// itself, to rounding.
  int rk4_steps = 0;
  /// What the null space is used for: `smooth` lessens the energy of the springs (of one chord the least is
  /// that of a column bent by its chord alone), `limits` the largest angles, `singularity` increases |∂ρ/∂θ|,
  /// the distance from type I.
  Objective objective = Objective::none;
  double null_step = 0.2;  ///< longest null-space motion of a leg from one pose to the next [rad]
};

/// Moves the joints along as the platform moves from one pose to another on a straight line: θ̇ = g
/// (g·θ̇)/|g|², leg by leg, for a row of K has joints of one leg only. Where a leg has no strut g is ∂ρ/∂θ,
/// and the motion depends on the chord ρ alone: it does not matter on which path, or how fast, the platform
/// went.
///
/// Base motors move too: their frames in `robot` turn. Residual: closure error [m], put right after the exact
/// flow, left as it is after Runge-Kutta. Not converged, with robot and legs as they were: `singular` where a
/// leg is straight; `unreachable` where the flow runs away, does not reach the pose, or passes through
/// straight. Allocates.
template <class Space>
Report follow_least_norm(ChainLegs<Space>& robot, const typename Space::Pose& from,
                         const typename Space::Pose& to, std::span<ChainLegState> legs,
                         const ChainMotionOptions& options = {});

}  // namespace sinew::inline v1
