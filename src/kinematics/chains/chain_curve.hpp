/// @file chain_curve.hpp
/// Curves of equilibria of robots on chains, along loads and what tendons hold, followed by arc length:
/// through folds, with the curves that branch off. Theory: docs/theory/continuation.md
#pragma once
#include "kinematics/chains/chain.hpp"
#include "sinew/kinematics/equilibrium_curve.hpp"

namespace sinew::inline v1 {

/// Where a curve leads, and how far it is followed. What legs hold and the wrench change linearly in a
/// parameter that is 0 at its beginning and 1 here.
template <class Space>
struct ChainCurveOptions {
  /// At 1: the same tendons' lengths as at the beginning, or tensions; none: as at the beginning.
  std::vector<TendonConstraint> hold = {};
  Vec<double, Space::dof> added_wrench = Vec<double, Space::dof>::Zero();  ///< at 1
  double lowest = 0, highest = 1;  ///< the curve ends where its parameter leaves this range, which holds 0
  int max_points = 500;            ///< on each curve
  bool is_backward = false;        ///< begins with a falling parameter
  bool follows_branches = false;   ///< the curves that leave a bifurcation of the first are followed, too
  int max_total_points = 200000;   ///< no other curve is begun where all have as many
};

template <class Space>
struct ChainCurvePoint {
  double parameter = 0;
  CurveEvent event = CurveEvent::none;  ///< `rod_bifurcation` is that of a chain
  ChainState<Space> state;
  int unstable_directions = 0;  ///< with what is held and the load; at a fold or bifurcation those before it
  double residual = 0;          ///< as that of `equilibrium` [m]
  double potential = 0;         ///< [J]; NaN under a moment in space
};

/// Points in the order of the curve.
template <class Space>
struct ChainCurve {
  std::vector<ChainCurvePoint<Space>> points;
  CurveEnd end = CurveEnd::stalled;
  int from_curve = -1, from_point = -1;  ///< the bifurcation it leaves; −1 of the first curve
};

/// Curves through an equilibrium; the first is the one it was asked for. Tendons that would have to push are
/// told of by their tensions, not stopped at. Empty where the state is not of this robot, or a straight chain
/// does not yield, where what is asked for is not finite, has no points or a range without 0, holds other
/// tendons than the state or lengths that no joints allow, or is what it begins with. Allocates.
template <class Space>
std::vector<ChainCurve<Space>> chain_curves(const ChainLegs<Space>& robot, const ChainState<Space>& state,
                                            const ChainCurveOptions<Space>& how, ChainWork& work);

}  // namespace sinew::inline v1
