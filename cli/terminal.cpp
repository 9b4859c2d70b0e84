#include "terminal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <vector>

namespace sinew::cli {
namespace {

volatile std::sig_atomic_t signals = 0;
volatile std::sig_atomic_t wait_for_end_of_line = 0;

extern "C" void on_signal(int) {
  if (!wait_for_end_of_line || signals) _exit(stopped);
  signals = 1;
}

}  // namespace

void print(std::string_view text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw OutputLost{errno};
}

void message(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fputc('\n', stderr);
}

int refuse(std::string_view verb, const Errors& errors) {
  for (const Error& error : errors) {
    const bool is_place = error.where.find(':') != std::string::npos;
    const bool is_said = error.where.empty() || error.message.starts_with(error.where);
    message(fmt::format("{}{}{} [{}]", is_place ? "" : fmt::format("sinew {}: ", verb),
                        is_said ? "" : error.where + ": ", error.message, error.code));
  }
  return bad_input;
}

void restart_with(const char* variable, const std::string& word) {
  const char* old = std::getenv(variable);
  const std::string value = old ? old : "";
  if (value.find(word) != std::string::npos) return;
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  const std::string line(std::istreambuf_iterator<char>(file), {});
  std::vector<char*> arguments;
  for (std::size_t begin = 0; begin < line.size(); begin = line.find('\0', begin) + 1)
    arguments.push_back(const_cast<char*>(line.data()) + begin);  // execv changes none of them
  if (arguments.empty()) return;
  arguments.push_back(nullptr);
  ::setenv(variable, (value.empty() ? word : value + ':' + word).c_str(), 1);
  ::execv("/proc/self/exe", arguments.data());
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

bool interrupted() { return signals != 0; }

}  // namespace sinew::cli
