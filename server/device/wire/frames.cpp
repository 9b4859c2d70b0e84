#include "frames.hpp"

#include <algorithm>

#include "sinew/kernel/crc32.h"

namespace sinew::server::device {
namespace {

// A link of the chain is 0x80 and the distance to the next or, from the last, to the end.
constexpr std::size_t link_mark = 0x80, bridge = 0xFF, bridged = 126;
constexpr double tension_step = 1.0 / 256;  // [N]

std::uint32_t checksum(std::string_view bytes) {
  kernel::Crc32 sum;
  sum.add_text(bytes);
  return sum.value();
}

void put(std::string& bytes, std::uint32_t value, int size) {
  for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xFF);
}

/// The least significant byte first. Reads past the end are noticed once, at the end.
class Bytes {
 public:
  explicit Bytes(std::string_view text) : text_(text) {}
  std::uint32_t take(int size) {
    std::uint32_t value = 0;
    for (int i = 0; i < size; ++i, ++at_)
      if (at_ < text_.size())
        value |= static_cast<std::uint32_t>(static_cast<unsigned char>(text_[at_])) << (8 * i);
    return value;
  }
  int small() { return static_cast<int>(take(1)); }
  bool is_at_end() const { return at_ == text_.size(); }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
};

/// Newlines become links that say how far it is to the next.
std::string linked(std::string_view bytes) {
  std::string line;
  for (;;) {
    const std::size_t run = std::min(std::min(bytes.find('\n'), bytes.size()), bridged);
    line += static_cast<char>(link_mark + 1 + run);
    line += bytes.substr(0, run);
    bytes.remove_prefix(run);
    if (bytes.empty()) return line + '\n';
    if (run != bridged) bytes.remove_prefix(1);
  }
}

}  // namespace

std::string encode(char verb, std::uint32_t sequence, std::uint32_t hash, std::string_view payload) {
  std::string bytes(1, verb);
  put(bytes, sequence, 4);
  put(bytes, hash, 4);
  bytes += payload;
  put(bytes, checksum(bytes), 4);
  return linked(bytes);
}

std::optional<std::string> decode(std::string_view line) {
  std::string bytes;
  for (std::size_t at = 0;;) {
    const std::size_t link = at < line.size() ? static_cast<unsigned char>(line[at]) : 0;
    if (link <= link_mark || at + link - link_mark > line.size()) return {};
    const std::size_t next = at + link - link_mark;
    bytes += line.substr(at + 1, next - at - 1);
    if (next == line.size()) break;
    if (link != bridge) bytes += '\n';
    at = next;
  }
  if (bytes.size() < 10) return {};
  const std::string_view body = std::string_view(bytes).substr(0, bytes.size() - 4);
  if (Bytes(std::string_view(bytes).substr(body.size())).take(4) != checksum(body)) return {};
  bytes.resize(body.size());
  return bytes;
}

std::string_view text_of(WireError error) {
  switch (error) {
    case WireError::wrong_hash:
      return "the firmware has another robot's table";
    case WireError::other_session:
      return "the controller was reset";
    case WireError::not_armed:
      return "the controller has let go by itself";
    case WireError::out_of_limits:
      return "the controller refuses this as out of limits";
    case WireError::drives:
      return "the drives answer nonsense";
    case WireError::not_homed:
      return "the controller's zeros are not set";
    case WireError::moving:
      return "the controller is still moving";
    case WireError::over_tension:
      return "a tendon is over-tensioned";
    default:
      return is_damage(error) ? "a request came damaged" : "the controller refuses this";
  }
}

std::optional<RawReply> read_reply(std::string_view line) {
  const auto bytes = decode(line);
  if (!bytes) return {};
  Bytes head(*bytes);
  RawReply reply;
  reply.verb = static_cast<char>(head.take(1));
  reply.sequence = head.take(4);
  const int mode = head.small();
  if (mode > 2) return {};
  reply.mode = static_cast<DriveMode>(mode);
  reply.payload = bytes->substr(6);
  return reply;
}

std::optional<Hello> read_hello(std::string_view payload) {
  Bytes said(payload);
  Hello hello;
  hello.version = said.small();
  hello.sections = said.small();
  hello.tendons = said.small();
  hello.stages = said.small();
  said.take(1);  // bits of angles: 16, or requests had another size
  hello.angle_fraction = said.small();
  said.take(1);
  hello.length_fraction = said.small();
  hello.hash = said.take(4);
  hello.last = said.take(4);
  hello.stage_limit = static_cast<std::int32_t>(said.take(4));
  hello.reset_cause = static_cast<char>(said.take(1));
  if (hello.version >= 3) {
    const int options = said.small();
    hello.has_tension = (options & 1) != 0;
    hello.needs_homing = (options & 2) != 0;
    hello.tension_limit = tension_step * said.take(2);
  }
  const bool is_possible = hello.sections > 0 && hello.tendons > 2 && hello.stages < 2;
  return said.is_at_end() && is_possible ? std::optional(hello) : std::nullopt;
}

bool DriveState::all_homed() const {
  return std::ranges::all_of(homed, [](bool is_homed) { return is_homed; });
}

std::optional<DriveState> read_state(std::string_view payload, const Hello& hello) {
  Bytes said(payload);
  DriveState state;
  for (std::size_t i = 0; i < hello.drives(); ++i)
    state.counts.push_back(static_cast<std::int32_t>(said.take(4)));
  for (int i = 0; i < 2 * hello.sections; ++i) state.bends.push_back(static_cast<std::int16_t>(said.take(2)));
  for (std::size_t i = 0; i < hello.tendon_drives(); ++i) said.take(1);  // letters: judged here anew
  state.damaged = static_cast<int>(said.take(2));
  state.homed.assign(hello.drives(), true);
  if (hello.version >= 3) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < hello.drives(); ++i) {
      if (i % 8 == 0) bits = said.take(1);
      state.homed[i] = (bits >> i % 8 & 1U) != 0;
    }
    if (hello.has_tension)
      for (std::size_t i = 0; i < hello.tendon_drives(); ++i)
        state.tension.push_back(tension_step * said.take(2));
  }
  return said.is_at_end() ? std::optional(state) : std::nullopt;
}

std::string pose_payload(int milliseconds, std::span<const std::int16_t> bends,
                         std::optional<std::int32_t> stage) {
  std::string bytes;
  put(bytes, static_cast<std::uint32_t>(milliseconds), 2);
  for (const std::int16_t bend : bends) put(bytes, static_cast<std::uint32_t>(bend), 2);
  if (stage) put(bytes, static_cast<std::uint32_t>(*stage), 4);
  return bytes;
}

std::string counts_payload(int milliseconds, std::span<const std::int32_t> counts) {
  std::string bytes;
  put(bytes, static_cast<std::uint32_t>(milliseconds), 2);
  for (const std::int32_t count : counts) put(bytes, static_cast<std::uint32_t>(count), 4);
  return bytes;
}

std::string zero_payload(std::size_t drive, std::int32_t count) {
  std::string bytes;
  put(bytes, static_cast<std::uint32_t>(drive), 1);
  put(bytes, static_cast<std::uint32_t>(count), 4);
  return bytes;
}

std::vector<std::int32_t> read_setpoints(std::string_view payload, std::span<const std::int32_t> expected) {
  std::vector<std::int32_t> setpoints(expected.begin(), expected.end());
  Bytes said(payload);
  if (payload.size() != 2 * expected.size()) return setpoints;
  for (std::int32_t& count : setpoints)
    count += static_cast<std::int16_t>(said.take(2) - static_cast<std::uint32_t>(count));
  return setpoints;
}

}  // namespace sinew::server::device
