#include "simulator/terminal.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace sinew::firmware {
namespace {

/// Bytes as they are: no echo, no lines, no signals.
void make_raw(int file) {
  termios settings{};
  if (tcgetattr(file, &settings) != 0) return;
  cfmakeraw(&settings);
  tcsetattr(file, TCSANOW, &settings);
}

}  // namespace

Terminal::Terminal(std::filesystem::path link) : link_(std::move(link)) {
  here_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  const char* const name =
      here_ >= 0 && grantpt(here_) == 0 && unlockpt(here_) == 0 ? ptsname(here_) : nullptr;
  if (name) there_ = open(name, O_RDWR | O_NOCTTY | O_CLOEXEC);
  std::error_code error;
  if (there_ >= 0) {
    make_raw(there_);
    if (is_symlink(symlink_status(link_, error))) remove(link_, error);
    create_symlink(name, link_, error);
    if (!error) return;
  }
  const std::string reason =
      there_ < 0 ? "no pseudo-terminal can be opened" : link_.string() + ": " + error.message();
  if (there_ >= 0) close(there_);
  if (here_ >= 0) close(here_);
  throw std::runtime_error(reason);
}

Terminal::~Terminal() {
  std::error_code error;
  std::filesystem::remove(link_, error);
  close(there_);
  close(here_);
}

std::string Terminal::read() {
  std::string all;
  std::array<char, 4096> bytes{};
  for (ssize_t size; (size = ::read(here_, bytes.data(), bytes.size())) > 0;)
    all.append(bytes.data(), static_cast<std::size_t>(size));
  return all;
}

void Terminal::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t size = ::write(here_, bytes.data(), bytes.size());
    if (size <= 0) return;
    bytes.remove_prefix(static_cast<std::size_t>(size));
  }
}

}  // namespace sinew::firmware
