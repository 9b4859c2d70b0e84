/// Zeros of tendons, moves of each drive for itself, and tension, on a desk.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <random>

#include "desk.hpp"

namespace sinew::firmware {
namespace homing_test {

/// A tendon's way in one move before its zero is set.
const std::int32_t homing_reach = robot::motor.of(Length::from_raw(30 << Length::fraction));

using Places = std::vector<std::int32_t>;

std::string move_payload(const Places& counts, int duration = 0) {
  std::string payload = little_endian(static_cast<std::uint32_t>(duration), 2);
  for (const std::int32_t count : counts) payload += little_endian(static_cast<std::uint32_t>(count), 4);
  return payload;
}
std::string zero_payload(std::size_t drive, std::int32_t count) {
  return little_endian(static_cast<std::uint32_t>(drive), 1) +
         little_endian(static_cast<std::uint32_t>(count), 4);
}

void expect_refused(const Answer& answer, Error error) {
  EXPECT_TRUE(answer.is_whole);
  EXPECT_EQ(answer.verb, '!');
  EXPECT_EQ(answer.code, static_cast<int>(error)) << text_of(static_cast<Error>(answer.code));
}
void expect_accepted(const Answer& answer, char verb) {
  EXPECT_TRUE(answer.is_whole);
  EXPECT_EQ(answer.verb, verb) << text_of(static_cast<Error>(answer.code));
}

class Homing : public testing::Test {
 protected:
  /// Encoders that begin anywhere.
  Homing() {
    for (std::size_t i = 0; i < tendon_drives; ++i) began[i] = static_cast<std::int32_t>(1000 * i) - 7000;
    std::ranges::copy(began, desk.board.positions.begin());
  }
  Answer move(const Places& counts, int duration = 0) {
    return desk.ask_binary('T', move_payload(counts, duration));
  }
  Answer zero(std::size_t drive, std::int32_t count) {
    return desk.ask_binary('Z', zero_payload(drive, count));
  }
  Answer pose(int value, int duration = 0) {
    std::vector<int> numbers(pose_size, 0);
    numbers[0] = value;
    return desk.ask_binary('P', pose_payload(numbers, duration));
  }
  void arm() { expect_accepted(desk.ask_binary('A'), 'A'); }
  void home() {
    for (std::size_t i = 0; i < drive_count; ++i) expect_accepted(zero(i, 0), 'Z');
  }
  /// Counts as the firmware tells them.
  Places counts() {
    expect_accepted(desk.ask_binary('S'), 'S');
    Places counts(drive_count);
    for (std::size_t i = 0; i < drive_count; ++i)
      counts[i] = static_cast<std::int32_t>(number_at(desk.payload, 4 * i, 4));
    return counts;
  }
  Places began = Places(drive_count);
  Desk desk;
};

TEST_F(Homing, HelloSaysWhatThereIs) {
  desk.ask_binary(binary_request('H', 7, {}, 0));
  ASSERT_EQ(desk.payload.size(), 8u + 4 + 4 + 4 + 1 + 1 + 2);
  EXPECT_EQ(desk.payload[21], 3);
  EXPECT_EQ(number_at(desk.payload, 22, 2), 20u * 256);
}

TEST_F(Homing, NoPoseBeforeTheZeros) {
  arm();
  for (std::size_t i = 0; i < drive_count; ++i) {
    expect_refused(pose(10), Error::not_homed);
    expect_accepted(zero(i, 0), 'Z');
  }
  EXPECT_TRUE(std::ranges::equal(desk.board.positions, began));
  expect_accepted(pose(10), 'P');
}

TEST_F(Homing, AZeroMovesNothingAndShiftsAll) {
  arm();
  EXPECT_EQ(counts(), began);
  expect_accepted(zero(2, 345), 'Z');
  Places expected = began;
  expected[2] = 345;
  EXPECT_EQ(counts(), expected);
  EXPECT_TRUE(std::ranges::equal(desk.board.positions, began));
  desk.wait(150);
  expected[2] = 400;
  expect_accepted(move(expected), 'T');
  EXPECT_EQ(desk.board.positions[2], began[2] + 55);
  expect_accepted(desk.ask_binary('D'), 'D');
  expect_accepted(desk.ask_binary('A'), 'A');  // it knows its zeros
  EXPECT_EQ(counts(), expected);
  EXPECT_EQ(desk.board.positions[2], began[2] + 55);
}

TEST_F(Homing, PosesBeginAtTheZeros) {
  arm();
  home();
  expect_accepted(pose(1000), 'P');
  std::vector<int> numbers(pose_size, 0);
  numbers[0] = 1000;
  const auto expected = expected_setpoints(numbers);
  for (std::size_t i = 0; i < drive_count; ++i) EXPECT_EQ(desk.board.positions[i], began[i] + expected[i]);
  EXPECT_EQ(counts(), expected);
}

TEST_F(Homing, StateTellsZerosAndTensions) {
  arm();
  std::iota(desk.board.tensions.begin(), desk.board.tensions.end(), Uint16{100});
  expect_accepted(zero(0, 0), 'Z');
  expect_accepted(zero(9, 0), 'Z');
  counts();
  const std::size_t bits = 4u * drive_count + 2u * bend_count + tendon_drives + 2u;
  ASSERT_EQ(desk.payload.size(), bits + (drive_count + 7u) / 8 + 2u * tendon_drives);
  EXPECT_EQ(number_at(desk.payload, bits, 2), 1u | 1u << 9);
  for (std::size_t i = 0; i < tendon_drives; ++i)
    EXPECT_EQ(number_at(desk.payload, bits + 2 + 2 * i, 2), 100 + i);
}

TEST_F(Homing, RefusesWhatDoesNotFit) {
  expect_refused(move(began), Error::not_armed);
  --desk.last;
  expect_refused(zero(0, 0), Error::not_armed);
  --desk.last;
  arm();
  expect_refused(desk.ask_binary('T', "x"), Error::wrong_count);
  expect_refused(desk.ask_binary('Z', ""), Error::wrong_count);
  expect_refused(zero(drive_count, 0), Error::out_of_range);
  expect_refused(zero(255, 0), Error::out_of_range);
  expect_refused(zero(0, 0x7FFFFFFF), Error::out_of_limits);
  Places far = began;
  far[0] += homing_reach + 1;
  expect_refused(move(far), Error::out_of_limits);
  far[0] = began[0] + homing_reach;
  far.back() = -1;
  expect_refused(move(far), Error::out_of_limits);
  far.back() = 0;
  expect_accepted(move(far, 100), 'T');
  expect_refused(zero(0, 0), Error::moving);
  desk.wait(100);
  expect_accepted(zero(0, 0), 'Z');
  EXPECT_EQ(desk.ask(request('T', desk.last + 1)).code, static_cast<int>(Error::unknown_verb));
  EXPECT_EQ(desk.ask(request('Z', desk.last + 1)).code, static_cast<int>(Error::unknown_verb));
}

TEST_F(Homing, WhatIsTooTightIsOnlyPaidOut) {
  arm();
  home();
  Places to(drive_count, 0);
  to[4] = -4000;
  expect_accepted(move(to, 100), 'T');
  desk.wait(50);
  const std::int32_t there = desk.board.setpoints[4] - began[4];
  EXPECT_NEAR(there, -2000, 50);
  desk.board.tensions[4] = 20 * 256;
  desk.wait(2);
  EXPECT_LT(desk.board.setpoints[4] - began[4], there);  // the limit itself may be
  desk.board.tensions[4] = 20 * 256 + 1;
  desk.wait(2);
  const std::int32_t stopped = desk.board.setpoints[4] - began[4];
  desk.wait(100);
  EXPECT_EQ(desk.board.setpoints[4] - began[4], stopped);
  to[4] = stopped - 1;
  expect_refused(move(to), Error::over_tension);
  expect_refused(pose(-0x800), Error::over_tension);  // takes it in, as those before it
  to[4] = stopped + 1000;
  expect_accepted(move(to, 10), 'T');
  desk.wait(10);
  EXPECT_EQ(desk.board.setpoints[4] - began[4], stopped + 1000);  // though it still is
  desk.board.tensions[4] = 0;
  to[4] = -4000;
  desk.wait(2);
  expect_accepted(move(to), 'T');
}

TEST_F(Homing, NoMoveIsMissingFromADamagedExchange) {
  arm();
  home();
  desk.board.damaged_exchanges = 1;
  desk.board.tensions[0] = 0xFFFF;
  Places to(drive_count, 0);
  to[0] = -100;
  desk.wait(2);
  EXPECT_EQ(desk.board.damaged_exchanges, 0);
  expect_accepted(move(to), 'T');  // what a damaged exchange says is not believed
}

TEST_F(Homing, ASilentHostEndsIt) {
  arm();
  Places to = began;
  to[0] += 20000;
  expect_accepted(move(to, 1000), 'T');
  desk.wait(link_timeout + 1);
  EXPECT_FALSE(desk.board.enabled);
  const auto there = desk.board.positions;
  desk.wait(1000);
  EXPECT_EQ(desk.board.positions, there);
}

/// Of whole frames with every verb and payload: positions change by what is accepted alone, and only when it
/// is armed; zeros alone move nothing.
TEST_F(Homing, RandomFramesMoveNothingUnasked) {
  std::mt19937 random(7);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  int moved = 0;
  for (int k = 0; k < 50'000; ++k) {
    const auto before = desk.board.positions;
    const bool was_armed = desk.session.state() == State::armed;
    std::string payload(static_cast<std::size_t>(below(80)), ' ');
    for (char& c : payload) c = static_cast<char>(random());
    char verb = "TZPASD"[below(6)];
    if (below(3) == 0) {
      Places to(drive_count);
      for (auto& count : to) count = below(8000) - 4000;
      to.back() = below(1000);
      payload = verb == 'Z' ? zero_payload(static_cast<std::size_t>(below(20)), below(2000) - 1000)
                            : move_payload(to, below(3));
    }
    if (verb != 'T' && verb != 'P' && verb != 'Z' && below(2)) payload.clear();
    std::string frame = binary_request(verb, ++desk.last, payload);
    const bool is_damaged = below(4) == 0;
    if (is_damaged) {
      auto& byte = frame[static_cast<std::size_t>(below(static_cast<int>(frame.size())))];
      byte = static_cast<char>(byte ^ 1 << below(8));
      if (std::ranges::count(frame, '\n') > 0) continue;
    }
    if (below(200) == 0)
      for (auto& tension : desk.board.tensions) tension = static_cast<Uint16>(below(6000));
    const Answer answer = desk.ask_binary(frame);
    if (answer.verb == '!' || is_damaged) {
      --desk.last;
      ASSERT_EQ(desk.board.positions, before);
    }
    if (desk.board.positions != before) {
      ASSERT_TRUE(was_armed);
      ASSERT_TRUE(answer.verb == 'T' || answer.verb == 'P') << answer.verb;
      ++moved;
    }
    if (desk.last % 0x10000 == 0xFFFF) desk.ask_binary(binary_request('H', 0, {}, 0));
  }
  EXPECT_GT(moved, 100);
}

}  // namespace homing_test
}  // namespace sinew::firmware
