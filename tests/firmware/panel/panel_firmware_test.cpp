/// The panel's firmware itself on a simulated controller, with a simulated arm on its drives.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>

#include "noise.hpp"
#include "panel/panel_desk.hpp"
#include "paths.hpp"
#include "simulator/drives.hpp"
#include "simulator/simulated_arm.hpp"
#include "sinew/io/robot_file.hpp"
#include "thorough.hpp"

namespace sinew::firmware {
namespace panel_firmware_test {

using Setpoints = std::vector<std::int32_t>;

struct Bench {
  Bench() { drives.follow_at_once = false; }

  /// Time goes on for controller and arm.
  void run(double seconds) {
    for (double left = seconds; left > 0; left -= 1e-3) {
      controller.run(controller.cycles(std::min(left, 1e-3)));
      arm.advance(1e-3, drives.setpoints, drives.are_enabled());
      for (std::size_t i = 0; i < arm.drive_count(); ++i) drives.positions[i] = arm.count(i);
      for (std::size_t i = 0; i < arm.tendon_count(); ++i)
        drives.tensions[i] = static_cast<std::uint16_t>(std::min(256 * arm.tension(i), 65535.0));
    }
  }
  Answer ask(char verb, const std::string& sent = {}) {
    if (last % 65536 == 65535 && verb != 'H') last = 0xFFFF;
    controller.send(binary_request(verb, ++last, sent) + '\n');
    std::string heard;
    for (int i = 0; i < 100 && heard.find('\n') == std::string::npos; ++i) {
      run(1e-3);
      heard += controller.received();
    }
    if (std::ranges::count(heard, '\n') != 1) return {};
    return read_binary_answer(heard.substr(0, heard.size() - 1), payload);
  }
  PanelState state() {
    EXPECT_EQ(ask('S').verb, 'S');
    return read_state(payload);
  }
  void start() {
    run(0.02);
    ASSERT_EQ(ask('A').verb, 'A');
  }
  Answer move(const Setpoints& to, int duration) { return ask('T', move_payload(to, duration)); }
  Answer pose(const std::vector<int>& pose, int duration) { return ask('P', pose_payload(pose, duration)); }
  /// Tendons in turn: taken in until one pulls, and that is its zero.
  void home() {
    const std::int32_t step = 40;  // 20 um
    Setpoints to = state().counts;
    for (int i = 0; i < tendon_drives; ++i) {
      const auto tendon = static_cast<std::size_t>(i);
      for (int steps = 0; steps < 400 && state().tensions[tendon] < 0.1; ++steps) {
        to[tendon] -= step;
        ASSERT_EQ(move(to, 2).verb, 'T');
        run(2e-3);
      }
      ASSERT_EQ(ask('Z', zero_payload(i, 0)).verb, 'Z') << i;
      to[tendon] = 0;
    }
    ASSERT_EQ(ask('Z', zero_payload(tendon_drives, 0)).verb, 'Z');
  }

