/// @file panel_desk.hpp
/// The protocol with tensions and homing on a desk, and what a host of it sends.
#pragma once

#include <gtest/gtest.h>

#include "desk.hpp"

namespace sinew::firmware {

static_assert(has_tensions && has_homing && stage_count == 1, "these tests are of all options");

inline std::string zero_payload(int drive, std::int32_t count) {
  return little_endian(static_cast<std::uint32_t>(drive), 1) +
         little_endian(static_cast<std::uint32_t>(count), 4);
}
inline std::string move_payload(std::span<const std::int32_t> counts, int duration = 0) {
  std::string payload = little_endian(static_cast<std::uint32_t>(duration), 2);
  for (const std::int32_t count : counts) payload += little_endian(static_cast<std::uint32_t>(count), 4);
  return payload;
}

/// The payload of a reply to `S`.
struct PanelState {
  std::vector<std::int32_t> counts;
  std::vector<int> bends;  ///< raw
  std::string letters;
  std::uint32_t damaged = 0, homed = 0;
  std::vector<double> tensions;  ///< [N]
};
inline PanelState read_state(const std::string& payload) {
  PanelState state;
  std::size_t at = 0;
  const auto next = [&](std::size_t size) {
    const std::uint32_t number = number_at(payload, at, size);
    at += size;
    return number;
  };
  for (int i = 0; i < drive_count; ++i) state.counts.push_back(static_cast<std::int32_t>(next(4)));
  for (int i = 0; i < bend_count; ++i) state.bends.push_back(static_cast<std::int16_t>(next(2)));
  for (int i = 0; i < tendon_drives; ++i) state.letters += static_cast<char>(next(1));
  state.damaged = next(2);
  state.homed = next(2);
  for (int i = 0; i < tendon_drives; ++i) state.tensions.push_back(next(2) / 256.0);
  EXPECT_EQ(at, payload.size());
  return state;
}

struct PanelDesk : Desk {
  using Desk::Desk;
  Answer pose(std::span<const int> pose, int duration = 0) {
    return ask_binary('P', pose_payload(pose, duration));
  }
  Answer move(std::span<const std::int32_t> counts, int duration = 0) {
    return ask_binary('T', move_payload(counts, duration));
  }
  Answer zero(int drive, std::int32_t count) { return ask_binary('Z', zero_payload(drive, count)); }
  /// All drives where they are.
  void home() {
    for (int i = 0; i < drive_count; ++i) EXPECT_EQ(zero(i, 0).verb, 'Z');
  }
  PanelState state() {
    EXPECT_EQ(ask_binary('S').verb, 'S');
    return read_state(payload);
  }
  std::vector<std::int32_t> counts() { return state().counts; }
  std::uint32_t homed() { return state().homed; }

  static void expect_refused(const Answer& answer, Error error) {
    EXPECT_TRUE(answer.is_whole);
    EXPECT_EQ(answer.verb, '!');
    EXPECT_EQ(answer.code, static_cast<int>(error)) << text_of(error);
  }
};

}  // namespace sinew::firmware
