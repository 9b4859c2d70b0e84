/// @file tendon_state.h
/// Whether tendons are exact, slack or over-tensioned, from what they have beyond the model in use.
/// Freestanding C++14, no includes but its neighbours, no heap.
#ifndef SINEW_KERNEL_TENDON_STATE_H
#define SINEW_KERNEL_TENDON_STATE_H

#include "sinew/kernel/section.h"

namespace sinew {
namespace kernel {

/// What a tendon is at a bend, within its tolerance.
enum class TendonState : unsigned char { exact, slack, over_tensioned };

/// @param slack what a tendon has beyond what the shape needs, < 0: it is too short
/// @param tolerance of a tendon: encoder step, friction, stretch
/// [LSK] section 4.1.
template <class Length>
constexpr TendonState tendon_state(Length slack, Length tolerance) {
  return slack > tolerance    ? TendonState::slack
         : slack < -tolerance ? TendonState::over_tensioned
                              : TendonState::exact;
}

/// What a tendon has beyond what a pull asks of it.
template <class Angle, class Length>
constexpr Length tendon_slack(Length change, const Pull<Length>& pull, const Direction<Angle>& at) {
  return change - tendon_change(pull, at);
}

}  // namespace kernel
}  // namespace sinew

#endif
