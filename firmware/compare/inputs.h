/// @file inputs.h
/// Inputs of all kernels, the same on every machine: most are such as a robot meets, some lie on the edges of
/// their formats and of the limits, and some are whatever fits the integers.
#ifndef SINEW_FIRMWARE_INPUTS_H
#define SINEW_FIRMWARE_INPUTS_H

#include "robot_table.h"
#include "target.h"

constexpr unsigned char sections = robot::sections, tendons = robot::tendons;
using Angle = robot::Angle;
using Length = robot::Length;
using Long = sinew::kernel::Fixed<32, 16>;

template <class S>
using Bends = sinew::kernel::Bend<S>[sections];
template <class S>
using Changes = S[sections][tendons];

/// Marsaglia's multiplication with carry: 16 bits a step, and cheap where 16 bits are what a product takes.
class Random {
 public:
  Int16 any() {
    state_ = static_cast<Uint32>(static_cast<Uint16>(state_)) * Uint16{36969} + (state_ >> 16);
    return static_cast<Int16>(state_ & 0xffff);
  }
  Uint32 any_long() {
    const Uint32 high = static_cast<Uint32>(any()) << 16;
    return high | static_cast<Uint16>(any());
  }

 private:
  Uint32 state_ = 20170;
};

/// A share of a limit: any 16 bits become what is between ± limit.
inline Int16 scaled(Int16 any, Int16 limit) {
  return static_cast<Int16>((static_cast<Int32>(any) * limit + (Int32{1} << 14)) >> 15);
}

class Inputs {
 public:
  Bends<Angle> bends;
  Bends<Long> long_bends;
  Changes<Length> changes;
  Changes<Long> long_changes;
  sinew::kernel::Bend<Angle> polar;  ///< θ and φ
  sinew::kernel::Bend<Long> long_polar;
  Length change;
  Int32 counts = 0;
  sinew::kernel::MotorCounts<Length> motor{1};

  void draw() {
    const Int16 drawn = static_cast<Int16>(random_.any() & 15);
    kind_ = drawn < 10 ? Kind::inside : drawn < 13 ? Kind::edge : Kind::any;
    draw_bends();
    draw_changes();
    draw_scalars();
  }

 private:
  enum class Kind : unsigned char { inside, edge, any };

  /// Within ± limit, at its ends and those of the integers, or anything. In unsigned integers, which may
  /// wrap.
  Int16 drawn(Int16 limit) {
    const Int16 any = random_.any();
    if (kind_ == Kind::inside) return scaled(any, limit);
    if (kind_ == Kind::any) return any;
    const Uint16 bits = static_cast<Uint16>(limit);
    switch (any & 7) {
      case 0:
        return 0;
      case 1:
        return 1;
      case 2:
        return -1;
      case 3:
        return limit;
      case 4:
        return static_cast<Int16>(0u - bits);
      case 5:
        return static_cast<Int16>(bits + 1u);
      case 6:
        return 32767;
      default:
        return Angle::smallest;
    }
  }
  /// The same number with 16 bits behind the point, and something in those that are new.
  template <int Fraction>
  Long finer(Int16 value) {
    const Uint32 same = static_cast<Uint32>(value) << (16 - Fraction);
    return Long::from_raw(static_cast<Int32>(
        kind_ == Kind::inside
            ? same | (static_cast<Uint16>(random_.any()) & ((Uint32{1} << (16 - Fraction)) - 1))
        : kind_ == Kind::any ? random_.any_long()
                             : long_edge(same)));
  }
  Uint32 long_edge(Uint32 value) {
    switch (random_.any() & 7) {
      case 0:
        return 0;
      case 1:
        return 1;
      case 2:
        return 0xffffffff;
      case 3:
        return value;
      case 4:
        return 0 - value;
      case 5:
        return value + 1;
      case 6:
        return 0x7fffffff;
      default:
        return 0x80000000;
    }
  }

  void draw_bends() {
    for (unsigned char m = 0; m < sections; ++m) {
      const Int16 limit = robot::limits.limit[m], x = drawn(limit), y = drawn(limit);
      bends[m] = {Angle::from_raw(x), Angle::from_raw(y)};
      long_bends[m].x = finer<Angle::fraction>(x);
      long_bends[m].y = finer<Angle::fraction>(y);
    }
  }

  /// Those of the bends, and up to three tolerances beside them: tendons in all states.
  void draw_changes() {
    robot::short_table<sinew::kernel::Portable>().changes(bends, changes);
    constexpr Int16 width = 3 * robot::tolerance.raw;
    for (unsigned char m = 0; m < sections; ++m)
      for (unsigned char i = 0; i < tendons; ++i) {
        Length& tendon = changes[m][i];
        tendon = kind_ == Kind::inside
                     ? sinew::kernel::wrapped_sum(tendon, Length::from_raw(scaled(random_.any(), width)))
                     : Length::from_raw(drawn(tendon.raw));
        long_changes[m][i] = finer<Length::fraction>(tendon.raw);
      }
  }

  void draw_scalars() {
    constexpr Int32 half_turn = Int32{205887} >> (16 - Angle::fraction);
    const Int16 theta = drawn(robot::limits.limit[0]), phi = drawn(half_turn < 32767 ? half_turn : 32767);
    polar = {Angle::from_raw(theta), Angle::from_raw(phi)};
    long_polar.x = finer<Angle::fraction>(theta);
    long_polar.y = finer<Angle::fraction>(phi);
    change = Length::from_raw(random_.any());
    counts = finer<0>(random_.any()).raw;
    const Int32 per_step = static_cast<Int32>(random_.any_long() & 0x7fffffff);
    motor.per_step = per_step == 0 ? 1 : kind_ == Kind::inside ? (per_step >> 8) + 1 : per_step;
  }

  Random random_;
  Kind kind_ = Kind::any;
};

#endif
