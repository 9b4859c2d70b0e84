/// The server and the bytes on its socket: where requests end, what they may cost, and who is served when
/// many are slow.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>
#include <vector>

#include "sanitizers.hpp"
#include "server/http/head.hpp"
#include "thorough.hpp"
#include "wire.hpp"
// They have httplib: last.
#include "desk.hpp"
#include "paths.hpp"
#include "server/http/listener.hpp"

namespace sinew::server {
namespace wire_test {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

/// Milliseconds, and what a busy machine makes of them: less than a connection has for its request, 30, or
/// sends for without an answer, 20.
constexpr double max_seconds = 10;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

const std::size_t stride = test::is_instrumented ? 61 : test::count_of<std::size_t>(5, 1);

struct Smuggler {
  explicit Smuggler(int port)
      : port_(port),
        host_("Host: 127.0.0.1:" + std::to_string(port) + "\r\n"),
        hidden_("GET /api/version HTTP/1.1\r\n" + host_ + "\r\n"),
        last_("GET /api/robots/none HTTP/1.1\r\n" + host_ + "Connection: close\r\n\r\n") {}

  /// What is answered to a request with another one in its body, from that byte on, and one after it. The
  /// other one is answered with the protocol's number.
  std::string ask(const std::string& line, const std::string& headers, std::size_t offset,
                  const std::string& length = "") const {
    const std::string body = std::string(offset, 'x') + hidden_;
    return raw(port_,
               line + " HTTP/1.1\r\n" + host_ + headers +
                   (length.empty() ? "Content-Length: " + std::to_string(body.size()) + "\r\n" : length) +
                   "\r\n" + body + last_,
               5000);
  }
  bool finds(const std::string& answer) const { return answer.find("\"protocol\"") != std::string::npos; }

