#include "sinew.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "sinew/io/robot_file.hpp"
#include "sinew/query/session.hpp"

namespace {

using Json = nlohmann::json;

sinew_robot* opened(std::string_view source, std::int32_t kind = SINEW_FILE) {
  sinew_robot* robot = nullptr;
  EXPECT_EQ(sinew_open(source.data(), source.size(), kind, &robot, nullptr), SINEW_OK) << source;
  return robot;
}

std::string asked(sinew_session* session, std::string_view question) {
  std::size_t length = 0;
  char* answer = sinew_ask(session, question.data(), question.size(), &length);
  EXPECT_NE(answer, nullptr);
  const std::string text(answer, length);
  EXPECT_EQ(answer[length], '\0');
  sinew_free(answer);
  return text;
}

constexpr std::string_view rods =
    R"({"query": "forward", "inputs": [0.44, 0.42, 0.41], "want": ["stiffness"]})";

TEST(CAbi, AnswersAsASession) {
  EXPECT_EQ(sinew_abi(), SINEW_ABI);
  for (const std::string_view name : sinew::builtin_robot_names()) {
    sinew_robot* robot = opened(name);
    sinew_session* session = sinew_session_new(robot);
    ASSERT_NE(session, nullptr);
    sinew_release(robot);  // the session keeps it
    auto own = sinew::Session::open(std::string(name)).value();
    for (const std::string_view question : {std::string_view(R"({"query": "describe"})"), rods})
      EXPECT_EQ(asked(session, question), own.answer(question)) << name;
    sinew_release(session);
  }
}

TEST(CAbi, OpensTexts) {
  const std::string text = sinew::read_robot_text("3-rfr").value();
  sinew_robot* robot = opened(text, SINEW_TEXT);
  sinew_session* session = sinew_session_new(robot);
  EXPECT_EQ(Json::parse(asked(session, R"({"query": "describe"})"))["robot"], "3-RFR");
  sinew_release(session);
  sinew_release(robot);
}

TEST(CAbi, SaysWhatIsWrong) {
  struct Case {
    std::string_view source;
    std::int32_t kind;
    std::string_view said;
  };
  for (const auto& [source, kind, said] :
       {Case{"no-such-robot", SINEW_FILE, "file_missing"}, Case{"", SINEW_FILE, "file_missing"},
        Case{"legs: [", SINEW_TEXT, "yaml_syntax"}, Case{"\xff", SINEW_TEXT, "not_utf8"},
        Case{"", SINEW_TEXT, "empty_document"}, Case{"3-rfr", 7, "SINEW_TEXT"}}) {
    sinew_robot* robot = reinterpret_cast<sinew_robot*>(1);
    char* error = nullptr;
    EXPECT_EQ(sinew_open(source.data(), source.size(), kind, &robot, &error), SINEW_BAD_INPUT);
    EXPECT_EQ(robot, nullptr);
    ASSERT_NE(error, nullptr);
    EXPECT_NE(std::string_view(error).find(said), std::string_view::npos) << error;
    sinew_free(error);
  }
}

TEST(CAbi, TakesNothingForAnything) {
  sinew_robot* robot = nullptr;
  EXPECT_EQ(sinew_open(nullptr, 0, SINEW_FILE, &robot, nullptr), SINEW_BAD_INPUT);
  EXPECT_EQ(sinew_open("3-rfr", 5, SINEW_FILE, nullptr, nullptr), SINEW_BAD_INPUT);
  EXPECT_EQ(sinew_session_new(nullptr), nullptr);
  EXPECT_EQ(sinew_ask(nullptr, "{}", 2, nullptr), nullptr);
  sinew_stop(nullptr);
  sinew_free(nullptr);
  sinew_release(nullptr);
  robot = opened("3-rfr");
  sinew_session* session = sinew_session_new(robot);
  EXPECT_EQ(sinew_ask(session, nullptr, 0, nullptr), nullptr);
  using namespace std::string_view_literals;
  for (const std::string_view question :
       {""sv, "{"sv, "[]"sv, "null"sv, "\0"sv, "{\"query\": \"\xff\"}"sv, "{\"query\":\0}"sv})
    EXPECT_TRUE(Json::parse(asked(session, question)).contains("error")) << question;
  sinew_release(session);
  sinew_release(robot);
}

TEST(CAbi, ThreadsShareARobot) {
  sinew_robot* robot = opened("3pfs-g2");
  sinew_session* session = sinew_session_new(robot);
  const std::string alone = asked(session, rods);
  sinew_release(session);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&] {
      sinew_session* own = sinew_session_new(robot);
      for (int k = 0; k < 50; ++k) EXPECT_EQ(asked(own, rods), alone);
      sinew_release(own);
    });
  for (std::thread& thread : threads) thread.join();
  sinew_release(robot);
}

TEST(CAbi, StopsFromAnotherThread) {
  sinew_robot* robot = opened("hexapod-torsion");
  sinew_session* session = sinew_session_new(robot);
  constexpr std::string_view home = R"({"query": "describe"})",
                             question =  // seconds
                             R"({"query": "forward", "inputs": [0.5, 0.5, 0.5, 0.5, 0.5, 0.5], "all": true})";
  std::atomic<bool> is_answered = false;
  std::thread stopper([&] {
    while (!is_answered) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      sinew_stop(session);
    }
  });
  const std::string answer = asked(session, question);
  is_answered = true;
  stopper.join();
  EXPECT_EQ(Json::parse(answer)["status"], "stopped") << answer.substr(0, 200);
  EXPECT_EQ(Json::parse(asked(session, home))["robot"], "hexapod-torsion");  // answered as ever
  sinew_release(session);
  sinew_release(robot);
}

}  // namespace
