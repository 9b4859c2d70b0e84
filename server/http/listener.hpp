/// @file listener.hpp
/// httplib's server with a door of its own: httplib 0.11 reads on without end, waits for each byte anew,
/// takes what a handler left of a body for the next request, and has no hook for any of this. So connections
/// are accepted and kept here, each request comes to it through a `Connection`, and it does what is left:
/// routes and replies. To be included last: httplib defines _res, which Eigen uses.
#pragma once
#include <condition_variable>
#include <deque>
#include <list>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "server/server.hpp"
// It has httplib: last.
#include "connection.hpp"

namespace sinew::server {

class Listener final : public httplib::Server {
 public:
  explicit Listener(const Limits& limits);
  ~Listener() override;

  /// More may come at once than httplib's five: who finds no room to wait tries again after a second, and
  /// loses it.
  void widen();
  /// Accepts until `stop`; false: the socket has failed.
  bool run();
  void stop();

  /// Whose request this thread answers; null outside of one.
  static Connection* current();

 private:
  bool process_and_close_socket(socket_t) override { return false; }  // httplib's own door stays shut
  void admit(int socket, std::string peer);
  bool drop_one();
  void work();
  void serve(Connection& connection);

  const Limits limits_;
  std::mutex mutex_;  // of all that follows
  std::condition_variable changed_;
  std::deque<std::unique_ptr<Connection>> waiting_;  // for a thread
  std::list<Connection*> open_;                      // these, and those that are served; the oldest first
  bool is_stopped_ = false;
};

}  // namespace sinew::server
