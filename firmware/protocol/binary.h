/// @file binary.h
/// Frames in bytes, for hosts that send a pose each millisecond. They end with a newline as every line does,
/// and have none within: so whatever comes, the next newline is where the receiver knows again where it is.
/// That is COBS (Cheshire and Baker, 1999) with the newline for its zero: in the place of each newline, and
/// before the first byte, stands how far it is to the next. The high bit of that byte tells binary frames
/// from ASCII. Table: firmware/README.md.
/// Freestanding C++14, no includes but its neighbours, no heap.
#ifndef SINEW_FIRMWARE_BINARY_H
#define SINEW_FIRMWARE_BINARY_H

#include "protocol/arm.h"
#include "protocol/frame.h"

namespace sinew {
namespace firmware {

/// A link of the chain is 0x80 and the distance to the next or, from the last, to the end. The largest
/// bridges 126 bytes without a newline behind them.
constexpr Uint8 link_mark = 0x80, bridge = 0xFF, bridged = 126;

/// In place: the bytes of a request, which is too short for bridges.
/// @param line its size becomes that of the bytes
inline Error decode(Uint8* line, Uint16& size) {
  for (Uint16 at = 0;;) {
    const Uint8 link = line[at];
    line[at] = '\n';
    if (link <= link_mark || link == bridge) return Error::checksum;
    at = static_cast<Uint16>(at + link - link_mark);
    if (at == size) break;
    if (at > size) return Error::truncated;
  }
  size = static_cast<Uint16>(size - 1);
  return Error::none;
}

/// The least significant byte first.
inline Uint16 read16(const Uint8* bytes) {
  return static_cast<Uint16>(bytes[0] | static_cast<Uint16>(bytes[1]) << 8);
}
inline Uint32 read32(const Uint8* bytes) {
  return static_cast<Uint32>(bytes[0]) | static_cast<Uint32>(bytes[1]) << 8 |
         static_cast<Uint32>(bytes[2]) << 16 | static_cast<Uint32>(bytes[3]) << 24;
}

/// Payloads: a pose, and with homing a setpoint of each drive.
constexpr Uint16 pose_bytes = 2 + 2 * bend_count + 4 * stage_count, move_bytes = 2 + 4 * drive_count;
constexpr Uint16 longest_payload = has_homing && move_bytes > pose_bytes ? move_bytes : pose_bytes;
constexpr Uint8 homed_bytes = (drive_count + 7) / 8;

struct BinaryRequest {
  static constexpr bool has_drives = has_homing;
  char verb;
  Uint32 sequence, hash;
  const Uint8* payload;
  Uint16 size;  ///< of the payload
};

/// The bytes of the line become those of the frame. The sequence number stays 0 until a checksum has vouched
/// for it.
inline Error read_request(Uint8* line, Uint16 size, BinaryRequest& request) {
  constexpr Uint8 head = 9, tail = 4;
  constexpr Uint32 of_whole = 0x2144DF1CUL;  // the sum of any bytes with their sum behind them
  static_assert(head + longest_payload + tail < bridged, "requests without bridges");
  request = BinaryRequest{0, 0, 0, line, 0};
  if (size < 1 + head + tail) return Error::truncated;
  const Error damage = decode(line, size);
  if (damage != Error::none) return damage;
  const Uint8* const bytes = line + 1;
  kernel::Crc32 sum;
  for (const Uint8 *at = bytes, *end = bytes + size; at != end; ++at) sum.add(*at);
  if (sum.value() != of_whole) return Error::checksum;
  request = BinaryRequest{static_cast<char>(bytes[0]), read32(bytes + 1), read32(bytes + 5), bytes + head,
                          static_cast<Uint16>(size - head - tail)};
  return Error::none;
}

/// A frame, gathered before it is sent.
/// @tparam Sink has
///   - `void wait_for_room(Uint8 bytes)`;
///   - `void put(Uint8)` and `void put(const Uint8*, Uint8 size)`, for which there is room;
///   - `void flush()` after some of these.
template <class Sink>
class BinaryFrame {
 public:
  explicit BinaryFrame(Sink& sink) : sink_(sink) {}

  void put(Uint8 byte) { *end_++ = byte; }
  void put16(Uint16 value) {
    put(static_cast<Uint8>(value & 0xFF));
    put(static_cast<Uint8>(value >> 8));
  }
  void put32(Uint32 value) {
    put16(static_cast<Uint16>(value & 0xFFFF));
    put16(static_cast<Uint16>(value >> 16));
  }
  void put_counts(const Counts& counts) {
    for (const Int32 count : counts) put32(static_cast<Uint32>(count));
  }
  /// The lower two bytes of each: a host that has the table knows the rest, and 1 kHz leaves time for no
  /// more.
  void put_setpoints(const Counts& counts) {
    Uint8* to = end_;
    for (const Int32 count : counts) {
      const Uint16 bits = static_cast<Uint16>(count & 0xFFFF);
      *to++ = static_cast<Uint8>(bits & 0xFF);
      *to++ = static_cast<Uint8>(bits >> 8);
    }
    end_ = to;
  }
  __attribute__((noinline)) void end() {
    kernel::Crc32 sum;
    for (const Uint8* at = bytes_; at != end_; ++at) sum.add(*at);
    put32(sum.value());
    const Uint8* at = bytes_;
    for (;;) {
      const Uint8* const limit = end_ - at > bridged ? at + bridged : end_;
      const Uint8* run = at;
      while (run != limit && *run != '\n') ++run;
      const Uint8 size = static_cast<Uint8>(run - at);
      sink_.wait_for_room(static_cast<Uint8>(size + 2));
      sink_.put(static_cast<Uint8>(link_mark + 1 + size));
      sink_.put(at, size);
      sink_.flush();
      at = run;
      if (at == end_) break;
      if (size != bridged) ++at;
    }
    sink_.put('\n');
    sink_.flush();
  }

 private:
  // The longest are replies to hello and state: counts, bends, letters, a count of exchanges, which drives
  // are homed, tensions.
  static constexpr Uint16 most = 10 + 4 * drive_count + 2 * bend_count + tendon_drives + 2 + homed_bytes +
                                 (has_tensions ? 2 * tendon_drives : 0);
  static constexpr Uint16 capacity = most > 40 ? most : 40;

  Sink& sink_;
  Uint8 bytes_[capacity];
  Uint8* end_ = bytes_;
};

template <class Sink>
class BinaryReply : public BinaryFrame<Sink> {
 public:
  explicit BinaryReply(Sink& sink) : BinaryFrame<Sink>(sink) {}

  void begin(char verb, Uint32 sequence, State state) {
    this->put(static_cast<Uint8>(verb));
    this->put32(sequence);
    this->put(static_cast<Uint8>(state));
  }
  void refuse(Uint32 sequence, Error error, State state) {
    begin('!', sequence, state);
    this->put(static_cast<Uint8>(error));
    this->end();
  }
};

}  // namespace firmware
}  // namespace sinew

#endif
