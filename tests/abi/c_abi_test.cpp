#include "sinew.h"

#include <gtest/gtest.h>

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "long_fit.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/session.hpp"

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

TEST(CAbi, FollowsAnArmFromQuestionToQuestion) {
  sinew_robot* robot = opened("tendon-rod");
  sinew_session* session = sinew_session_new(robot);
  const auto across = [&](int tension, const char* start) {
    const std::string question =
        R"({"query": "track", "set": {"sections[0].tendons.friction": 0.3}, "points": [{"tensions": [[)" +
        std::to_string(tension) + ", 0, 0, 0]]}]" + start + "}";
    const Json answer = Json::parse(asked(session, question));
    EXPECT_EQ(answer["status"], "converged") << answer;
    return answer["tip"]["position"][0].get<double>();
  };
  const double pulled = across(1, "");
  across(3, R"(, "start": "last")");
  EXPECT_GT(across(1, R"(, "start": "last")"), pulled + 1e-4);  // let go it stays bent
  EXPECT_NEAR(across(1, ""), pulled, 1e-12);
  sinew_release(session);
  sinew_release(robot);
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

/// Through pointers to anything, as of languages without types.
TEST(CAbi, NoticesObjectsOfAnotherKind) {
  sinew_robot* robot = opened("3-rfr");
  sinew_session* session = sinew_session_new(robot);
  void *any_robot = robot, *any_session = session;
  EXPECT_EQ(sinew_ask(static_cast<sinew_session*>(any_robot), "{}", 2, nullptr), nullptr);
  EXPECT_EQ(sinew_session_new(static_cast<sinew_robot*>(any_session)), nullptr);
  EXPECT_EQ(sinew_fields(static_cast<sinew_batch*>(any_session)), nullptr);
  char* error = nullptr;
  const sinew_input in{};
  const sinew_output out{};
  EXPECT_EQ(sinew_run(static_cast<sinew_batch*>(any_session), 0, &in, &out, nullptr, 1, &error),
            SINEW_BAD_INPUT);
  EXPECT_NE(std::string_view(error).find("batch"), std::string_view::npos) << error;
  sinew_free(error);
  sinew_stop(robot);  // nothing of it can be stopped
  std::uint64_t nothing[64] = {};
  sinew_stop(nothing);
  sinew_release(nothing);
  EXPECT_EQ(sinew_ask(reinterpret_cast<sinew_session*>(nothing), "{}", 2, nullptr), nullptr);
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

TEST(CAbi, TellsHowFarAFitIsToAnotherThread) {
  sinew_robot* robot = opened("ftdcr-v4");
  sinew_session* session = sinew_session_new(robot);
  constexpr std::string_view ask_progress = R"({"query": "progress"})";
  EXPECT_EQ(asked(session, ask_progress), R"({"query":"progress","busy":false})");
  std::atomic<bool> is_over = false;
  std::string answer;
  std::thread fit([&] {
    answer = asked(session, sinew::test::long_fit());
    is_over = true;
  });
  int told = 0, last = 0;
  std::string part;
  while (!is_over) {
    const Json now = Json::parse(asked(session, ask_progress));
    if (now.contains("steps")) {
      EXPECT_TRUE(now["busy"].get<bool>());
      EXPECT_TRUE(now["part"] != part || now["steps"].get<int>() >= last) << now;
      EXPECT_GT(now["error"].get<double>(), 0);
      part = now["part"];
      last = now["steps"];
      if (++told == 20) sinew_stop(session);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  fit.join();
  EXPECT_GT(told, 0);
  EXPECT_TRUE(Json::parse(answer).contains("status")) << answer.substr(0, 400);
  EXPECT_EQ(asked(session, ask_progress), R"({"query":"progress","busy":false})");
  // nothing else is taken for it
  EXPECT_TRUE(Json::parse(asked(session, R"({"query": "progress", "id": 1})")).contains("error"));
  EXPECT_TRUE(Json::parse(asked(session, R"({"query": ["progress"]})")).contains("error"));
  sinew_release(session);
  sinew_release(robot);
}

/// A prepared question and the columns of its rows.
struct Rows {
  sinew_batch* batch = nullptr;
  std::vector<double> in, out;
  std::vector<std::uint8_t> statuses;

  Rows(std::string_view robot, std::string_view question) {
    sinew_robot* opened_robot = opened(robot);
    char* error = nullptr;
    EXPECT_EQ(sinew_prepare(opened_robot, question.data(), question.size(), &batch, &error), SINEW_OK)
        << error;
    sinew_release(opened_robot);  // the batch keeps what it needs
  }
  Rows(const Rows&) = delete;
  Rows& operator=(const Rows&) = delete;
  ~Rows() { sinew_release(batch); }

  /// Of arrays whose rows have all fields side by side, as many numbers of each as these.
  std::string run(std::size_t rows, const std::vector<std::size_t>& inputs,
                  const std::vector<std::size_t>& outputs, std::int32_t threads = 0) {
    const auto total = [](const std::vector<std::size_t>& sizes) {
      return std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
    };
    out.assign(rows * total(outputs), -1);
    statuses.assign(rows, 99);
    std::vector<sinew_input> from;
    std::vector<sinew_output> to;
    const auto place = [&](auto& list, auto* data, const std::vector<std::size_t>& sizes) {
      for (const std::size_t size : sizes) {
        list.push_back({data, static_cast<std::ptrdiff_t>(total(sizes) * sizeof(double)), sizeof(double)});
        data += size;
      }
    };
    place(from, in.data(), inputs);
    place(to, out.data(), outputs);
    char* error = nullptr;
    EXPECT_EQ(sinew_run(batch, rows, from.data(), to.data(), statuses.data(), threads, &error), SINEW_OK);
    const std::string said = error ? error : "";
    sinew_free(error);
    return said;
  }
};

TEST(CAbi, RunsRowsOfColumns) {
  Rows rows("3pfs-g2", R"({"query": "forward", "inputs": ["$a", "$b", "$c"], "path": "continue"})");
  char* fields = sinew_fields(rows.batch);
  const Json told = Json::parse(fields);
  sinew_free(fields);
  EXPECT_EQ(told["inputs"][1], (Json{{"name", "b"}, {"unit", "m"}, {"rank", 0}, {"shape", Json::array()}}));
  EXPECT_EQ(told["outputs"][1], (Json{{"name", "quaternion"}, {"unit", ""}, {"rank", 1}, {"shape", {4}}}));
  EXPECT_EQ(told["method"], "rods in lanes");
  EXPECT_EQ(told["want"], Json::array());
  for (int k = 0; k < 100; ++k)
    for (const double length : {0.43, 0.43 + 1e-4 * k, 0.43 - 1e-4 * k}) rows.in.push_back(length);
  EXPECT_EQ(told["outputs"].size(), 3U);
  EXPECT_EQ(told["outputs"][2]["name"], "residual");
  EXPECT_EQ(rows.run(100, {1, 1, 1}, {3, 4, 1}), "");
  EXPECT_EQ(rows.statuses, std::vector<std::uint8_t>(100, 7));
  sinew_robot* robot = opened("3pfs-g2");
  sinew_session* session = sinew_session_new(robot);
  const Json last =
      Json::parse(asked(session, Json{{"query", "forward"}, {"inputs", {0.43, 0.4399, 0.4201}}}.dump()));
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(rows.out[99 * 8 + c], last["pose"]["position"][c].get<double>(), 1e-10);
  sinew_release(session);
  sinew_release(robot);
}

TEST(CAbi, RunsListsAndMatrices) {
  Rows rows(
      "3pfs-g2",
      R"({"query": "velocity", "inputs": "$L", "wrench": "$w", "outputs": {"K": "K", "fx": "legs[0].force[0]"}})");
  char* fields = sinew_fields(rows.batch);
  const Json told = Json::parse(fields);
  sinew_free(fields);
  EXPECT_EQ(told["inputs"], (Json{{{"name", "L"}, {"unit", "m"}, {"rank", 1}, {"shape", {3}}},
                                  {{"name", "w"}, {"unit", "N, N m"}, {"rank", 1}, {"shape", {6}}}}));
  EXPECT_EQ(told["outputs"][0]["shape"], (Json{6, 3}));
  rows.in = {0.43, 0.43, 0.43, 0, 0, -1, 0, 0, 0, 0.44, 0.42, 0.41, 0, 0, 0, 0, 0, 0.1};
  EXPECT_EQ(rows.run(2, {3, 6}, {18, 1}), "");
  sinew_robot* robot = opened("3pfs-g2");
  sinew_session* session = sinew_session_new(robot);
  const Json alone = Json::parse(asked(
      session, R"({"query": "velocity", "inputs": [0.44, 0.42, 0.41], "wrench": [0, 0, 0, 0, 0, 0.1]})"));
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_NEAR(rows.out[19 + 3 * i + j], alone["K"][i][j].get<double>(), 1e-6);
  EXPECT_NEAR(rows.out[19 + 18], alone["legs"][0]["force"][0].get<double>(), 1e-9);
  sinew_release(session);
  sinew_release(robot);
}

/// One robot and one batch, which several threads run, each on threads of its own, while others ask.
TEST(CAbi, ThreadsShareABatch) {
  constexpr std::string_view name = "3pfs-g2",
                             question = R"({"query": "forward", "inputs": "$L", "path": "continue"})";
  sinew_robot* robot = opened(name);
  sinew_batch* batch = nullptr;
  ASSERT_EQ(sinew_prepare(robot, question.data(), question.size(), &batch, nullptr), SINEW_OK);
  constexpr std::size_t rows = 2100;  // three chunks
  std::vector<double> in;
  for (std::size_t k = 0; k < 3 * rows; ++k)
    in.push_back(0.43 + 1e-2 * std::sin(0.01 * static_cast<double>(k)));
  struct Found {
    std::vector<double> poses = std::vector<double>(7 * rows), residuals = std::vector<double>(rows);
    std::vector<std::uint8_t> statuses = std::vector<std::uint8_t>(rows);
  };
  const auto run = [&](Found& found, std::size_t count, std::int32_t threads) {
    const sinew_input from{in.data(), 24, 8};
    const sinew_output to[] = {
        {found.poses.data(), 56, 8}, {found.poses.data() + 3, 56, 8}, {found.residuals.data(), 8, 8}};
    EXPECT_EQ(sinew_run(batch, count, &from, to, found.statuses.data(), threads, nullptr), SINEW_OK);
  };
  Found alone;
  run(alone, rows, 1);
  std::vector<std::thread> threads;
  for (int t = 0; t < 3; ++t)
    threads.emplace_back([&] {
      Found own, single;
      sinew_session* session = sinew_session_new(robot);
      for (int k = 0; k < 3; ++k) {
        run(own, rows, 2);
        EXPECT_EQ(own.poses, alone.poses);
        run(single, 1, 1);
        EXPECT_NEAR(single.poses[2], alone.poses[2], 1e-12);
        EXPECT_NE(asked(session, rods).find("converged"), std::string::npos);
      }
      sinew_release(session);
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(alone.statuses, std::vector<std::uint8_t>(rows, 7));
  sinew_release(batch);
  sinew_release(robot);
}

TEST(CAbi, SaysWhatIsOddAboutRows) {
  Rows rows("3-rfr",
            R"({"query": "inverse", "pose": {"x": "$x", "y": 0, "phi": 0}, "outputs": {"l": "inputs[0]"}})");
  rows.in = {0, NAN, 0.01};
  EXPECT_EQ(Json::parse(rows.run(3, {1}, {1}))["error"]["where"], "pose.x");
  EXPECT_EQ(rows.statuses, (std::vector<std::uint8_t>{7, 9, 7}));
  EXPECT_TRUE(std::isnan(rows.out[1]));
  Rows none("3-rfr",
            R"({"query": "forward", "inputs": ["$a", 0.19, 0.19], "outputs": {"p": "type_2.pitch"}})");
  none.in = {0.19, 0.188};
  EXPECT_NE(none.run(2, {1}, {1}).find("outputs.p"), std::string::npos);
}

TEST(CAbi, SaysWhyRowsAreUnsupported) {
  Rows rows("3-rfr", R"({"query": "forward", "inputs": ["$a", 0.2, 0.2], "wrench": [0, 0, 1]})");
  rows.in = {0.2, 0.19};
  EXPECT_NE(rows.run(2, {1}, {1, 1, 1, 1}).find("constant curvature bears no load"), std::string::npos);
  EXPECT_EQ(rows.statuses, (std::vector<std::uint8_t>{10, 10}));
}

TEST(CAbi, PreparesNothingThatEveryRowIsRefused) {
  sinew_robot* robot = opened("3-rfr");
  sinew_session* session = sinew_session_new(robot);
  for (const auto& [question, alone] :
       {std::pair{R"({"query": "forward", "inputs": ["$a", 0.2]})",
                  R"({"query": "forward", "inputs": [0, 0.2]})"},
        std::pair{R"({"query": "forward", "input": "$a"})", R"({"query": "forward", "input": 0})"},
        std::pair{R"({"query": "inverse", "pose": {"x": "$a", "y": 0, "phi": 0}, "elbow": [1, 1, 1]})",
                  R"({"query": "inverse", "pose": {"x": 0, "y": 0, "phi": 0}, "elbow": [1, 1, 1]})"}}) {
    sinew_batch* batch = nullptr;
    char* error = nullptr;
    EXPECT_EQ(sinew_prepare(robot, question, std::strlen(question), &batch, &error), SINEW_BAD_INPUT);
    EXPECT_EQ(batch, nullptr);
    ASSERT_NE(error, nullptr) << question;
    auto said = Json::parse(asked(session, alone))["error"]["message"].get<std::string>();
    said = said.substr(0, said.find("; "));  // one of them a line
    EXPECT_NE(std::string_view(error).find(said.substr(0, said.find(". "))), std::string_view::npos)
        << error << said;
    sinew_free(error);
  }
  sinew_release(session);
  sinew_release(robot);
}

TEST(CAbi, TellsTheFieldsOfWhatIsWanted) {
  Rows rows("3pfs-g2", R"({"query": "forward", "inputs": "$L", "want": ["stiffness"]})");
  char* text = sinew_fields(rows.batch);
  const Json told = Json::parse(text)["outputs"];
  sinew_free(text);
  ASSERT_EQ(told.size(), 4U);
  EXPECT_EQ(told[2]["name"], "stiffness");
  EXPECT_EQ(told[2]["shape"], (Json{6, 6}));
  rows.in = {0.44, 0.42, 0.41};
  EXPECT_EQ(rows.run(1, {3}, {3, 4, 36, 1}), "");
  EXPECT_GT(rows.out[7], 0);
}

TEST(CAbi, RefusesPlacesThatNoAnswerHas) {
  sinew_robot* robot = opened("3-rfr");
  sinew_batch* batch = nullptr;
  char* error = nullptr;
  constexpr std::string_view question =
      R"({"query": "forward", "inputs": "$L", "outputs": {"x": "poze.x", "c": "legs[3].chord"}})";
  EXPECT_EQ(sinew_prepare(robot, question.data(), question.size(), &batch, &error), SINEW_BAD_INPUT);
  ASSERT_NE(error, nullptr);
  EXPECT_NE(std::string_view(error).find("did you mean \"pose.x\"?"), std::string_view::npos) << error;
  EXPECT_NE(std::string_view(error).find("give a leg from 0 to 2"), std::string_view::npos) << error;
  sinew_free(error);
  sinew_release(robot);
}

TEST(CAbi, PreparesNothingOfNothing) {
  sinew_batch* batch = nullptr;
  char* error = nullptr;
  EXPECT_EQ(sinew_prepare(nullptr, "{}", 2, &batch, nullptr), SINEW_BAD_INPUT);
  sinew_robot* robot = opened("3-rfr");
  for (const std::string_view question : {"", "{", "[]", "null", R"({"query": "forward"})"}) {
    EXPECT_EQ(sinew_prepare(robot, question.data(), question.size(), &batch, &error), SINEW_BAD_INPUT)
        << question;
    EXPECT_EQ(batch, nullptr);
    ASSERT_NE(error, nullptr);
    sinew_free(error);
  }
  EXPECT_EQ(sinew_prepare(robot, nullptr, 0, &batch, nullptr), SINEW_BAD_INPUT);
  EXPECT_EQ(sinew_prepare(robot, "{}", 2, nullptr, nullptr), SINEW_BAD_INPUT);
  sinew_release(robot);
  EXPECT_EQ(sinew_fields(nullptr), nullptr);
  EXPECT_EQ(sinew_run(nullptr, 1, nullptr, nullptr, nullptr, 0, nullptr), SINEW_BAD_INPUT);
  Rows rows("3-rfr",
            R"({"query": "inverse", "pose": {"x": "$x", "y": 0, "phi": 0}, "outputs": {"l": "inputs[0]"}})");
  const sinew_input in{nullptr, 8, 8};
  const sinew_output out{nullptr, 8, 8};
  EXPECT_EQ(sinew_run(rows.batch, 1, &in, &out, nullptr, 0, &error), SINEW_BAD_INPUT);
  sinew_free(error);
  EXPECT_EQ(sinew_run(rows.batch, 0, &in, &out, nullptr, 0, nullptr), SINEW_OK);
}

/// A thread is cancelled while threads of its own compute, some of them longer than itself.
TEST(CAbi, CancelsAThreadAfterItsRun) {
  Rows rows("3pfs-g2", R"({"query": "forward", "inputs": ["$a", 0.42, 0.42]})");
  constexpr std::size_t many = 20000;
  rows.in.assign(many, 0.41);
  for (int trial = 0; trial < 8; ++trial) {
    std::atomic<bool> runs = false, is_over = false;
    std::thread runner([&] {
      runs = true;
      rows.run(many, {1}, {3, 4, 1}, 8);
      is_over = true;
      for (;;) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    });
    while (!runs) std::this_thread::yield();
    pthread_cancel(runner.native_handle());
    runner.join();
    EXPECT_TRUE(is_over);
    EXPECT_EQ(std::ranges::count(rows.statuses, 7), static_cast<std::ptrdiff_t>(many));
  }
}

TEST(CAbi, StopsRows) {
  Rows rows(
      "hexapod-torsion",
      R"({"query": "forward", "inputs": ["$a", 0.5, 0.5, 0.5, 0.5, 0.5], "all": true, "outputs": {"n": "count"}})");
  rows.in.assign(64, 0.5);
  std::atomic<bool> is_done = false;
  std::thread stopper([&] {
    while (!is_done) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      sinew_stop(rows.batch);
    }
  });
  rows.run(64, {1}, {1});
  is_done = true;
  stopper.join();
  EXPECT_EQ(rows.statuses, std::vector<std::uint8_t>(64, 8));
}

}  // namespace
