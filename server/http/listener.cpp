#include "listener.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <map>
#include <tuple>

namespace sinew::server {
namespace {

using namespace std::chrono_literals;

thread_local Connection* served = nullptr;

std::string name_of(const sockaddr_storage& address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  const void* bytes =
      address.ss_family == AF_INET6
          ? static_cast<const void*>(&reinterpret_cast<const sockaddr_in6&>(address).sin6_addr)
          : &reinterpret_cast<const sockaddr_in&>(address).sin_addr;
  return inet_ntop(address.ss_family, bytes, text.data(), text.size()) ? text.data() : "";
}

/// Of `accept`: the client's fault, or the network's; the next one may be better.
bool is_of_one(int error) {
  constexpr std::array theirs{EINTR,        ECONNABORTED, EPROTO, ENETDOWN,  ENOPROTOOPT, EHOSTDOWN, ENONET,
                              EHOSTUNREACH, ENETUNREACH,  EAGAIN, ETIMEDOUT, EPERM,       EOPNOTSUPP};
  return std::ranges::find(theirs, error) != theirs.end();
}

bool is_of_shortage(int error) {
  return error == EMFILE || error == ENFILE || error == ENOMEM || error == ENOBUFS;
}

Reply failed() { return refused(500, "internal", "server", "this request failed inside sinew"); }

}  // namespace

Listener::Listener(const Limits& limits) : limits_(limits) {
  set_exception_handler([](const httplib::Request&, httplib::Response& response, std::exception_ptr) {
    served->close_after();  // who knows how far it came
    const Reply reply = failed();
    response.status = reply.status;
    response.set_content(reply.text, "application/json");
  });
  set_post_routing_handler([](const httplib::Request&, httplib::Response& response) {
    if (!served || served->is_consumed()) return;
    response.headers.erase("Keep-Alive");
    response.set_header("Connection", "close");
  });
}

Listener::~Listener() {
  if (const socket_t socket = svr_sock_.exchange(INVALID_SOCKET); socket != INVALID_SOCKET) close(socket);
}

void Listener::widen() { ::listen(svr_sock_, SOMAXCONN); }

Connection* Listener::current() { return served; }

bool Listener::run() {
  std::vector<std::jthread> threads;
  for (int i = 0; i < limits_.threads; ++i) threads.emplace_back([this] { work(); });
  bool is_good = true;
  for (;;) {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    const int socket =
        accept4(svr_sock_, reinterpret_cast<sockaddr*>(&address), &size, SOCK_CLOEXEC | SOCK_NONBLOCK);
    const int error = errno;
    {
      const std::lock_guard lock(mutex_);
      if (is_stopped_) {
        if (socket >= 0) close(socket);
        break;
      }
    }
    if (socket >= 0) {
      admit(socket, name_of(address));
    } else if (is_of_shortage(error)) {
      const std::lock_guard lock(mutex_);
      drop_one();
      std::this_thread::sleep_for(1ms);  // until it is closed
    } else if (!is_of_one(error)) {
      is_good = false;
      break;
    }
  }
  stop();
  return is_good;
}

void Listener::stop() {
  const std::lock_guard lock(mutex_);
  is_stopped_ = true;
  shutdown(svr_sock_, SHUT_RDWR);
  changed_.notify_all();
  using enum Connection::Doing;
  for (Connection* connection : open_)
    for (const auto doing : {waiting, reading, writing}) connection->drop(doing);
}

/// One more than can be served displaces one that waits for its client.
void Listener::admit(int socket, std::string peer) {
  auto connection = std::make_unique<Connection>(socket, std::move(peer), limits_);
  const std::lock_guard lock(mutex_);
  const auto most = static_cast<std::size_t>(limits_.threads);
  const auto kept = static_cast<std::size_t>(std::ranges::count_if(
      open_, [](const Connection* one) { return one->doing() != Connection::Doing::dropped; }));
  if (kept >= most && !drop_one() && waiting_.size() >= most) {
    connection->refuse(refused(503, "busy", "server", "all connections are taken; try again"));
    return;
  }
  open_.push_back(connection.get());
  waiting_.push_back(std::move(connection));
  changed_.notify_one();
}

/// The slowest of the client that has most of them: first who asks nothing, then who is slow to ask, then who
/// is slow to take its answer. So many slow connections are worth no more than one.
bool Listener::drop_one() {
  using enum Connection::Doing;
  struct Candidate {
    Connection* connection;
    Connection::Doing doing;
  };
  std::map<std::string_view, std::vector<Candidate>> of_peers;
  for (Connection* one : open_)
    if (const auto doing = one->doing(); doing == waiting || doing == reading || doing == writing)
      of_peers[one->peer()].push_back({one, doing});
  if (of_peers.empty()) return false;
  const auto most =
      std::ranges::max_element(of_peers, {}, [](const auto& peer) { return peer.second.size(); });
  const auto worst = std::ranges::min_element(most->second, {}, [](const Candidate& candidate) {
    return std::tuple(candidate.doing, candidate.connection->since());
  });
  return worst->connection->drop(worst->doing);
}

void Listener::work() {
  for (;;) {
    std::unique_ptr<Connection> connection;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return is_stopped_ || !waiting_.empty(); });
      if (waiting_.empty()) return;
      connection = std::move(waiting_.front());
      waiting_.pop_front();
    }
    served = connection.get();
    serve(*connection);
    served = nullptr;
    const std::lock_guard lock(mutex_);
    std::erase(open_, connection.get());
  }
}

void Listener::serve(Connection& connection) {
  try {
    for (bool is_last = false; !is_last;) {
      if (const auto has_come = connection.next(); !has_come) {
        if (has_come.error().status == 0) return;
        connection.refuse(has_come.error());
        break;
      }
      if (!process_request(connection, false, is_last, nullptr) || !connection.is_consumed()) break;
      const std::lock_guard lock(mutex_);
      if (is_stopped_) return;
    }
  } catch (...) {  // of httplib, before it routes or while it answers
    connection.refuse(failed());
  }
  connection.linger();
}

}  // namespace sinew::server
