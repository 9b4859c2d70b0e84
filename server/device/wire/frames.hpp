/// @file frames.hpp
/// Binary frames of the firmware, for any robot: how many sections, tendons and stages there are is what the
/// reply to hello says, not what a table says that was compiled in. Bytes: firmware/README.md.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sinew::server::device {

/// A request as it goes over the line, with its newline.
std::string encode(char verb, std::uint32_t sequence, std::uint32_t hash, std::string_view payload = {});
/// The bytes of a line without newline and checksum; nothing if it is damaged.
std::optional<std::string> decode(std::string_view line);

/// Why a controller refuses: the codes that the host has to tell apart.
enum class WireError : std::uint8_t {
  none = 0,
  too_long = 1,
  malformed = 4,
  wrong_hash = 6,
  other_session = 7,
  not_armed = 11,
  out_of_limits = 12,
  drives = 13,
  not_homed = 15,
  moving = 16,
  over_tension = 17
};
/// Whether the request came damaged.
constexpr bool is_damage(WireError error) {
  return error >= WireError::too_long && error <= WireError::malformed;
}
std::string_view text_of(WireError error);

enum class DriveMode : std::uint8_t { disarmed, armed, lost };

/// A reply without its payload's meaning.
struct RawReply {
  char verb = 0;  ///< `!`: refused
  std::uint32_t sequence = 0;
  DriveMode mode = DriveMode::disarmed;
  std::string payload;
};
std::optional<RawReply> read_reply(std::string_view line);

/// What a controller says of itself.
struct Hello {
  int version = 0, sections = 0, tendons = 0, stages = 0;
  int angle_fraction = 0, length_fraction = 0;  ///< bits behind the point
  std::uint32_t hash = 0, last = 0;             ///< of its table; the last sequence number
  std::int32_t stage_limit = 0;                 ///< [counts]
  char reset_cause = '-';
  bool has_tension = false, needs_homing = false;
  double tension_limit = 0;  ///< [N], 0: none

  std::size_t tendon_drives() const { return static_cast<std::size_t>(sections * tendons); }
  std::size_t drives() const { return tendon_drives() + static_cast<std::size_t>(stages); }
  std::uint32_t session() const { return (last + 1) >> 16U; }
};
std::optional<Hello> read_hello(std::string_view payload);

/// What the drives measure.
struct DriveState {
  std::vector<std::int32_t> counts;  ///< of the tendons, then of the stage
  std::vector<std::int16_t> bends;   ///< x, y of each section, raw
  int damaged = 0;                   ///< exchanges on SPI since the reset
  std::vector<bool> homed;           ///< of each drive
  std::vector<double> tension;       ///< [N] of each tendon; empty: not measured
  bool all_homed() const;
};
std::optional<DriveState> read_state(std::string_view payload, const Hello& hello);

/// @name Payloads of requests
/// @{
std::string pose_payload(int milliseconds, std::span<const std::int16_t> bends,
                         std::optional<std::int32_t> stage);
std::string counts_payload(int milliseconds, std::span<const std::int32_t> counts);
std::string zero_payload(std::size_t drive, std::int32_t count);
/// @}

/// Setpoints of which a reply has the lower halves, near those that were expected.
std::vector<std::int32_t> read_setpoints(std::string_view payload, std::span<const std::int32_t> expected);

}  // namespace sinew::server::device
