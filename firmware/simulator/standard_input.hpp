/// @file standard_input.hpp
/// stdin as it comes, which nobody waits for.
#pragma once

#include <poll.h>
#include <unistd.h>

#include <array>
#include <optional>
#include <string>
#include <utility>

namespace sinew::firmware {

class StandardInput {
 public:
  /// The next whole line, with its newline; nothing while there is none.
  std::optional<std::string> line() {
    read_what_is_there();
    const std::size_t size = pending_.find('\n') + 1;
    if (size == 0) return {};
    std::string first = pending_.substr(0, size);
    pending_.erase(0, size);
    return first;
  }
  /// All that has come.
  std::string bytes() {
    read_what_is_there();
    return std::exchange(pending_, {});
  }
  /// No line will come any more.
  bool has_ended() const { return is_closed_ && pending_.find('\n') == std::string::npos; }

 private:
  void read_what_is_there() {
    pollfd in{STDIN_FILENO, POLLIN, 0};
    if (is_closed_ || poll(&in, 1, 0) <= 0) return;
    std::array<char, 4096> bytes{};
    const ssize_t size = ::read(STDIN_FILENO, bytes.data(), bytes.size());
    if (size <= 0)
      is_closed_ = true;
    else
      pending_.append(bytes.data(), static_cast<std::size_t>(size));
  }

  std::string pending_;
  bool is_closed_ = false;
};

}  // namespace sinew::firmware
