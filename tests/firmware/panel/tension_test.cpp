/// Over-tension, and that nothing but a fresh valid frame moves or zeroes anything, on a desk.
#include <gtest/gtest.h>

#include "noise.hpp"
#include "panel/panel_desk.hpp"
#include "thorough.hpp"

namespace sinew::firmware {
namespace tension_test {

using Setpoints = std::vector<std::int32_t>;
const std::vector<int> straight(pose_size, 0);
constexpr Uint16 above = tension_limit + 1;

struct TensionDesk : PanelDesk {
  TensionDesk() {
    ask_binary('A');
    home();
  }
  /// Long enough for an exchange that shows what the tensions are now: of a millisecond in which one has
  /// been made for another reason there is no other.
  void see() { wait(2); }
  Setpoints setpoints() const { return {board.setpoints.begin(), board.setpoints.end()}; }
};

TEST(PanelTension, StateTellsThem) {
  TensionDesk desk;
  for (int i = 0; i < tendon_drives; ++i)
    desk.board.tensions[static_cast<std::size_t>(i)] = static_cast<Uint16>(4000 * i + 1);
  const auto tensions = desk.state().tensions;
  for (int i = 0; i < tendon_drives; ++i)
    EXPECT_EQ(tensions[static_cast<std::size_t>(i)], (4000 * i + 1) / 256.0);
}

TEST(PanelTension, RampStopsWhereATendonComesAboveTheLimit) {
  for (const bool is_pose : {false, true}) {
    TensionDesk desk;
    std::vector<int> pose = straight;
    pose[0] = 1000;
    Setpoints to(drive_count, -4000);
    to.back() = 4000;
    is_pose ? desk.pose(pose, 100) : desk.move(to, 100);
    desk.wait(40);
    desk.board.tensions[5] = tension_limit;  // at the limit is not above it
    desk.wait(10);
    const auto before = desk.board.setpoints;
    desk.board.tensions[5] = above;
    desk.wait(1);  // it is told, and stops
    const auto stopped = desk.board.setpoints;
    desk.wait(80);
    EXPECT_EQ(desk.board.setpoints, stopped);
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LE(std::abs(stopped[i] - before[i]), 60);
    EXPECT_TRUE(desk.board.enabled);
    desk.board.tensions[5] = 0;
    desk.wait(20);
    EXPECT_EQ(desk.board.setpoints, stopped);  // by itself nothing goes on
  }
}

TEST(PanelTension, OnlyPayingOutIsLeft) {
  TensionDesk desk;
  desk.move(Setpoints(drive_count, 100));
  desk.board.tensions[4] = above;
  desk.see();
  Setpoints to = desk.setpoints();
  to[4] -= 1;
  desk.expect_refused(desk.move(to), Error::over_tension);
  --desk.last;
  desk.expect_refused(desk.move(to, 500), Error::over_tension);
  --desk.last;
  desk.expect_refused(desk.pose(straight), Error::over_tension);  // back to 0 takes all in
  --desk.last;
  EXPECT_EQ(desk.ask('P', straight).code, static_cast<int>(Error::over_tension));
  --desk.last;
  EXPECT_EQ(desk.setpoints(), Setpoints(drive_count, 100));
  to[4] += 1;  // where it is
  to[3] -= 50;
  EXPECT_EQ(desk.move(to).verb, 'T');
  to[4] += 500;
  EXPECT_EQ(desk.move(to, 50).verb, 'T');  // and its ramp is not stopped
  desk.wait(50);
  EXPECT_EQ(desk.setpoints(), to);
  desk.board.tensions[4] = 0;
  desk.see();
  EXPECT_EQ(desk.pose(straight).verb, 'P');
}

TEST(PanelTension, SecondTendonStopsARampThatRelaxesTheFirst) {
  TensionDesk desk;
  desk.board.tensions[0] = above;
  desk.see();
  Setpoints to(drive_count, 0);
  to[0] = 1000;
  to[1] = -1000;
  EXPECT_EQ(desk.move(to, 100).verb, 'T');
  desk.wait(50);
  EXPECT_EQ(desk.board.setpoints[0], 500);
  desk.board.tensions[1] = above;
  desk.wait(50);
  EXPECT_NEAR(desk.board.setpoints[1], -500, 11);
}

TEST(PanelTension, DamagedExchangeTellsNothing) {
  TensionDesk desk;
  Setpoints to(drive_count, 0);
  to[2] = -1000;
  desk.move(to, 100);
  desk.wait(10);
  desk.board.tensions[2] = 0xFFFF;
  desk.board.damaged_exchanges = 3;
  desk.wait(3);
  desk.board.tensions[2] = 0;
  desk.wait(87);
  EXPECT_EQ(desk.setpoints(), to);
}

/// Frames of `T` and `Z` as hosts send them, within limits.
std::string any_move(Noise& noise, std::uint32_t sequence, std::uint32_t hash = table_hash) {
  if (noise.below(3) == 0)
    return binary_request('Z', sequence, zero_payload(noise.below(drive_count), noise.below(2000)), hash);
  Setpoints to(drive_count);
  for (std::int32_t& count : to) count = noise.below(20000);
  return binary_request('T', sequence, move_payload(to, noise.below(2) ? 0 : noise.below(65536)), hash);
}
/// Whole and fresh, but not to be obeyed: drives that are not there, counts beyond any limit, payloads too
/// short or long.
std::string wrong_move(Noise& noise, std::uint32_t sequence) {
  const std::int32_t far = (1 << 24) * (noise.below(2) ? 1 : -1) * (1 + noise.below(100));
  if (noise.below(3) == 0) {
    const int drive = noise.below(drive_count);
    const std::string payload = zero_payload(drive, 0);
    switch (noise.below(4)) {
      case 0:
        return binary_request('Z', sequence, zero_payload(drive_count + noise.below(256 - drive_count), 0));
      case 1:
        return binary_request('Z', sequence, zero_payload(drive, far));
      case 2:
        return binary_request('Z', sequence, payload.substr(0, static_cast<std::size_t>(noise.below(5))));
      default:
        return binary_request('Z', sequence, payload + 'x');
    }
  }
  Setpoints to(drive_count);
  const std::string payload = move_payload(to);
  switch (noise.below(3)) {
    case 0:
      to[static_cast<std::size_t>(noise.below(drive_count))] = far;
      return binary_request('T', sequence, move_payload(to, noise.below(65536)));
    case 1:
      return binary_request(
          'T', sequence,
          payload.substr(0, static_cast<std::size_t>(noise.below(static_cast<int>(payload.size())))));
    default:
      return binary_request('T', sequence,
                            payload + std::string(static_cast<std::size_t>(1 + noise.below(4)), 'x'));
  }
}
/// None of which may be obeyed.
std::string bad_move(Noise& noise, std::uint32_t last) {
  const auto any = [&noise](std::size_t size) {
    return static_cast<std::size_t>(noise.below(static_cast<int>(size)));
  };
  const std::string good = any_move(noise, last + 1);
  switch (noise.below(7)) {
    case 6:
      return wrong_move(noise, last + 1);
    case 0:
      return any_move(noise, last - static_cast<std::uint32_t>(noise.below(50)));
    case 1:
      return any_move(noise, last + 1 + 65536 * static_cast<std::uint32_t>(1 + noise.below(9)));
    case 2:
      return any_move(noise, last + 1, table_hash ^ 1u << noise.below(32));
    case 3:
      return good.substr(0, any(good.size()));
    case 4:
      return good.substr(any(good.size() - 1) + 1);
    default:
      return noise.with_flips(good, 1 + noise.below(6));
  }
}

TEST(PanelNoise, NothingButAFreshValidFrameMovesOrZeroes) {
  const int frames = lines_of(test::count_of(60'000, 400'000));
  TensionDesk desk;
  Noise noise(11);
  int accepted = 0;
  for (int i = 0; i < frames; ++i) {
    const auto before = desk.board.setpoints;
    const std::string line = bad_move(noise, desk.last) + '\n';
    const std::string whole = i % 2 ? line : noise.binary(desk.last, {});
    const std::string replies = desk.ask_raw(whole);
    ASSERT_EQ(std::ranges::count(replies, '\n'), std::ranges::count(whole, '\n')) << i;
    std::istringstream stream(replies);
    for (std::string reply; std::getline(stream, reply);) {
      const Answer answer = read_any_answer(reply);
      ASSERT_TRUE(answer.is_whole);
      if (answer.verb != '!') ++accepted;
    }
    ASSERT_EQ(desk.board.setpoints, before) << i;
    if (i % 16 != 0) continue;
    ASSERT_EQ(desk.ask_binary('S').verb, 'S') << i;
    ASSERT_TRUE(std::ranges::equal(read_state(desk.payload).counts, before)) << i;  // no zero has changed
  }
  EXPECT_EQ(accepted, 0);
}

}  // namespace tension_test
}  // namespace sinew::firmware
