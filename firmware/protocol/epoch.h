/// @file epoch.h
/// A number that no two sessions share: it grows at every reset and is kept in EEPROM. Two copies are written
/// in turn, so that a power failure while one is written leaves the other. Freestanding C++14, no heap.
#ifndef SINEW_FIRMWARE_EPOCH_H
#define SINEW_FIRMWARE_EPOCH_H

#include "protocol/number.h"

namespace sinew {
namespace firmware {

/// Of one copy: its number and the complement of it. An erased EEPROM holds none.
template <class Board>
bool read_epoch(Board& board, Uint16 address, Uint16& epoch) {
  Uint8 bytes[4];
  for (Uint8 i = 0; i < 4; ++i) bytes[i] = board.eeprom_read(static_cast<Uint16>(address + i));
  epoch = static_cast<Uint16>(bytes[0] | static_cast<Uint16>(bytes[1]) << 8);
  return static_cast<Uint8>(~bytes[0]) == bytes[2] && static_cast<Uint8>(~bytes[1]) == bytes[3];
}

/// The number after the newest of the two copies, written before it is used. After 65535 comes 1; 0 where
/// none can be kept. Where one copy is lost it may have been the newer: one number is left out. Not at
/// address 0, which a failing supply may damage.
class NextEpoch {
 public:
  /// Whether one is being written, or was and has not been taken.
  bool is_begun() const { return step_ != idle; }

  template <class Board>
  void begin(Board& board) {
    constexpr Uint16 first = 8, second = 12;
    Uint16 a = 0, b = 0;
    const bool has_a = read_epoch(board, first, a), has_b = read_epoch(board, second, b);
    const bool b_is_newer = has_b && (!has_a || static_cast<Int16>(b - a) > 0);
    const Uint16 newest = b_is_newer ? b : has_a ? a : 0;
    next_ = static_cast<Uint16>(newest + (has_a == has_b ? 1 : 2));
    if (next_ == 0) next_ = 1;
    address_ = b_is_newer ? first : second;  // the older
    other_ = b_is_newer ? second : first;
    is_first_of_all_ = !has_a && !has_b;
    is_kept_ = false;
    step_ = 0;
  }

  /// Writes a byte, if the last is in the EEPROM by now: 3.4 ms each, for which nothing has to wait. True
  /// when all is done.
  template <class Board>
  bool step(Board& board) {
    if (step_ == done) return true;
    if (!board.is_eeprom_ready()) return false;
    if (step_ < size) {
      const Uint8 half = static_cast<Uint8>(step_ & 1 ? next_ >> 8 : next_ & 0xFF);
      board.eeprom_write(static_cast<Uint16>(address_ + step_), static_cast<Uint8>(step_ < 2 ? half : ~half));
      ++step_;
      return false;
    }
    Uint16 kept = 0;
    const bool is_kept = read_epoch(board, address_, kept) && kept == next_;
    is_kept_ = is_kept_ || is_kept;
    // The first of all in both places; elsewhere too where this one is worn.
    const bool needs_other = address_ != other_ && (!is_kept || is_first_of_all_);
    address_ = other_;
    step_ = needs_other ? 0 : done;
    return step_ == done;
  }

  /// Of what is done.
  Uint16 take() {
    step_ = idle;
    return is_kept_ ? next_ : 0;
  }

 private:
  static constexpr Uint8 size = 4, done = 5, idle = 6;

  Uint16 next_ = 0, address_ = 0, other_ = 0;
  Uint8 step_ = idle;
  bool is_first_of_all_ = false, is_kept_ = false;
};

/// At once, however long it takes.
template <class Board>
Uint16 next_epoch(Board& board) {
  NextEpoch next;
  next.begin(board);
  while (!next.step(board)) {
  }
  return next.take();
}

}  // namespace firmware
}  // namespace sinew

#endif