 private:
  int port_;
  std::string host_, hidden_, last_;
};

TEST(Wire, NoPartOfABodyIsARequestFromAnyByteOn) {
  Desk desk;
  const Smuggler smuggler(desk.port);
  const std::string robot = "/api/query?robot=" + desk.opened("3-rfr");
  const std::vector<std::pair<std::string, std::string>> requests{
      {"POST " + robot, "Content-Type: multipart/form-data; boundary=x\r\n"},
      {"POST /api/robot", "Content-Type: multipart/form-data\r\n"},
      {"POST /api/jobs", "Content-Type: application/x-www-form-urlencoded\r\n"},
      {"POST " + robot, "Content-Type: text/plain\r\n"},
      {"POST " + robot, "Content-Type: application/json\r\n"},
      {"POST " + robot, "Content-Type: application/json\r\nContent-Encoding: gzip\r\n"},
      {"POST " + robot, "Content-Type: application/json\r\nOrigin: http://evil.example\r\n"},
      {"POST /nothing", "Content-Type: multipart/form-data; boundary=x\r\n"},
      {"POST /api/robot", "Content-Type: text/yaml\r\nExpect: 100-continue\r\n"},
      {"DELETE /api/jobs/0", ""},
      {"GET /", ""},
      {"PUT /api/query", ""}};
  std::size_t first = 0;  // each begins one byte later, so that together they have every byte
  for (const auto& [line, headers] : requests)
    for (std::size_t offset = first++ % stride; offset < 4500; offset += stride) {
      const std::string answer = smuggler.ask(line, headers, offset);
      const std::string found = statuses(answer);
      ASSERT_FALSE(smuggler.finds(answer)) << line << ' ' << headers << offset << '\n' << answer;
      ASSERT_TRUE(found.size() == 3 || found == "400 404" || found == "422 404" || found == "100 422 404")
          << line << ' ' << headers << offset << ": " << found;
    }
}

TEST(Wire, ABodyWhoseEndIsInDoubtClosesTheConnection) {
  Desk desk;
  const Smuggler smuggler(desk.port);
  const std::string robot = "POST /api/query?robot=" + desk.opened("3-rfr"),
                    type = "Content-Type: application/json\r\n";
  for (const char* length : {"Transfer-Encoding: chunked\r\n",
                             "Transfer-Encoding: chunked\r\nContent-Length: 4\r\n",
                             "Content-Length: 4\r\nTransfer-Encoding: chunked\r\n",
                             "Transfer-Encoding: identity\r\nContent-Length: 0\r\n",
                             "Transfer-Encoding : chunked\r\nContent-Length: 0\r\n",
                             "Transfer-Encoding:\r\nContent-Length: 0\r\n",
                             "Content-Length: 0\r\nContent-Length: 9\r\n",
                             "Content-Length: 0, 0\r\n",
                             "Content-Length: +0\r\n",
                             "Content-Length: -1\r\n",
                             "Content-Length: 0x0\r\n",
                             "Content-Length: \r\n",
                             "Content-Length: 0 1\r\n",
                             "Content-Length: %30\r\n",
                             "Content-Length: 99999999999999999999999\r\n",
                             " Content-Length: 0\r\n",
                             "X: 1\r\n Content-Length: 0\r\n",
                             "X: 1\nContent-Length: 0\r\n",
                             "X: 1\rContent-Length: 0\r\n",
                             "Host: localhost\r\n",
                             "Content-Type: text/plain\r\n",
                             "X\r\nContent-Length: 0\r\n"})
    for (std::size_t offset = 0; offset < 4200; offset += 7 * stride) {
      const std::string answer = smuggler.ask(robot, type, offset, length);
      ASSERT_FALSE(smuggler.finds(answer)) << length << offset << '\n' << answer;
      const std::string found = statuses(answer);
      ASSERT_TRUE(found == "400" || found == "411") << length << offset << ": " << found;
    }
}

TEST(Wire, RequestsThatFollowEachOtherAreEachAnswered) {
  Desk desk;
  const std::string host = "Host: 127.0.0.1:" + std::to_string(desk.port) + "\r\n", body = "sinew: 1\n",
                    post = "POST /api/robot HTTP/1.1\r\n" + host +
                           "Content-Type: text/yaml\r\nContent-Length: " + std::to_string(body.size()) +
                           "\r\n\r\n" + body,
                    get = "GET /api/version HTTP/1.1\r\n" + host + "Range: bytes=0-0,1-1\r\n\r\n";
  std::string bytes;
  for (int i = 0; i < 3; ++i) bytes += post + get;
  bytes += "GET /api/version HTTP/1.0\r\n" + host + "\r\n";
  for (std::size_t cut = 1; cut < bytes.size(); cut += 1 + stride) {  // come as they may
    Wire wire(desk.port);
    wire.send(bytes.substr(0, cut));
    wire.send(bytes.substr(cut));
    ASSERT_EQ(statuses(wire.receive()), "422 200 422 200 422 200 200") << cut;
    ASSERT_TRUE(wire.has_ended);
  }
}

TEST(Wire, ALongAnswerBeforeTheEndIsWholeWhateverComesAfterItsRequest) {
  Desk desk;
  const std::string host = "Host: 127.0.0.1:" + std::to_string(desk.port) + "\r\n",
                    query =
                        R"({"query": "track", "from": {"x": 0, "y": 0, "phi": 0}, "to": {"x": 0.01, "y": 0,)"
                        R"( "phi": 0.2}, "samples": 5000})",
                    request = "POST /api/query?robot=" + desk.opened("3-rfr") + " HTTP/1.1\r\n" + host +
                              "Content-Type: application/json\r\nConnection: close\r\nContent-Length: " +
                              std::to_string(query.size()) + "\r\n\r\n" + query;
  for (int i = 0; i < test::count_of(5, 20); ++i) {
    Wire wire(desk.port);
    wire.send(request);
    std::this_thread::sleep_for(2ms);  // it is read by itself
    wire.send(std::string(30'000, 'x'));
    ASSERT_EQ(statuses(wire.receive()), "200");
    EXPECT_TRUE(wire.has_ended);
  }
}

TEST(Wire, WhatIsRefusedSaysThatItCloses) {
  Desk desk;
  const std::string host = "Host: 127.0.0.1:" + std::to_string(desk.port) + "\r\n";
  const auto reply = [&](const std::string& request) { return raw(desk.port, request, 5000); };
  for (const std::string& request :
       {"GET /" + std::string(20'000, 'a') + " HTTP/1.1\r\n" + host + "\r\n",
        "GET / HTTP/2\r\n" + host + "\r\n", "GET /\r\n" + host + "\r\n",
        "GET http://127.0.0.1/ HTTP/1.1\r\n" + host + "\r\n", "GET / HTTP/1.1\r\n" + host + "X: \x01\r\n\r\n",
        "\r\nGET / HTTP/1.1\r\n" + host + "\r\n", std::string("GET /\0 HTTP/1.1\r\n", 17) + host + "\r\n",
        "POST /api/robot HTTP/1.1\r\n" + host +
            "Content-Length: 20000000\r\nContent-Type: text/yaml\r\n\r\n"}) {
    const std::string text = reply(request);
    EXPECT_TRUE(statuses(text) == "505" || statuses(text).starts_with("4")) << request << text;
    EXPECT_NE(text.find("Connection: close\r\n"), std::string::npos) << text;
    EXPECT_NE(text.find(R"({"error":{"code":)"), std::string::npos) << text;
  }
}

/// A server as it is run, and the memory that it takes.
class Program {
 public:
  Program() {
    std::array<int, 2> out{};
    EXPECT_EQ(pipe(out.data()), 0);
    child_ = fork();
    if (child_ == 0) {
      dup2(out[1], 1);
      execl(test::command_path, "sinew", "serve", "--host", "0.0.0.0", "--port", "0", "--quiet", nullptr);
      _exit(127);
    }
    ::close(out[1]);
    std::string line;
    for (char c = 0; ::read(out[0], &c, 1) == 1 && c != '\n';) line += c;
    ::close(out[0]);
    const std::size_t path = line.rfind("/?token=");
    port = path == std::string::npos ? -1 : std::stoi(line.substr(line.rfind(':', path) + 1));
  }
  ~Program() {
    kill(child_, SIGINT);
    waitpid(child_, nullptr, 0);
  }
  long peak_kilobytes() const {
    std::ifstream status("/proc/" + std::to_string(child_) + "/status");
    long kilobytes = -1;
    for (std::string word; status >> word;)
      if (word == "VmHWM:") status >> kilobytes;
    return kilobytes;
  }

  int port = -1;

 private:
  pid_t child_ = -1;
};

/// How much of an endless text is taken, at most 64 MiB, and what is answered.
std::pair<std::size_t, std::string> pour(int port, const std::string& begin, const std::string& more) {
  Wire wire(port);
  std::string block;
  while (block.size() < 65'536) block += more;
  std::size_t sent = 0;
  if (wire.send(begin))
    while (sent < std::size_t{64} << 20U && wire.send(block)) sent += block.size();
  return {sent, wire.receive(2000)};
}

TEST(Wire, StrangersTakeNoMemoryHoweverLongTheyGoOn) {
  const Program program;
  ASSERT_GT(program.port, 0);
  pour(program.port, "", "x");  // all threads have run once
  const long before = program.peak_kilobytes();
  const std::string host = "Host: 127.0.0.1:" + std::to_string(program.port) + "\r\n",
                    chunked = "POST /api/query HTTP/1.1\r\n" + host + "Transfer-Encoding: chunked\r\n\r\n";
  const std::vector<std::pair<std::string, std::string>> endless{
      {"GET /", "a"},
      {"GET / HTTP/1.1\r\n" + host, "X-Name: value\r\n"},
      {"GET / HTTP/1.1\r\n" + host + "X: ", "a"},
      {"GET / HTTP/1.1\r\n" + host, "x"},
      {chunked, "0"},
      {chunked, "4\r\nabcd\r\n"},
      {chunked + "1;", "a"},
      {"POST /api/jobs HTTP/1.1\r\n" + host +
           "Content-Type: application/json\r\nContent-Length: 9999999999999\r\n\r\n",
       "[["}};
  std::vector<std::thread> clients;
  std::atomic<std::size_t> most = 0;
  for (int round = 0; round < 4; ++round)
    for (const auto& [begin, more] : endless)
      clients.emplace_back([&, begin = begin, more = more] {
        const auto [sent, answer] = pour(program.port, begin, more);
        std::size_t seen = most;
        while (sent > seen && !most.compare_exchange_weak(seen, sent)) {
        }
        EXPECT_TRUE(answer.empty() || statuses(answer).size() == 3) << answer;
      });
  for (std::thread& client : clients) client.join();
  const long grown = program.peak_kilobytes() - before;
  RecordProperty("kilobytes_before", std::to_string(before));
  RecordProperty("kilobytes_grown", std::to_string(grown));
  std::printf("%ld KiB at the start, %ld KiB more at the highest; %zu KiB taken of one client at most\n",
              before, grown, most.load() >> 10U);
  EXPECT_LT(grown, 8192);
}

/// How long an honest client waits at most [s] for each of his answers, each on a connection of its own; −1:
/// one was not given.
double longest_wait(int port, int requests, const char* from = "127.0.0.1") {
  const std::string host = "Host: 127.0.0.1:" + std::to_string(port) + "\r\n";
  double longest = 0;
  for (int i = 0; i < requests; ++i) {
    const auto begin = Clock::now();
    Wire wire(port, from);
    wire.send("GET /api/version HTTP/1.1\r\n" + host + "Connection: close\r\n\r\n");
    const std::string answer = wire.receive();
    if (statuses(answer) != "200") {
      ADD_FAILURE() << "request " << i << " was answered after " << seconds_since(begin) << " s: " << answer;
      return -1;
    }
    longest = std::max(longest, seconds_since(begin));
  }
  return longest;
}

TEST(Wire, SlowConnectionsLockNobodyOut) {
  Desk desk;
  const std::string host = "Host: 127.0.0.1:" + std::to_string(desk.port) + "\r\n";
  for (const std::string& begin :
       {std::string(), std::string("GET / HTTP/1.1\r\n"),
        "POST /api/robot HTTP/1.1\r\n" + host + "Content-Type: text/yaml\r\nContent-Length: 1000\r\n\r\n"}) {
    std::vector<Wire> slow;
    for (int i = 0; i < 300; ++i) {
      slow.emplace_back(desk.port);
      slow.back().send(begin);
    }
    std::atomic<bool> is_over = false;
    std::thread drip([&] {
      for (; !is_over; std::this_thread::sleep_for(20ms))
        for (Wire& wire : slow) wire.send("X");
    });
    const double longest = longest_wait(desk.port, 200);
    is_over = true;
    drip.join();
    EXPECT_GE(longest, 0) << begin;
    EXPECT_LT(longest, max_seconds) << begin;
  }
}

TEST(Wire, ThoseWhoComeAgainAndAgainLockNobodyOut) {
  Desk desk;
  std::atomic<bool> is_over = false;
  std::vector<std::thread> floods;
  for (int i = 0; i < 4; ++i)
    floods.emplace_back([&] {
      std::vector<Wire> held;
      while (!is_over) {
        held.emplace_back(desk.port);
        held.back().send("GET / HTTP/1.1\r\nX: ");
        if (held.size() > 100) held.clear();
      }
    });
  const double longest =
      longest_wait(desk.port, 50, "127.0.0.2");  // the others have more connections than he
  is_over = true;
  for (std::thread& flood : floods) flood.join();
  EXPECT_GE(longest, 0);
  EXPECT_LT(longest, max_seconds);
}

TEST(Wire, ARequestThatDoesNotComeWholeInTimeIsTold) {
  Options options;
  options.limits.reading = 0.3;
  Desk desk(options);
  const std::string host = "Host: 127.0.0.1:" + std::to_string(desk.port) + "\r\n";
  for (const auto& [bytes, status] : std::vector<std::pair<std::string, std::string>>{
           {"GET / HTTP/1.1\r\n", "408"},
           {"POST /api/robot HTTP/1.1\r\n" + host + "Content-Type: text/yaml\r\nContent-Length: 99\r\n\r\n",
            "400"}}) {
    Wire wire(desk.port);
    const auto begin = Clock::now();
    wire.send(bytes);
    std::atomic<bool> is_told = false;
    std::thread drip([&] {  // each byte is in time
      for (; !is_told && seconds_since(begin) < 20; std::this_thread::sleep_for(30ms)) wire.send("a");
    });
    EXPECT_EQ(statuses(wire.receive(30'000)), status);
    is_told = true;
    EXPECT_TRUE(wire.has_ended);
    EXPECT_LT(seconds_since(begin), max_seconds);
    drip.join();
  }
}

TEST(Wire, AServerThatStopsWaitsForNoConnection) {
  auto desk = std::make_unique<Desk>();
  std::vector<Wire> idle;
  for (int i = 0; i < 100; ++i) {
    idle.emplace_back(desk->port);
    idle.back().send("GET / HTTP/1.1\r\n");
  }
  const auto begin = Clock::now();
  desk.reset();
  EXPECT_LT(seconds_since(begin), max_seconds);
}

TEST(Wire, AHandlerThatThrowsIsAnsweredAndTheServerGoesOn) {
  Listener listener{Limits{}};
  listener.Get("/good", [](const httplib::Request&, httplib::Response& response) {
    response.set_content("1", "a/b");
  });
  listener.Get("/one",
               [](const httplib::Request&, httplib::Response&) { throw std::runtime_error("a\r\nb"); });
  listener.Get("/two", [](const httplib::Request&, httplib::Response&) { throw 5; });
  listener.Post("/one",
                [](const httplib::Request&, httplib::Response&, const httplib::ContentReader& reader) {
                  reader([](const char*, std::size_t) -> bool { throw std::bad_alloc(); });
                });
  listener.Get("/late", [](const httplib::Request&, httplib::Response& response) {
    response.set_content_provider(5, "a/b", [](std::size_t, std::size_t, httplib::DataSink&) -> bool {
      throw std::runtime_error("late");
    });
  });
  const int port = listener.bind_to_any_port("127.0.0.1");
  std::thread thread([&] { EXPECT_TRUE(listener.run()); });
  const auto ask = [&](const std::string& line, const std::string& rest = "") {
    return raw(port, line + " HTTP/1.1\r\n" + rest + "\r\nGET /good HTTP/1.1\r\nConnection: close\r\n\r\n",
               5000);
  };
  EXPECT_EQ(statuses(ask("GET /good")), "200 200");
  for (const std::string& answer :
       {ask("GET /one"), ask("GET /two"), ask("POST /one", "Content-Length: 2\r\n")}) {
    EXPECT_EQ(statuses(answer), "500") << answer;
    EXPECT_NE(answer.find("Connection: close"), std::string::npos) << answer;
    EXPECT_NE(answer.find(R"({"error":{"code":"internal")"), std::string::npos) << answer;
  }
  EXPECT_EQ(statuses(ask("GET /late")), "200 cut short");  // its head had gone out
  EXPECT_EQ(statuses(ask("GET /good")), "200 200");
  listener.stop();
  thread.join();
}

TEST(Head, IsReadOneWayOrRefused) {
  const auto status = [](const std::string& text) {
    const auto head = read_head(text);
    return head ? 200 : head.error().status;
  };
  const std::string line = "GET / HTTP/1.1\r\n";
  EXPECT_EQ(status(line + "Host: a\r\n\r\n"), 200);
  EXPECT_EQ(status(line + "Host: a"), 400);
  EXPECT_EQ(status(""), 400);
  EXPECT_EQ(status("GET / HTTP/1.1\n\n"), 400);
  EXPECT_EQ(status("GET / HTTP/3\r\n\r\n"), 505);
  EXPECT_EQ(status(line + "hOST: a\r\nHost: a\r\n\r\n"), 400);
  EXPECT_EQ(status(line + "transfer-encoding: gzip\r\n\r\n"), 411);
  EXPECT_EQ(status(line + "A\tB: 1\r\n\r\n"), 400);
  EXPECT_EQ(status(line + ": 1\r\n\r\n"), 400);
  for (int c = 0; c < 256; ++c) {  // of a value
    const bool is_good = (c >= ' ' && c != 0x7f) || c == '\t';
    EXPECT_EQ(status(line + "A: b" + static_cast<char>(c) + "\r\n\r\n"), is_good ? 200 : 400) << c;
  }
  EXPECT_EQ(read_head(line + "Content-Length: 12 \r\n\r\n")->body, 12U);
}

}  // namespace wire_test
}  // namespace sinew::server
