// Ctrl-C: the first one stops the solve, which answers `stopped` with exit code 4; the second one ends the
// command at once. And the sign of life that a terminal shows meanwhile.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "command.hpp"
#include "paths.hpp"

namespace interrupt_test {

using namespace sinew::test;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// Soon, for a machine that has other work to do, and for a track that writes the samples it has.
constexpr auto soon = 3000ms;

/// The command under way, its output in files; stderr and the controlling terminal may be a pseudo-terminal.
class Running {
 public:
  enum class Errors { file, terminal };

  Running(std::vector<std::string> arguments, Errors errors, const std::string& input = {}) {
    arguments.insert(arguments.begin(), command_path);
    std::vector<char*> argv;
    for (std::string& word : arguments) argv.push_back(word.data());
    argv.push_back(nullptr);
    const std::string in = here_.path() / "in", out = here_.path() / "out", err = here_.path() / "err";
    if (!input.empty() && mkfifo(in.c_str(), 0600) != 0) std::abort();
    child_ = errors == Errors::terminal ? forkpty(&terminal_, nullptr, nullptr, nullptr) : fork();
    if (child_ == 0) {
      dup2(open(input.empty() ? "/dev/null" : in.c_str(), O_RDONLY), 0);
      dup2(open(out.c_str(), O_WRONLY | O_CREAT, 0600), 1);
      if (errors == Errors::file) dup2(open(err.c_str(), O_WRONLY | O_CREAT, 0600), 2);
      execv(argv[0], argv.data());
      _exit(127);
    }
    if (input.empty()) return;
    input_ = open(in.c_str(), O_WRONLY);  // stays open: the stream does not end by itself
    if (write(input_, input.data(), input.size()) != static_cast<ssize_t>(input.size())) std::abort();
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  ~Running() {
    if (child_ > 0) kill(child_, SIGKILL), waitpid(child_, nullptr, 0);
    for (const int file : {terminal_, input_})
      if (file >= 0) close(file);
  }

  void interrupt() const { kill(child_, SIGINT); }
  /// As the keyboard does.
  void press_control_c() const { ASSERT_EQ(write(terminal_, "\x03", 1), 1); }

  /// Whether the terminal shows it before long.
  bool shows(std::string_view text, std::chrono::milliseconds patience = 20s) {
    const auto until = Clock::now() + patience;
    while (screen_.find(text) == std::string::npos && Clock::now() < until) {
      pollfd one{.fd = terminal_, .events = POLLIN, .revents = 0};
      char buffer[4096];
      if (poll(&one, 1, 50) <= 0) continue;
      const ssize_t count = read(terminal_, buffer, sizeof buffer);
      if (count <= 0) break;  // the command has ended
      screen_.append(buffer, static_cast<std::size_t>(count));
    }
    return screen_.find(text) != std::string::npos;
  }
  const std::string& screen() const { return screen_; }

  bool has_ended() {
    int status = 0;
    if (child_ > 0 && waitpid(child_, &status, WNOHANG) == child_) {
      child_ = -1;
      exit_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    return child_ < 0;
  }
  bool ends_within(std::chrono::milliseconds patience) {
    for (const auto until = Clock::now() + patience; !has_ended() && Clock::now() < until;)
      std::this_thread::sleep_for(1ms);
    return child_ < 0;
  }
  /// Waits until it has computed for a while, however busy the machine is; whether it then goes on.
  bool computes() {
    clockid_t clock{};
    timespec time{};
    if (child_ < 0 || clock_getcpuclockid(child_, &clock) != 0) return false;
    for (const auto until = Clock::now() + 60s; !has_ended() && Clock::now() < until;) {
      if (clock_gettime(clock, &time) == 0 && (time.tv_sec > 0 || time.tv_nsec > 250'000'000)) return true;
      std::this_thread::sleep_for(1ms);
    }
    return false;
  }
  int exit() const { return exit_; }
  std::string out() const { return read_text(here_.path() / "out"); }
  std::string err() const { return read_text(here_.path() / "err"); }

 private:
  Scratch here_;
  pid_t child_ = -1;
  int terminal_ = -1, input_ = -1, exit_ = -1;
  std::string screen_;
};

using Words = std::vector<std::string>;

/// Takes seconds: rods that bear torque, searched from many starts.
const Words long_work{"forward", "hexapod-torsion", "--inputs",
                      "410 mm, 410 mm, 405 mm, 405 mm, 405 mm, 405 mm", "--all"};

class Stopped : public testing::TestWithParam<Words> {};

TEST_P(Stopped, ByTheFirstInterruptItSaysSo) {
  Words words = GetParam();
  Running run(words, Running::Errors::file);
  ASSERT_TRUE(run.computes()) << "the work is too short for this test";
  run.interrupt();
  ASSERT_TRUE(run.ends_within(soon));
  EXPECT_EQ(run.exit(), 4) << run.err();
  EXPECT_NE(run.err().find("stopped"), std::string::npos) << run.err();
  if (words.back() == "--json") {
    EXPECT_NE(run.out().find(R"("status":"stopped")"), std::string::npos) << run.out().substr(0, 300);
    EXPECT_TRUE(run.out().ends_with("}\n"));
  }
}

INSTANTIATE_TEST_SUITE_P(
    OfEveryKind, Stopped,
    testing::Values(Words{long_work[0], long_work[1], long_work[2], long_work[3], "--all", "--json"},
                    long_work,
                    Words{"branches", "hexapod-torsion", "--inputs",
                          "410 mm, 410 mm, 405 mm, 405 mm, 405 mm, 405 mm", "--to-wrench",
                          "0, 0, -20 N, 0, 0, 0", "--range", "0, 5", "--samples", "20000", "--all", "--json"},
                    Words{"track", "6-ufs", "--from", "0, 0, 180 mm, 0, 0, 0", "--to",
                          "10 mm, 5 mm, 180 mm, 0, 10 deg, 0", "--samples", "100000", "--json"},
                    Words{"identify", "ftdcr-v6", std::string(source_folder) + "/data/measured/ftdcr-v6.csv",
                          "--json"},
                    Words{"map", "6-ufs", "--x", "-20 mm : 20 mm : 1000", "--y", "-20 mm : 20 mm : 1000",
                          "--z", "180 mm : 190 mm : 10"}),
    [](const auto& test) { return fmt::format("{}{}", test.param.front(), test.index); });

TEST(Interrupt, TheSecondOneEndsItAtOnce) {
  Running run(long_work, Running::Errors::file);
  ASSERT_TRUE(run.computes());
  run.interrupt();
  run.interrupt();  // they may become one
  std::this_thread::sleep_for(20ms);
  run.interrupt();
  ASSERT_TRUE(run.ends_within(soon));
  EXPECT_EQ(run.exit(), 4);
}

TEST(Interrupt, TheLineUnderWayOfAStreamIsAnsweredAndNoOther) {
  const std::string line =
      R"({"id": 1, "query": "forward", "inputs": [0.41, 0.41, 0.405, 0.405, 0.405, 0.405], "all": true})";
  Running run({"query", "hexapod-torsion"}, Running::Errors::file, line + '\n' + line + '\n');
  ASSERT_TRUE(run.computes());
  run.interrupt();
  ASSERT_TRUE(run.ends_within(soon));
  EXPECT_EQ(run.exit(), 4);
  const auto answers = lines_of(run.out());
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_NE(answers[0].find(R"("status":"stopped")"), std::string::npos) << answers[0];
}

TEST(Interrupt, AStreamThatWaitsEndsWithoutAnAnswer) {
  Running run({"query", "3-rfr"}, Running::Errors::file, "\n");
  std::this_thread::sleep_for(700ms);
  run.interrupt();
  ASSERT_TRUE(run.ends_within(soon));
  EXPECT_EQ(run.exit(), 4);
  EXPECT_EQ(run.out(), "");
}

TEST(Terminal, ShowsThatItIsSolvingAndHowToStopIt) {
  Running run(long_work, Running::Errors::terminal);
  ASSERT_TRUE(run.shows("solving; Ctrl-C stops it")) << run.screen();
  EXPECT_EQ(run.screen().find_first_of(".s"), 2U) << run.screen();  // "\r0.5 s ...", later on a busy machine
  run.press_control_c();
  ASSERT_TRUE(run.shows("stopping; Ctrl-C again ends it at once", 500ms) || run.shows("stopped", soon))
      << run.screen();
  run.press_control_c();
  ASSERT_TRUE(run.ends_within(soon));
  EXPECT_EQ(run.exit(), 4);
}

TEST(Terminal, IsLeftAsItWasWhereTheWorkIsShort) {
  for (const Words& words : {Words{"forward", "3-rfr", "--inputs", "0.19, 0.19, 0.188"}}) {
    Running run(words, Running::Errors::terminal);
    EXPECT_FALSE(run.shows("solving", 2s)) << run.screen();
    ASSERT_TRUE(run.ends_within(soon));
    EXPECT_EQ(run.exit(), 0);
    EXPECT_EQ(run.screen(), "");
  }
}

TEST(Terminal, ShowsNothingWhenQuietAndAFileNeverDoes) {
  Words quiet = long_work;
  quiet.emplace_back("-q");
  Running run(quiet, Running::Errors::terminal);
  EXPECT_FALSE(run.shows("solving", 1s)) << run.screen();
  Running into_a_file(long_work, Running::Errors::file);
  std::this_thread::sleep_for(1s);
  EXPECT_EQ(into_a_file.err(), "");
}

}  // namespace interrupt_test
