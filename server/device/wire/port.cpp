#include "port.hpp"

// Not <termios.h>, which knows a list of rates only, and cannot be included beside it.
#include <asm/termbits.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

namespace sinew::server::device {
namespace {

/// Bytes that wait for a port that takes none; what comes after them is lost, and then noticed as silence.
constexpr std::size_t max_waiting = 4096;

class Port : public Wire {
 public:
  explicit Port(int file) : file_(file) {}
  ~Port() override { close(file_); }
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  std::string read() override {
    flush();
    std::string text;
    std::array<char, 1024> bytes;
    while (!is_gone_ && text.size() < max_waiting) {
      const ssize_t count = ::read(file_, bytes.data(), bytes.size());
      if (count > 0)
        text.append(bytes.data(), static_cast<std::size_t>(count));
      else if (count < 0 && (errno == EAGAIN || errno == EINTR))
        break;
      else
        is_gone_ = true;  // end of file or EIO: unplugged, or the other side of a pty has closed
    }
    return text;
  }
  void write(std::string_view bytes) override {
    if (waiting_.size() + bytes.size() <= max_waiting) waiting_ += bytes;
    flush();
  }
  bool is_gone() const override { return is_gone_; }
  void wait(double seconds) override {
    pollfd port{file_, POLLIN, 0};
    const int milliseconds = static_cast<int>(seconds * 1e3) + 1;
    if (is_gone_ || ::poll(&port, 1, milliseconds) < 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
  }

 private:
  void flush() {
    while (!waiting_.empty() && !is_gone_) {
      const ssize_t count = ::write(file_, waiting_.data(), waiting_.size());
      if (count > 0)
        waiting_.erase(0, static_cast<std::size_t>(count));
      else if (count < 0 && (errno == EAGAIN || errno == EINTR))
        return;
      else
        is_gone_ = true;
    }
  }

  int file_;
  bool is_gone_ = false;
  std::string waiting_;
};

/// Bytes as they are: no echo, no lines, no signals, no flow control.
bool make_raw(int file, int baud) {
  termios2 mode{};
  if (ioctl(file, TCGETS2, &mode) != 0) return false;
  mode.c_iflag = 0;
  mode.c_oflag = 0;
  mode.c_lflag = 0;
  mode.c_cflag = CS8 | CREAD | CLOCAL | BOTHER | BOTHER << IBSHIFT;
  mode.c_ispeed = mode.c_ospeed = static_cast<unsigned>(baud);
  mode.c_cc[VMIN] = 1;  // with 0 a read of nothing would look like an end
  mode.c_cc[VTIME] = 0;
  return ioctl(file, TCSETS2, &mode) == 0 && ioctl(file, TCFLSH, TCIOFLUSH) == 0;
}

}  // namespace

Expected<std::unique_ptr<Wire>> open_port(const std::string& path, int baud) {
  const int file = open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (file < 0)
    return failure("no_device", path,
                   fmt::format("cannot be opened: {}; is it plugged in, and may you use it (group dialout)?",
                               std::strerror(errno)));
  auto port = std::make_unique<Port>(file);
  if (flock(file, LOCK_EX | LOCK_NB) != 0)
    return failure("in_use", path, "another program uses it; close that one first");
  if (!make_raw(file, baud))
    return failure("no_device", path,
                   fmt::format("is no serial port, or cannot do {} baud: {}", baud, std::strerror(errno)));
  return std::unique_ptr<Wire>(std::move(port));
}

}  // namespace sinew::server::device
