/// @file whole_potential.hpp
/// What is least at a stable equilibrium of tendons, for arms and for legs that are arms.
#pragma once
#include <algorithm>
#include <span>

#include "sinew/kinematics/arm.hpp"

namespace sinew::inline v1 {

/// The potential with the motors that prescribe tensions [J].
template <class State>
double whole_potential(const State& one, std::span<const TendonCommand> commands) {
  double sum = one.energy;
  for (std::size_t i = 0; i < std::min(commands.size(), one.changes.size()); ++i)
    if (commands[i].held == TendonHeld::tension) sum += one.tensions[i] * one.changes[i];
  return sum;
}

}  // namespace sinew::inline v1
