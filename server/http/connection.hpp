/// @file connection.hpp
/// One client's connection, as httplib sees it: of each request just its own bytes, within a time and a size.
/// To be included last: httplib defines _res, which Eigen uses.
#pragma once
#include <atomic>
#include <chrono>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "server/reply.hpp"
#include "server/server.hpp"
// It defines _res, which Eigen uses: last.
#include <httplib.h>

namespace sinew::server {

class Connection final : public httplib::Stream {
 public:
  using Clock = std::chrono::steady_clock;
  /// What it is at; whoever waits for its client may be dropped for others.
  enum class Doing { waiting, reading, writing, working, dropped };

  /// @param socket that does not block; closed in the end
  Connection(int socket, std::string peer, const Limits& limits);
  ~Connection() override;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  /// Waits for the head of the next request, which `read` then gives, and the body after it. Else what to
  /// answer before the connection is closed; of status 0 nothing.
  tl::expected<void, Reply> next();
  /// The request has been read to its last byte. Else what is left would be taken for the next one.
  bool is_consumed() const { return left_ == 0 && !is_last_; }
  std::size_t left() const { return left_; }  ///< [bytes] of the request, not yet read
  void close_after() { is_last_ = true; }     ///< no request after this one
  /// Answers without httplib.
  void refuse(const Reply& reply);
  /// Before it is closed: were anything unread then, a reset would take the answer from the client.
  void linger();

  /// @name For other threads
  /// @{
  /// The client has closed its side, or more.
  bool is_gone() const;
  Doing doing() const { return doing_.load(std::memory_order_relaxed); }
  Clock::time_point since() const {
    return Clock::time_point(Clock::duration(since_.load(std::memory_order_relaxed)));
  }
  const std::string& peer() const { return peer_; }
  /// Ends it if it still does this.
  bool drop(Doing at);
  /// @}

  bool is_readable() const override;
  bool is_writable() const override;
  ssize_t read(char* bytes, size_t count) override;
  ssize_t write(const char* bytes, size_t count) override;
  void get_remote_ip_and_port(std::string& ip, int& port) const override;
  void get_local_ip_and_port(std::string& ip, int& port) const override;
  socket_t socket() const override { return socket_; }

 private:
  bool turn(Doing next);
  /// Bytes that have come until the deadline; 0: it is closed, −1: too late.
  ssize_t receive(char* bytes, std::size_t count, Clock::time_point deadline) const;
  tl::expected<void, Reply> begin(std::size_t head_size);

  int socket_;
  std::string peer_;
  const Limits& limits_;
  std::string buffer_;    // the head, and what came with it
  std::size_t used_ = 0;  // of the buffer
  std::size_t left_ = 0;  // of head and body, to be read
  bool has_answered_ = false, is_last_ = false;
  Clock::time_point deadline_{};  // for the request to be here
  std::atomic<Doing> doing_ = Doing::waiting;
  std::atomic<Clock::rep> since_;
};

}  // namespace sinew::server
