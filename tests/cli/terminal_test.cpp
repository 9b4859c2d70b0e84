// What only a terminal sees: colours, and tables of words as wide as it is.
#include <gtest/gtest.h>
#include <pty.h>

#include <algorithm>

#include "command.hpp"
#include "paths.hpp"

namespace terminal_test {

using namespace sinew::test;

using Words = std::vector<std::string>;

/// What a terminal of so many columns gets, stdout and stderr, from the command in an environment.
std::string on_terminal(Words arguments, unsigned short columns, const Words& environment = {"TERM=xterm"}) {
  const Scratch here;
  arguments.insert(arguments.begin(), command_path);
  Words variables{"/usr/bin/env", "-u", "NO_COLOR", "-u", "COLUMNS"};
  variables.insert(variables.end(), environment.begin(), environment.end());
  arguments.insert(arguments.begin(), variables.begin(), variables.end());
  std::vector<char*> argv;
  for (std::string& word : arguments) argv.push_back(word.data());
  argv.push_back(nullptr);
  const winsize size{.ws_row = 40, .ws_col = columns, .ws_xpixel = 0, .ws_ypixel = 0};
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, &size);
  if (child == 0) {
    if (chdir(here.path().c_str()) != 0) _exit(126);
    execv(argv[0], argv.data());
    _exit(127);
  }
  std::string screen;
  char buffer[4096];
  for (ssize_t count = 0; (count = read(terminal, buffer, sizeof buffer)) > 0;)
    screen.append(buffer, static_cast<std::size_t>(count));
  close(terminal);
  waitpid(child, nullptr, 0);
  std::erase(screen, '\r');
  return screen;
}

const Words solved{"inverse", "3-rfr", "--pose", "10 mm, -5 mm, 10 deg"};

TEST(Colours, AreOnTerminalsAlone) {
  const Scratch here;
  const std::string shown = on_terminal(solved, 80), plain = run_command(solved, here.path()).out;
  EXPECT_EQ(plain.find('\033'), std::string::npos);
  EXPECT_TRUE(shown.starts_with("\033[1minput")) << shown;
  EXPECT_NE(shown.find("\033[32mconverged, residual"), std::string::npos) << shown;
  EXPECT_NE(shown.find("\033[0m\n"), std::string::npos);
  Words json = solved;
  json.emplace_back("--json");
  EXPECT_EQ(on_terminal(json, 80).find('\033'), std::string::npos);
}

TEST(Colours, OfErrorsAreRedAndOfWarningsYellow) {
  EXPECT_TRUE(on_terminal({"inverse", "3-rfr"}, 80).starts_with("\033[31msinew inverse: "));
  EXPECT_TRUE(on_terminal({"check", "nope.yaml"}, 80).starts_with("\033[31m"));
  const std::string warned = on_terminal({"check", "3-rfrr"}, 80);
  EXPECT_NE(warned.find("\033[33mwarning:\033[0m "), std::string::npos) << warned;
}

TEST(Colours, AreNotShownToWhoWantsNone) {
  const Scratch here;
  const std::string plain = run_command(solved, here.path()).out;
  for (const Words& environment : {Words{"TERM=dumb"}, Words{"TERM=xterm", "NO_COLOR=1"}, Words{"TERM="}})
    EXPECT_EQ(on_terminal(solved, 80, environment), plain) << environment.back();
  EXPECT_NE(on_terminal(solved, 80, {"TERM=xterm", "NO_COLOR="}), plain);  // empty says nothing
}

std::size_t width_of(const std::string& text) {
  std::size_t most = 0;
  for (const std::string& line : lines_of(text))
    most = std::max(most, static_cast<std::size_t>(std::ranges::count_if(
                              line, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; })));
  return most;
}

TEST(Tables, OfWordsAreAsWideAsTheTerminal) {
  const Scratch here;
  const Words asked{"list"};
  const std::string wide = run_command(asked, here.path()).out;
  EXPECT_GT(width_of(wide), 120U);
  EXPECT_LE(width_of(on_terminal(asked, 80, {"TERM=dumb"})), 80U);
  EXPECT_LE(width_of(on_terminal(asked, 200, {"TERM=dumb", "COLUMNS=60"})), 60U);
  EXPECT_EQ(on_terminal(asked, 500, {"TERM=dumb"}), wide);
  const auto words_of = [](const std::string& text) {
    std::istringstream stream(text);
    Words words(std::istream_iterator<std::string>(stream), {});
    std::ranges::sort(words);
    return words;
  };
  EXPECT_EQ(words_of(on_terminal(asked, 70, {"TERM=dumb"})), words_of(wide));  // none is lost
}

TEST(Tables, OfReproduceAreBrokenAtBlanks) {
  const Words asked{"reproduce", "tdpcr/fig10", "-o", "made"};
  const std::string narrow = on_terminal(asked, 90, {"TERM=dumb"});
  const auto lines = lines_of(narrow);
  ASSERT_GE(lines.size(), 4U);
  for (const std::string& line : lines) {
    if (line.find(" | ") == std::string::npos) continue;
    EXPECT_LE(width_of(line), 90U) << line;
  }
}

}  // namespace terminal_test
