/// What serial robots answer where an answer is easily wrong: straight sections, limits, values that
/// overflow.
#include <gtest/gtest.h>

#include "sinew_query.hpp"

namespace sinew::test {
namespace serial_answers_test {

Json ask_one(const std::string& robot, const Json& query) { return ask(robot, {query}).front(); }

TEST(SerialAnswers, AStraightRobotMovesSideways) {  // its coordinates are singular there, not the robot
  for (const Json& straight : {Json{{0, 0}}, Json{{1e-6, 0.3}}})
    for (const std::vector<double>& twist :
         {std::vector{0.0, 0.01, 0.0, 0.0, 0.0, 0.0}, std::vector{0.01, 0.0, 0.0, 0.0, 0.1, 0.0}}) {
      const Json answer = ask_one("nottingham-neutral",
                                  {{"query", "velocity"}, {"configuration", straight}, {"twist", twist}});
      ASSERT_EQ(answer["status"], "converged") << answer;
      std::size_t column = 0;
      std::array<double, 6> made{};
      for (const Json& section : answer["rates"])
        for (const Json& rate : section) {
          for (std::size_t i = 0; i < 6; ++i)
            made[i] += answer["J"][i][column].get<double>() * rate.get<double>();
          ++column;
        }
      for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(made[i], twist[i], 1e-7);
    }
  const Json along =
      ask_one("nottingham-neutral",
              {{"query", "velocity"}, {"configuration", Json::array()}, {"twist", {0, 0, 0.01, 0, 0, 0}}});
  EXPECT_EQ(along["status"], "singular");
  EXPECT_FALSE(along.contains("rates"));
}

TEST(SerialAnswers, NoSolutionWithinTheLimitsIsNotConverged) {
  Json query = {{"query", "inverse"}, {"all", true}, {"pose", {{"position", {1.5, 0.2, 1.2}}}}};
  query["set"] = {{"sections[0].limit", "5 deg"}};
  const Json answer = ask_one("three-arcs", query);
  EXPECT_EQ(answer["status"], "unreachable") << answer;
  EXPECT_EQ(answer["count"], 0);
  query["start"] = Json::array({{0, 0}});
  EXPECT_EQ(ask_one("three-arcs", query)["error"]["code"], "no_effect");
}

TEST(SerialAnswers, AnglesWithoutASineAreRefused) {
  EXPECT_EQ(ask_one("three-arcs", {{"query", "forward"}, {"configuration", {{1e200, 0}}}})["error"]["code"],
            "out_of_range");
  EXPECT_EQ(
      ask_one("nottingham-tpcj", {{"query", "describe"},
                                  {"set", {{"sections.tendons.angle", "1e20 rad each"}}}})["error"]["code"],
      "out_of_range");
}

TEST(SerialAnswers, ChangesGivenAreChangesAnswered) {  // counts to send are those of the command
  const Json given = {{0.001, 0.001, 0.001}};
  const Json answer = ask_one("nottingham-tpcj", {{"query", "forward"}, {"changes", given}});
  EXPECT_EQ(answer["status"], "slack");
  EXPECT_EQ(answer["changes"][0], given[0]);
  for (const Json& slack : answer["slack"][0]) EXPECT_NEAR(slack.get<double>(), 0.001, 1e-15);
}

TEST(SerialAnswers, BendingShortensAllTendonsOfASlenderSection) {  // too short where they are met best only
  const Json query = {{"query", "diagram"},
                      {"section", 0},
                      {"changes", {-1e-4, -1e-4, -1e-4}},
                      {"limit", "90 deg"},
                      {"model", "pcc"}};
  const Json answer = ask_one("three-arcs", query);
  EXPECT_EQ(answer["class"], "indeterminate") << answer["message"];
  EXPECT_GT(answer["margin"].get<double>(), 0.01);
}

TEST(SerialAnswers, EarlierSectionsBeyondTheirLimitAreNamed) {
  const Json far = {0.1, -0.05, -0.05};
  const Json answer =
      ask_one("nottingham-tpcj", {{"query", "diagram"}, {"section", 1}, {"changes", {far, far}}});
  EXPECT_EQ(answer["status"], "left_domain");
  EXPECT_TRUE(answer["message"].get<std::string>().starts_with("sections[0]"));
  EXPECT_TRUE(answer.contains("class"));
}

/// The second of two sections, the first paid out by so much at its straight bend [m].
Json second_after(double first, double own, const char* model = "lsk") {
  return ask_one("nottingham-tpcj",
                 {{"query", "diagram"},
                  {"section", 1},
                  {"model", model},
                  {"changes", {{first, first, first}, {first + own, first + own, first + own}}}});
}

TEST(SerialAnswers, WithoutAnOutlineADiagramSaysWhy) {
  EXPECT_TRUE(second_after(3e-4, 3e-4).contains("outline"));
  EXPECT_FALSE(second_after(3e-4, 3e-4).contains("no_outline"));
  const Json after_over = second_after(-3e-4, 6e-4);
  EXPECT_TRUE(after_over["conditional"]);
  EXPECT_FALSE(after_over.contains("outline"));
  EXPECT_EQ(after_over["no_outline"], "previous_over_tensioned");
  EXPECT_EQ(second_after(3e-4, -9e-4)["no_outline"], "over_tensioned");
  EXPECT_EQ(second_after(3e-4, 0, "pcc")["no_outline"], "exact_model");
  const Json exact = second_after(0, 0);
  EXPECT_FALSE(exact["conditional"]);
  EXPECT_FALSE(exact.contains("no_outline"));
}

TEST(SerialAnswers, ADiagramHasTheWordsOfItsState) {
  const Json slack = ask_one("nottingham-tpcj", {{"query", "diagram"},
                                                 {"section", 0},
                                                 {"changes", {3e-4, 3e-4, 3e-4}},
                                                 {"measured", {-3e-4, -3e-4, -3e-4}}});
  EXPECT_EQ(slack["word"], "SLACK");
  EXPECT_NEAR(slack["amount"].get<double>(), 3e-4, 1e-15);
  EXPECT_EQ(slack["near_limit"], false);
  EXPECT_EQ(slack["advice"], "Take in tendons 1, 2 and 3 by 0.30 mm");
  EXPECT_EQ(slack["measured"]["word"], "OVER-TENSIONED");
}

TEST(SerialAnswers, VelocityTellsHowToSteer) {  // straight: the tip's axes are those of the bend
  const Json straight = ask_one("nottingham-tpcj", {{"query", "velocity"}, {"configuration", Json::array()}});
  EXPECT_NEAR(straight["steering"][0][0].get<double>(), 0.25, 1e-12) << "of four joints each bends a quarter";
  EXPECT_NEAR(straight["steering"][0][1].get<double>(), 0, 1e-12);
  const Json folded =
      ask_one("three-arcs", {{"query", "velocity"}, {"configuration", {{0, 0}, {0, 0}, {"180 deg", 0}}}});
  EXPECT_FALSE(folded.contains("steering")) << folded.dump();
}

TEST(SerialAnswers, ReadingsThatCannotBeAreNoClass) {
  const Json answer =
      ask_one("nottingham-tpcj",
              {{"query", "diagram"}, {"section", 0}, {"changes", {0, 0, 0}}, {"measured", {1e5, 0, 0}}});
  EXPECT_EQ(answer["measured"]["status"], "left_domain");
  EXPECT_FALSE(answer["measured"].contains("class"));
}

TEST(SerialAnswers, RoundingIsWithinAToleranceOfNothing) {
  const Json answer = ask_one(
      "nottingham-tpcj",
      {{"query", "diagram"}, {"section", 0}, {"changes", {-0.0011, 0.002, -0.0009}}, {"tolerance", 0}});
  EXPECT_EQ(answer["class"], "exact") << answer;
}

TEST(SerialAnswers, AShapeIsNotLargerThanAMillionPoints) {
  const Json answer = ask_one("nottingham-tpcj", {{"query", "shape"},
                                                  {"set", {{"sections.segments", 1000}}},
                                                  {"configuration", Json::array()},
                                                  {"samples", 200}});
  EXPECT_EQ(answer["error"]["code"], "out_of_range") << answer.dump().substr(0, 200);
}

}  // namespace serial_answers_test
}  // namespace sinew::test
