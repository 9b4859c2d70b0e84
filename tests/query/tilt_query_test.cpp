/// Tilt, azimuth and torsion in place of quaternions, and beside them.
#include <gtest/gtest.h>

#include <numbers>

#include "sinew_query.hpp"

namespace sinew::test {
namespace tilt_query_test {

constexpr double pi = std::numbers::pi;

Json placed(const Json& turn) {
  Json pose{{"position", {0.01, -0.005, 0.19}}};
  pose.update(turn);
  return pose;
}

Json inverse_at(const Json& turn) { return {{"query", "inverse"}, {"pose", placed(turn)}, {"tilt", true}}; }

void expect_angles(const Json& pose, double tilt, double azimuth, double torsion) {
  EXPECT_NEAR(pose["tilt"].get<double>(), tilt, 1e-15) << pose;
  EXPECT_NEAR(pose["azimuth"].get<double>(), azimuth, 1e-14) << pose;
  EXPECT_NEAR(pose["torsion"].get<double>(), torsion, 1e-15) << pose;
}

TEST(TiltQuery, APoseComesBackAsItWasAsked) {
  const auto answers =
      ask("6-ufs", {inverse_at({{"tilt", "10 deg"}, {"azimuth", "-120 deg"}, {"torsion", 0.2}}),
                    inverse_at({{"tilt", 0.1}}), inverse_at({{"azimuth", 0.1}}),
                    inverse_at({{"torsion", "-5 deg"}}), inverse_at({{"tilt", "-10 deg"}})});
  for (const Json& answer : answers) ASSERT_EQ(answer["status"], "converged") << answer;
  expect_angles(answers[0]["pose"], pi / 18, -2 * pi / 3, 0.2);
  expect_angles(answers[1]["pose"], 0.1, 0, 0);
  expect_angles(answers[2]["pose"], 0, 0, 0);  // nothing leans
  expect_angles(answers[3]["pose"], 0, 0, -pi / 36);
  expect_angles(answers[4]["pose"], pi / 18, pi, 0);
}

TEST(TiltQuery, IsTheQuaternionInOtherWords) {
  const Json angles = {{"tilt", 0.2}, {"azimuth", 0.7}, {"torsion", -0.1}};
  const Json first = ask("6-ufs", {inverse_at(angles)})[0];
  const Json second = ask("6-ufs", {inverse_at({{"quaternion", first["pose"]["quaternion"]}})})[0];
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_NEAR(first["inputs"][k].get<double>(), second["inputs"][k].get<double>(), 1e-15);
}

TEST(TiltQuery, StandsInEveryPoseThatIsRead) {
  const Json angles = {{"tilt", 0.05}, {"azimuth", 0.7}};
  Json held = {{"position", {0, 0.01, 0.4}}};
  held.update(angles);
  const Json inputs = {0.24, 0.24, 0.24, 0.24, 0.24, 0.24};
  const auto arcs =
      ask("6-ufs",
          {{{"query", "forward"}, {"inputs", inputs}, {"start", placed(angles)}},
           {{"query", "velocity"}, {"pose", placed(angles)}},
           {{"query", "shape"}, {"pose", placed(angles)}},
           {{"query", "track"}, {"from", placed(angles)}, {"to", placed({{"torsion", 0.1}})}, {"samples", 3}},
           {{"query", "statics"}, {"set_at", placed(angles)}},
           {{"query", "forward"}, {"inputs", inputs}, {"set", {{"platform.home", placed(angles)}}}}});
  const auto rods = ask("hexapod", {{{"query", "inverse"}, {"pose", held}, {"tilt", true}},
                                    {{"query", "shape"}, {"pose", held}}});
  const auto serial =
      ask("three-arcs",
          {{{"query", "inverse"}, {"pose", {{"position", {0.3, 0.2, 2}}, {"tilt", 0.5}}}, {"tilt", true}}});
  for (const auto& answers : {arcs, rods, serial})
    for (const Json& answer : answers) EXPECT_EQ(answer["status"], "converged") << answer;
  expect_angles(rods[0]["pose"], 0.05, 0.7, 0);
  EXPECT_NEAR(serial[0]["tip"]["tilt"].get<double>(), 0.5, 1e-9);
}

TEST(TiltQuery, AddsToPoseTipAndSolutionsAndToNothingElse) {
  const Json inputs = {0.24, 0.24, 0.24, 0.24, 0.24, 0.24};
  const Json query{{"query", "forward"}, {"inputs", inputs}, {"all", true}};
  Json asked = query;
  asked["tilt"] = true;
  Json answer = ask("6-ufs", {asked})[0];
  ASSERT_GE(answer["solutions"].size(), 2U);
  const auto leave_out = [](Json& pose) {
    for (const char* key : {"tilt", "azimuth", "torsion"}) EXPECT_EQ(pose.erase(key), 1U) << key;
  };
  leave_out(answer["pose"]);
  for (Json& solution : answer["solutions"]) leave_out(solution["pose"]);
  EXPECT_EQ(answer.dump(), ask("6-ufs", {query})[0].dump());
}

TEST(TiltQuery, ShowsTheBendOfASerialRobot) {
  const auto answers =
      ask("nottingham-neutral",
          {{{"query", "forward"}, {"configuration", {{0.3, 0.2}, {0.4, 0.2}}}, {"tilt", true}},
           {{"query", "describe"}, {"tilt", true}},
           {{"query", "forward"}, {"configuration", {{0.3, 0.2}, {0.4, 0.2}}}, {"tilt", false}}});
  expect_angles(answers[0]["tip"], 0.7, 0.2, 0);
  EXPECT_EQ(answers[1]["status"], "converged");
  EXPECT_FALSE(answers[2]["tip"].contains("tilt"));
}

TEST(TiltQuery, SaysOneThingOnce) {
  const auto code = [](const std::string& robot, const Json& query) {
    return ask(robot, {query})[0]["error"]["code"];
  };
  EXPECT_EQ(code("6-ufs", inverse_at({{"tilt", 0.1}, {"quaternion", {1, 0, 0, 0}}})), "ambiguous");
  EXPECT_EQ(code("6-ufs", inverse_at({{"torsion", "1 mm"}})), "wrong_dimension");
  EXPECT_EQ(code("3-rfr", {{"query", "forward"}, {"inputs", {0.19, 0.19, 0.19}}, {"tilt", true}}),
            "no_effect");
  EXPECT_EQ(code("3-rfr", {{"query", "inverse"}, {"pose", {{"x", 0}, {"y", 0}, {"phi", 0}, {"tilt", 0}}}}),
            "unknown_key");
}

}  // namespace tilt_query_test
}  // namespace sinew::test
