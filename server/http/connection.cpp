#include "connection.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>

#include "head.hpp"

namespace sinew::server {
namespace {

using namespace std::chrono_literals;

constexpr auto idle = 2s;     // between requests, as httplib's clients know it
constexpr auto stuck = 5s;    // of a client that takes nothing of its answer
constexpr auto parting = 1s;  // for what a refused client still sends

std::chrono::duration<double> seconds(double count) { return std::chrono::duration<double>(count); }

/// Whether any of the events has come until then.
short wait(int socket, short events, Connection::Clock::time_point until) {
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Connection::Clock::now()).count();
    pollfd one{socket, events, 0};
    const int count = poll(&one, 1, static_cast<int>(std::clamp<std::int64_t>(left, 0, 1'000'000)));
    if (count < 0 && errno == EINTR) continue;
    return count > 0 ? one.revents : short{0};
  }
}

}  // namespace

Connection::Connection(int socket, std::string peer, const Limits& limits)
    : socket_(socket),
      peer_(std::move(peer)),
      limits_(limits),
      since_(Clock::now().time_since_epoch().count()) {}

Connection::~Connection() { close(socket_); }

/// False where it has been dropped meanwhile.
bool Connection::turn(Doing next) {
  Doing now = doing();
  while (now != Doing::dropped && !doing_.compare_exchange_weak(now, next)) {
  }
  if (now != next) since_.store(Clock::now().time_since_epoch().count(), std::memory_order_relaxed);
  return now != Doing::dropped;
}

bool Connection::drop(Doing at) {
  if (!doing_.compare_exchange_strong(at, Doing::dropped)) return false;
  shutdown(socket_, SHUT_RDWR);
  return true;
}

bool Connection::is_gone() const { return wait(socket_, POLLRDHUP, {}) != 0; }

ssize_t Connection::receive(char* bytes, std::size_t count, Clock::time_point deadline) const {
  for (;;) {
    if (Clock::now() >= deadline || wait(socket_, POLLIN, deadline) == 0) return -1;
    const ssize_t got = recv(socket_, bytes, count, 0);
    if (got >= 0) return got;
    if (errno != EINTR && errno != EAGAIN) return 0;
  }
}

tl::expected<void, Reply> Connection::next() {
  const auto over = tl::unexpected(Reply{0, {}});
  buffer_.erase(0, used_);
  used_ = left_ = 0;
  has_answered_ = false;
  const auto begun = Clock::now();
  deadline_ = begun + std::chrono::duration_cast<Clock::duration>(seconds(limits_.reading));
  if (!turn(buffer_.empty() ? Doing::waiting : Doing::reading)) return over;
  for (std::size_t seen = 0;;) {
    const std::size_t end = buffer_.find("\r\n\r\n", seen);
    if (end != std::string::npos && end + 4 <= max_head) return begin(end + 4);
    if (buffer_.size() >= max_head)
      return tl::unexpected(
          refused(431, "too_large", "header", fmt::format("give at most {} bytes", max_head)));
    seen = buffer_.size() - std::min<std::size_t>(buffer_.size(), 3);
    std::array<char, 4096> bytes;
    const bool is_idle = buffer_.empty();
    const ssize_t got = receive(bytes.data(), std::min(bytes.size(), max_head - buffer_.size()),
                                is_idle ? std::min(deadline_, begun + idle) : deadline_);
    if (got == 0 || (got < 0 && is_idle)) return over;
    if (got < 0)
      return tl::unexpected(
          refused(408, "too_slow", "request", fmt::format("send all of it within {} s", limits_.reading)));
    if (is_idle) {
      deadline_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(seconds(limits_.reading));
      if (!turn(Doing::reading)) return over;
    }
    buffer_.append(bytes.data(), static_cast<std::size_t>(got));
  }
}

tl::expected<void, Reply> Connection::begin(std::size_t head_size) {
  const std::string_view text = std::string_view(buffer_).substr(0, head_size);
  const auto head = read_head(text);
  if (!head) return tl::unexpected(head.error());
  left_ = head_size + head->body;
  if (!head->range.empty()) {
    left_ -= head->range.size() + 2;
    buffer_.erase(static_cast<std::size_t>(head->range.data() - buffer_.data()), head->range.size() + 2);
  }
  if (head->body == 0 && !turn(Doing::working)) return tl::unexpected(Reply{0, {}});
  return {};
}

ssize_t Connection::read(char* bytes, size_t count) {
  count = std::min(count, left_);
  if (count == 0) return 0;
  auto got = static_cast<ssize_t>(std::min(count, buffer_.size() - used_));
  if (got > 0)
    std::copy_n(buffer_.data() + used_, got, bytes);
  else
    got = receive(bytes, count, deadline_);
  if (got <= 0) return -1;
  used_ += std::min(static_cast<std::size_t>(got), buffer_.size() - used_);
  left_ -= static_cast<std::size_t>(got);
  if (left_ == 0 && !turn(Doing::working)) return -1;
  return got;
}

ssize_t Connection::write(const char* bytes, size_t count) {
  has_answered_ = true;
  const Doing before = doing();
  for (;;) {
    const ssize_t sent = send(socket_, bytes, count, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent >= 0 || (errno != EAGAIN && errno != EINTR)) {
      if (doing() != before && !turn(before)) return -1;
      return sent;
    }
    if (!turn(Doing::writing) || (wait(socket_, POLLOUT, Clock::now() + stuck) & POLLOUT) == 0) return -1;
  }
}

bool Connection::is_readable() const {
  return left_ > 0 && (used_ < buffer_.size() || wait(socket_, POLLIN, {}) != 0);
}

bool Connection::is_writable() const {
  return (wait(socket_, POLLOUT | POLLRDHUP, Clock::now() + stuck) & (POLLOUT | POLLRDHUP)) == POLLOUT;
}

void Connection::refuse(const Reply& reply) {
  is_last_ = true;
  if (has_answered_) return;
  const std::string text = fmt::format(
      "HTTP/1.1 {} Refused\r\nContent-Type: {}\r\nContent-Length: {}\r\nCache-Control: no-store\r\n"
      "X-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n{}",
      reply.status, reply.type, reply.text.size(), reply.text);
  write(text.data(), text.size());  // into an empty buffer of the system: whole, or to a client that is gone
}

void Connection::linger() {
  shutdown(socket_, SHUT_WR);
  if (!turn(Doing::waiting)) return;
  const auto until = Clock::now() + parting;
  std::array<char, 4096> bytes;
  for (std::size_t more = limits_.jobs.body; more > 0;) {
    const ssize_t got = receive(bytes.data(), bytes.size(), until);
    if (got <= 0) return;
    more -= std::min(more, static_cast<std::size_t>(got));
  }
}

void Connection::get_remote_ip_and_port(std::string& ip, int& port) const {
  ip = peer_;
  port = 0;
}

void Connection::get_local_ip_and_port(std::string& ip, int& port) const {
  ip.clear();
  port = 0;
}

}  // namespace sinew::server
