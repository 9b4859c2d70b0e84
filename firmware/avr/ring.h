/// @file ring.h
/// Bytes between an interrupt and the rest: one side puts, the other takes, and neither waits. It holds 255.
#ifndef SINEW_FIRMWARE_RING_H
#define SINEW_FIRMWARE_RING_H

#include "protocol/number.h"

namespace sinew {
namespace firmware {

class Ring {
 public:
  bool put(Uint8 byte) {
    const Uint8 next = static_cast<Uint8>(head_ + 1);
    if (next == tail_) return false;
    bytes_[head_] = byte;
    head_ = next;  // an index is one byte and wraps by itself: no interrupt comes in between
    return true;
  }
  bool take(Uint8& byte) {
    if (empty()) return false;
    byte = bytes_[tail_];
    tail_ = static_cast<Uint8>(tail_ + 1);
    return true;
  }
  bool empty() const { return head_ == tail_; }

 private:
  volatile Uint8 bytes_[256];
  volatile Uint8 head_ = 0, tail_ = 0;
};

}  // namespace firmware
}  // namespace sinew

#endif
