#include "terminal.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

#include "io/document/visible.hpp"

namespace sinew::cli {
namespace {

static_assert(std::atomic<bool>::is_always_lock_free);  // a handler of signals may set it then
std::atomic<bool> has_signal = false;
volatile std::sig_atomic_t wait_for_end_of_line = 0;

extern "C" void on_signal(int) {
  if (!wait_for_end_of_line || has_signal.exchange(true)) _exit(stopped);
}

/// Where a style begins, in characters for private use, which pass `visible`; and what a terminal takes for
/// it.
struct Mark {
  std::string_view mark, escape;
};
constexpr std::array<Mark, 4> marks{
    {{"\uE000", "\033[1m"}, {"\uE001", "\033[32m"}, {"\uE002", "\033[31m"}, {"\uE003", "\033[33m"}}};
constexpr std::string_view end_mark = "\uE00F", end_escape = "\033[0m";

bool has_colours(int file) {
  const char *none = std::getenv("NO_COLOR"), *terminal = std::getenv("TERM");
  return isatty(file) != 0 && !(none && *none) && terminal && *terminal &&
         std::string_view(terminal) != "dumb";
}

bool has_any_colours() {
  static const bool has = has_colours(STDOUT_FILENO) || has_colours(STDERR_FILENO);
  return has;
}

/// Marks as what the terminal takes for them, or as nothing.
std::string painted(std::string text, int file) {
  if (!has_any_colours()) return text;
  const bool is_shown = has_colours(file);
  const auto replace = [&](std::string_view mark, std::string_view escape) {
    for (std::size_t at = 0; (at = text.find(mark, at)) != std::string::npos;)
      text.replace(at, mark.size(), is_shown ? escape : std::string_view());
  };
  for (const auto& [mark, escape] : marks) replace(mark, escape);
  replace(end_mark, end_escape);
  return text;
}

}  // namespace

void print(std::string_view text) {
  const std::string shown = painted(visible(text), STDOUT_FILENO);
  for (std::string_view rest = shown; !rest.empty();) {
    const ssize_t done = ::write(STDOUT_FILENO, rest.data(), rest.size());
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) throw OutputLost{done == 0 ? ENOSPC : errno};
    rest.remove_prefix(static_cast<std::size_t>(done));
  }
}

void message(std::string_view text, std::optional<Style> style) {
  constexpr std::string_view warning = "warning:";
  std::string line(text);
  if (style)
    line = styled(text, *style);
  else if (text.starts_with(warning))
    line = styled(warning, Style::doubtful) + line.substr(warning.size());
  const std::string shown = painted(visible(line), STDERR_FILENO) + '\n';
  std::fwrite(shown.data(), 1, shown.size(), stderr);
}

std::string styled(std::string_view text, Style style) {
  if (!has_any_colours()) return std::string(text);
  return fmt::format("{}{}{}", marks[static_cast<std::size_t>(style)].mark, text, end_mark);
}

std::size_t line_width() {
  if (isatty(STDOUT_FILENO) == 0) return 0;
  const char* columns = std::getenv("COLUMNS");
  if (const long said = columns ? std::strtol(columns, nullptr, 10) : 0; said > 0)
    return static_cast<std::size_t>(said);
  winsize size = {};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

int refuse(std::string_view verb, const Errors& errors) {
  for (const Error& error : errors) {
    const bool is_place = error.where.find(':') != std::string::npos;
    const bool is_said = error.where.empty() || error.message.starts_with(error.where);
    message(visible_line(fmt::format("{}{}{} [{}]", is_place ? "" : fmt::format("sinew {}: ", verb),
                                     is_said ? "" : error.where + ": ", error.message, error.code)),
            Style::bad);
  }
  const std::string_view code = errors.front().code;
  return code == "file_unwritable" || code == "write_failed" ? stopped : bad_input;
}

int become(const std::filesystem::path& program) {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  const std::string line(std::istreambuf_iterator<char>(file), {});
  std::vector<char*> arguments;
  for (std::size_t begin = 0; begin < line.size(); begin = line.find('\0', begin) + 1)
    arguments.push_back(const_cast<char*>(line.data()) + begin);  // execv changes none of them
  if (arguments.empty()) return EINVAL;
  arguments.push_back(nullptr);
  ::execv(program.c_str(), arguments.data());
  return errno;
}

void restart_with(const char* variable, const std::string& word) {
  const char* old = std::getenv(variable);
  const std::string value = old ? old : "";
  if (value.find(word) != std::string::npos) return;
  ::setenv(variable, (value.empty() ? word : value + ':' + word).c_str(), 1);
  become("/proc/self/exe");
}

void watch_signals() {
  struct sigaction action = {};
  action.sa_handler = on_signal;  // without SA_RESTART: a read that waits for input ends
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  action.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &action, nullptr);
  sigaction(SIGXFSZ, &action, nullptr);  // as a disc that is full
}

void finish_what_is_begun() { wait_for_end_of_line = 1; }

bool interrupted() { return has_signal; }

StopToken stop_token() { return StopToken(has_signal); }

}  // namespace sinew::cli
