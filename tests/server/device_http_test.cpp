/// A device through the server: the simulated one, on a pseudo-terminal, and two pages.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

// It has httplib: last.
#include "desk.hpp"

namespace sinew::server {
namespace device_http_test {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

Options with_demo() {
  Options options;
  options.robot = "nottingham-tpcj";
  options.device.is_demo = true;
  options.device.folder = (std::filesystem::temp_directory_path() / "sinew-http-device").string();
  return options;
}

/// The events, as a page has them.
class Events {
 public:
  explicit Events(int port) : client_("127.0.0.1", port) {
    thread_ = std::thread([this] {
      client_.Get("/api/device/events", [this](const char* bytes, std::size_t count) {
        text_.append(bytes, count);
        for (std::size_t end; (end = text_.find("\n\n")) != std::string::npos; text_.erase(0, end + 2))
          take(text_.substr(0, end));
        return !is_over_;
      });
    });
  }
  ~Events() {
    is_over_ = true;
    client_.stop();
    thread_.join();
  }
  json frame() {
    const std::lock_guard lock(mutex_);
    return frame_;
  }
  int frames() const { return frames_; }
  std::vector<std::string> log() {
    const std::lock_guard lock(mutex_);
    return log_;
  }
  bool await(const std::function<bool(const json&)>& holds) {
    for (int i = 0; i < 500; ++i, std::this_thread::sleep_for(20ms))
      if (const json now = frame(); !now.is_null() && holds(now)) return true;
    ADD_FAILURE() << frame();
    return false;
  }

