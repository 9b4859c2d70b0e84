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

template <class Board>
void write_epoch(Board& board, Uint16 address, Uint16 epoch) {
  const Uint8 low = static_cast<Uint8>(epoch & 0xFF), high = static_cast<Uint8>(epoch >> 8);
  const Uint8 bytes[4] = {low, high, static_cast<Uint8>(~low), static_cast<Uint8>(~high)};
  for (Uint8 i = 0; i < 4; ++i) board.eeprom_write(static_cast<Uint16>(address + i), bytes[i]);
}

/// Writes a copy; whether it can be read again.
template <class Board>
bool keep_epoch(Board& board, Uint16 address, Uint16 epoch) {
  write_epoch(board, address, epoch);
  Uint16 kept = 0;
  return read_epoch(board, address, kept) && kept == epoch;
}

/// The next one, written before it is used. After 65535 comes 1; 0 where none can be kept. Where one copy is
/// lost it may have been the newer: one number is left out. Not at address 0, which a failing supply may
/// damage.
template <class Board>
Uint16 next_epoch(Board& board) {
  constexpr Uint16 first = 8, second = 12;
  Uint16 a = 0, b = 0;
  const bool has_a = read_epoch(board, first, a), has_b = read_epoch(board, second, b);
  const bool b_is_newer = has_b && (!has_a || static_cast<Int16>(b - a) > 0);
  const Uint16 newest = b_is_newer ? b : has_a ? a : 0;
  Uint16 next = static_cast<Uint16>(newest + (has_a == has_b ? 1 : 2));
  if (next == 0) next = 1;
  const Uint16 older = b_is_newer ? first : second, other = b_is_newer ? second : first;
  const bool is_kept = keep_epoch(board, older, next);
  if (is_kept && (has_a || has_b)) return next;
  return keep_epoch(board, other, next) || is_kept ? next : 0;  // the first of all in both places
}

}  // namespace firmware
}  // namespace sinew

#endif
