/// Walks along an input: `"start": "last"` begins where the platform was found last.
#include <gtest/gtest.h>

#include "sinew/session.hpp"
#include "sinew_query.hpp"

namespace sinew::test {
namespace start_last_test {

/// A walk of small steps along the first input, for the robot's model.
struct Walk {
  std::string robot;
  Json first;  ///< its inputs
  double step;
  std::string model = {};
  int steps = 8;

  Json query(const char* kind, int k) const {
    Json inputs = first;
    inputs[0] = first[0].get<double>() + k * step;
    Json query{{"query", kind}, {"inputs", inputs}};
    if (!model.empty()) query["model"] = model;
    return query;
  }
  Json query(const char* kind, int k, const Json& start) const {
    Json one = query(kind, k);
    one["start"] = start;
    return one;
  }
};

const std::vector<Walk>& walks() {
  static const std::vector<Walk> all = {{"3-rfr", {0.19, 0.19, 0.188}, 0.001},
                                        {"3-rfr", {0.195, 0.197, 0.196}, 0.0003, "prb"},
                                        {"6-ufs", {0.24, 0.241, 0.24, 0.242, 0.24, 0.239}, 0.0005},
                                        {"3prs", {0.30, 0.31, 0.29}, 0.002},
                                        {"3pfs-g2", {0.42, 0.42, 0.41}, 0.003},
                                        {"hexapod", {0.41, 0.42, 0.40, 0.41, 0.41, 0.40}, 0.002}};
  return all;
}

double gap_of(const Json& a, const Json& b) {
  if (a.is_number()) return std::abs(a.get<double>() - b.get<double>());
  if (!a.is_structured()) return a == b ? 0 : std::numeric_limits<double>::infinity();
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double gap = 0;
  for (auto i = a.begin(), j = b.begin(); i != a.end(); ++i, ++j) gap = std::max(gap, gap_of(*i, *j));
  return gap;
}

/// Answers of a walk whose every search is told where to begin.
std::vector<Json> told(const Walk& walk) {
  std::vector<Json> answers = {ask(walk.robot, {walk.query("forward", 0)})[0]};
  for (int k = 1; k < walk.steps; ++k)
    answers.push_back(ask(walk.robot, {walk.query("forward", k, answers.back()["pose"])})[0]);
  return answers;
}

TEST(StartLast, WalksAsWithTheStartsOfTheAnswers) {
  for (const Walk& walk : walks()) {
    std::vector<Json> queries;
    for (int k = 0; k < walk.steps; ++k) queries.push_back(walk.query("forward", k, "last"));
    const auto found = ask(walk.robot, queries), expected = told(walk);
    for (std::size_t k = 0; k < found.size(); ++k) {
      ASSERT_EQ(found[k]["status"], "converged") << walk.robot << found[k];
      EXPECT_LT(gap_of(found[k]["pose"], expected[k]["pose"]), 1e-10) << walk.robot << k;
    }
    if (walk.robot == "3-rfr" && walk.model.empty()) {  // Newton's method from nearby, not from home
      const Json anew = ask(walk.robot, {walk.query("forward", walk.steps - 1)})[0];
      EXPECT_LT(found.back()["iterations"], anew["iterations"]);
    }
  }
}

TEST(StartLast, QuestionsThatDoNotSayItChangeNothing) {
  for (const Walk& walk : walks()) {
    std::vector<Json> queries;
    for (int k = 0; k < walk.steps; ++k) {
      queries.push_back(walk.query("forward", k, "last"));
      queries.push_back(walk.query("forward", -3));
      queries.push_back({{"query", "describe"}});
      if (walk.model.empty()) queries.push_back(walk.query("shape", -2));
      if (walk.model.empty()) queries.push_back(walk.query("velocity", -1));
    }
    const auto answers = ask(walk.robot, queries), expected = told(walk);
    const std::size_t stride = answers.size() / expected.size();
    for (std::size_t k = 0; k < expected.size(); ++k)
      EXPECT_LT(gap_of(answers[k * stride]["pose"], expected[k]["pose"]), 1e-10) << walk.robot << k;
    for (std::size_t k = 0; k < answers.size(); ++k) {  // nor does a walk change theirs, to the last byte
      if (k % stride == 0) continue;
      EXPECT_EQ(answers[k].dump(), ask(walk.robot, {queries[k]})[0].dump()) << walk.robot << k;
    }
  }
}

TEST(StartLast, ForwardVelocityAndShapeWalkTogether) {
  for (const Walk& walk : walks()) {
    if (!walk.model.empty()) continue;
    const std::vector<const char*> kinds = {"forward", "shape", "velocity"};
    std::vector<Json> queries;
    for (int k = 0; k < walk.steps; ++k)
      queries.push_back(walk.query(kinds[static_cast<std::size_t>(k) % 3], k, "last"));
    const auto found = ask(walk.robot, queries), expected = told(walk);
    for (std::size_t k = 0; k < found.size(); ++k)
      EXPECT_LT(gap_of(found[k]["pose"], expected[k]["pose"]), 1e-10) << walk.robot << k;
  }
}

TEST(StartLast, AWalkMayBeginAnywhere) {  // in a mode that home does not lead to
  const Json inputs = {0.19, 0.19, 0.188};
  const Json all = ask("3-rfr", {{{"query", "forward"}, {"inputs", inputs}, {"all", true}}})[0]["solutions"];
  ASSERT_GE(all.size(), 2U);
  for (const Json& mode : all) {
    const auto found =
        ask("3-rfr", {{{"query", "forward"}, {"inputs", inputs}, {"start", mode["pose"]}},
                      {{"query", "forward"}, {"inputs", inputs}, {"start", "last"}},
                      {{"query", "forward"}, {"inputs", inputs}, {"start", "last"}, {"all", true}},
                      {{"query", "forward"}, {"inputs", inputs}, {"start", "last"}}});
    for (const Json& answer : found) EXPECT_LT(gap_of(answer["pose"], mode["pose"]), 1e-9) << answer;
  }
}

TEST(StartLast, BeginsAtHomeAtFirstAndAfterAFailure) {
  for (const Walk& walk : walks()) {
    Json lost = walk.query("forward", 0, "last");
    lost["inputs"][0] = -1.0;
    const auto answers = ask(walk.robot, {walk.query("forward", 5, "last"), walk.query("forward", 0, "last"),
                                          lost, walk.query("forward", 5, "last")});
    ASSERT_NE(answers[2]["status"], "converged") << answers[2];
    const std::string from_home = ask(walk.robot, {walk.query("forward", 5)})[0].dump();
    EXPECT_EQ(answers[0].dump(), from_home);
    EXPECT_EQ(answers[3].dump(), from_home);
  }
}

TEST(StartLast, ALoadIsFollowedFromTheLastEquilibrium) {
  const Json until = {{"wrench", {0, 0, -1, 0, 0, 0}}, {"limit", 20}};
  Json loaded{{"query", "forward"}, {"inputs", {0.42, 0.42, 0.41}}, {"start", "last"}, {"until", until}};
  const auto answers = ask("3pfs-g2", {loaded,
                                       {{"query", "shape"},
                                        {"inputs", {0.42, 0.42, 0.41}},
                                        {"wrench", {0, 0, -20, 0, 0, 0}},
                                        {"start", "last"}}});
  ASSERT_EQ(answers[0]["why"], "limit");
  EXPECT_LT(gap_of(answers[0]["pose"], answers[1]["pose"]), 1e-10);
}

TEST(StartLast, ASessionForgetsForAnotherClient) {
  auto session = Session::open("3-rfr");
  ASSERT_TRUE(session);
  const std::string there = walks()[0].query("forward", 7, "last").dump();
  const std::string from_home = session->answer(there);
  EXPECT_NE(session->answer(there), from_home);
  session->forget();
  EXPECT_EQ(session->answer(there), from_home);
}

TEST(StartLast, IsOneWordAndOfASearch) {
  const auto code = [](const Json& query) { return ask("3-rfr", {query})[0]["error"]["code"]; };
  const Json inputs = {0.19, 0.19, 0.188}, pose = {{"x", 0}, {"y", 0}, {"phi", 0}};
  EXPECT_EQ(code({{"query", "forward"}, {"inputs", inputs}, {"start", "lost"}}), "unknown_choice");
  EXPECT_EQ(code({{"query", "velocity"}, {"pose", pose}, {"start", "last"}}), "ambiguous");
  EXPECT_EQ(code({{"query", "inverse"}, {"pose", pose}, {"start", "last"}}), "wrong_type");
}

}  // namespace start_last_test
}  // namespace sinew::test
