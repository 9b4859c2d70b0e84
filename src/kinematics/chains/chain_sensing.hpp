/// @file chain_sensing.hpp
/// The load on a platform from the tensions of tendons whose lengths are held. Theory:
/// docs/theory/chain_equilibrium.md
#pragma once
#include "kinematics/chains/chain.hpp"

namespace sinew::inline v1 {

/// Of the tendon of that leg whose length is held.
struct MeasuredTension {
  int leg = 0;
  double tension = 0;  ///< [N]
};

template <class Space>
struct SensedLoad {
  Report report;
  Mat<double, Space::dof, Space::dof> sensitivity;  ///< ∂wrench/∂tensions at fixed lengths: 1, and m
};

/// The wrench under which the tendons that `state` holds at their lengths are so tense; it goes into `state`
/// with pose and legs. In the place of the wrench the pose is the unknown: at fixed lengths it makes all
/// forces, and the wrench is what they leave over. `bad_input` where not as many legs as the platform has
/// freedoms are measured, each once; `singular` where the tensions do not tell; `stalled` where no wrench
/// near that of `state` makes them; `slack` as of equilibria.
/// @param state an equilibrium of these lengths, where the search begins
template <class Space>
SensedLoad<Space> sense_wrench(const ChainLegs<Space>& robot, std::span<const MeasuredTension> measured,
                               ChainState<Space>& state, ChainWork& work, const ChainOptions& options = {});

}  // namespace sinew::inline v1
