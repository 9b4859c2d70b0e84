/// The firmware itself, as it is flashed, on a simulated controller: all is asked over its UART.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "noise.hpp"
#include "paths.hpp"
#include "protocol/session.h"
#include "simulator/drives.hpp"

namespace sinew::firmware {
namespace simulated_test {

const std::string folder = test::firmware_folder;
const std::vector<int> straight(pose_size, 0);

struct Bench {
  explicit Bench(const std::string& elf = "sinew-firmware.elf") : controller(folder + '/' + elf) {}

  /// The next whole line, without its newline; nothing if it takes longer than a second.
  std::string line() {
    const std::uint64_t patience = controller.cycle() + controller.cycles(1.0);
    for (std::size_t end; controller.cycle() < patience;) {
      if ((end = heard.find('\n')) != std::string::npos) {
        const std::string found = heard.substr(0, end);
        heard.erase(0, end + 1);
        return found;
      }
      if (!controller.step()) return {};
      heard += controller.received();
    }
    return {};
  }
  Answer ask(const std::string& text) {
    controller.send(text + '\n');
    return read_answer(line());
  }
  Answer ask(char verb, std::span<const int> numbers = {}) { return ask(request(verb, ++last, numbers)); }
  /// What a host does first: the last number that was accepted is there to be read.
  Answer hello() {
    const Answer answer = ask(request('H', 0, {}, 0));
    if (answer.rest.size() == 10) last = static_cast<std::uint32_t>(std::stoul(answer.rest[8]));
    return answer;
  }
  void wait(double seconds) { controller.run(controller.cycles(seconds)); }
  double milliseconds_until(bool (*is_so)(const Bench&), double most) {
    const std::uint64_t start = controller.cycle();
    while (!is_so(*this) && controller.cycle() < start + controller.cycles(most)) controller.step();
    return 1e3 * static_cast<double>(controller.cycle() - start) / controller.frequency();
  }

