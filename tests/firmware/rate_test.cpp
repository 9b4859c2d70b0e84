/// A pose each millisecond over a line of 1 Mbaud, to the firmware itself on a simulated controller.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "noise.hpp"
#include "paths.hpp"
#include "protocol/session.h"
#include "simulator/drives.hpp"
#include "thorough.hpp"

namespace sinew::firmware {
namespace rate_test {

/// A path on which all sections and the stage move at once.
std::vector<int> pose_at(int i) {
  std::vector<int> pose;
  for (int k = 0; k < bend_count; ++k)
    pose.push_back(static_cast<int>(3000 * std::sin(0.004 * (k + 1) * i + 0.5 * k)));
  if (stage_count > 0) pose.push_back(20 * i);
  return pose;
}

/// A controller, its drives, and replies with the time at which their last byte has left.
struct Bench {
  Bench() {
    controller.on_sent = [this](std::uint8_t byte) {
      line += static_cast<char>(byte);
      if (byte != '\n') return;
      line.pop_back();
      // It is given to a register before the shift register, which may have a byte to finish.
      replies.push_back({line, now() + 2 * controller.byte_time()});
      line.clear();
    };
  }
  double now() const { return static_cast<double>(controller.cycle()) / controller.frequency(); }
  void run_until(double time) {
    if (time > now()) controller.run(controller.cycles(time - now()));
  }
  Answer ask(const std::string& frame) {
    replies.clear();
    controller.send(frame + '\n');
    const double patience = now() + 0.1;
    while (replies.empty() && now() < patience) controller.run(controller.cycles(1e-5));
    return replies.empty() ? Answer{} : read_binary_answer(replies.front().line, payload);
  }

