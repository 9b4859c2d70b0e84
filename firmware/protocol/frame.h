/// @file frame.h
/// Frames are lines: a body, `*`, the CRC-32 of the body, newline. A request's body is its verb, its sequence
/// number, the hash of the robot's table and integers, one space between each. Table: firmware/README.md
/// Freestanding C++14, no includes but its neighbours, no heap.
#ifndef SINEW_FIRMWARE_FRAME_H
#define SINEW_FIRMWARE_FRAME_H

#include "protocol/number.h"
#include "sinew/kernel/crc32.h"

namespace sinew {
namespace firmware {

/// In the order in which they are looked for: a reply names the first.
enum class Error : Uint8 {
  none,
  too_long,
  truncated,
  checksum,
  malformed,
  unknown_verb,
  wrong_hash,
  other_session,
  replayed,
  wrong_count,
  out_of_range,
  not_armed,
  out_of_limits,
  drives,
  no_session
};

inline const char* text_of(Error error) {
  static const char* const texts[] = {"",
                                      "too long",
                                      "truncated",
                                      "checksum",
                                      "malformed",
                                      "unknown verb",
                                      "wrong hash",
                                      "other session",
                                      "replayed",
                                      "wrong count of numbers",
                                      "number out of range",
                                      "not armed",
                                      "out of limits",
                                      "drives answer nonsense",
                                      "no session can be kept"};
  return texts[static_cast<Uint8>(error)];
}

/// Collects characters up to a newline. Of a line that is too long only that is remembered.
template <Uint16 Capacity>
class Line {
 public:
  /// True when this character ended a line; it is there until `clear()`.
  bool take(char c) {
    if (c == '\n') return true;
    if (size_ == Capacity)
      too_long_ = true;
    else
      characters_[size_++] = c;
    return false;
  }
  void clear() {
    size_ = 0;
    too_long_ = false;
  }
  bool too_long() const { return too_long_; }
  /// Without the newline, and without a carriage return before it: terminals send one.
  Text text() const {
    const Uint16 size = size_ > 0 && characters_[size_ - 1] == '\r' ? static_cast<Uint16>(size_ - 1) : size_;
    return {characters_, characters_ + size};
  }

 private:
  char characters_[Capacity];
  Uint16 size_ = 0;
  bool too_long_ = false;
};

struct Request {
  char verb;
  Uint32 sequence, hash;
  Text numbers;  ///< all that follows the hash
};

/// Takes `*` and the checksum off a line.
inline Error check(Text& line) {
  if (line.end - line.at < 9) return Error::truncated;
  Text tail{line.end - 9, line.end};
  Uint32 sum = 0;
  if (!skip(tail, '*') || !read_hex(tail, sum)) return Error::truncated;
  line.end -= 9;
  kernel::Crc32 crc;
  for (const char* c = line.at; c != line.end; ++c) crc.add(static_cast<unsigned char>(*c));
  return crc.value() == sum ? Error::none : Error::checksum;
}

/// The sequence number stays 0 until a checksum has vouched for it.
inline Error read_request(Text line, Request& request) {
  request = Request{0, 0, 0, {line.end, line.end}};
  const Error damage = check(line);
  if (damage != Error::none) return damage;
  if (line.empty()) return Error::malformed;
  request.verb = *line.at++;
  if (!skip(line, ' ')) return Error::malformed;
  const Reading sequence = read_unsigned(line, request.sequence);
  if (sequence != Reading::good) {
    request.sequence = 0;
    return sequence == Reading::malformed ? Error::malformed : Error::out_of_range;
  }
  if (!skip(line, ' ') || !read_hex(line, request.hash)) return Error::malformed;
  request.numbers = line;
  return Error::none;
}

/// Exactly `count` integers, a space before each.
/// @param put called with index and value
template <class Put>
Error read_numbers(Text numbers, Uint16 count, Int32 smallest, Int32 largest, Put put) {
  bool fits = true;
  Uint16 found = 0;
  for (; !numbers.empty(); ++found) {
    Int32 value = 0;
    if (!skip(numbers, ' ')) return Error::malformed;
    const Reading reading = read_integer(numbers, smallest, largest, value);
    if (reading == Reading::malformed) return Error::malformed;
    if (reading == Reading::out_of_range) fits = false;
    if (found < count) put(found, value);
  }
  if (found != count) return Error::wrong_count;
  return fits ? Error::none : Error::out_of_range;
}

/// A reply on its way: characters go out at once, the checksum is summed up beside them.
template <class Board>
class Reply {
 public:
  explicit Reply(Board& board) : board_(board) {}
  __attribute__((noinline)) void put(char c) {  // called from so many places
    crc_.add(static_cast<unsigned char>(c));
    board_.send(c);
  }
  Reply& text(const char* characters) {
    for (; *characters; ++characters) put(*characters);
    return *this;
  }
  Reply& word(const char* characters) {
    put(' ');
    return text(characters);
  }
  Reply& number(Int32 value) {
    put(' ');
    write_integer(*this, value);
    return *this;
  }
  Reply& count(Uint32 value) {
    put(' ');
    write_unsigned(*this, value);
    return *this;
  }
  Reply& hex(Uint32 value) {
    put(' ');
    write_hex(*this, value);
    return *this;
  }
  void end() {
    const Uint32 sum = crc_.value();
    put('*');
    write_hex(*this, sum);
    board_.send('\n');
  }

 private:
  Board& board_;
  kernel::Crc32 crc_;
};

}  // namespace firmware
}  // namespace sinew

#endif
