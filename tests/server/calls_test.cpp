#include "server/calls.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "server/queries.hpp"
#include "server/watchdog.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::server {
namespace calls_test {

using nlohmann::json;
using Texts = std::vector<std::string_view>;

TEST(Queries, AreABodyOrItsElements) {
  EXPECT_EQ(queries_of(R"( {"query": "describe"} )", 9), (Texts{R"({"query": "describe"})"}));
  EXPECT_EQ(queries_of(R"([{"a": [1, 2]}, {"b": "], \" ,["},{}])", 9),
            (Texts{R"({"a": [1, 2]})", R"({"b": "], \" ,["})", "{}"}));
  EXPECT_EQ(queries_of("[1, ]", 9),
            (Texts{"1", ""}));  // an element that is no query is for a session to refuse
  for (const char* body : {"", " ", "5", "[]", "[ ]", "[", "]", "[{]", "[}", "[{\"a]", "[\"\\", "text"})
    EXPECT_TRUE(queries_of(body, 9).empty()) << body;
  EXPECT_EQ(queries_of("[" + std::string(1'000'000, ',') + "]", 9).size(), 10U);
}

TEST(Rate, GivesASecondsWorthAtOnceAndThenASecondsWorthASecond) {
  Rate rate(10);
  const auto start = Rate::Clock::now();
  const auto after = [&](int milliseconds) { return start + std::chrono::milliseconds(milliseconds); };
  EXPECT_TRUE(rate.allows("a", 10, start));
  EXPECT_FALSE(rate.allows("a", 1, start));
  EXPECT_TRUE(rate.allows("b", 10, start));
  EXPECT_TRUE(rate.allows("a", 5, after(550)));
  EXPECT_FALSE(rate.allows("a", 5, after(600)));
  EXPECT_TRUE(rate.allows("a", 10, after(60'000)));
  EXPECT_FALSE(rate.allows("a", 1, after(60'000)));
}

TEST(Places, AreGivenBack) {
  Places places(1);
  {
    const auto first = places.wait(std::chrono::seconds(0));
    EXPECT_TRUE(first);
    EXPECT_FALSE(places.wait(std::chrono::milliseconds(1)));
  }
  EXPECT_TRUE(places.wait(std::chrono::seconds(0)));
}

TEST(Robots, KeepTheLastUsed) {
  Robots robots(2, 1'000'000);
  const auto text = [](const char* name) { return read_robot_text(name).value(); };
  const std::string a = robots.open(text("3-rfr")).value(), b = robots.open(text("3-frr")).value();
  EXPECT_EQ(robots.open(text("3-rfr")).value(), a);
  const std::string c = robots.open(text("3prs")).value();
  EXPECT_TRUE(robots.find(a));
  EXPECT_FALSE(robots.find(b));
  EXPECT_TRUE(robots.find(c));
}

TEST(Robots, KeepNoMoreTextThanTold) {
  const auto text = [](const char* name) { return read_robot_text(name).value(); };
  Robots robots(9, text("3-rfr").size() + text("3-frr").size());
  const std::string a = robots.open(text("3-rfr")).value(), b = robots.open(text("3-frr")).value();
  EXPECT_TRUE(robots.find(a) && robots.find(b));
  const std::string c = robots.open(text("3-rfr") + "#").value();  // the same robot, another text
  EXPECT_FALSE(robots.find(a));
  EXPECT_FALSE(robots.find(b));
  EXPECT_TRUE(robots.find(c));
}

TEST(Room, IsGivenBack) {
  Room room(10);
  auto six = room.take(6);
  EXPECT_TRUE(six);
  EXPECT_FALSE(room.take(5));
  EXPECT_TRUE(room.take(4));
  six.reset();
  EXPECT_TRUE(room.take(10));
}

TEST(Watchdog, EndsWhatIsOverAndLetsTheNextBegin) {
  Watchdog dog;
  std::atomic<bool> is_late = false;
  Watchdog::Watched watched(dog, [&] { return is_late.load(); });
  const auto until_over = [&] {
    for (int i = 0; i < 1000 && !watched.is_over(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return watched.token().stop_requested();
  };
  EXPECT_FALSE(watched.is_over());
  is_late = true;
  EXPECT_TRUE(until_over());
  watched.renew([&] { is_late = false; });
  EXPECT_FALSE(watched.is_over());
  std::this_thread::sleep_for(std::chrono::milliseconds(50));  // it has looked again
  EXPECT_FALSE(watched.is_over());
  dog.stop();
  EXPECT_TRUE(until_over());
  EXPECT_TRUE(Watchdog::Watched(dog, [] { return false; }).is_over());
}

TEST(Calls, TellWhatHasNoTimeLeft) {
  Options options;
  options.limits.time = 0;
  Calls calls(options);
  const std::string handle =
      json::parse(calls.open_robot(read_robot_text("3-rfr").value()).text)["robot"].get<std::string>();
  const json answers =
      json::parse(calls.query(handle, R"([{"query": "describe"}, {"query": "describe"}])", "a").text);
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[1]["error"]["code"], "too_slow");
}

TEST(Calls, TellWhatHasNoRoomLeft) {
  Options options;
  options.limits.answers = 100;
  Calls calls(options);
  const std::string handle =
      json::parse(calls.open_robot(read_robot_text("3-rfr").value()).text)["robot"].get<std::string>();
  const json answers =
      json::parse(calls.query(handle, R"([{"query": "describe"}, {"query": "describe"}])", "a").text);
  EXPECT_EQ(answers[0]["status"], "converged");
  EXPECT_EQ(answers[1]["error"]["code"], "too_large");
}

}  // namespace calls_test
}  // namespace sinew::server