 private:
  void take(const std::string& event) {
    const std::size_t data = event.find("data: ");
    if (data == std::string::npos) return;
    const std::lock_guard lock(mutex_);
    if (event.starts_with("event: log")) log_.push_back(json::parse(event.substr(data + 6))["text"]);
    if (!event.starts_with("event: frame")) return;
    frame_ = json::parse(event.substr(data + 6));
    ++frames_;
  }
  httplib::Client client_;
  std::string text_;
  std::mutex mutex_;
  json frame_;
  std::vector<std::string> log_;
  std::atomic<int> frames_ = 0;
  std::atomic<bool> is_over_ = false;
  std::thread thread_;
};

std::string code_of(Desk& desk, const std::string& call, const json& body) {
  const json answer = json::parse(desk.post("/api/device/" + call, body.dump()), nullptr, false);
  return answer.contains("error") ? answer["error"]["code"].get<std::string>() : "";
}

TEST(DeviceHttp, AServerWithoutOneSaysSo) {
  Desk desk;
  EXPECT_EQ(desk.get("/api/device"), R"({"device":null})");
  EXPECT_EQ(code_of(desk, "hold", json::object()), "no_device");
  desk.get("/api/device/events");
  EXPECT_EQ(desk.status, 404);
}

/// While it is homed it records.
void keep_pictures(Desk& desk, const json& frame) {
  const std::string jpeg = "\xFF\xD8\xFF picture", path = "/api/device/snapshot";
  const auto code = [&](const std::string& query, const std::string& bytes, const char* type) {
    const json answer = json::parse(desk.post(path + query, bytes, type), nullptr, false);
    return answer.contains("error") ? answer["error"]["code"].get<std::string>() : "";
  };
  EXPECT_EQ(code("", jpeg, "image/png"), "bad_picture");
  EXPECT_EQ(code("", "", "image/jpeg"), "bad_picture");
  EXPECT_EQ(code("", "<svg/>", "image/png"), "bad_picture");
  EXPECT_EQ(code("", jpeg, "image/gif"), "wrong_type");
  EXPECT_EQ(code("?text=" + std::string(501, 'x'), jpeg, "image/jpeg"), "too_long");
  EXPECT_EQ(code("?text=%ff%0a%22", jpeg, "image/jpeg"), "");
  const std::string name = frame["recording"]["name"];
  std::string kept;
  for (int i = 0; i < 250 && kept.empty(); ++i, std::this_thread::sleep_for(20ms)) {
    const std::string told = desk.get("/api/recordings/" + name + "/snapshots/001");
    if (desk.status == 200) kept = told;
  }
  EXPECT_EQ(kept, jpeg);
  const json list = json::parse(desk.get("/api/recordings"));
  EXPECT_NE(std::ranges::find_if(list["recordings"], [&](const json& one) { return one["name"] == name; }),
            list["recordings"].end());
}

/// What moves and what the page shows are one robot.
TEST(DeviceHttp, ItsRobotMayBeChanged) {
  Options options = with_demo();
  options.settings = {{.key = "tolerance", .value = make_node("0.2 mm")}};
  Desk desk(options);
  const json opened = json::parse(desk.get("/api/robots"))["opened"],
             device = json::parse(desk.get("/api/device"))["device"];
  EXPECT_EQ(json::parse(desk.post("/api/robot", opened["changed"]["text"], as_yaml))["robot"],
            device["robot"]);
  const json answer = json::parse(
      desk.post("/api/query?robot=" + device["robot"].get<std::string>(), R"({"query": "describe"})"));
  EXPECT_EQ(answer["tolerance"], 0.0002);
}

TEST(DeviceHttp, TwoPagesAtOneDevice) {
  Desk desk(with_demo());
  Events first(desk.port), second(desk.port);
  ASSERT_TRUE(first.await([](const json& frame) { return frame["link"] == "ok"; }));
  const json device = json::parse(desk.get("/api/device"))["device"];
  EXPECT_EQ(device["source"], "demo");
  EXPECT_EQ(device["tendons"], 3);
  EXPECT_TRUE(device["has_tension"] && device["has_stage"] && device["faults"]);
  const json query{{"query", "describe"}};
  desk.post("/api/query?robot=" + device["robot"].get<std::string>(), query.dump());
  EXPECT_EQ(desk.status, 200);

  const json mine = json::parse(desk.post("/api/device/lease", "{}"));
  const json lease{{"lease", mine["lease"]}};
  EXPECT_EQ(code_of(desk, "lease", json::object()), "lease_taken");
  EXPECT_EQ(code_of(desk, "arm", {{"lease", "another"}}), "not_yours");
  EXPECT_EQ(code_of(desk, "arm", lease), "not_homed");
  const json no = json::parse(desk.post("/api/device/snapshot", "\xFF\xD8\xFF", "image/jpeg"));
  EXPECT_EQ(no["error"]["code"], "no_recording");
  EXPECT_EQ(code_of(desk, "move", {{"lease", mine["lease"]}, {"held", true}}), "not_armed");
  EXPECT_EQ(code_of(desk, "lease", lease), "");
  const int before = second.frames();
  bool has_homed = false;
  Clock::duration slowest{};
  for (int i = 0; i < 15; ++i) {  // a button held for a second and a half
    const auto asked = Clock::now();
    EXPECT_EQ(code_of(desk, "lease", lease), "");
    EXPECT_EQ(code_of(desk, "home", {{"lease", mine["lease"]}, {"held", true}}), "");
    slowest = std::max(slowest, Clock::now() - asked);
    std::this_thread::sleep_for(80ms);
    has_homed |= first.frame()["activity"] == "homing" && !first.frame()["homing"].is_null();
  }
  EXPECT_TRUE(has_homed) << first.frame();
  EXPECT_LT(slowest, 100ms) << "of two calls";
  EXPECT_NEAR(second.frames() - before, 25, 12);
  keep_pictures(desk, first.frame());
  EXPECT_EQ(code_of(desk, "hold", json::object()), "") << "anybody";
  EXPECT_EQ(code_of(desk, "home", {{"lease", mine["lease"]}, {"held", true}}), "release_first");
  EXPECT_TRUE(second.await([](const json& frame) { return frame["state"] == "view_only"; })) << "2 s";
  EXPECT_EQ(second.frame()["why"], first.frame()["why"]);

  EXPECT_EQ(code_of(desk, "fault", {{"line", "unplug"}}), "");
  EXPECT_TRUE(first.await([](const json& frame) { return frame["sections"][0]["word"] == "NO DATA"; }));
  EXPECT_EQ(code_of(desk, "fault", {{"line", "plug"}}), "");
  EXPECT_TRUE(first.await([](const json& frame) { return frame["link"] == "ok"; }));
  EXPECT_EQ(code_of(desk, "fault", {{"line", "nonsense"}}), "fault");
  const auto log = first.log();
  EXPECT_NE(std::ranges::find(log, "device found"), log.end());
}

/// With a lease of this moment: on a busy machine 300 ms may be over before the next call, and a line silent
/// for a while.
std::string with_lease(Desk& desk, const std::string& call, json body) {
  std::string code = "never asked";
  for (int i = 0; i < 200; ++i, std::this_thread::sleep_for(20ms)) {
    const json taken = json::parse(desk.post("/api/device/lease", "{}"));
    if (!taken.contains("lease")) continue;  // the last one is not over yet
    body["lease"] = taken["lease"];
    code = code_of(desk, call, body);
    desk.post("/api/device/release", json{{"lease", taken["lease"]}}.dump());
    if (code != "not_yours" && code != "no_link") break;
  }
  return code;
}

TEST(DeviceHttp, APlanIsLoadedWhereItIsOfTheSameRobot) {
  Desk desk(with_demo());
  Events events(desk.port);
  ASSERT_TRUE(events.await([](const json& frame) { return frame["link"] == "ok"; }));
  const json device = json::parse(desk.get("/api/device"))["device"];
  EXPECT_NE(device["file"], device["robot"]) << "it names no motor: that of the firmware is added";
  json plan{{"robot", device["file"]}, {"name", "wall"}, {"steps", json::array()}};
  for (int k = 0; k < 3000; ++k) {
    json bends = json::array();
    for (int m = 0; m < 5; ++m) bends.push_back({1e-5 * k, -1.234567890123e-5 * k});
    plan["steps"].push_back({{"bends", bends}, {"stage", 1e-5 * k}});
  }
  EXPECT_GT(plan.dump().size(), 300'000u);
  EXPECT_EQ(with_lease(desk, "plan", plan), "");
  EXPECT_TRUE(events.await([](const json& frame) { return frame["plan"].is_object(); }));
  EXPECT_EQ(events.frame()["plan"]["name"], "wall");
  const json told = json::parse(desk.get("/api/device/plan"))["plan"];
  EXPECT_EQ(told["steps"], plan["steps"]);
  EXPECT_EQ(with_lease(desk, "follow", {{"held", true}}), "not_armed");
  EXPECT_EQ(with_lease(desk, "follow", {{"held", true}, {"back", true}}), "not_armed");
  plan["robot"] = "0123";
  EXPECT_EQ(code_of(desk, "plan", plan), "another_robot");
  plan.erase("robot");
  EXPECT_EQ(code_of(desk, "plan", plan), "another_robot");
  desk.post("/api/device/plan", std::string(1'000'000, '['));
  EXPECT_EQ(desk.status, 400);
  desk.post("/api/device/plan", R"({"name": "x", "steps": [{"bends": [[1e999, 0]], "stage": 0}]})");
  EXPECT_EQ(desk.status, 400);
  desk.post("/api/device/plan", std::string((1U << 20U) + 1, ' '));
  EXPECT_EQ(desk.status, 413);
  desk.post("/api/device/target", std::string(20'000, ' '));
  EXPECT_EQ(desk.status, 413) << "other commands are short";
  EXPECT_EQ(events.frame()["plan"]["name"], "wall") << "what is refused changes nothing";
  EXPECT_EQ(code_of(desk, "plan", {{"lease", "another"}}), "not_yours");
  EXPECT_EQ(with_lease(desk, "plan", json::object()), "");
  EXPECT_EQ(desk.get("/api/device/plan"), R"({"plan":null})");
}

}  // namespace device_http_test
}  // namespace sinew::server