  Controller controller{std::string(test::firmware_folder) + "/sinew-firmware-panel.elf"};
  Drives drives{controller, drive_count, tendon_drives};
  SimulatedArm arm{*load_serial("nottingham-tpcj")};
  std::string payload;
  std::uint32_t last = 0xFFFF;
};

/// Whoever has homed it sees that the arm goes where it is told.
TEST(PanelFirmware, HomesAndPosesAndStopsOverTension) {
  Bench bench;
  bench.start();
  const std::vector<int> straight(pose_size, 0);
  EXPECT_EQ(bench.pose(straight, 0).code, static_cast<int>(Error::not_homed));
  --bench.last;
  EXPECT_EQ(bench.state().homed, 0u);
  bench.home();
  EXPECT_EQ(bench.state().homed, 0xFFFFu);
  for (const Bend& bend : bench.arm.bends()) EXPECT_LT(bend.norm(), 0.03);

  std::vector<int> pose(pose_size, 0);
  for (int k = 0; k < bend_count; ++k) pose[static_cast<std::size_t>(k)] = Angle(k % 3 ? 0.2 : -0.15).raw;
  pose.back() = 20'000;
  ASSERT_EQ(bench.pose(pose, 300).verb, 'P');
  bench.run(0.15);
  bench.state();  // a sign of life
  bench.run(0.16);
  EXPECT_EQ(bench.state().counts, expected_setpoints(pose));
  EXPECT_EQ(bench.state().letters, std::string(tendon_drives, 'e'));
  double off = 0;
  for (std::size_t m = 0; m < section_count; ++m)
    for (int axis = 0; axis < 2; ++axis)
      off = std::max(
          off, std::abs(bench.arm.bends()[m][axis] - pose[2 * m + static_cast<std::size_t>(axis)] / 8192.0));
  std::printf("bends off by %.4f rad at most\n", off);
  EXPECT_LT(off, 0.07);  // stretch, friction, backlash, zeros
  EXPECT_NEAR(bench.arm.stage(), 20'000 / 4096.0 * 2e-3, 1e-6);

  // All tendons of the last section against one another, until the firmware stops them.
  Setpoints to = bench.state().counts;
  for (int i = tendon_drives - tendon_count; i < tendon_drives; ++i) to[static_cast<std::size_t>(i)] -= 2000;
  ASSERT_EQ(bench.move(to, 150).verb, 'T');
  bench.run(0.18);
  const PanelState stopped = bench.state();
  const double most = std::ranges::max(stopped.tensions);
  std::printf("stopped at %.2f N\n", most);
  EXPECT_GT(most, tension_limit / 256.0);
  EXPECT_LT(most, tension_limit / 256.0 + 3);
  EXPECT_GT(stopped.counts[tendon_drives - 1], to[tendon_drives - 1]);
  EXPECT_EQ(bench.move(to, 50).code, static_cast<int>(Error::over_tension));
  --bench.last;
  bench.run(0.05);
  EXPECT_EQ(bench.state().counts, stopped.counts);
  to = stopped.counts;
  for (int i = tendon_drives - tendon_count; i < tendon_drives; ++i) to[static_cast<std::size_t>(i)] += 400;
  EXPECT_EQ(bench.move(to, 50).verb, 'T');
  bench.run(0.06);
  EXPECT_EQ(bench.state().counts, to);
  EXPECT_LT(std::ranges::max(bench.state().tensions), 15);
  EXPECT_EQ(bench.drives.torn + bench.drives.refused, 0u);
}

/// Binary frames of all verbs with wrong bits, and bytes at random.
TEST(PanelFirmware, BadFramesMoveNothing) {
  const int frames = lines_of(test::count_of(10'000, 60'000));
  Bench bench;
  bench.start();
  const auto before = bench.drives.setpoints;
  Noise noise(21);
  const auto any = [&noise](std::size_t size) {
    return static_cast<std::size_t>(noise.below(static_cast<int>(size)));
  };
  const std::vector<std::string> good = {
      binary_request('T', 0x10005, move_payload(Setpoints(drive_count, 300), 3)),
      binary_request('Z', 0x10005, zero_payload(3, 77)),
      binary_request('P', 0x10005, pose_payload(noise.pose())), binary_request('D', 0x10005),
      binary_request('A', 0x10005)};
  int replies = 0, accepted = 0;
  std::string heard, payload;
  const auto listen = [&] {
    heard += bench.controller.received();
    for (std::size_t end; (end = heard.find('\n')) != std::string::npos; heard.erase(0, end + 1)) {
      const Answer answer = read_any_answer(heard.substr(0, end));
      ++replies;
      if (!answer.is_whole || answer.verb != '!') ++accepted;
    }
  };
  for (int i = 0; i < frames; ++i) {
    std::string line = good[any(good.size())];
    if (i % 3 == 0) {
      line.assign(1 + any(30), '\0');
      for (char& byte : line) byte = static_cast<char>(noise.below(256));
    } else {
      line = noise.with_flips(line, 1 + noise.below(4));
    }
    bench.controller.send(line + '\n');
    if (i % 64 == 0) {
      bench.run(64 * 0.4e-3);
      listen();
      ASSERT_EQ(bench.drives.setpoints, before) << i;
    }
  }
  bench.run(0.1);
  while (!bench.controller.all_sent()) bench.run(0.01);
  bench.run(0.05);
  listen();
  std::printf("%d frames, %d replies\n", frames, replies);
  EXPECT_GT(replies, frames / 2);  // a burst may be longer than the buffer
  EXPECT_EQ(accepted, 0);
  EXPECT_EQ(bench.drives.setpoints, before);
  // It still listens, and no zero has been set.
  ASSERT_EQ(bench.ask('A').verb, 'A');
  const PanelState state = bench.state();
  EXPECT_EQ(state.homed, 0u);
  EXPECT_TRUE(std::ranges::all_of(state.counts, [](std::int32_t count) { return count == 0; }));
}

/// By exact PCC, with tensions and zeros: a pose takes more than two milliseconds, in which no exchange goes
/// out.
TEST(PanelFirmware, TakesAPoseEachFourMilliseconds) {
  const int period = 4;  // [ms]
  Bench bench;
  bench.start();
  for (int i = 0; i < drive_count; ++i) ASSERT_EQ(bench.ask('Z', zero_payload(i, 0)).verb, 'Z');
  std::vector<int> pose(pose_size, 0);
  int accepted = 0;
  double latest = 0;
  std::string line;
  const auto now = [&] {
    return static_cast<double>(bench.controller.cycle()) / bench.controller.frequency();
  };
  double heard_whole = 0;  ///< when the last request had come
  bench.controller.on_sent = [&](std::uint8_t byte) {
    if (byte != '\n') return void(line += static_cast<char>(byte));
    accepted += read_binary_answer(line, bench.payload).verb == 'P';
    latest = std::max(latest, now() + 2 * bench.controller.byte_time() - heard_whole);
    line.clear();
  };
  const int poses = 500;
  const std::size_t latched = bench.drives.latched;
  for (int i = 0; i < poses; ++i) {
    std::ranges::fill(pose, static_cast<int>(500 * std::sin(0.1 * i)));
    pose.back() = 10 * i;
    const std::string frame = binary_pose(++bench.last, pose, period) + '\n';
    heard_whole = now() + static_cast<double>(frame.size()) * bench.controller.byte_time();
    bench.controller.send(frame);
    bench.controller.run(bench.controller.cycles(1e-3 * period));
  }
  bench.controller.run(bench.controller.cycles(1e-3 * (period + 1)));
  std::printf("%d of %d poses at 250 Hz, a reply ends at most %.3f ms after its request\n", accepted, poses,
              1e3 * latest);
  EXPECT_EQ(accepted, poses);
  EXPECT_LT(latest, 4e-3);
  EXPECT_EQ(bench.drives.setpoints, expected_setpoints(pose));
  const double exchanges = static_cast<double>(bench.drives.latched - latched) / poses;
  std::printf("%.2f exchanges a pose\n", exchanges);
  EXPECT_GT(exchanges, 1.9);
  bench.controller.on_sent = nullptr;
}

/// Tensions stop what pulls too much within an exchange: none may be away for long, whatever is computed.
TEST(PanelFirmware, NoRequestKeepsTheDrivesWaiting) {
  Bench bench;
  bench.start();
  for (int i = 0; i < drive_count; ++i) ASSERT_EQ(bench.ask('Z', zero_payload(i, 0)).verb, 'Z');
  const std::vector<int> pose(pose_size, 2000);
  ASSERT_EQ(bench.pose(pose, 100).verb, 'P');
  bench.run(0.15);
  const std::string pose_again = pose_payload(pose, 40), moves = move_payload(bench.drives.setpoints, 40);
  for (const auto& [verb, sent] : {std::pair('S', std::string()), {'P', pose_again}, {'T', moves}}) {
    bench.controller.send(binary_request(verb, ++bench.last, sent) + '\n');
    double longest = 0, since = 0;
    std::size_t latched = bench.drives.latched;
    for (int i = 0; i < 400; ++i) {
      bench.controller.run(bench.controller.cycles(5e-5));
      since = std::exchange(latched, bench.drives.latched) == bench.drives.latched ? since + 5e-5 : 0;
      longest = std::max(longest, since);
    }
    std::printf("%c: %.2f ms without an exchange\n", verb, 1e3 * longest);
    EXPECT_LT(longest, 3e-3) << verb;
    bench.run(5e-3);
  }
}

/// One direction of SPI, on which some exchanges have one to three wrong bits.
struct DamagedWire {
  std::uint8_t operator()(std::uint8_t byte) {
    if (at == 0) {
      const bool is_damaged = every > 0 && ++exchanges % every == 0;
      mask = is_damaged ? noise.with_flips(std::string(size, 0), 1 + noise.below(3)) : std::string(size, 0);
    }
    const auto wrong = static_cast<std::uint8_t>(mask[at]);
    at = (at + 1) % size;
    return byte ^ wrong;
  }

  static constexpr std::size_t size = 4 * drive_count + 2 * tendon_drives + 2;
  Noise noise{31};
  int every = 0, exchanges = 0;
  std::size_t at = 0;
  std::string mask;
};

struct DamagedBench : Bench {
  explicit DamagedBench(bool outwards) {
    auto& side = outwards ? drives.to_drives : drives.from_drives;
    side = [this](std::uint8_t byte) { return wire(byte); };
    start();
    for (int i = 0; i < drive_count; ++i) EXPECT_EQ(ask('Z', zero_payload(i, 0)).verb, 'Z');
    origin = drives.setpoints;
  }
  /// Whether all that drives were told for so long lies between two of the host's setpoints.
  bool stay_between(const Setpoints& from, const Setpoints& to, double seconds) {
    for (double left = seconds; left > 0; left -= 1e-3) {
      run(1e-3);
      for (std::size_t i = 0; i < to.size(); ++i) {
        const auto [least, most] = std::minmax(from[i], to[i]);
        const std::int32_t now = drives.setpoints[i] - origin[i];
        if (now < least || now > most) return false;
      }
    }
    return true;
  }
  Setpoints told() const {
    Setpoints counts(drive_count);
    std::ranges::transform(drives.setpoints, origin, counts.begin(), std::minus());
    return counts;
  }
  /// Asked again where the drives' answer was damaged, each time another while later.
  Answer insist(char verb, const std::string& sent = {}) {
    Answer answer = ask(verb, sent);
    for (int i = 1; i < 20 && answer.code == static_cast<int>(Error::drives); ++i) {
      run(1e-3 * i);
      answer = ask(verb, sent);
    }
    return answer;
  }

  DamagedWire wire;
  Setpoints origin;  ///< the drives' own counts where the host's are zero
};

/// Between this controller and its drives: what is damaged is noticed, and the next exchange mends it.
TEST(PanelFirmware, DamagedExchangesCostTimeAndNothingElse) {
  for (const bool outwards : {false, true}) {
    DamagedBench bench(outwards);
    bench.wire.every = 3;
    Setpoints from(drive_count, 0);
    for (int i = 0; i < test::count_of(30, 300); ++i) {
      Setpoints to(drive_count, 0);  // or straight by a pose, only the stage elsewhere
      const bool is_pose = i % 3 == 2;
      for (std::int32_t& count : to) count = is_pose ? 0 : bench.wire.noise.below(4000);
      to.back() = bench.wire.noise.below(4000);
      std::vector<int> straight(pose_size, 0);
      straight.back() = to.back();
      const Answer moved = is_pose ? bench.pose(straight, 40) : bench.move(to, 40);
      ASSERT_EQ(moved.verb, is_pose ? 'P' : 'T') << i << " code " << moved.code;
      ASSERT_TRUE(bench.stay_between(from, to, 0.05)) << i;
      ASSERT_EQ(bench.told(), to) << i;
      ASSERT_EQ(bench.insist('S').verb, 'S');
      // A tendon whose place was read wrong would jump: it is where its setpoint is.
      bench.run(0.1);
      const int drive = i % drive_count;
      const Answer zeroed = bench.insist('Z', zero_payload(drive, to[static_cast<std::size_t>(drive)]));
      ASSERT_EQ(zeroed.verb, 'Z') << i << " code " << zeroed.code;
      ASSERT_EQ(bench.told(), to) << i;
      ASSERT_TRUE(bench.drives.are_enabled());
      from = to;
    }
    ASSERT_EQ(bench.insist('S').verb, 'S');
    EXPECT_GT(read_state(bench.payload).damaged, 1000u);
  }
}

/// Five in a row let go, wherever it was; what is armed anew stays there.
TEST(PanelFirmware, FiveDamagedExchangesLetGo) {
  for (const bool outwards : {false, true}) {
    DamagedBench bench(outwards);
    const Setpoints from(drive_count, 0), to(drive_count, 8000);
    ASSERT_EQ(bench.move(to, 400).verb, 'T');
    ASSERT_TRUE(bench.stay_between(from, to, 0.1));
    bench.wire.every = 1;
    const Setpoints before = bench.told();
    const std::uint64_t begin = bench.controller.cycle();
    while (bench.drives.are_enabled() && bench.controller.cycle() < begin + bench.controller.cycles(0.1))
      bench.controller.step();
    const double time = static_cast<double>(bench.controller.cycle() - begin) / bench.controller.frequency();
    std::printf("let go %.2f ms after the first\n", 1e3 * time);
    EXPECT_LT(time, 1e-3 * (damage_limit + 2));
    const Setpoints stopped = bench.told();
    // What drives refuse they do not follow; else the ramp went on till then.
    const int most = outwards ? 0 : (damage_limit + 2) * 8000 / 400;
    for (std::size_t i = 0; i < stopped.size(); ++i) {
      EXPECT_GE(stopped[i], before[i]);
      EXPECT_LE(stopped[i], before[i] + most);
    }
    const Answer refused = bench.ask('A');
    EXPECT_EQ(refused.code, static_cast<int>(Error::drives));
    EXPECT_EQ(refused.state, "lost");
    EXPECT_FALSE(bench.drives.are_enabled());
    bench.wire.every = 0;
    bench.run(0.2);  // an arm that was let go comes to rest
    const auto rest = bench.drives.positions;
    ASSERT_EQ(bench.ask('A').verb, 'A');
    bench.run(0.1);
    EXPECT_EQ(bench.drives.positions, rest);
    EXPECT_EQ(bench.state().homed, 0xFFFFu);
  }
}

}  // namespace panel_firmware_test
}  // namespace sinew::firmware
