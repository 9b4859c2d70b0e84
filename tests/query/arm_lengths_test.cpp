/// Arms asked as serial robots, by pcc and lsk: tendons' lengths give the shape.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sinew_query.hpp"

namespace sinew::test {
namespace arm_lengths_test {

double distance(const Json& one, const Json& other) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i)
    sum += std::pow(one["position"][i].get<double>() - other["position"][i].get<double>(), 2);
  return std::sqrt(sum);
}

/// Lengths of the arm that tensions bend, by energy, are of the same arc.  @verifies LSK (1), (2)
TEST(ArmsByLengths, AreWhereLoadedOnesHaveTheSameLengths) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> tension(0, 6);
  for (const bool has_discs : {true, false}) {
    const std::string robot = has_discs ? "two-segment" : "tendon-rod";
    for (int trial = 0; trial < 10; ++trial) {
      Json tensions = Json::array();
      for (int section = 0; section < (has_discs ? 2 : 1); ++section) {
        tensions.push_back(Json::array());
        for (int i = 0; i < (has_discs ? 3 : 4); ++i)
          tensions.back().push_back(i == trial % 3 ? 0 : tension(random));
      }
      Json pulled{{"query", "forward"}, {"model", "cc"}, {"tensions", tensions}};
      if (!has_discs)
        pulled.update({{"set", {{"sections[0].tendons.compliance", 0}}}, {"gravity", {0, 0, 0}}});
      const Json loaded = ask(robot, {pulled})[0];
      ASSERT_EQ(loaded["status"], "converged") << loaded;
      for (const char* model : {"pcc", "lsk"}) {
        if (has_discs && model == std::string("lsk")) continue;  // chords are shorter than arcs
        const Json shaped =
            ask(robot, {{{"query", "forward"}, {"model", model}, {"changes", loaded["changes"]}}})[0];
        ASSERT_EQ(shaped["status"], "converged") << shaped;
        EXPECT_LT(distance(shaped["tip"], loaded["tip"]), has_discs ? 1e-12 : 1e-7) << shaped;
      }
    }
  }
}

TEST(ArmsByLengths, AnswerWhatSerialRobotsAnswer) {
  const Json there =
      ask("two-segment",
          {{{"query", "forward"}, {"model", "lsk"}, {"configuration", {{0.5, 1.5}, {0.8, -2}}}}})[0];
  ASSERT_EQ(there["status"], "converged") << there;
  const Json back = ask(
      "two-segment", {{{"query", "inverse"}, {"model", "lsk"}, {"position", there["tip"]["position"]}}})[0];
  ASSERT_EQ(back["status"], "converged") << back;
  EXPECT_LT(distance(back["tip"], there["tip"]), 1e-12);
  const Json shown = ask("two-segment", {{{"query", "diagram"},
                                          {"set", {{"sections[0].limit", 3}}},
                                          {"section", 0},
                                          {"changes", {-0.0011, 0.002, -0.0005}}}})[0];
  EXPECT_EQ(shown["class"], "indeterminate") << shown;
  EXPECT_EQ(ask("two-segment", {{{"query", "describe"}, {"model", "pcc"}}})[0]["kind"], "serial");
  const Json rates =
      ask("two-segment", {{{"query", "velocity"}, {"model", "pcc"}, {"configuration", {{0.5, 1.5}}}}})[0];
  EXPECT_EQ(rates["J"].size(), 6U) << rates;
}

TEST(ArmsByLengths, SayWhatTheyHaveNoPlaceFor) {
  const auto said = [](const std::string& robot, Json query, Json set = nullptr) {
    query["model"] = "pcc";
    if (!set.is_null()) query["set"] = set;
    const Json answer = ask(robot, {query})[0];
    EXPECT_EQ(answer["status"], "unsupported") << answer;
    return answer.dump();
  };
  const Json straight{{"query", "forward"}, {"configuration", Json::array()}};
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_TRUE(has(said("two-segment", straight, {{"sections[0].precurvature", {1, 0, 0}}}), "bent at rest"));
  EXPECT_TRUE(has(said("two-segment", straight, {{"sections[0].tendons[1].angle", 0}}), "evenly spread"));
  EXPECT_TRUE(has(said("two-segment", straight, {{"sections[1].tendons[1].turn", 1}}), "not parallel"));
  EXPECT_TRUE(
      has(said("two-segment", straight, {{"sections[1].tendons[1].radius", 0.009}}), "another radius"));
  EXPECT_TRUE(
      has(said("two-segment",
               {{"query", "forward"}, {"configuration", Json::array()}, {"wrench", {1, 0, 0, 0, 0, 0}}}),
          "bears no load"));
  EXPECT_TRUE(has(said("two-segment", {{"query", "statics"}, {"tensions", {{1, 0, 0}}}}), "statics"));
  EXPECT_TRUE(has(said("two-segment", {{"query", "track"}}), "track"));
}

}  // namespace arm_lengths_test
}  // namespace sinew::test
