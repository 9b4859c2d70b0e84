/// @file frame.h
/// Frames in ASCII: a body, `*`, the CRC-32 of the body, newline. A request's body is its verb, its sequence
/// number, the hash of the robot's table and integers, one space between each. Table: firmware/README.md
/// What these share with binary frames is here too: lines, errors, states.
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
  no_session,
  not_homed,
  moving,
  over_tension
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
                                      "no session can be kept",
                                      "not homed",
                                      "moving",
                                      "over-tension"};
  return texts[static_cast<Uint8>(error)];
}

enum class State : Uint8 { disarmed, armed, lost };

inline const char* text_of(State state) {
  return state == State::armed ? "armed" : state == State::lost ? "lost" : "disarmed";
}

/// Collects characters up to a newline. Of a line that is too long only that is remembered.
template <Uint16 Capacity>
class Line {
 public:
  /// Of so many bytes those up to the end of the line: how many. What has ended is there until `clear()`.
  Uint8 collect(const volatile Uint8* bytes, Uint8 size) {
    const volatile Uint8* at = bytes;
    const volatile Uint8* const end = bytes + size;
    char* to = end_;
    while (at != end) {
      const char c = static_cast<char>(*at++);
      if (c == '\n') {
        has_ended_ = true;
        break;
      }
      if (to != characters_ + Capacity)
        *to++ = c;
      else
        too_long_ = true;
    }
    end_ = to;
    return static_cast<Uint8>(at - bytes);
  }
  bool has_ended() const { return has_ended_; }
  void clear() {
    end_ = characters_;
    too_long_ = has_ended_ = false;
  }
  bool too_long() const { return too_long_; }
  /// A binary frame: no character of ASCII has this bit.
  bool is_binary() const { return end_ != characters_ && (static_cast<Uint8>(characters_[0]) & 0x80) != 0; }
  /// Without the newline.
  Uint8* bytes() { return reinterpret_cast<Uint8*>(characters_); }
  Uint16 size() const { return static_cast<Uint16>(end_ - characters_); }
  /// Without the newline, and without a carriage return before it: terminals send one.
  Text text() const { return {characters_, end_ != characters_ && end_[-1] == '\r' ? end_ - 1 : end_}; }

 private:
  char characters_[Capacity];
  char* end_ = characters_;
  bool too_long_ = false, has_ended_ = false;
};

struct TextRequest {
  static constexpr bool has_drives = false;  ///< numbers of single drives: in binary frames only
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
inline Error read_request(Text line, TextRequest& request) {
  request = TextRequest{0, 0, 0, {line.end, line.end}};
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
/// @param put called with index and value of each; whether it is in its range
template <class Put>
Error read_numbers(Text numbers, Uint16 count, Put put) {
  constexpr Int32 largest = 0x7FFFFFFF;
  bool fits = true;
  Uint16 found = 0;
  for (; !numbers.empty(); ++found) {
    Int32 value = 0;
    if (!skip(numbers, ' ')) return Error::malformed;
    const Reading reading = read_integer(numbers, -largest, largest, value);
    if (reading == Reading::malformed) return Error::malformed;
    if (reading == Reading::out_of_range || (found < count && !put(found, value))) fits = false;
  }
  if (found != count) return Error::wrong_count;
  return fits ? Error::none : Error::out_of_range;
}

/// A reply on its way: characters go out at once, the checksum is summed up beside them.
/// @tparam Sink has `void send(char)`, which may wait
template <class Sink>
class TextReply {
 public:
  explicit TextReply(Sink& sink) : sink_(sink) {}
  __attribute__((noinline)) void put(char c) {  // called from so many places
    crc_.add(static_cast<unsigned char>(c));
    sink_.send(c);
  }
  void begin(char verb, Uint32 sequence, State state) {
    put('+');
    put(verb);
    count(sequence).word(text_of(state));
  }
  void refuse(Uint32 sequence, Error error, State state) {
    put('!');
    write_unsigned(*this, sequence);
    count(static_cast<Uint8>(error)).word(text_of(state)).word(text_of(error)).end();
  }
  TextReply& text(const char* characters) {
    for (; *characters; ++characters) put(*characters);
    return *this;
  }
  TextReply& word(const char* characters) {
    put(' ');
    return text(characters);
  }
  TextReply& number(Int32 value) {
    put(' ');
    write_integer(*this, value);
    return *this;
  }
  TextReply& count(Uint32 value) {
    put(' ');
    write_unsigned(*this, value);
    return *this;
  }
  TextReply& hex(Uint32 value) {
    put(' ');
    write_hex(*this, value);
    return *this;
  }
  void end() {
    const Uint32 sum = crc_.value();
    put('*');
    write_hex(*this, sum);
    sink_.send('\n');
  }

 private:
  Sink& sink_;
  kernel::Crc32 crc_;
};

}  // namespace firmware
}  // namespace sinew

#endif