  struct Reply {
    std::string line;
    double time;
  };
  Controller controller{std::string(test::firmware_folder) +
                        (stage_count > 0 ? "/sinew-firmware-insertion.elf" : "/sinew-firmware-1m.elf")};
  Drives drives{controller, drive_count};
  std::vector<Reply> replies;
  std::string line, payload;
};

/// Streams poses and holds each reply to its request; the worst time between their ends.
double stream(Bench& bench, int poses, double period) {
  bench.run_until(0.05);
  std::uint32_t next = 0x10000;
  EXPECT_EQ(bench.ask(binary_request('A', next++)).state, "armed");
  bench.replies.clear();
  const double start = bench.now() + period;
  const std::size_t latched = bench.drives.latched;
  std::vector<double> ends;
  for (int i = 0; i < poses; ++i) {
    const std::string frame = binary_pose(next + static_cast<std::uint32_t>(i), pose_at(i)) + '\n';
    bench.run_until(start + i * period);
    bench.controller.send(frame);
    ends.push_back(bench.now() + static_cast<double>(frame.size()) * bench.controller.byte_time());
  }
  bench.run_until(bench.now() + 5e-3);
  EXPECT_EQ(bench.replies.size(), ends.size());
  double worst = 0;
  for (std::size_t i = 0; i < std::min(bench.replies.size(), ends.size()); ++i) {
    const Answer answer = read_binary_answer(bench.replies[i].line, bench.payload);
    EXPECT_TRUE(answer.is_whole && answer.verb == 'P' && answer.state == "armed") << answer.code;
    EXPECT_EQ(answer.sequence, next + i);
    EXPECT_EQ(bench.payload, expected_reply(pose_at(static_cast<int>(i)))) << i;
    if (testing::Test::HasFailure()) break;
    worst = std::max(worst, bench.replies[i].time - ends[i]);
  }
  EXPECT_GE(bench.drives.latched, latched + ends.size());
  EXPECT_EQ(bench.drives.torn + bench.drives.refused, 0u);
  return worst;
}

TEST(FirmwareRate, APoseEachMillisecond) {
  Bench bench;
  const double worst = stream(bench, 3000, 1e-3);
  std::printf("3000 poses at 1 kHz: a reply ends at most %.3f ms after its request\n", 1e3 * worst);
  EXPECT_LT(worst, 2e-3);
}

TEST(FirmwareRate, ThereIsTimeToSpare) {
  Bench bench;
  const double worst = stream(bench, 2000, 0.9e-3);
  std::printf("2000 poses at 1.11 kHz: at most %.3f ms\n", 1e3 * worst);
  EXPECT_LT(worst, 2e-3);
}

TEST(FirmwareRate, RampsAtHalfTheRate) {
  Bench bench;
  bench.run_until(0.05);
  std::uint32_t next = 0x10000;
  bench.ask(binary_request('A', next++));
  bench.replies.clear();
  const std::size_t latched = bench.drives.latched;
  const double start = bench.now();
  for (int i = 0; i < 500; ++i) {
    bench.run_until(start + i * 2e-3);
    bench.controller.send(binary_pose(next++, pose_at(2 * i), 2) + '\n');
  }
  bench.run_until(start + 1.01);
  ASSERT_EQ(bench.replies.size(), 500u);
  for (std::size_t i = 0; i < 500; ++i) {
    read_binary_answer(bench.replies[i].line, bench.payload);
    ASSERT_EQ(bench.payload, expected_reply(pose_at(static_cast<int>(2 * i)))) << i;
  }
  EXPECT_EQ(bench.drives.positions, expected_setpoints(pose_at(998)));
  EXPECT_NEAR(static_cast<double>(bench.drives.latched - latched), 1010, 3);  // one a millisecond
}

TEST(FirmwareRate, SpiTakesEightBitsAtItsClock) {
  Bench bench;
  double selected = 0, latched = 0;
  bench.controller.watch_port_b(Drives::latch_bit,
                                [&](bool high) { (high ? latched : selected) = bench.now(); });
  bench.run_until(0.05);
  bench.ask(binary_request('A', 0x10000));
  const double bytes = 4 * drive_count + 2, shortest = bytes * 8 / 4e6;
  EXPECT_GT(latched - selected, shortest);
  EXPECT_LT(latched - selected, 1.5 * shortest);
}

TEST(FirmwareRate, FloodLosesFramesAndNothingElse) {
  Bench bench;
  bench.run_until(0.05);
  std::uint32_t next = 0x10000;
  bench.ask(binary_request('A', next++));
  bench.replies.clear();
  std::string flood;
  for (int i = 0; i < 1500; ++i) flood += binary_pose(next++, pose_at(i), i % 3) + '\n';
  bench.controller.send(flood);
  bench.run_until(bench.now() + 0.8);
  std::size_t accepted = 0;
  for (const auto& reply : bench.replies) {
    const Answer answer = read_binary_answer(reply.line, bench.payload);
    ASSERT_TRUE(read_any_answer(reply.line).is_whole);
    if (answer.verb == 'P') {
      ++accepted;
      ASSERT_EQ(bench.payload, expected_reply(pose_at(static_cast<int>(answer.sequence - 0x10001))));
    }
  }
  EXPECT_GT(accepted, 200u);
  EXPECT_EQ(bench.ask(binary_request('A', next++)).state, "armed");
  EXPECT_EQ(bench.ask(binary_pose(next++, pose_at(7))).verb, 'P');
  EXPECT_EQ(bench.drives.setpoints, expected_setpoints(pose_at(7)));
}

TEST(FirmwareRate, ResetWithinAFrame) {
  Bench bench;
  bench.run_until(0.05);
  bench.ask(binary_request('A', 0x10000));
  bench.ask(binary_pose(0x10001, pose_at(100), 1000));
  const std::string frame = binary_pose(0x10002, pose_at(5)) + '\n';
  bench.controller.send(frame.substr(0, 20));
  bench.run_until(bench.now() + 1e-3);
  bench.controller.reset();
  bench.run_until(bench.now() + 0.05);
  EXPECT_FALSE(bench.drives.are_enabled());
  const auto setpoints = bench.drives.setpoints;
  const Answer rest = bench.ask(frame.substr(20, frame.size() - 21));
  EXPECT_NE(rest.verb, 'P');
  EXPECT_EQ(bench.ask(binary_pose(0x10002, pose_at(5))).code, static_cast<int>(Error::other_session));
  EXPECT_EQ(bench.ask(binary_pose(0x20000, pose_at(5))).code, static_cast<int>(Error::not_armed));
  EXPECT_EQ(bench.drives.setpoints, setpoints);
  EXPECT_EQ(bench.ask(binary_request('A', 0x20000)).state, "armed");
}

TEST(FirmwareRate, SessionChangesWithoutWaiting) {
  Bench bench;
  bench.run_until(0.05);
  bench.ask(binary_request('A', 0x1EFF0));
  bench.replies.clear();
  const double start = bench.now();
  std::vector<std::uint32_t> sequences;
  for (std::uint32_t next = 0x1EFF1; next <= 0x1F020; ++next) sequences.push_back(next);
  for (std::uint32_t next = 0x1FFF0; next <= 0x20010; ++next) sequences.push_back(next);
  for (std::size_t i = 0; i < sequences.size(); ++i) {
    bench.run_until(start + static_cast<double>(i) * 1e-3);
    bench.controller.send(binary_pose(sequences[i], pose_at(static_cast<int>(i))) + '\n');
  }
  bench.run_until(bench.now() + 3e-3);
  ASSERT_EQ(bench.replies.size(), sequences.size());
  for (const auto& reply : bench.replies) EXPECT_EQ(read_binary_answer(reply.line, bench.payload).verb, 'P');
}

TEST(FirmwareRate, DamagedSpiIsNoticedAtBothEnds) {
  for (const bool outwards : {false, true}) {
    Bench bench;
    bench.run_until(0.05);
    std::uint32_t next = 0x10000;
    int every = 1, bytes = 0;
    const auto damage = [&](std::uint8_t byte) {
      return static_cast<std::uint8_t>(every > 0 && ++bytes % every == 0 ? byte ^ 0x10 : byte);
    };
    (outwards ? bench.drives.to_drives : bench.drives.from_drives) = damage;
    EXPECT_EQ(bench.ask(binary_request('A', next)).code, static_cast<int>(Error::drives));
    EXPECT_EQ(bench.drives.latched > 0, !outwards);
    every = 0;
    EXPECT_EQ(bench.ask(binary_request('A', next++)).state, "armed");
    // One exchange of three is damaged: nothing is lost but time.
    every = 3 * (4 * drive_count + 2);
    for (int i = 0; i < 100; ++i) {
      ASSERT_EQ(bench.ask(binary_pose(next++, pose_at(i))).state, "armed");
      bench.run_until(bench.now() + 3e-3);
      ASSERT_EQ(bench.drives.positions, expected_setpoints(pose_at(i)));
    }
    every = 1;
    const double start = bench.now();
    while (bench.drives.are_enabled() && bench.now() < start + 0.1) bench.run_until(bench.now() + 1e-4);
    EXPECT_LT(bench.now(), start + 1e-3 * (damage_limit + 2));
    EXPECT_EQ(bench.ask(binary_pose(next, pose_at(0))).state, "lost");
  }
}

TEST(FirmwareRate, NothingButAFreshValidFrameMovesTheDrives) {
  const int frames = test::count_of(3000, 30000);
  Bench bench;
  Noise noise(5);
  std::vector<std::string> accepted;
  bench.run_until(0.05);
  std::uint32_t last = 0x10000;
  ASSERT_EQ(bench.ask(binary_request('A', last)).state, "armed");
  for (int i = 0; i < frames; ++i) {
    const auto before = bench.drives.setpoints;
    const std::string lines = noise.binary(last, accepted);
    bench.replies.clear();
    bench.controller.send(lines);
    const auto count = static_cast<std::size_t>(std::ranges::count(lines, '\n'));
    const double patience = bench.now() + 0.1;
    while (bench.replies.size() < count && bench.now() < patience) bench.run_until(bench.now() + 1e-4);
    ASSERT_EQ(bench.replies.size(), count) << i;
    for (const auto& reply : bench.replies) {
      const Answer answer = read_any_answer(reply.line);
      ASSERT_TRUE(answer.is_whole && answer.verb == '!') << i;
    }
    ASSERT_EQ(bench.drives.setpoints, before) << i;
    if (i % 8 != 0) continue;
    const std::vector<int> pose = noise.pose();
    ASSERT_EQ(bench.ask(binary_pose(++last, pose)).verb, 'P') << i;
    ASSERT_EQ(bench.drives.setpoints, expected_setpoints(pose));
    if (accepted.size() < 100) accepted.push_back(binary_pose(last, pose));
  }
}

}  // namespace rate_test
}  // namespace sinew::firmware
