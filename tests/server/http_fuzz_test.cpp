/// Requests that are made up and broken in many ways, against a server on a socket: it answers well-formed
/// HTTP or closes the connection, at once, and goes on. From the same number the same requests;
/// SINEW_FUZZ_SECONDS says how long.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <thread>
#include <vector>

#include "thorough.hpp"
#include "wire.hpp"
// It has httplib: last.
#include "desk.hpp"
#include "paths.hpp"

namespace sinew::server {
namespace http_fuzz_test {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

struct Made {
  std::string line;  ///< method and path
  std::vector<std::string> headers;
  std::string body;
};

Made read_made(const std::string& text) {
  Made made;
  std::size_t at = 0;
  for (std::size_t end; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
    const std::string line = text.substr(at, end - at);
    if (line.empty()) break;
    if (made.line.empty())
      made.line = line;
    else
      made.headers.push_back(line);
  }
  made.body = text.substr(std::min(at + 1, text.size()));
  return made;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at; (at = text.find(what)) != std::string::npos;) text.replace(at, what.size(), by);
  return text;
}

class Maker {
 public:
  Maker(const std::vector<Made>& corpus, std::string host, unsigned seed)
      : corpus_(corpus),
        host_(std::move(host)),
        random_(seed) {}

  std::size_t pick(std::size_t count) { return count ? random_() % count : 0; }

  /// One connection's worth: requests after each other, perhaps with bytes wrong.
  std::string next() {
    std::string text;
    for (std::size_t count = 1 + pick(3); count > 0; --count) text += one();
    if (pick(4) == 0) spoil(text, 6);
    if (pick(8) == 0) text.resize(pick(text.size()));
    return text;
  }

 private:
  template <class Of>
  auto some(const Of& of) {
    return of[pick(std::size(of))];
  }

