/// @file zeros.h
/// What each drive calls zero. Drives with incremental encoders begin somewhere; a host finds the end of a
/// tendon's slack and says what count it is. Kept in RAM: after a reset nothing vouches for it.
/// Freestanding C++14, no heap.
#ifndef SINEW_FIRMWARE_ZEROS_H
#define SINEW_FIRMWARE_ZEROS_H

#include "protocol/number.h"

namespace sinew {
namespace firmware {

/// Of a host's count the drive's own and back, modulo 2^32.
template <Uint8 Count, bool Homing>
class Zeros {
 public:
  using Counts = Int32[Count];

  void set(Uint8 drive, Int32 of_drive, Int32 of_host) {
    offsets_[drive] = static_cast<Uint32>(of_drive) - static_cast<Uint32>(of_host);
    homed_[drive / 8] = static_cast<Uint8>(homed_[drive / 8] | 1u << drive % 8);
  }
  /// Of the host's counts those of the drives; `room` is where they may be kept.
  __attribute__((noinline)) const Counts& to_drives(const Counts& counts, Counts& room) const {
    for (Uint8 i = 0; i < Count; ++i)
      room[i] = static_cast<Int32>(static_cast<Uint32>(counts[i]) + offsets_[i]);
    return room;
  }
  Int32 to_host(Uint8 drive, Int32 count) const {
    return static_cast<Int32>(static_cast<Uint32>(count) - offsets_[drive]);
  }
  bool are_set() const {
    for (Uint8 i = 0; i < bytes; ++i)
      if (bits(i) != 0xFF) return false;
    return true;
  }
  /// Of eight drives a bit each, the first the lowest; those that there are not are ones.
  Uint8 bits(Uint8 byte) const {
    return byte + 1 == bytes ? static_cast<Uint8>(homed_[byte] | none) : homed_[byte];
  }

 private:
  static constexpr Uint8 bytes = (Count + 7) / 8;
  static constexpr Uint8 none = static_cast<Uint8>(Count % 8 ? 0xFF << Count % 8 & 0xFF : 0);
  Uint32 offsets_[Count] = {};
  Uint8 homed_[bytes] = {};
};

/// Drives that know their zero.
template <Uint8 Count>
class Zeros<Count, false> {
 public:
  using Counts = Int32[Count];

  void set(Uint8, Int32, Int32) {}
  const Counts& to_drives(const Counts& counts, Counts&) const { return counts; }
  Int32 to_host(Uint8, Int32 count) const { return count; }
  bool are_set() const { return true; }
  Uint8 bits(Uint8) const { return 0xFF; }
};

}  // namespace firmware
}  // namespace sinew

#endif
