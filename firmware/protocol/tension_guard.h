/// @file tension_guard.h
/// Which tendons pull more than they may, and what then is refused: whatever takes such a tendon in.
/// Freestanding C++14, no heap.
#ifndef SINEW_FIRMWARE_TENSION_GUARD_H
#define SINEW_FIRMWARE_TENSION_GUARD_H

#include "protocol/number.h"

namespace sinew {
namespace firmware {

/// @tparam Limit [1/256 N]; 0: none
template <Uint8 Tendons, Uint16 Limit>
class TensionGuard {
 public:
  /// What a whole exchange has shown. Whether a tendon has come above the limit by it.
  template <class Board>
  bool look(const Board& board) {
    bool is_new = false;
    for (Uint8 i = 0; i < Tendons; ++i) {
      const bool is_above = board.tension(i) > Limit;
      is_new = is_new || (is_above && !above_[i]);
      above_[i] = is_above;
    }
    return is_new;
  }
  /// Whether one above the limit would become shorter.
  bool forbids(const Int32* from, const Int32* to) const {
    for (Uint8 i = 0; i < Tendons; ++i)
      if (above_[i] && to[i] < from[i]) return true;
    return false;
  }

 private:
  bool above_[Tendons] = {};
};

template <Uint8 Tendons>
class TensionGuard<Tendons, 0> {
 public:
  template <class Board>
  bool look(const Board&) {
    return false;
  }
  bool forbids(const Int32*, const Int32*) const { return false; }
};

}  // namespace firmware
}  // namespace sinew

#endif