  std::string one() {
    Made made = some(corpus_);
    if (pick(4) == 0) made.line = some(methods) + ' ' + some(paths);
    if (pick(4) == 0) made.body = some(corpus_).body;
    for (std::size_t count = pick(3) * pick(2); count > 0; --count) made.headers.push_back(some(headers));
    if (pick(6) == 0) spoil(made.body, 8);
    if (pick(6) == 0) made.body.insert(pick(made.body.size() + 1), some(bodies));
    if (pick(12) == 0) made.body.insert(pick(made.body.size() + 1), std::string(pick(20'000), some(fillers)));
    const std::string end = pick(30) == 0 ? "\n" : "\r\n";
    std::string text = made.line + ' ' + (pick(12) == 0 ? some(versions) : "HTTP/1.1") + end;
    if (pick(20) != 0) text += "Host: " + host_ + end;
    for (const std::string& header : made.headers) text += header + end;
    if (pick(12) == 0)
      text += some(lengths) + end;
    else if (!made.body.empty() || pick(4) == 0)
      text += "Content-Length: " + std::to_string(made.body.size()) + end;
    return text + end + made.body;
  }

  void spoil(std::string& text, std::size_t most) {
    for (std::size_t count = 1 + pick(most); count > 0 && !text.empty(); --count) {
      const std::size_t at = pick(text.size());
      if (pick(3) == 0) {
        text.insert(at, some(bodies));
      } else if (pick(3) == 0) {
        text.erase(at, pick(20));
      } else {
        text[at] = pick(2) == 0 ? some(fillers) : static_cast<char>(pick(256));
      }
    }
  }

  inline static const std::vector<std::string> methods{
      "GET", "HEAD", "POST", "PUT", "DELETE", "OPTIONS", "PATCH", "PRI", "TRACE", "CONNECT", "get", "", "X"},
      paths{"/",
            "*",
            "",
            "/api/robot",
            "/api/robots/..%2f..%2fetc%2fpasswd",
            "/api/query",
            "/api/jobs/",
            "/%00",
            "/api/jobs//events",
            "/?token=%",
            "//",
            "http://a/",
            "/api/query?robot=%ff&robot=",
            "/\x80",
            "/api/robots/" + std::string(7000, '.'),
            "/?" + std::string(7000, '&')},
      headers{"Content-Type: text/yaml",
              "Content-Type: application/json",
              "Content-Encoding: gzip",
              "Content-Encoding: br",
              "Expect: 100-continue",
              "Transfer-Encoding: chunked",
              "Connection: close",
              "Connection: keep-alive",
              "Range: bytes=0-0,-1,5-2",
              "Range: bytes=" + std::string(4000, '0') + "-",
              "Origin: null",
              "Last-Event-ID: 99999999999999999999",
              "Host: evil.example",
              ": ",
              " X: folded",
              "Cookie: sinew_token=",
              "Authorization: Bearer ",
              "X: " + std::string(9000, 'h'),
              "REMOTE_ADDR: x",
              "Accept-Encoding: gzip, br",
              "Upgrade: h2c",
              "Content-Type: multipart/form-data; boundary="},
      versions{"HTTP/1.0", "HTTP/2", "HTTP/1.1 x", "", "HTTP/9"},
      lengths{"Content-Length: -1",
              "Content-Length: 5",
              "Content-Length: 0",
              "Content-Length: 99999",
              "Content-Length: 18446744073709551616",
              "Content-Length: 5\r\nContent-Length: 6",
              "Content-Length: x",
              "Transfer-Encoding: chunked\r\n\r\n5\r\nabcde\r\n0",
              "Transfer-Encoding: chunked\r\n\r\nffffffffffffffff"},
      bodies{"\r\n\r\n",
             "\r\n",
             "\n",
             "{",
             "[[[[[[[[",
             "\"",
             "1e999",
             "null",
             "\\ud800",
             "--x\r\n",
             "0\r\n\r\n",
             "&a *a",
             "GET /api/version HTTP/1.1\r\n\r\n",
             "set",
             ": ",
             "-",
             std::string(1, '\0'),
             "\xff\xfe",
             "NaN"};
  static constexpr std::string_view fillers{"\0\r\n\t \"[{a0\x7f\xff:,", 15};

  const std::vector<Made>& corpus_;
  std::string host_;
  std::mt19937 random_;
};

double seconds_of_fuzzing() {
  const char* told = std::getenv("SINEW_FUZZ_SECONDS");
  return told ? std::atof(told) : test::count_of(2, 10);
}

/// Nothing where the text is made of whole replies, each known by its status.
std::string fault_of(const std::string& text) {
  const std::string found = statuses(text, true);
  return std::ranges::all_of(found, [](char c) { return c == ' ' || (c >= '0' && c <= '9'); }) ? "" : found;
}

std::vector<Made> read_corpus(const std::string& robot, const std::string& job) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(test::source_folder) + "/tests/fuzz/corpus/http"))
    paths.push_back(entry.path());
  std::ranges::sort(paths);
  std::vector<Made> corpus;
  for (const auto& path : paths) {
    std::ifstream file(path);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    corpus.push_back(read_made(replaced(replaced(text, "{robot}", robot), "{job}", job)));
  }
  return corpus;
}

TEST(HttpFuzz, WhateverComesIsAnsweredInWholeRepliesOrNotAtAll) {
  Options options;
  options.limits.query = 0.1;
  options.limits.jobs.result = 1'000'000;
  Desk desk(options);
  const std::string robot = desk.opened("3-rfr"), path = "/api/query?robot=" + robot,
                    query = R"({"query": "describe"})";
  const std::string job =
      json::parse(desk.post("/api/jobs", R"({"robot": ")" + robot + R"(", "queries": [5, 5]})"))["job"];
  const std::string expected = desk.post(path, query);
  const std::vector<Made> corpus = read_corpus(robot, job);
  ASSERT_GT(corpus.size(), 10U);
  const auto end = Clock::now() + std::chrono::duration<double>(seconds_of_fuzzing());
  std::vector<std::thread> clients;
  std::atomic<std::size_t> sent = 0, answered = 0;
  std::atomic<bool> is_over = false;
  for (unsigned seed = 1; seed <= 4; ++seed)
    clients.emplace_back([&, seed] {
      Maker maker(corpus, "127.0.0.1:" + std::to_string(desk.port), seed);
      while (Clock::now() < end && !is_over) {
        const std::string request = maker.next();
        const auto begin = Clock::now();
        Wire wire(desk.port);
        const std::size_t cut = maker.pick(4) == 0 ? maker.pick(request.size()) : request.size();
        wire.send(std::string_view(request).substr(0, cut));
        if (cut < request.size()) wire.send(std::string_view(request).substr(cut));
        wire.end();
        const std::string answer = wire.receive(20'000);
        const std::string fault = fault_of(answer);
        ++sent;
        answered += !answer.empty();
        if (!fault.empty() || !wire.has_ended || Clock::now() - begin > 15s) {
          is_over = true;
          ADD_FAILURE() << "seed " << seed << ": " << fault << (wire.has_ended ? "" : " and stays open")
                        << "\n--- asked\n"
                        << request << "\n--- answered\n"
                        << answer;
        }
      }
    });
  httplib::Client good("127.0.0.1", desk.port);
  while (Clock::now() < end && !is_over) {
    const auto answer = good.Post(path, query, as_json);
    if (!answer && !good.Get("/api/version")) ADD_FAILURE() << "nobody answers";
    if (answer && answer->status == 200) {
      EXPECT_EQ(answer->body, expected);
    }
    if (answer && answer->status == 404) desk.opened("3-rfr");  // displaced by robots that were made up
    std::this_thread::sleep_for(20ms);
  }
  for (std::thread& client : clients) client.join();
  std::printf("%zu connections, %zu answered\n", sent.load(), answered.load());
  EXPECT_GT(answered, sent / 4);
}

}  // namespace http_fuzz_test
}  // namespace sinew::server
