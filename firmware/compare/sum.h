/// @file sum.h
/// Checksums of results.
#ifndef SINEW_FIRMWARE_SUM_H
#define SINEW_FIRMWARE_SUM_H

#include "sinew/kernel/crc32.h"
#include "sinew/kernel/fixed.h"
#include "sinew/kernel/section.h"
#include "sinew/kernel/tendon_state.h"
#include "target.h"

/// Checksum of integers: words of 16 bits are added up as Fletcher does, since an AVR takes a thousand cycles
/// for a CRC of as many as a kernel gives, and the CRC is of the sums.
class Sum {
 public:
  void add(Uint16 value) {
    first_ = static_cast<Uint16>(first_ + value);
    second_ += first_;
  }
  void add(bool value) { add(static_cast<Uint16>(value)); }
  void add(sinew::kernel::TendonState value) { add(static_cast<Uint16>(value)); }
  void add(Int16 value) { add(static_cast<Uint16>(value)); }
  void add(Int32 value) {
    add(static_cast<Uint16>(value & 0xffff));
    add(static_cast<Uint16>((value >> 16) & 0xffff));
  }
  void add(float value) {
    Int32 bits = 0;
    static_assert(sizeof bits == sizeof value, "the format of IEEE 754");
    __builtin_memcpy(&bits, &value, sizeof bits);
    add(bits);
  }
  template <int Bits, int Fraction>
  void add(sinew::kernel::Fixed<Bits, Fraction> value) {
    add(value.raw);
  }
  template <class Angle>
  void add(const sinew::kernel::Bend<Angle>& bend) {
    add(bend.x);
    add(bend.y);
  }
  template <class Value, decltype(sizeof(0)) Count>
  void add(const Value (&values)[Count]) {
    for (const Value& value : values) add(value);
  }
  /// CRC-32 of the sums at the end of each block.
  void close_block() {
    for (unsigned char shift = 0; shift < 32; shift = static_cast<unsigned char>(shift + 8))
      crc_.add(static_cast<unsigned char>((second_ >> shift) & 0xff));
    crc_.add(static_cast<unsigned char>(first_ & 0xff));
    crc_.add(static_cast<unsigned char>(first_ >> 8));
  }
  Uint32 value() const { return crc_.value(); }

 private:
  Uint16 first_ = 1;
  Uint32 second_ = 0;
  sinew::kernel::Crc32 crc_;
};

#endif
