/// @file wire.hpp
/// A connection to the server as bytes, and the replies in what comes back.
#pragma once
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace sinew::server {

class Wire {
 public:
  explicit Wire(int port, const char* from = "127.0.0.1") : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    const sockaddr_in own = address(from, 0), server = address("127.0.0.1", port);
    const int yes =
        1;  // the port is found with the server's: ten thousands of connections have been closed of late
    setsockopt(socket_, IPPROTO_IP, IP_BIND_ADDRESS_NO_PORT, &yes, sizeof yes);
    is_open_ = bind(socket_, reinterpret_cast<const sockaddr*>(&own), sizeof own) == 0 &&
               connect(socket_, reinterpret_cast<const sockaddr*>(&server), sizeof server) == 0;
  }
  Wire(Wire&& other) noexcept : socket_(std::exchange(other.socket_, -1)), is_open_(other.is_open_) {}
  Wire& operator=(Wire&&) = delete;
  ~Wire() { close(); }

  bool is_open() const { return is_open_; }
  void close() {
    if (socket_ >= 0) ::close(std::exchange(socket_, -1));
  }
  /// Whether all of it could be sent.
  bool send(std::string_view bytes) const {
    return ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
  }
  /// Nothing more will be sent.
  void end() const { shutdown(socket_, SHUT_WR); }
  /// All that comes until the server closes, or is silent for so long [ms].
  std::string receive(int patience = 5000) {
    const timeval silence{patience / 1000, patience % 1000 * 1000};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &silence, sizeof silence);
    std::string text;
    std::array<char, 4096> bytes;
    ssize_t count = 0;
    while ((count = recv(socket_, bytes.data(), bytes.size(), 0)) > 0)
      text.append(bytes.data(), static_cast<std::size_t>(count));
    has_ended = count == 0 || errno == ECONNRESET;
    return text;
  }

  bool has_ended = false;  ///< the server has closed it, as the last `receive` saw

 private:
  static sockaddr_in address(const char* name, int port) {
    sockaddr_in result{};
    result.sin_family = AF_INET;
    result.sin_port = htons(static_cast<std::uint16_t>(port));
    inet_pton(AF_INET, name, &result.sin_addr);
    return result;
  }

  int socket_;
  bool is_open_ = false;
};

/// What comes back for bytes on a connection of their own.
inline std::string raw(int port, const std::string& bytes, int patience = 10) {
  Wire wire(port);
  wire.send(bytes);
  return wire.receive(patience);
}

/// The replies that a text is made of, as the statuses of each: `100 403`. Nothing but whole ones, else what
/// is wrong.
/// @param is_lenient of replies to HEAD nothing but the head comes, and the stream of a client who has left
/// ends anywhere
inline std::string statuses(std::string_view text, bool is_lenient = false) {
  std::string found;
  const auto wrong = [&](const char* what) { return found + what; };
  while (!text.empty()) {
    const std::size_t end = text.find("\r\n\r\n");
    if (!text.starts_with("HTTP/1.1 ") || end == std::string_view::npos) return wrong("no head");
    const std::string_view head = text.substr(0, end + 2), status = head.substr(9, 3);
    found += (found.empty() ? "" : " ") + std::string(status);
    text.remove_prefix(end + 4);
    for (std::size_t at = 0; at < head.size(); ++at)
      if ((head[at] == '\n') != (at > 0 && head[at - 1] == '\r')) return wrong(" bare line end");
    if (is_lenient && (text.empty() || text.starts_with("HTTP/1.1 "))) continue;
    if (head.find("\r\nTransfer-Encoding: chunked\r\n") != std::string_view::npos) {
      const std::size_t last = text.find("0\r\n\r\n");
      if (last == std::string_view::npos) return is_lenient ? found : wrong(" cut short");
      text.remove_prefix(last + 5);
      continue;
    }
    constexpr std::string_view name = "\r\nContent-Length: ";
    const std::size_t length = head.find(name);
    if (status == "100" || status == "204") continue;
    if (length == std::string_view::npos) return wrong(" no length");
    std::size_t count = 0;
    for (std::size_t i = length + name.size(); head[i] >= '0' && head[i] <= '9'; ++i)
      count = 10 * count + static_cast<std::size_t>(head[i] - '0');
    if (text.size() < count) return wrong(" cut short");
    text.remove_prefix(count);
  }
  return found;
}

}  // namespace sinew::server
