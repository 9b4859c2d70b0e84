/// What a query may cost: its time, that of its request, and of a client who has left.
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <thread>

#include "cpu_time.hpp"
#include "sanitizers.hpp"
#include "wire.hpp"
// It has httplib: last.
#include "desk.hpp"

namespace sinew::server {
namespace limits_test {

using namespace std::chrono_literals;

/// Ten seconds of computing where nothing stops it.
const std::string endless =
    R"({"query": "track", "inputs": [0.4, 0.4, 0.4, 0.4, 0.4, 0.4], "to": {"wrench": [0, 0, -30, 0, 0, 0]},)"
    R"( "samples": 20000, "branches": true, "range": [-100, 100]})";
const std::string quick = R"({"query": "describe"})";

/// What is computed meanwhile, here and in the server, which is part of this process [s]: who waits for a
/// query lets it compute.
double time_of(const std::function<void()>& work) {
  const double begin = test::cpu_seconds();
  work();
  return test::cpu_seconds() - begin;
}

Options with_limits(double query, double time) {
  Options options;
  options.limits.query = query;
  options.limits.time = time;
  options.limits.working = 1;
  return options;
}

/// Instrumented code gets to where it can stop later.
const double patience = test::is_instrumented ? 10 : 1;

TEST(Limits, AQueryThatTakesTooLongIsStoppedAndTheNextOneIsNot) {
  Desk desk(with_limits(0.3, 20));
  const std::string path = "/api/query?robot=" + desk.opened("hexapod-heavy");
  json answer;
  EXPECT_LT(time_of([&] { answer = json::parse(desk.post(path, endless)); }), patience);
  EXPECT_EQ(answer["status"], "stopped");
  EXPECT_NE(answer["message"].get<std::string>().find("POST /api/jobs"), std::string::npos)
      << answer["message"];
  EXPECT_LT(time_of([&] { answer = json::parse(desk.post(path, "[" + endless + "," + quick + "]")); }),
            patience);
  EXPECT_EQ(answer[0]["status"], "stopped");
  EXPECT_EQ(answer[1], json::parse(desk.post(path, quick)));
}

TEST(Limits, TheQueriesOfARequestShareItsTime) {
  Desk desk(with_limits(0.3, 0.5));
  const std::string path = "/api/query?robot=" + desk.opened("hexapod-heavy");
  json answers;
  EXPECT_LT(time_of([&] {
              answers = json::parse(desk.post(path, "[" + endless + "," + endless + "," + endless + "]"));
            }),
            1.2 * patience);
  EXPECT_EQ(answers[0]["status"], "stopped");
  EXPECT_TRUE(answers[1].contains("error") || answers[1]["status"] == "stopped");  // as the machine has time
  EXPECT_EQ(answers[2]["error"]["code"], "too_slow");
}

TEST(Limits, AQueryEndsWhenItsClientLeaves) {
  Desk desk(with_limits(20, 20));
  const std::string path = "/api/query?robot=" + desk.opened("hexapod-heavy");
  {
    Wire wire(desk.port);
    wire.send("POST " + path + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(desk.port) +
              "\r\nContent-Type: application/json\r\nContent-Length: " + std::to_string(endless.size()) +
              "\r\n\r\n" + endless);
    std::this_thread::sleep_for(200ms);  // it has the one place to compute
  }
  EXPECT_LT(time_of([&] { desk.post(path, quick); }), patience);
  EXPECT_EQ(desk.status, 200);
}

TEST(Limits, AJobThatIsCancelledEndsWithinAQuery) {
  Desk desk;
  const std::string robot = desk.opened("hexapod-heavy");
  const std::string job = json::parse(
      desk.post("/api/jobs", R"({"robot": ")" + robot + R"(", "queries": [)" + endless + "]}"))["job"];
  std::this_thread::sleep_for(200ms);
  std::string events;
  const double seconds = time_of([&] {
    desk.client.Delete("/api/jobs/" + job);
    events = desk.get("/api/jobs/" + job + "/events");
  });
  EXPECT_LT(seconds, 0.3);  // 0.02 to see it, and the heart beat of the stream 0.1
  EXPECT_NE(events.find("event: cancelled\ndata: {\"done\":0,\"total\":1}"), std::string::npos) << events;
}

TEST(Limits, AServerThatStopsWaitsForNoQuery) {
  auto desk = std::make_unique<Desk>(with_limits(20, 20));
  const std::string path = "/api/query?robot=" + desk->opened("hexapod-heavy");
  std::thread client([&, port = desk->port] {
    httplib::Client one("127.0.0.1", port);
    const auto answer = one.Post(path, endless, as_json);
    EXPECT_TRUE(!answer || json::parse(answer->body)["status"] == "stopped");
  });
  std::this_thread::sleep_for(200ms);
  EXPECT_LT(time_of([&] { desk.reset(); }), patience);
  client.join();
}

}  // namespace limits_test
}  // namespace sinew::server
