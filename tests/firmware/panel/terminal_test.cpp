/// sinew-simulate on a pseudo-terminal, as a program beside a host: faults on its stdin, frames through the
/// terminal.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "panel/panel_desk.hpp"
#include "paths.hpp"

extern char** environ;

namespace sinew::firmware {
namespace terminal_test {

constexpr int patience = 10'000;  ///< [ms]: a machine may be busy

/// The next line of a file; nothing if none comes.
std::string next_line(int file, std::string& heard, int milliseconds) {
  for (;;) {
    if (const std::size_t end = heard.find('\n'); end != std::string::npos) {
      const std::string line = heard.substr(0, end);
      heard.erase(0, end + 1);
      return line;
    }
    pollfd in{file, POLLIN, 0};
    std::array<char, 512> bytes{};
    if (poll(&in, 1, milliseconds) <= 0) return {};
    const ssize_t size = read(file, bytes.data(), bytes.size());
    if (size <= 0) return {};
    heard.append(bytes.data(), static_cast<std::size_t>(size));
  }
}

/// The program, its stdin and stdout, and its terminal.
struct Child {
  explicit Child(std::vector<std::string> more = {}) {
    std::array<int, 2> in{}, out{};
    if (pipe2(in.data(), O_CLOEXEC) != 0 || pipe2(out.data(), O_CLOEXEC) != 0) return;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in[0], 0);
    posix_spawn_file_actions_adddup2(&actions, out[1], 1);
    const std::string folder = test::firmware_folder, program = folder + "/sinew-simulate";
    std::vector<std::string> words = {
        program, folder + "/sinew-firmware-panel.elf", "--pty", link, "--arm", "nottingham-tpcj"};
    words.insert(words.end(), more.begin(), more.end());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    if (posix_spawn(&process, program.c_str(), &actions, nullptr, pointers.data(), environ) != 0)
      process = -1;
    posix_spawn_file_actions_destroy(&actions);
    close(in[0]);
    close(out[1]);
    input = in[1];
    output = out[0];
  }
  ~Child() {
    close(input);  // which ends it
    close(output);
    if (terminal >= 0) close(terminal);
    if (process > 0) waitpid(process, nullptr, 0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  std::string said() { return next_line(output, said_, patience); }
  std::string tell(const std::string& line) {
    const std::string whole = line + '\n';
    if (write(input, whole.data(), whole.size()) != static_cast<ssize_t>(whole.size())) return {};
    return said();
  }
  void open_terminal() {
    terminal = open(link.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    ASSERT_GE(terminal, 0);
    termios settings{};
    ASSERT_EQ(tcgetattr(terminal, &settings), 0);
    cfmakeraw(&settings);
    cfsetspeed(&settings, B1000000);
    ASSERT_EQ(tcsetattr(terminal, TCSANOW, &settings), 0);
  }
  Answer ask(char verb, const std::string& sent = {}, int milliseconds = patience) {
    const std::string frame = binary_request(verb, ++last, sent) + '\n';
    if (write(terminal, frame.data(), frame.size()) != static_cast<ssize_t>(frame.size())) return {};
    return read_any_answer_into(next_line(terminal, heard, milliseconds));
  }
  Answer read_any_answer_into(const std::string& line) { return read_binary_answer(line, payload); }
  int wait() {
    int status = -1;
    waitpid(process, &status, 0);
    process = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  const std::string link = testing::TempDir() + "sinew-panel-" + std::to_string(getpid());
  pid_t process = -1;
  int input = -1, output = -1, terminal = -1;
  std::uint32_t last = 0xFFFF;
  std::string said_, heard, payload;
};

TEST(Terminal, IsASerialPortWithAnArmAndFaults) {
  Child child;
  ASSERT_EQ(child.said(), "ready " + child.link);
  child.open_terminal();
  ASSERT_EQ(child.ask('H').verb, 'H');
  EXPECT_EQ(number_at(child.payload, 0, 1), 3u);
  child.last = number_at(child.payload, 12, 4);
  EXPECT_EQ(child.ask('A').state, "armed");
  ASSERT_EQ(child.ask('S').verb, 'S');
  EXPECT_EQ(read_state(child.payload).homed, 0u);

  // A stage that moves, in real time.
  std::vector<std::int32_t> to(drive_count, 0);
  to.back() = 4000;
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(child.ask('T', move_payload(to, 150)).verb, 'T');
  for (PanelState state; state.counts != to; state = read_state(child.payload)) {
    ASSERT_EQ(child.ask('S').verb, 'S');
    ASSERT_LT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(patience));
  }
  EXPECT_GT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(120));
  EXPECT_NEAR(nlohmann::json::parse(child.tell("state"))["stage"].get<double>(), 4000 / 4096.0 * 2e-3, 1e-6);

  EXPECT_EQ(child.tell("unplug"), "ok");
  EXPECT_EQ(child.ask('S', {}, 100).verb, 0);
  EXPECT_EQ(child.tell("plug"), "ok");
  std::this_thread::sleep_for(std::chrono::milliseconds(250));
  ASSERT_EQ(child.ask('S').verb, 'S');
  EXPECT_EQ(child.tell("cut 3 1"), "ok");
  EXPECT_EQ(nlohmann::json::parse(child.tell("state"))["cut"], std::vector<int>{6});
  EXPECT_TRUE(child.tell("cut 9 9").starts_with("? "));
  EXPECT_EQ(child.tell("reset"), "ok");
  ASSERT_EQ(child.ask('H').verb, 'H');
  EXPECT_EQ(number_at(child.payload, 12, 4), 0x1FFFFu);  // another session
  EXPECT_EQ(child.tell("quit"), "ok");
  EXPECT_EQ(child.wait(), 0);
  EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(child.link)));
}

TEST(Terminal, EndsWithItsInputOrASignal) {
  for (const bool by_signal : {false, true}) {
    Child child({"--motor-set", "{lead: 1 mm, counts: 1024}", "--seed", "7"});
    ASSERT_EQ(child.said(), "ready " + child.link);
    if (by_signal)
      kill(child.process, SIGTERM);
    else
      close(std::exchange(child.input, -1));
    EXPECT_EQ(child.wait(), 0);
    EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(child.link)));
  }
}

TEST(Terminal, SaysWhatIsWrong) {
  for (const std::vector<std::string>& bad :
       std::vector<std::vector<std::string>>{{"--arm", "nowhere.yaml"},
                                             {"--motor-set", "{lead: 2 kg, counts: 1}"},
                                             {"--pty", "/nowhere/at/all"}}) {
    Child child(bad);
    EXPECT_EQ(child.said(), "");
    EXPECT_EQ(child.wait(), 2);
  }
}

}  // namespace terminal_test
}  // namespace sinew::firmware
