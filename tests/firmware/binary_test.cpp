/// Binary frames, ramps, a stage and a disturbed SPI, on a desk.
#include <gtest/gtest.h>

#include <cmath>

#include "desk.hpp"
#include "noise.hpp"
#include "thorough.hpp"

namespace sinew::firmware {
namespace binary_test {

const std::vector<int> straight(pose_size, 0);

std::vector<int> some_pose(int step = 100) {
  std::vector<int> pose(pose_size);
  for (int i = 0; i < static_cast<int>(pose_size); ++i)
    pose[static_cast<std::size_t>(i)] = i == bend_count ? 70 * step : step * (i + 1) * (i % 2 ? -1 : 1);
  return pose;
}

void expect_refused(const Answer& answer, Error error) {
  EXPECT_TRUE(answer.is_whole);
  EXPECT_EQ(answer.verb, '!');
  EXPECT_EQ(answer.code, static_cast<int>(error)) << text_of(error);
}
void expect_accepted(const Answer& answer, char verb, const std::string& state) {
  EXPECT_TRUE(answer.is_whole);
  EXPECT_EQ(answer.verb, verb) << "code " << answer.code;
  EXPECT_EQ(answer.state, state);
}

struct BinaryDesk : Desk {
  Answer pose(std::span<const int> pose, int duration = 0) {
    return ask_binary('P', pose_payload(pose, duration));
  }
  bool is_at(std::span<const int> pose) const {
    return std::ranges::equal(board.setpoints, expected_setpoints(pose));
  }
};

TEST(FirmwareBinary, EncodingIsFoundAgain) {
  std::mt19937 random(1);
  for (int i = 0; i < 20000; ++i) {
    std::string bytes(random() % 400, 'x');
    for (char& c : bytes) c = static_cast<char>(random() % 3 ? random() : '\n');
    const std::string line = encoded(bytes);
    ASSERT_EQ(line.find('\n'), std::string::npos);
    ASSERT_TRUE(line[0] & 0x80);
    ASSERT_EQ(decoded(line), bytes);
    if (bytes.size() >= bridged) continue;
    std::vector<Uint8> in_place(line.begin(), line.end());
    auto size = static_cast<Uint16>(in_place.size());
    ASSERT_EQ(decode(in_place.data(), size), Error::none);
    ASSERT_TRUE(std::equal(bytes.begin(), bytes.end(), in_place.begin() + 1, in_place.begin() + 1 + size,
                           [](char a, Uint8 b) { return static_cast<Uint8>(a) == b; }));
  }
}

/// What a reply is sent to.
struct Lines {
  void wait_for_room(Uint8) {}
  void put(Uint8 byte) { text += static_cast<char>(byte); }
  void put(const Uint8* bytes, Uint8 size) { text.append(reinterpret_cast<const char*>(bytes), size); }
  void flush() {}
  std::string text;
};

TEST(FirmwareBinary, RepliesAreEncodedAlike) {
  std::mt19937 random(2);
  for (int i = 0; i < 20000; ++i) {
    Lines lines;
    BinaryReply<Lines> reply(lines);
    std::string body;
    for (std::size_t size = random() % 100; size > 0; --size)
      body += static_cast<char>(random() % 4 ? random() : '\n');
    for (const char c : body) reply.put(static_cast<Uint8>(c));
    reply.end();
    ASSERT_EQ(lines.text, binary_framed(body) + '\n');
  }
}

TEST(FirmwareBinary, HelloSaysWhatAHostHasToKnow) {
  Desk desk;
  const Answer answer = desk.ask_binary(binary_request('H', 7, {}, 0));
  expect_accepted(answer, 'H', "disarmed");
  EXPECT_EQ(answer.sequence, 7u);
  const auto byte = [](int value) { return little_endian(static_cast<std::uint32_t>(value), 1); };
  EXPECT_EQ(desk.payload, byte(protocol_version) + byte(section_count) + byte(tendon_count) +
                              byte(stage_count) + byte(16) + byte(Angle::fraction) + byte(16) +
                              byte(Length::fraction) + little_endian(table_hash, 4) +
                              little_endian(0xFFFF, 4) + little_endian(stage_count > 0 ? stage_limit : 0, 4) +
                              'p' + byte(0) + little_endian(0, 2));
}

TEST(FirmwareBinary, VerbsDoWhatThoseOfAsciiDo) {
  BinaryDesk desk;
  expect_refused(desk.pose(straight), Error::not_armed);
  --desk.last;
  expect_accepted(desk.ask_binary('A'), 'A', "armed");
  expect_accepted(desk.pose(some_pose()), 'P', "armed");
  EXPECT_TRUE(desk.is_at(some_pose()));
  EXPECT_EQ(desk.payload, expected_reply(some_pose()));
  expect_accepted(desk.ask_binary('S'), 'S', "armed");
  const std::string binary = desk.payload;
  const Answer ascii = desk.ask('S');
  const std::string homed((drive_count + 7) / 8, '\xFF');
  ASSERT_EQ(binary.size(), 4u * drive_count + 2u * bend_count + tendon_drives + 2u + homed.size());
  EXPECT_EQ(binary.substr(binary.size() - homed.size()), homed);
  for (std::size_t i = 0; i < drive_count; ++i)
    EXPECT_EQ(std::to_string(static_cast<std::int32_t>(number_at(binary, 4 * i, 4))), ascii.rest[i]);
  for (std::size_t i = 0; i < bend_count; ++i)
    EXPECT_EQ(std::to_string(static_cast<std::int16_t>(number_at(binary, 4 * drive_count + 2 * i, 2))),
              ascii.rest[drive_count + i]);
  EXPECT_EQ(binary.substr(4 * drive_count + 2 * bend_count, tendon_drives), ascii.rest.back());
  expect_accepted(desk.ask('P', straight), 'P', "armed");  // in turn
  expect_accepted(desk.ask_binary('D'), 'D', "disarmed");
  EXPECT_FALSE(desk.board.enabled);
}

TEST(FirmwareBinary, ErrorsAreThoseOfAscii) {
  BinaryDesk desk;
  desk.ask('A');
  const std::uint32_t next = desk.last + 1;
  const std::string good = binary_pose(next, straight);
  expect_refused(desk.ask_binary(good + std::string(500, 'x')), Error::too_long);
  expect_refused(desk.ask_binary(good.substr(0, 12)), Error::truncated);
  expect_refused(desk.ask_binary(good.substr(0, good.size() - 1)), Error::truncated);
  expect_refused(desk.ask_binary("\x81"), Error::truncated);
  expect_refused(desk.ask_binary(good + 'x'), Error::checksum);
  expect_refused(desk.ask_binary(binary_request('Z', next)), Error::unknown_verb);
  expect_refused(desk.ask_binary(binary_request('P', next, pose_payload(straight), table_hash + 1)),
                 Error::wrong_hash);
  expect_refused(desk.ask_binary(binary_pose(next + 0x10000, straight)), Error::other_session);
  expect_refused(desk.ask_binary(binary_pose(desk.last, straight)), Error::replayed);
  expect_refused(desk.ask_binary(binary_request('P', next)), Error::wrong_count);
  expect_refused(desk.ask_binary(binary_request('P', next, pose_payload(straight) + '\0')),
                 Error::wrong_count);
  expect_refused(desk.ask_binary(binary_request('S', next, "x")), Error::wrong_count);
  std::vector<int> far = straight;
  far[3] = robot::limits.limit[0] + 1;
  expect_refused(desk.ask_binary(binary_pose(next, far)), Error::out_of_limits);
  expect_refused(desk.ask_binary(binary_pose(next, far, 1000)), Error::out_of_limits);
  EXPECT_EQ(desk.board.exchanges, 4);
  expect_accepted(desk.ask_binary(good), 'P', "armed");
  ++desk.last;
  desk.board.damaged_exchanges = 3;
  expect_refused(desk.ask_binary('S'), Error::drives);
}

/// The board makes them 0, which is right where a 0 was sent.
TEST(FirmwareBinary, FrameWithAByteThatWasDamagedIsRefused) {
  BinaryDesk desk;
  desk.ask('A');
  std::string good = binary_pose(desk.last + 1, some_pose(), 300) + '\n';
  for (std::size_t at = 0; at < good.size(); ++at) {
    if (good[at] == 0) continue;
    std::string line = good;
    line[at] = 0;
    const std::string replies = desk.ask_raw(line + (at + 1 == good.size() ? "\n" : ""));
    ASSERT_EQ(std::ranges::count(replies, '\n'), 1) << at;
    const Answer answer = read_any_answer(replies.substr(0, replies.size() - 1));
    ASSERT_TRUE(answer.is_whole && answer.verb == '!') << at;
  }
  expect_accepted(desk.ask_binary(good.substr(0, good.size() - 1)), 'P', "armed");
}

TEST(FirmwareStage, LimitsHold) {
  if (stage_count == 0) GTEST_SKIP();
  BinaryDesk desk;
  desk.ask('A');
  std::vector<int> pose = straight;
  for (const int far : {-1, stage_limit + 1, 0x7FFFFFFF, -0x7FFFFFFF}) {
    pose.back() = far;
    expect_refused(desk.pose(pose), Error::out_of_limits);
    --desk.last;
    expect_refused(desk.ask('P', pose), Error::out_of_limits);
    --desk.last;
  }
  for (const int near : {stage_limit, 1, 0}) {
    pose.back() = near;
    expect_accepted(desk.pose(pose), 'P', "armed");
    EXPECT_EQ(desk.board.setpoints.back(), near);
    expect_accepted(desk.ask('P', pose), 'P', "armed");
  }
  desk.ask('D');
  desk.board.positions.back() = stage_limit + 1;
  expect_refused(desk.ask('A'), Error::drives);
  --desk.last;
  desk.board.positions.back() = 5;
  expect_accepted(desk.ask('A'), 'A', "armed");
  EXPECT_EQ(desk.board.setpoints.back(), 5);
}

TEST(FirmwareRamp, IsLinearMonotoneAndExactAtTheEnd) {
  std::mt19937 random(3);
  for (int i = 0; i < 400; ++i) {
    Ramp<3> ramp, late;
    const unsigned shift = random() % 32;
    const auto any = [&] { return static_cast<Int32>(static_cast<std::uint32_t>(random())) >> shift; };
    const Int32 from[3] = {any(), any(), 7}, to[3] = {any(), any(), 7};
    const auto ticks = static_cast<Uint16>(2 + random() % (i % 4 ? 40 : 65534));
    for (Ramp<3>* each : {&ramp, &late}) {
      std::copy(to, to + 3, each->target());
      each->begin(from, ticks);
    }
    Int32 at[3] = {from[0], from[1], from[2]}, late_at[3] = {};
    for (Uint16 t = 1; t <= ticks; ++t) {
      const Int32 before[3] = {at[0], at[1], at[2]};
      ramp.advance(1, at);
      for (int k = 0; k < 3; ++k) {
        const double way = static_cast<double>(to[k]) - from[k], part = way * t / ticks;
        ASSERT_LE(std::abs(at[k] - (from[k] + part)), 1.001 + std::abs(way) * 0x1p-32) << t << '/' << ticks;
        ASSERT_TRUE(to[k] >= from[k] ? at[k] >= before[k] && at[k] <= to[k]
                                     : at[k] <= before[k] && at[k] >= to[k]);
      }
      if (t % 5 == 0 || t == ticks) {
        late.advance(static_cast<Uint16>(t % 5 == 0 ? 5 : t % 5), late_at);
        ASSERT_TRUE(std::equal(at, at + 3, late_at));
      }
    }
    ASSERT_TRUE(std::equal(at, at + 3, to));
    ASSERT_FALSE(ramp.is_running());
  }
}

TEST(FirmwareRamp, TakesItsTime) {
  BinaryDesk desk;
  desk.ask('A');
  desk.board.keeps_path = true;
  expect_accepted(desk.pose(some_pose(), 50), 'P', "armed");
  EXPECT_EQ(desk.payload, expected_reply(some_pose()));  // where it will be
  EXPECT_TRUE(desk.is_at(straight));
  desk.wait(49);
  EXPECT_FALSE(desk.is_at(some_pose()));
  desk.wait(1);
  EXPECT_TRUE(desk.is_at(some_pose()));
  EXPECT_EQ(desk.board.path.size(), 50u);  // an exchange a tick
  const auto expected = expected_setpoints(some_pose());
  for (std::size_t t = 0; t < 50; ++t)
    for (std::size_t i = 0; i < drive_count; ++i)
      EXPECT_NEAR(desk.board.path[t][i], expected[i] * (static_cast<double>(t) + 1) / 50, 1.001);
}

TEST(FirmwareRamp, NextBeginsWhereThisOneIs) {
  BinaryDesk desk;
  desk.ask('A');
  desk.pose(some_pose(), 100);
  desk.wait(40);
  const auto before = desk.board.setpoints;
  desk.board.keeps_path = true;
  desk.pose(straight, 10);
  EXPECT_EQ(desk.board.setpoints, before);
  desk.wait(10);
  EXPECT_TRUE(desk.is_at(straight));
  for (std::size_t t = 0; t < 10; ++t)
    for (std::size_t i = 0; i < drive_count; ++i)
      EXPECT_NEAR(desk.board.path[t][i], before[i] * (9.0 - static_cast<double>(t)) / 10, 1.001);
  desk.pose(some_pose(), 100);
  desk.wait(40);
  desk.pose(straight);  // at once
  EXPECT_TRUE(desk.is_at(straight));
  desk.wait(100);
  EXPECT_TRUE(desk.is_at(straight));
}

TEST(FirmwareRamp, EndsWithEnable) {
  BinaryDesk desk;
  desk.ask('A');
  desk.pose(some_pose(), 65535);
  desk.wait(link_timeout);  // a ramp is no sign of life
  EXPECT_FALSE(desk.board.enabled);
  EXPECT_EQ(desk.session.state(), State::lost);
  const auto stopped = desk.board.setpoints;
  desk.wait(1000);
  EXPECT_EQ(desk.board.setpoints, stopped);
  expect_accepted(desk.ask('A'), 'A', "armed");
  desk.wait(100);
  EXPECT_EQ(desk.board.setpoints, stopped);
  desk.pose(some_pose(), 100);
  desk.wait(50);
  const auto middle = desk.board.setpoints;
  desk.ask_binary('D');
  desk.wait(100);
  EXPECT_EQ(desk.board.setpoints, middle);
}

TEST(FirmwareRamp, LongestArrives) {
  BinaryDesk desk;
  desk.ask('A');
  desk.pose(some_pose(), 65535);
  for (int t = 0; t < 65535; t += 15) {
    EXPECT_FALSE(desk.is_at(some_pose()));
    desk.wait(15);
    if (t % 150 == 0) desk.ask_binary('S');
  }
  EXPECT_TRUE(desk.is_at(some_pose()));
  EXPECT_TRUE(desk.board.enabled);
}

TEST(FirmwareRamp, GoesOnWhileARepliesFillsTheLine) {
  BinaryDesk desk;
  desk.ask('A');
  desk.pose(some_pose(), 20);
  desk.board.keeps_path = true;
  desk.board.room_left = 0;
  EXPECT_EQ(desk.ask('S').state, "armed");
  EXPECT_GE(desk.board.path.size(), 3u);
}

TEST(FirmwareSpi, DamagedExchangesAreMendedByTheNext) {
  BinaryDesk desk;
  desk.ask('A');
  desk.board.damaged_exchanges = damage_limit - 1;
  expect_accepted(desk.pose(some_pose()), 'P', "armed");
  EXPECT_FALSE(desk.is_at(some_pose()));
  desk.wait(damage_limit);
  EXPECT_TRUE(desk.is_at(some_pose()));
  EXPECT_TRUE(desk.board.enabled);
  desk.ask_binary('S');
  EXPECT_EQ(number_at(desk.payload, 4 * drive_count + 2 * bend_count + tendon_drives, 2), damage_limit - 1u);
}

TEST(FirmwareSpi, WireThatBringsNothingDisablesTheDrives) {
  BinaryDesk desk;
  desk.ask('A');
  desk.wait(1);
  desk.board.damaged_exchanges = 1000;
  desk.wait(damage_limit - 1);
  EXPECT_TRUE(desk.board.enabled);
  desk.wait(1);
  EXPECT_FALSE(desk.board.enabled);
  EXPECT_EQ(desk.session.state(), State::lost);
  expect_refused(desk.ask('A'), Error::drives);
  EXPECT_FALSE(desk.board.enabled);
}

TEST(FirmwareEpoch, NextSessionIsPreparedWithoutWaiting) {
  BinaryDesk desk;
  desk.ask('A');
  desk.last = 0x1F000;
  expect_accepted(desk.ask_binary('S'), 'S', "armed");
  desk.wait(12);
  desk.board.writes_until_power_fails = 0;  // from here on nothing has to be written
  desk.last = 0x1FFFE;
  expect_accepted(desk.ask_binary('S'), 'S', "armed");
  expect_accepted(desk.ask_binary('S'), 'S', "armed");
  expect_refused(desk.ask_binary(binary_request('S', 0x1FFFF)), Error::other_session);
  Desk after(&desk.board.eeprom);
  EXPECT_EQ(after.ask(request('S', 0x30000)).verb, 'S');
}

TEST(FirmwareBinary, NothingButAFreshValidFrameMovesTheDrives) {
  const int frames = lines_of(test::count_of(stage_count > 0 ? 100'000 : 300'000, 1'000'000));
  BinaryDesk desk;
  Noise noise(4);
  std::vector<std::string> accepted;
  desk.ask('A');
  for (int i = 0; i < frames; ++i) {
    const auto before = desk.board.setpoints;
    const int exchanges = desk.board.exchanges;
    const std::string lines = noise.binary(desk.last, accepted);
    const std::string replies = desk.ask_raw(lines);
    ASSERT_EQ(std::ranges::count(replies, '\n'), std::ranges::count(lines, '\n')) << i;
    std::istringstream stream(replies);
    for (std::string reply; std::getline(stream, reply);) {
      const Answer answer = read_any_answer(reply);
      ASSERT_TRUE(answer.is_whole && answer.verb == '!') << i;
    }
    ASSERT_EQ(desk.board.setpoints, before) << i;
    ASSERT_EQ(desk.board.exchanges, exchanges) << i;
    ASSERT_TRUE(desk.board.enabled) << i;
    if (i % 8 != 0) continue;
    const std::vector<int> pose = noise.pose();
    ASSERT_EQ(desk.pose(pose).verb, 'P') << i;
    ASSERT_TRUE(desk.is_at(pose));
    if (accepted.size() < 1000) accepted.push_back(binary_pose(desk.last, pose));
  }
}

}  // namespace binary_test
}  // namespace sinew::firmware
