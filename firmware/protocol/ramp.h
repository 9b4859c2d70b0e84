/// @file ramp.h
/// Setpoints on their way from where they are to where they shall be, in so many ticks of a clock.
/// Freestanding C++14, no heap.
#ifndef SINEW_FIRMWARE_RAMP_H
#define SINEW_FIRMWARE_RAMP_H

#include "protocol/number.h"

namespace sinew {
namespace firmware {

/// After t of n ticks each setpoint has gone the share ⌊2³² t/n⌋ / 2³² of its way, rounded towards where it
/// came from: within a count of the straight line, never back, never beyond, and exactly there at the end.
template <Uint8 Count>
class Ramp {
 public:
  using Counts = Int32[Count];

  /// To where `target()` is by then.
  /// @param ticks > 0
  void begin(const Counts& from, Uint16 ticks) {
    for (Uint8 i = 0; i < Count; ++i) from_[i] = from[i];
    ticks_ = left_ = ticks;
    // One division for all setpoints, and none in a tick: 2^32 / ticks by its quotient and remainder.
    constexpr Uint32 largest = 0xFFFFFFFFUL;
    step_ = largest / ticks;
    step_rest_ = static_cast<Uint16>(largest - step_ * ticks + 1);
    if (step_rest_ == ticks) {
      ++step_;
      step_rest_ = 0;
    }
    share_ = 0;
    share_rest_ = 0;
  }
  void stop() { left_ = 0; }
  Counts& target() { return to_; }
  const Counts& target() const { return to_; }
  bool is_running() const { return left_ != 0; }

  /// Where the setpoints are so many ticks later.
  void advance(Uint16 ticks, Counts& setpoints) {
    if (ticks >= left_) {
      left_ = 0;
      for (Uint8 i = 0; i < Count; ++i) setpoints[i] = to_[i];
      return;
    }
    left_ = static_cast<Uint16>(left_ - ticks);
    for (; ticks > 0; --ticks) grow_share();
    for (Uint8 i = 0; i < Count; ++i) setpoints[i] = between(from_[i], to_[i]);
  }

 private:
  void grow_share() {
    share_ += step_;
    if (share_rest_ >= static_cast<Uint16>(ticks_ - step_rest_)) {
      share_rest_ = static_cast<Uint16>(share_rest_ - (ticks_ - step_rest_));
      ++share_;
    } else {
      share_rest_ = static_cast<Uint16>(share_rest_ + step_rest_);
    }
  }
  Int32 between(Int32 from, Int32 to) const {
    // Modulo 2^32, so that no difference of two counts overflows.
    const Uint32 a = static_cast<Uint32>(from), b = static_cast<Uint32>(to);
    return static_cast<Int32>(to > from ? a + part(b - a) : a - part(a - b));
  }
  Uint32 part(Uint32 way) const {
    return static_cast<Uint32>(static_cast<__UINT64_TYPE__>(way) * share_ >> 32);
  }

  Counts from_ = {}, to_ = {};
  Uint32 share_ = 0, step_ = 0;  ///< of the way, in 1/2^32: now, and what a tick adds
  Uint16 share_rest_ = 0, step_rest_ = 0, ticks_ = 0, left_ = 0;
};

}  // namespace firmware
}  // namespace sinew

#endif
