/// @file polar.h
/// The bend of a neutral backbone from its angle θ and direction φ, for scalars of controllers: fixed point
/// has no sine of its own. Freestanding C++14, no includes but its neighbours, no heap.
#ifndef SINEW_KERNEL_POLAR_H
#define SINEW_KERNEL_POLAR_H

#include "sinew/kernel/direction.h"

namespace sinew {
namespace kernel {

/// cos and sin of an angle [rad] within a turn, by their series from the nearest axis.
template <class S>
constexpr Direction<S> direction_at(S angle) {
  const S eighth = S(detail::pi / 4), quarter = S(detail::pi / 2), half = S(detail::pi);
  const bool is_left = angle < -S(eighth + quarter) || angle > S(eighth + quarter);
  const bool is_up = !is_left && angle > eighth, is_down = !is_left && angle < -eighth;
  const S from = is_left ? (angle > eighth ? half : -half) : is_up ? quarter : is_down ? -quarter : S(0.0);
  const S near = angle - from, w = S(near * near);
  const S cosine = detail::PowerSeries<S, 1, 0, Terms<S>::few>::at(w);
  const S sine = S(near * detail::PowerSeries<S, 2, 0, Terms<S>::few>::at(w));
  return is_left   ? Direction<S>{-cosine, -sine}
         : is_up   ? Direction<S>{-sine, cosine}
         : is_down ? Direction<S>{sine, -cosine}
                   : Direction<S>{cosine, sine};
}
inline Direction<double> direction_at(double angle) { return {__builtin_cos(angle), __builtin_sin(angle)}; }
#if __SIZEOF_DOUBLE__ == __SIZEOF_FLOAT__  // AVR: its library has no names for float
inline Direction<float> direction_at(float angle) {
  return {static_cast<float>(__builtin_cos(angle)), static_cast<float>(__builtin_sin(angle))};
}
#else
inline Direction<float> direction_at(float angle) { return {__builtin_cosf(angle), __builtin_sinf(angle)}; }
#endif

/// x = θ cos φ, y = θ sin φ.
template <class S>
constexpr Bend<S> polar_bend(S theta, S phi) {
  const Direction<S> towards = direction_at(phi);
  return {S(theta * towards.cosine), S(theta * towards.sine)};
}

}  // namespace kernel
}  // namespace sinew

#endif
