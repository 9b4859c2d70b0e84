#include "server/calls.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "server/queries.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::server {
namespace {

using nlohmann::json;
using Texts = std::vector<std::string_view>;

TEST(Queries, AreABodyOrItsElements) {
  EXPECT_EQ(queries_of(R"( {"query": "describe"} )"), (Texts{R"({"query": "describe"})"}));
  EXPECT_EQ(queries_of(R"([{"a": [1, 2]}, {"b": "], \" ,["},{}])"),
            (Texts{R"({"a": [1, 2]})", R"({"b": "], \" ,["})", "{}"}));
  EXPECT_EQ(queries_of("[1, ]"), (Texts{"1", ""}));  // an element that is no query is for a session to refuse
  for (const char* body : {"", " ", "5", "[]", "[ ]", "[", "]", "[{]", "[}", "[{\"a]", "[\"\\", "text"})
    EXPECT_TRUE(queries_of(body).empty()) << body;
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
  Robots robots(2);
  const auto text = [](const char* name) { return read_robot_text(name).value(); };
  const std::string a = robots.open(text("3-rfr")).value(), b = robots.open(text("3-frr")).value();
  EXPECT_EQ(robots.open(text("3-rfr")).value(), a);
  const std::string c = robots.open(text("3prs")).value();
  EXPECT_TRUE(robots.find(a));
  EXPECT_FALSE(robots.find(b));
  EXPECT_TRUE(robots.find(c));
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

}  // namespace
}  // namespace sinew::server
