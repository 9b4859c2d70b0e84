/// Homing and moves of single drives, on a desk.
#include <gtest/gtest.h>

#include "panel/panel_desk.hpp"

namespace sinew::firmware {
namespace homing_test {

const std::vector<int> straight(pose_size, 0);

TEST(PanelHello, SaysOptionsAndLimit) {
  PanelDesk desk;
  EXPECT_EQ(desk.ask_binary(binary_request('H', 0, {}, 0)).verb, 'H');
  ASSERT_EQ(desk.payload.size(), 8u + 4 + 4 + 4 + 1 + 1 + 2);
  EXPECT_EQ(number_at(desk.payload, 0, 1), 3u);
  EXPECT_EQ(number_at(desk.payload, 21, 1), 3u);
  EXPECT_EQ(number_at(desk.payload, 22, 2), 20u * 256);
}

TEST(PanelHoming, PosesWaitForAllZeros) {
  PanelDesk desk;
  desk.ask_binary('A');
  for (int drive = 0; drive < drive_count; ++drive) {
    desk.expect_refused(desk.pose(straight), Error::not_homed);
    --desk.last;
    EXPECT_EQ(desk.ask('P', straight).code, static_cast<int>(Error::not_homed));  // in ASCII, too
    --desk.last;
    EXPECT_EQ(desk.zero(drive, 0).verb, 'Z');
    EXPECT_EQ(desk.homed(), (1u << (drive + 1)) - 1);
  }
  EXPECT_EQ(desk.pose(straight).verb, 'P');
  EXPECT_EQ(desk.payload, expected_reply(straight));
}

TEST(PanelHoming, ZeroNamesACountAndMovesNothing) {
  PanelDesk desk;
  for (int i = 0; i < drive_count; ++i) desk.board.positions[static_cast<std::size_t>(i)] = 100 * i - 700;
  desk.board.positions.back() = 40;
  desk.ask_binary('A');
  const auto before = desk.board.positions;
  for (int i = 0; i < drive_count; ++i) EXPECT_EQ(desk.zero(i, 10 * i).verb, 'Z');
  EXPECT_EQ(desk.board.positions, before);
  EXPECT_EQ(desk.board.setpoints, before);
  const auto counts = desk.counts();
  for (int i = 0; i < drive_count; ++i) EXPECT_EQ(counts[static_cast<std::size_t>(i)], 10 * i);
  // A pose is from these zeros on; so are those after arming anew.
  for (const char again : {'S', 'D'}) {
    desk.ask_binary(again);
    desk.ask_binary('A');
    EXPECT_EQ(desk.pose(straight).verb, 'P');
    for (int i = 0; i < drive_count; ++i)
      EXPECT_EQ(desk.board.positions[static_cast<std::size_t>(i)],
                before[static_cast<std::size_t>(i)] - 10 * i);
  }
}

TEST(PanelHoming, ZeroOfADriveThatLagsIsWhereItIs) {
  PanelDesk desk;
  desk.ask_binary('A');
  desk.board.follows = false;
  desk.board.positions[4] = 55;
  EXPECT_EQ(desk.zero(4, 0).verb, 'Z');
  EXPECT_EQ(desk.board.setpoints[4], 55);
  EXPECT_EQ(desk.counts()[4], 0);
}

TEST(PanelHoming, ZeroIsCheckedInOrder) {
  PanelDesk desk;
  const auto refused = [&desk](const std::string& payload, Error error) {
    desk.expect_refused(desk.ask_binary('Z', payload), error);
    --desk.last;
  };
  refused(std::string(4, '\0'), Error::wrong_count);
  refused(std::string(6, '\0'), Error::wrong_count);
  refused(zero_payload(drive_count, 0), Error::out_of_range);
  refused(zero_payload(0, 0), Error::not_armed);
  desk.ask_binary('A');
  refused(zero_payload(0, longest_change() + 1), Error::out_of_limits);
  refused(zero_payload(0, -longest_change() - 1), Error::out_of_limits);
  refused(zero_payload(tendon_drives, -1), Error::out_of_limits);  // the stage
  desk.home();
  desk.pose(straight, 0);
  std::vector<int> stage = straight;
  stage.back() = 1000;
  desk.pose(stage, 50);
  refused(zero_payload(0, 0), Error::moving);
  desk.wait(50);
  desk.board.damaged_exchanges = 3;
  refused(zero_payload(0, 0), Error::drives);
  EXPECT_EQ(desk.zero(0, 0).verb, 'Z');
  EXPECT_EQ(desk.ask("Z 999999 " + hex(table_hash) + "*00000000").code, static_cast<int>(Error::checksum));
  EXPECT_EQ(desk.ask(request('Z', desk.last + 1)).code,
            static_cast<int>(Error::unknown_verb));  // binary only
  EXPECT_EQ(desk.ask(request('T', desk.last + 1)).code, static_cast<int>(Error::unknown_verb));
}

TEST(PanelHoming, ResetForgetsZerosButDisarmingDoesNot) {
  PanelDesk desk;
  desk.ask_binary('A');
  desk.home();
  desk.wait(link_timeout);
  EXPECT_EQ(desk.session.state(), State::lost);
  EXPECT_EQ(desk.homed(), (1u << drive_count) - 1);
  desk.ask_binary('A');
  EXPECT_EQ(desk.pose(straight).verb, 'P');
  PanelDesk after(&desk.board.eeprom);
  after.last = 0x1FFFF;
  after.ask_binary('A');
  EXPECT_EQ(after.homed(), 0u);
  after.expect_refused(after.pose(straight), Error::not_homed);
}

TEST(PanelMove, GoesByARampAndReportsItsEnd) {
  PanelDesk desk;
  desk.ask_binary('A');
  std::vector<std::int32_t> to(drive_count, 0);
  for (int i = 0; i < drive_count; ++i) to[static_cast<std::size_t>(i)] = (i % 2 ? -300 : 70'000 / 7) + i;
  to.back() = 123'456;
  EXPECT_EQ(desk.move(to, 20).verb, 'T');
  EXPECT_EQ(desk.payload.size(), 2u * drive_count);
  for (std::size_t i = 0; i < to.size(); ++i)
    EXPECT_EQ(number_at(desk.payload, 2 * i, 2), static_cast<std::uint32_t>(to[i]) & 0xFFFF);
  EXPECT_EQ(desk.board.setpoints[0], 0);
  desk.wait(10);
  for (std::size_t i = 0; i < to.size(); ++i) EXPECT_NEAR(desk.board.setpoints[i], to[i] / 2.0, 1.001);
  desk.wait(10);
  EXPECT_TRUE(std::ranges::equal(desk.board.setpoints, to));
  EXPECT_EQ(desk.move(std::vector<std::int32_t>(drive_count, 5)).verb, 'T');  // at once
  EXPECT_TRUE(std::ranges::count(desk.board.setpoints, 5) == drive_count);
}

TEST(PanelMove, IsCheckedInOrder) {
  PanelDesk desk;
  std::vector<std::int32_t> to(drive_count, 0);
  const auto refused = [&](Error error) {
    const auto before = desk.board.setpoints;
    desk.expect_refused(desk.move(to), error);
    --desk.last;
    EXPECT_EQ(desk.board.setpoints, before);
  };
  desk.expect_refused(desk.ask_binary('T', std::string(move_bytes - 1, '\0')), Error::wrong_count);
  --desk.last;
  refused(Error::not_armed);
  desk.ask_binary('A');
  to[3] = longest_change() + 1;
  refused(Error::out_of_limits);
  to[3] = 0;
  to.back() = stage_limit + 1;
  refused(Error::out_of_limits);
  to.back() = -1;
  refused(Error::out_of_limits);
  to.back() = 0;
  EXPECT_EQ(desk.move(to).verb, 'T');
}

/// Before zeros are known a tendon goes 30 mm at a time; then as far as a change may be.
TEST(PanelMove, IsShortBeforeHoming) {
  PanelDesk desk;
  desk.ask_binary('A');
  const std::int32_t most = robot::motor.of(Length(30.0));
  std::vector<std::int32_t> to(drive_count, 0);
  for (const int sign : {1, -1}) {
    to[7] = sign * (most + 1);
    desk.expect_refused(desk.move(to), Error::out_of_limits);
    --desk.last;
    to[7] = sign * most;
    EXPECT_EQ(desk.move(to).verb, 'T');
    to[7] = 0;
    EXPECT_EQ(desk.move(to).verb, 'T');
  }
  desk.home();
  to[7] = longest_change();
  EXPECT_EQ(desk.move(to).verb, 'T');
  to[7] = -longest_change();
  EXPECT_EQ(desk.move(to).verb, 'T');
}

}  // namespace homing_test
}  // namespace sinew::firmware
