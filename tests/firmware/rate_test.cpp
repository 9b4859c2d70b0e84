/// A pose each millisecond over a line of 1 Mbaud, to the firmware itself on a simulated controller.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "frames.hpp"
#include "paths.hpp"
#include "protocol/session.h"
#include "simulator/drives.hpp"

namespace sinew::firmware {
namespace rate_test {

constexpr double period = 1e-3, byte_time = 10e-6;

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
      replies.push_back({line, now() + 2 * byte_time});
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

TEST(FirmwareRate, APoseEachMillisecond) {
  constexpr int poses = 3000;
  Bench bench;
  bench.run_until(0.05);
  std::uint32_t next = 0x10000;
  ASSERT_EQ(bench.ask(binary_request('A', next++)).state, "armed");
  bench.replies.clear();
  const double start = bench.now() + period;
  const std::size_t latched = bench.drives.latched;
  bench.run_until(start);
  const std::uint64_t asleep = bench.controller.asleep(), begun = bench.controller.cycle();
  std::vector<double> sent;
  for (int i = 0; i < poses; ++i) {
    const std::string frame = binary_pose(next + static_cast<std::uint32_t>(i), pose_at(i)) + '\n';
    bench.run_until(start + i * period);
    bench.controller.send(frame);
    sent.push_back(bench.now() + static_cast<double>(frame.size()) * byte_time);
  }
  bench.run_until(start + poses * period);
  const double idle = static_cast<double>(bench.controller.asleep() - asleep) /
                      static_cast<double>(bench.controller.cycle() - begun);
  bench.run_until(bench.now() + 5 * period);
  ASSERT_EQ(bench.replies.size(), static_cast<std::size_t>(poses));
  double worst = 0;
  for (std::size_t i = 0; i < poses; ++i) {
    std::string payload;
    const Answer answer = read_binary_answer(bench.replies[i].line, payload);
    ASSERT_TRUE(answer.is_whole && answer.verb == 'P') << i << " code " << answer.code;
    ASSERT_EQ(answer.sequence, next + i);
    ASSERT_EQ(answer.state, "armed");
    ASSERT_EQ(payload, expected_reply(pose_at(static_cast<int>(i)))) << i;
    worst = std::max(worst, bench.replies[i].time - sent[i]);
  }
  std::printf("%d poses at 1 kHz: a reply ends at most %.3f ms after its request, idle %.1f %%\n", poses,
              1e3 * worst, 100 * idle);
  EXPECT_LT(worst, 2 * period);
  EXPECT_GE(bench.drives.latched, latched + poses);
  EXPECT_EQ(bench.drives.torn + bench.drives.refused, 0u);
}

}  // namespace rate_test
}  // namespace sinew::firmware