  Controller controller;
  Drives drives{controller, drive_count};
  std::string heard;
  std::uint32_t last = 0;
};

bool are_disabled(const Bench& bench) { return !bench.drives.are_enabled(); }

void expect_setpoints(const Bench& bench, std::span<const int> pose) {
  EXPECT_TRUE(std::ranges::equal(bench.drives.setpoints, expected_setpoints(pose)));
  EXPECT_EQ(bench.drives.torn, 0u);
}

/// A walk over many poses; all bytes on SPI are those of the same table on this machine.
void walk(Bench& bench, int poses) {
  Noise random(3);
  ASSERT_EQ(bench.hello().verb, 'H');
  ASSERT_EQ(bench.ask('A').state, "armed");
  for (int i = 0; i < poses; ++i) {
    const std::vector<int> pose = random.pose();
    const std::size_t latched = bench.drives.latched;
    const Answer answer = bench.ask('P', pose);
    ASSERT_TRUE(answer.is_whole && answer.verb == 'P') << i << " code " << answer.code;
    ASSERT_GT(bench.drives.latched, latched);
    expect_setpoints(bench, pose);
    const Answer state = bench.ask('S');
    ASSERT_EQ(state.rest.size(), drive_count + bend_count + 1u);
    for (std::size_t k = 0; k < drive_count; ++k)
      ASSERT_EQ(state.rest[k], std::to_string(bench.drives.positions[k]));
    for (std::size_t k = 0; k < bend_count; ++k)
      ASSERT_NEAR(std::stoi(state.rest[drive_count + k]), pose[k], 8);
    ASSERT_EQ(state.rest.back(), std::string(drive_count, 'e'));
    expect_setpoints(bench, pose);
  }
}

TEST(FirmwareSimulated, PosesGoToTheDrives) {
  Bench bench;
  walk(bench, 100);
}

TEST(FirmwareSimulated, PosesGoToTheDrivesAtAMegabaud) {
  Bench bench("sinew-firmware-1m.elf");
  walk(bench, 100);
}

TEST(FirmwareSimulated, DrivesAreOffFromTheFirstInstructionUntilArmed) {
  Bench bench;
  for (const double end = 0.05; bench.controller.cycle() < bench.controller.cycles(end);) {
    bench.controller.step();
    ASSERT_TRUE(are_disabled(bench));
  }
  bench.hello();
  EXPECT_EQ(bench.ask('P', straight).code, static_cast<int>(Error::not_armed));
  EXPECT_EQ(bench.drives.latched, 0u);
}

TEST(FirmwareSimulated, ArmingKeepsTheDrivesWhereTheyAre) {
  for (const bool at_latch : {false, true}) {
    Bench bench;
    bench.drives.samples_at_latch = at_latch;
    for (std::size_t i = 0; i < drive_count; ++i)
      bench.drives.positions[i] = -12345 * static_cast<int>(i) + 5;
    const auto before = bench.drives.positions;
    bench.hello();
    EXPECT_EQ(bench.ask('A').state, "armed");
    EXPECT_TRUE(bench.drives.are_enabled());
    EXPECT_EQ(bench.drives.setpoints, before);
    EXPECT_EQ(bench.ask('S').state, "armed");
    EXPECT_EQ(bench.drives.positions, before);
  }
}

TEST(FirmwareSimulated, StatesComeFromTheCountsOfTheDrives) {
  Bench bench;
  bench.hello();
  bench.ask('A');
  bench.ask('P', Noise(5).pose());
  const std::int32_t much = robot::motor.of(Length(2.0));
  bench.drives.strain[0] = much;              // of section 1
  bench.drives.strain[tendon_count] = -much;  // of section 2
  const std::string states = bench.ask('S').rest.back();
  EXPECT_EQ(states.substr(0, tendon_count), std::string(tendon_count, 's'));
  EXPECT_EQ(states.substr(tendon_count, tendon_count), std::string(tendon_count, 'o'));
  EXPECT_EQ(states.substr(2 * tendon_count), std::string(drive_count - 2 * tendon_count, 'e'));
  // Whatever the encoders say, it fits: far out it saturates as on this machine.
  bench.drives.strain[1] = 2'000'000'000;
  bench.drives.strain[2] = -2'000'000'000;
  const Answer answer = bench.ask('S');
  ASSERT_EQ(answer.rest.size(), drive_count + bend_count + 1u);
  Counts counts;
  for (std::size_t i = 0; i < drive_count; ++i) counts[i] = std::stoi(answer.rest[i]);
  Bends bends;
  States expected;
  measure(counts, bends, expected, [] {});
  for (Uint8 i = 0; i < bend_count; ++i)
    EXPECT_EQ(answer.rest[drive_count + i], std::to_string(bend_at(bends, i).raw));
  for (Uint8 i = 0; i < drive_count; ++i)
    EXPECT_EQ(answer.rest.back()[i], letter_of(expected[i / tendon_count][i % tendon_count]));
}

TEST(FirmwareSimulated, DeadLineDisablesTheDrives) {
  Bench bench;
  bench.hello();
  bench.ask('A');
  const double time = bench.milliseconds_until(are_disabled, 1.0);
  EXPECT_GT(time, link_timeout - 10.0);  // counted from the request, not from its reply
  EXPECT_LT(time, link_timeout + 1.0);
  const Answer refused = bench.ask('P', straight);
  EXPECT_EQ(refused.code, static_cast<int>(Error::not_armed));
  EXPECT_EQ(refused.state, "lost");
  EXPECT_EQ(bench.ask(request('A', bench.last + 1)).state, "armed");
  EXPECT_TRUE(bench.drives.are_enabled());
}

TEST(FirmwareSimulated, FloodOfNoiseDisablesThemToo) {
  Bench bench;
  bench.hello();
  bench.ask('A');
  bench.controller.send(std::string(20000, '\n'));  // replies are far longer: the line out never rests
  const double time = bench.milliseconds_until(are_disabled, 1.0);
  EXPECT_LT(time, link_timeout + 30.0);
}

TEST(FirmwareSimulated, FramingErrorsAreErrors) {
  Bench bench;
  bench.hello();
  bench.ask('A');
  int until_fault = 20;
  bench.controller.line = [&](std::uint8_t byte) { return until_fault-- == 0 ? -1 : static_cast<int>(byte); };
  EXPECT_EQ(bench.ask(request('P', bench.last + 1, straight)).code, static_cast<int>(Error::checksum));
  EXPECT_EQ(bench.ask('P', straight).verb, 'P');
}

TEST(FirmwareSimulated, HangIsEndedByTheWatchdog) {
  Bench bench;
  bench.hello();
  bench.ask('A');
  bench.ask('P', Noise(7).pose());
  const auto before = bench.drives.setpoints;
  bench.controller.hang();
  const double time = bench.milliseconds_until(are_disabled, 1.0);
  EXPECT_LT(time, 160.0);  // 120 ms by an oscillator that no one has trimmed
  bench.controller.mend();
  bench.heard.clear();
  const Answer answer = bench.hello();
  ASSERT_EQ(answer.rest.size(), 10u);
  EXPECT_EQ(answer.rest.back(), "w");
  EXPECT_EQ(answer.state, "disarmed");
  EXPECT_EQ(bench.ask('P', straight).code, static_cast<int>(Error::not_armed));
  EXPECT_EQ(bench.drives.setpoints, before);
}

TEST(FirmwareSimulated, EachResetBeginsASession) {
  Bench bench;
  std::vector<std::string> recorded;
  for (std::uint32_t session = 1; session <= 10; ++session) {
    bench.hello();
    EXPECT_EQ(bench.last, 65536 * session - 1);
    EXPECT_EQ(bench.ask('A').state, "armed");
    for (const std::string& old : recorded)
      EXPECT_EQ(bench.ask(old).code, static_cast<int>(Error::other_session));
    recorded.push_back(request('P', bench.last + 1, straight));
    EXPECT_EQ(bench.ask('P', straight).verb, 'P');
    EXPECT_EQ(bench.ask(recorded.back()).code, static_cast<int>(Error::replayed));
    bench.controller.reset();
    bench.wait(0.03);
  }
}

TEST(FirmwareSimulated, NothingButAFreshValidFrameMovesTheDrives) {
  const int lines = lines_of(6000);
  Bench bench("sinew-firmware-1m.elf");
  Noise noise(2);
  std::vector<std::string> accepted;
  bench.hello();
  ASSERT_EQ(bench.ask('A').state, "armed");
  for (int i = 0; i < lines; ++i) {
    const auto before = bench.drives.setpoints;
    const std::string line = noise.line(bench.last, accepted);
    bench.controller.send(line);
    for (auto replies = std::ranges::count(line, '\n'); replies > 0; --replies) {
      const std::string reply = bench.line();
      const Answer answer = read_any_answer(reply);
      ASSERT_TRUE(answer.is_whole && answer.verb == '!' && answer.state == "armed") << line << reply;
    }
    ASSERT_EQ(bench.heard, "") << line;
    ASSERT_EQ(bench.drives.setpoints, before) << line;
    if (i % 20 != 0) continue;
    const std::vector<int> pose = noise.pose();
    ASSERT_EQ(bench.ask('P', pose).verb, 'P') << i;
    expect_setpoints(bench, pose);
    if (accepted.size() < 1000) accepted.push_back(request('P', bench.last, pose));
  }
}

/// Lines of the README's transcript: `> ` to the firmware, `< ` from it.
std::string transcript(const std::string& mark) {
  std::ifstream readme(std::string(test::source_folder) + "/firmware/README.md");
  std::string lines;
  for (std::string line; std::getline(readme, line);)
    if (line.starts_with(mark)) lines += line.substr(mark.size()) + '\n';
  return lines;
}

struct Outcome {
  std::string output;
  int status = -1;
};
Outcome simulate(const std::string& arguments) {
  Outcome run;
  std::FILE* pipe = popen((folder + "/sinew-simulate " + arguments + " 2>&1").c_str(), "r");
  if (!pipe) return run;
  for (int c; (c = std::fgetc(pipe)) != EOF;) run.output += static_cast<char>(c);
  run.status = WEXITSTATUS(pclose(pipe));
  return run;
}

TEST(FirmwareSimulator, ReplaysTheReadmesTranscript) {
  const std::string path = testing::TempDir() + "sinew-transcript.txt";
  std::ofstream(path) << transcript("> ");
  const Outcome run = simulate(folder + "/sinew-firmware.elf --turns < " + path);
  EXPECT_EQ(run.status, 0);
  EXPECT_GT(std::ranges::count(run.output, '\n'), 5);
  EXPECT_EQ(run.output, transcript("< "));
}

TEST(FirmwareSimulator, KeepsTheEeprom) {
  const std::string eeprom = testing::TempDir() + "sinew-eeprom.bin";
  const std::string hello = testing::TempDir() + "sinew-hello.txt";
  std::remove(eeprom.c_str());
  std::ofstream(hello) << request('H', 0) << '\n';
  for (const std::uint32_t session : {1u, 2u, 3u}) {
    const Outcome run = simulate(folder + "/sinew-firmware.elf --eeprom " + eeprom + " < " + hello);
    const Answer answer = read_answer(run.output.substr(0, run.output.size() - 1));
    ASSERT_EQ(answer.rest.size(), 10u) << run.output;
    EXPECT_EQ(answer.rest[8], std::to_string(65536 * session - 1));
  }
}

const std::string example = std::string(test::source_folder) + "/tests/firmware/trajectory.csv";

TEST(FirmwarePlayer, PlaysTheExample) {
  for (const char* name : {"sinew-firmware-insertion", "sinew-firmware-1m"}) {
    const Outcome run = simulate(folder + '/' + name + ".elf --play " + example);
    EXPECT_EQ(run.status, 0) << run.output;
    EXPECT_NE(run.output.find("rate                  1000.0 Hz\nreplies to the count  100 of 100\n"),
              std::string::npos)
        << run.output;
  }
}

/// A trajectory of few rows with the counts of this machine's table, `off` too many in one place.
std::string small_trajectory(int off, double bend) {
  std::string text = "# rows 20 ms apart\nname,time[s]";
  for (int m = 0; m < section_count; ++m)
    for (const char* column : {"_beta_1[rad]", "_beta_2[rad]"}) text += ",S" + std::to_string(m) + column;
  for (int i = 0; i < tendon_drives; ++i)
    text += ",S" + std::to_string(i / tendon_count) + "_counts_" + std::to_string(i % tendon_count + 1);
  for (int row = 0; row < 12; ++row) {
    const std::string angle = std::to_string(bend * row / 12);
    const std::vector<int> pose(pose_size, Angle(std::stod(angle)).raw);
    text += "\nx," + std::to_string(0.02 * row);
    for (int k = 0; k < bend_count; ++k) text += ',' + angle;
    auto counts = expected_setpoints(pose);
    counts.resize(tendon_drives);
    if (row == 5) counts[3] += off;
    for (const std::int32_t count : counts) text += ',' + std::to_string(count);
  }
  const std::string path = testing::TempDir() + "sinew-trajectory.csv";
  std::ofstream(path) << text << "\n";
  return path;
}

TEST(FirmwarePlayer, ComparesWithTheFilesCounts) {
  for (const int off : {0, -3}) {
    const Outcome run = simulate(folder + "/sinew-firmware-1m.elf --play " + small_trajectory(off, 0.3));
    EXPECT_EQ(run.status, 0) << run.output;
    EXPECT_NE(run.output.find("off the file's counts " + std::to_string(-off) + " at most"),
              std::string::npos)
        << run.output;
  }
}

TEST(FirmwarePlayer, FailsWhereAPoseIsRefused) {
  const Outcome run = simulate(folder + "/sinew-firmware-1m.elf --play " + small_trajectory(0, 1.0));
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.output.find("refused               out of limits"), std::string::npos) << run.output;
}

TEST(FirmwarePlayer, SaysWhatIsWrong) {
  const std::string elf = folder + "/sinew-firmware-1m.elf --play ",
                    bad = testing::TempDir() + "sinew-bad.csv";
  const auto error_of = [&](const std::string& text) {
    std::ofstream(bad) << text;
    const Outcome run = simulate(elf + bad);
    EXPECT_EQ(run.status, 2) << text;
    return run.output;
  };
  EXPECT_NE(error_of("").find("there is no row"), std::string::npos);
  EXPECT_NE(error_of("time[s],x\n0,1\n").find(":1: there is no column S0_beta_1[rad]"), std::string::npos);
  std::ifstream file(example);
  std::string head, line;
  for (int i = 0; i < 3 && std::getline(file, line); ++i) head += line + '\n';
  EXPECT_NE(error_of(head + "0.1,2\n").find(":4: 2 cells"), std::string::npos);
  EXPECT_NE(error_of(head + line + '\n').find(":4: times have to grow"), std::string::npos);
  EXPECT_EQ(simulate(elf + "/nowhere.csv").status, 2);
}

TEST(FirmwareSimulator, SaysWhatIsWrong) {
  EXPECT_EQ(simulate("--help").status, 0);
  for (const char* bad :
       {"", "--what", "missing.elf", "--cycles", "--cycles many x.elf", "/etc/passwd", "a b"}) {
    const Outcome run = simulate(bad);
    EXPECT_EQ(run.status, 2) << bad;
    EXPECT_TRUE(run.output.starts_with("sinew-simulate: ")) << bad;
    EXPECT_EQ(std::ranges::count(run.output, '\n'), 1) << run.output;
  }
}

}  // namespace simulated_test
}  // namespace sinew::firmware
