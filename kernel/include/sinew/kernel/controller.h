/// @file controller.h
/// What a controller checks and converts beside its table: limits of bends, counts of motors.
/// Freestanding C++14, no includes but its neighbours, no heap.
#ifndef SINEW_KERNEL_CONTROLLER_H
#define SINEW_KERNEL_CONTROLLER_H

#include "sinew/kernel/products.h"
#include "sinew/kernel/section.h"

namespace sinew {
namespace kernel {

/// Bends that sections are allowed: of twin pivots β₁ and β₂ each, of a neutral backbone θ. Within them no
/// sum of a table wraps.
template <decltype(sizeof(0)) Sections, class Angle>
struct BendLimits {
  Backbone backbone[Sections];
  typename Stored<Angle>::type limit[Sections];  ///< [rad], ≥ 0

  /// Whether all bends are within the limits.
  constexpr bool hold(const Bend<Angle> (&bends)[Sections]) const {
    for (decltype(sizeof(0)) m = 0; m < Sections; ++m) {
      const Angle most = Stored<Angle>::load(limit[m]);
      const Bend<Angle>& bend = bends[m];
      if (!within(bend.x, most) || !within(bend.y, most)) return false;
      if (backbone[m] == Backbone::neutral && bend.x * bend.x + bend.y * bend.y > most * most) return false;
    }
    return true;
  }

 private:
  static constexpr bool within(Angle value, Angle most) { return !(value > most) && !(value < -most); }
};

/// Counts of a motor's encoder for a change of its tendon, Δl > 0 counts upwards.
template <class Length>
struct MotorCounts {
  __INT32_TYPE__ per_step;  ///< counts in one step of a length, in 1/65536, > 0

  /// To the nearest, halves upwards.
  constexpr __INT32_TYPE__ of(Length change) const { return counts_of(change.raw); }
  /// The change nearest to so many counts; what does not fit saturates.
  constexpr Length change(__INT32_TYPE__ counts) const {
    const __INT64_TYPE__ scaled = static_cast<__INT64_TYPE__>(counts) * 65536 + per_step / 2;
    const __INT64_TYPE__ steps = scaled / per_step - (scaled % per_step < 0 ? 1 : 0);  // downwards
    return Length::from_raw(steps > Length::largest    ? Length::largest
                            : steps < Length::smallest ? Length::smallest
                                                       : static_cast<typename Length::Raw>(steps));
  }

 private:
  constexpr __INT32_TYPE__ counts_of(__INT32_TYPE__ steps) const {
    return static_cast<__INT32_TYPE__>((static_cast<__INT64_TYPE__>(steps) * per_step + 32768) >> 16);
  }
  /// The same of 16 bits, by the halves of the factor: an AVR takes a fifth of the time.
  constexpr __INT32_TYPE__ counts_of(__INT16_TYPE__ steps) const {
    const __INT16_TYPE__ high = static_cast<__INT16_TYPE__>(per_step >> 16);
    const __UINT16_TYPE__ low = static_cast<__UINT16_TYPE__>(per_step & 0xffff);
    // -2^15 * (2^16 - 1) and 2^15 more are within 32 bits.
    return static_cast<__INT32_TYPE__>(steps) * high +
           ((static_cast<__INT32_TYPE__>(steps) * low + 32768) >> 16);
  }
};

}  // namespace kernel
}  // namespace sinew

#endif
