/// @file direction.h
/// Directions around a disc as constants: cosine and sine at compile time, where no library offers them.
/// Freestanding C++14, no includes but its neighbours, no heap.
#ifndef SINEW_KERNEL_DIRECTION_H
#define SINEW_KERNEL_DIRECTION_H

#include "sinew/kernel/section.h"

namespace sinew {
namespace kernel {

namespace detail {
constexpr double pi = 3.14159265358979323846;

/// The same angle within half a turn.
constexpr double within_half_turn(double angle) {
  const double turns = angle / (2 * pi);
  return angle - 2 * pi * static_cast<double>(static_cast<long>(turns < 0 ? turns - 0.5 : turns + 0.5));
}
}  // namespace detail

/// cos and sin of an angle [rad] of a few turns at most.
template <class Angle>
constexpr Direction<Angle> direction(double angle) {
  const double half = detail::within_half_turn(angle) / 2, w = half * half;
  const double sine = half * (1 + chord_loss(w));
  const double cosine = detail::PowerSeries<double, 1, 0, Terms<double>::most>::at(w);
  return {Angle(1 - 2 * sine * sine), Angle(2 * sine * cosine)};
}

}  // namespace kernel
}  // namespace sinew

#endif
