/// @file frames.hpp
/// Requests and replies as a host writes and reads them, with checksums and an encoding of its own making.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/arm.h"
#include "protocol/frame.h"

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

/// A frame of bytes as it goes over the line, without the newline.
inline std::string encoded(std::string_view bytes) {
  std::string line;
  for (;;) {
    const std::size_t run = std::min<std::size_t>(bytes.find('\n'), bytes.size());
    if (run >= 126) {
      line += '\xFF' + std::string(bytes.substr(0, 126));
      bytes.remove_prefix(126);
      if (bytes.empty()) return line;
    } else {
      line += static_cast<char>(0x81 + run) + std::string(bytes.substr(0, run));
      if (run == bytes.size()) return line;
      bytes.remove_prefix(run + 1);
    }
  }
}
/// The bytes; none if that is no frame.
inline std::string decoded(std::string_view line) {
  std::string bytes;
  for (;;) {
    const int link = line.empty() ? 0 : static_cast<std::uint8_t>(line[0]);
    const std::size_t run = link == 0xFF ? 126 : static_cast<std::size_t>(link - 0x81);
    if (link <= 0x80 || line.size() < 1 + run) return {};
    bytes += line.substr(1, run);
    line.remove_prefix(1 + run);
    if (line.empty()) return bytes;
    if (link != 0xFF) bytes += '\n';
  }
}

inline std::string little_endian(std::uint32_t value, int size) {
  std::string bytes;
  for (; size > 0; --size, value >>= 8) bytes += static_cast<char>(value & 0xFF);
  return bytes;
}
inline std::uint32_t number_at(std::string_view bytes, std::size_t at, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = size; i-- > 0;) value = value << 8 | static_cast<std::uint8_t>(bytes.at(at + i));
  return value;
}

/// With its checksum, without the newline.
inline std::string binary_framed(const std::string& body) {
  return encoded(body + little_endian(slow_crc32(body), 4));
}
inline std::string binary_request(char verb, std::uint32_t sequence, const std::string& payload = {},
                                  std::uint32_t hash = table_hash) {
  return binary_framed(verb + little_endian(sequence, 4) + little_endian(hash, 4) + payload);
}
inline std::string pose_payload(std::span<const int> pose, int duration = 0) {
  std::string payload = little_endian(static_cast<std::uint32_t>(duration), 2);
  for (std::size_t i = 0; i < pose.size(); ++i)
    payload += little_endian(static_cast<std::uint32_t>(pose[i]), i < bend_count ? 2 : 4);
  return payload;
}
inline std::string binary_pose(std::uint32_t sequence, std::span<const int> pose, int duration = 0) {
  return binary_request('P', sequence, pose_payload(pose, duration));
}

/// What a line of the firmware says in bytes; `rest` is empty.
inline Answer read_binary_answer(std::string_view line, std::string& payload) {
  Answer answer;
  payload.clear();
  const std::string bytes = decoded(line);
  if (bytes.size() < 10) return answer;
  const std::string body = bytes.substr(0, bytes.size() - 4);
  answer.is_whole = number_at(bytes, body.size(), 4) == slow_crc32(body);
  answer.verb = body[0];
  answer.sequence = number_at(body, 1, 4);
  answer.state = text_of(static_cast<State>(body[5]));
  payload = body.substr(6);
  if (answer.verb == '!' && payload.size() == 1) answer.code = payload[0];
  return answer;
}
/// In bytes or ASCII.
inline Answer read_any_answer(const std::string& line) {
  std::string payload;
  return !line.empty() && (line[0] & 0x80) ? read_binary_answer(line, payload) : read_answer(line);
}
/// Numbers of a pose: bends, and the stage where there is one.
constexpr std::size_t pose_size = bend_count + stage_count;

/// What the drives are to be told of a pose; empty beyond the limits.
inline std::vector<std::int32_t> expected_setpoints(std::span<const int> raw) {
  Pose pose;
  for (Uint8 i = 0; i < bend_count; ++i)
    bend_at(pose.bends, i) = Angle::from_raw(static_cast<Angle::Raw>(raw[i]));
  if (stage_count > 0) pose.stage = raw[bend_count];
  Changes changes;
  Counts counts;
  if (!is_within_limits(pose)) return {};
  plan(pose, changes, counts);
  return {counts, counts + drive_count};
}

/// The payload of a pose's reply.
inline std::string expected_reply(std::span<const int> raw) {
  std::string payload;
  for (const std::int32_t count : expected_setpoints(raw))
    payload += little_endian(static_cast<std::uint32_t>(count), 2);
  return payload;
}

}  // namespace sinew::firmware
