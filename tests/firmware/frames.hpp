/// @file frames.hpp
/// Requests and replies as a host writes and reads them, with a checksum of its own making.
#pragma once

#include <cstdint>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/arm.h"

namespace sinew::firmware {

/// Bit by bit, as in the standard.
inline std::uint32_t slow_crc32(std::string_view text) {
  std::uint32_t state = 0xFFFFFFFF;
  for (const char c : text) {
    state ^= static_cast<std::uint8_t>(c);
    for (int bit = 0; bit < 8; ++bit) state = state & 1 ? state >> 1 ^ 0xEDB88320 : state >> 1;
  }
  return ~state;
}

inline std::string hex(std::uint32_t value) {
  std::string digits(8, '0');
  for (std::size_t i = 8; i-- > 0; value >>= 4) digits[i] = "0123456789abcdef"[value & 15];
  return digits;
}

/// Without the newline.
inline std::string framed(const std::string& body) { return body + '*' + hex(slow_crc32(body)); }

inline std::string request(char verb, std::uint32_t sequence, std::span<const int> numbers = {},
                           std::uint32_t hash = table_hash) {
  std::string body = std::string(1, verb) + ' ' + std::to_string(sequence) + ' ' + hex(hash);
  for (const int number : numbers) body += ' ' + std::to_string(number);
  return framed(body);
}

/// What a line of the firmware says.
struct Answer {
  bool is_whole = false;  ///< its checksum holds
  char verb = 0;          ///< of an accepted request, '!' of a refused one
  std::uint32_t sequence = 0;
  int code = 0;  ///< of an error
  std::string state;
  std::vector<std::string> rest;
};

inline Answer read_answer(const std::string& line) {
  Answer answer;
  const std::size_t star = line.rfind('*');
  if (star == std::string::npos || line.size() != star + 9) return answer;
  const std::string body = line.substr(0, star);
  answer.is_whole = line.substr(star + 1) == hex(slow_crc32(body));
  std::istringstream words(body);
  char mark = 0;
  words >> mark;
  answer.verb = mark;
  if (mark == '+') words >> answer.verb;
  words >> answer.sequence;
  if (mark == '!') words >> answer.code;
  words >> answer.state;
  for (std::string word; words >> word;) answer.rest.push_back(word);
  return answer;
}

/// What the drives are to be told of these bends; empty beyond the limits.
inline std::vector<std::int32_t> expected_setpoints(std::span<const int> raw) {
  Bends bends;
  for (Uint8 i = 0; i < bend_count; ++i) bend_at(bends, i) = Angle::from_raw(static_cast<Angle::Raw>(raw[i]));
  Changes changes;
  Counts counts;
  if (!plan(bends, changes, counts)) return {};
  return {counts, counts + drive_count};
}

}  // namespace sinew::firmware
