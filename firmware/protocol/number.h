/// @file number.h
/// Numbers from text and to text. Each number has one spelling only: no `+`, no `-0`, no leading zeros, hex
/// in eight lower-case digits. So no two requests mean the same, and a flipped bit never changes just the
/// case of a digit. Freestanding C++14, no includes, no heap.
#ifndef SINEW_FIRMWARE_NUMBER_H
#define SINEW_FIRMWARE_NUMBER_H

namespace sinew {
namespace firmware {

using Uint8 = __UINT8_TYPE__;
using Uint16 = __UINT16_TYPE__;
using Uint32 = __UINT32_TYPE__;
using Int16 = __INT16_TYPE__;
using Int32 = __INT32_TYPE__;

/// What is left to read.
struct Text {
  const char* at;
  const char* end;
  constexpr bool empty() const { return at == end; }
};

enum class Reading : Uint8 { good, malformed, out_of_range };

constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Steps over that character if it comes next.
constexpr bool skip(Text& text, char expected) {
  if (text.empty() || *text.at != expected) return false;
  ++text.at;
  return true;
}

constexpr Reading read_unsigned(Text& text, Uint32& value) {
  value = 0;
  if (text.empty() || !is_digit(*text.at)) return Reading::malformed;
  const bool zero = *text.at == '0';
  bool fits = true;
  const char* const begin = text.at;
  for (; !text.empty() && is_digit(*text.at); ++text.at) {
    const Uint8 digit = static_cast<Uint8>(*text.at - '0');
    if (value > 429496729UL || (value == 429496729UL && digit > 5)) fits = false;
    value = static_cast<Uint32>(value * 10 + digit);
  }
  if (zero && text.at - begin > 1) return Reading::malformed;
  return fits ? Reading::good : Reading::out_of_range;
}

constexpr Reading read_integer(Text& text, Int32 smallest, Int32 largest, Int32& value) {
  const bool minus = skip(text, '-');
  Uint32 size = 0;
  const Reading reading = read_unsigned(text, size);
  if (reading != Reading::good) return reading;
  if (minus && size == 0) return Reading::malformed;
  if (size > 0x7FFFFFFFUL) return Reading::out_of_range;
  value = minus ? -static_cast<Int32>(size) : static_cast<Int32>(size);
  return value < smallest || value > largest ? Reading::out_of_range : Reading::good;
}

/// Eight digits, lower case.
constexpr bool read_hex(Text& text, Uint32& value) {
  value = 0;
  for (Uint8 i = 0; i < 8; ++i, ++text.at) {
    if (text.empty()) return false;
    const char c = *text.at;
    const bool letter = c >= 'a' && c <= 'f';
    if (!letter && !is_digit(c)) return false;
    value = static_cast<Uint32>(value << 4) | static_cast<Uint8>(letter ? c - 'a' + 10 : c - '0');
  }
  return true;
}

/// @param sink has `put(char)`
template <class Sink>
void write_unsigned(Sink& sink, Uint32 value) {
  // Subtracting powers of ten: a 32-bit division costs an 8-bit controller some 600 cycles.
  static const Uint32 powers[] = {1000000000UL, 100000000UL, 10000000UL, 1000000UL, 100000UL,
                                  10000UL,      1000UL,      100UL,      10UL};
  bool begun = false;
  for (const Uint32 power : powers) {
    char digit = '0';
    for (; value >= power; value -= power) ++digit;
    begun = begun || digit != '0';
    if (begun) sink.put(digit);
  }
  sink.put(static_cast<char>('0' + static_cast<char>(value)));
}

template <class Sink>
void write_integer(Sink& sink, Int32 value) {
  if (value < 0) sink.put('-');
  write_unsigned(
      sink, value < 0 ? static_cast<Uint32>(0) - static_cast<Uint32>(value) : static_cast<Uint32>(value));
}

template <class Sink>
void write_hex(Sink& sink, Uint32 value) {
  for (Uint8 i = 0; i < 8; ++i, value = static_cast<Uint32>(value << 4)) {
    const Uint8 digit = static_cast<Uint8>(value >> 28);
    sink.put(static_cast<char>(digit < 10 ? '0' + digit : 'a' + (digit - 10)));
  }
}

}  // namespace firmware
}  // namespace sinew

#endif
