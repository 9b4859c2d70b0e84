/// A platform on legs of two sections, through the real `sinew query`.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sinew_query.hpp"

namespace sinew::test {
namespace arm_legs_query_test {

const std::string tripod = "tripod-two-section";

Json of_all_legs(std::initializer_list<double> section) {
  Json lists = Json::array();
  for (int k = 0; k < 6; ++k) lists.push_back(section);
  return lists;
}
std::string status(const Json& query) {
  const Json answer = ask(tripod, {query})[0];
  return answer.contains("error") ? answer["error"]["code"].get<std::string>()
                                  : answer["status"].get<std::string>();
}

TEST(ArmLegsQuery, ForwardAnswersPoseTendonsAndWhatTipsBear) {
  const Json query{
      {"query", "forward"},
      {"tensions", {{1, 0, 0.3}, {0, 0.5, 0}, {0.2, 0, 0}, {0.1, 0, 0}, {0.7, 0, 0}, {0, 0.4, 0}}},
      {"wrench", {0.05, 0, -0.1, 0, 0, 0}},
      {"want", {"pose", "stiffness", "velocity"}}};
  const Json answer = ask(tripod, {query})[0];
  ASSERT_EQ(answer["status"], "converged") << answer.dump();
  EXPECT_LT(answer["residual"], 1e-10);
  EXPECT_TRUE(answer["stable"].get<bool>());
  EXPECT_EQ(answer["reached"], 1);
  ASSERT_EQ(answer["legs"].size(), 3U);
  double down = 0, along = 0;
  for (const Json& leg : answer["legs"]) {
    along += leg["force"][0].get<double>();
    down += leg["force"][2].get<double>();
  }
  EXPECT_NEAR(along, 0.05, 1e-9);
  EXPECT_NEAR(down, -0.1 - 0.02 * 9.81, 1e-9);
  ASSERT_EQ(answer["tensions"].size(), 6U);
  EXPECT_EQ(answer["tensions"][1][1], 0.5);
  EXPECT_EQ(answer["stiffness"].size(), 6U);
  EXPECT_EQ(answer["U"][0].size(), 18U);

  // the changes that were found, held, give the same tensions
  const Json back{{"query", "forward"}, {"changes", answer["changes"]}, {"wrench", query["wrench"]}};
  const Json again = ask(tripod, {back})[0];
  ASSERT_EQ(again["status"], "converged") << again.dump();
  for (std::size_t m = 0; m < 6; ++m)
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(again["tensions"][m][i].get<double>(), answer["tensions"][m][i].get<double>(), 1e-4);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(again["pose"]["position"][i].get<double>(), answer["pose"]["position"][i].get<double>(),
                1e-6);
}

TEST(ArmLegsQuery, ShapeHasALineALegAndATendon) {
  const Json answer =
      ask(tripod, {{{"query", "shape"}, {"tensions", of_all_legs({0.5, 0.1, 0.1})}, {"samples", 11}}})[0];
  ASSERT_EQ(answer["status"], "converged") << answer.dump();
  ASSERT_EQ(answer["backbones"].size(), 3U);
  EXPECT_EQ(answer["backbones"][0].size(), 11U);
  EXPECT_EQ(answer["tendons"].size(), 6U);
  EXPECT_EQ(answer["tendons"][5].size(), 3U);
  EXPECT_EQ(answer["discs"].size(), 30U);
  const double x = answer["pose"]["position"][0], z = answer["pose"]["position"][2];
  EXPECT_NEAR(x, 0, 1e-7);  // pulled alike it stays in the middle
  const Json tip = answer["backbones"][0][10];
  EXPECT_NEAR(tip[0].get<double>(), 0.06, 1e-7);
  EXPECT_NEAR(tip[2].get<double>(), z, 1e-7);
}

TEST(ArmLegsQuery, LoadsGrowUntilThePlatformGivesWay) {
  const auto upright = [](double limit) {
    return Json{{"query", "forward"},
                {"gravity", {0, 0, 0}},
                {"until", {{"wrench", {0, 0, -1, 0, 0, 0}}, {"limit", limit}}},
                {"set",
                 {{"legs[0].platform_point.radius", 0.08},
                  {"legs[1].platform_point.radius", 0.08},
                  {"legs[2].platform_point.radius", 0.08}}}};
  };
  const Json answer = ask(tripod, {upright(100)})[0];
  ASSERT_EQ(answer["status"], "converged") << answer.dump();
  const double bending = 54e9 * std::numbers::pi * std::pow(1.4e-3, 4) / 64,
               euler = 3 * std::pow(std::numbers::pi / 0.4, 2) * bending;
  EXPECT_EQ(answer["why"], "bifurcation");
  EXPECT_NEAR(answer["load"].get<double>() / euler, 1, 2e-3);
  const Json less = ask(tripod, {upright(1)})[0];
  EXPECT_EQ(less["why"], "limit");
  EXPECT_EQ(less["load"], 1);
  double down = 0;
  for (const Json& leg : less["legs"]) down += leg["force"][2].get<double>();
  EXPECT_NEAR(down, -1, 1e-9);
}

const Json some_tensions = {{1, 0, 0.3}, {0, 0.5, 0}, {0.2, 0, 0}, {0.1, 0, 0}, {0.7, 0, 0}, {0, 0.4, 0}};

TEST(ArmLegsQuery, WalksStartAtTheLastAndAreCheaper) {
  std::vector<Json> walk, anew;
  for (int k = 0; k < 6; ++k) {
    Json query{{"query", "forward"}, {"tensions", some_tensions}, {"wrench", {0.02 * k, 0, 0, 0, 0, 0}}};
    anew.push_back(query);
    query["start"] = "last";
    walk.push_back(query);
  }
  const auto warm = ask(tripod, walk), cold = ask(tripod, anew);
  int of_warm = 0, of_cold = 0;
  for (std::size_t k = 0; k < walk.size(); ++k) {
    ASSERT_EQ(warm[k]["status"], "converged") << warm[k];
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(warm[k]["pose"]["position"][i].get<double>(), cold[k]["pose"]["position"][i].get<double>(),
                  1e-6);
    of_warm += warm[k]["iterations"].get<int>(), of_cold += cold[k]["iterations"].get<int>();
  }
  EXPECT_LT(of_warm, of_cold);
}

TEST(ArmLegsQuery, InverseStaticsAndTrackAgreeWithForward) {
  const Json forward{{"query", "forward"}, {"tensions", some_tensions}, {"wrench", {0.05, 0, -0.1, 0, 0, 0}}};
  const Json there = ask(tripod, {forward})[0];
  ASSERT_EQ(there["status"], "converged");
  const auto near = [](const Json& a, const Json& b, double by) {
    for (std::size_t i = 0; i < b.size(); ++i) EXPECT_NEAR(a[i].get<double>(), b[i].get<double>(), by) << i;
  };
  const Json inverse =
      ask(tripod, {{{"query", "inverse"}, {"pose", there["pose"]}, {"wrench", forward["wrench"]}}})[0];
  ASSERT_EQ(inverse["status"], "converged") << inverse;
  near(inverse["pose"]["position"], there["pose"]["position"], 1e-7);
  EXPECT_LE(inverse["residual"], 1e-7);
  // held there with the same tensions it takes the same wrench
  const Json held =
      ask(tripod, {{{"query", "statics"}, {"tensions", some_tensions}, {"pose", there["pose"]}}})[0];
  ASSERT_EQ(held["status"], "converged") << held;
  near(held["wrench"], forward["wrench"], 1e-4);
  // and by what tendons of held lengths pull
  Json pulls = Json::array();
  for (const Json& section : there["tensions"])
    for (const Json& tension : section) pulls.push_back(tension);
  const Json sensed =
      ask(tripod, {{{"query", "statics"}, {"changes", there["changes"]}, {"measured_tensions", pulls}}})[0];
  ASSERT_EQ(sensed["status"], "converged") << sensed;
  near(sensed["wrench"], forward["wrench"], 1e-3);
  EXPECT_EQ(sensed["covariance"].size(), 6U);
  EXPECT_GT(sensed["condition"], 1);
  // a path to the pose, and to the load there
  const Json path = ask(tripod, {{{"query", "track"},
                                  {"points",
                                   {{{"tensions", some_tensions}},
                                    {{"tensions", some_tensions}, {"wrench", forward["wrench"]}},
                                    {{"pose", there["pose"]}, {"wrench", forward["wrench"]}}}},
                                  {"steps", 2}}})[0];
  ASSERT_EQ(path["status"], "converged") << path;
  ASSERT_EQ(path["rows"].size(), 6U);
  near(path["rows"][3]["pose"]["position"], there["pose"]["position"], 1e-6);
  near(path["pose"]["position"], there["pose"]["position"], 1e-7);
  const Json ends =
      ask(tripod, {{{"query", "track"},
                    {"points", {{{"tensions", some_tensions}}, {{"wrench", {0, 0, -100, 0, 0, 0}}}}},
                    {"steps", 20}}})[0];
  EXPECT_EQ(ends["status"], "stalled");
  EXPECT_EQ(ends["reached"]["point"], 1);
}

TEST(ArmLegsQuery, LoadsOnLegsAreTakenByEveryQuestion) {
  const Json loads = {{{"leg", 0}, {"place", "33 mm"}, {"wrench", {0.1, 0.05, 0, 0, 0, 0}}},
                      {{"leg", 2}, {"place", 0.2}, {"wrench", {0, 0, -0.05, 0, 0, 0}}, {"following", false}}},
             along = {0.1, -0.1, 0};
  const auto with = [&](Json query) {
    query["loads"] = loads;
    query["distributed"] = along;
    return query;
  };
  const Json forward = with({{"query", "forward"}, {"tensions", some_tensions}});
  const std::vector<Json> first =
      ask(tripod,
          {forward,
           with({{"query", "velocity"}, {"tensions", some_tensions}, {"want", {"velocity", "stiffness"}}}),
           with({{"query", "shape"}, {"tensions", some_tensions}, {"samples", 3}}),
           {{"query", "track"},
            {"distributed", along},
            {"points", {{{"tensions", some_tensions}}, {{"loads", loads}}}},
            {"steps", 2}},
           with({{"query", "forward"},
                 {"tensions", some_tensions},
                 {"until", {{"wrench", {0.01, 0, 0, 0, 0, 0}}, {"limit", 2}}}}),
           {{"query", "forward"}, {"tensions", some_tensions}}});
  const Json& there = first[0];
  ASSERT_EQ(there["status"], "converged") << there;
  const auto near = [](const Json& a, const Json& b, double by) {
    for (std::size_t i = 0; i < b.size(); ++i) EXPECT_NEAR(a[i].get<double>(), b[i].get<double>(), by) << i;
  };
  for (const std::size_t k : {1U, 2U, 3U})
    near(first[k]["pose"]["position"], there["pose"]["position"], 1e-6);
  ASSERT_EQ(first[3]["rows"].size(), 4U) << first[3];
  EXPECT_EQ(first[4]["why"], "limit") << first[4];
  EXPECT_GT(
      std::abs(first[5]["pose"]["position"][0].get<double>() - there["pose"]["position"][0].get<double>()),
      1e-4);
  double down = 0;  // what acts on legs their bases bear
  for (const Json& leg : there["legs"]) down += leg["force"][2].get<double>();
  EXPECT_NEAR(down, -0.02 * 9.81, 1e-9);
  const std::vector<Json> then =
      ask(tripod, {with({{"query", "statics"}, {"tensions", some_tensions}, {"pose", there["pose"]}}),
                   with({{"query", "inverse"}, {"pose", there["pose"]}})});
  ASSERT_EQ(then[0]["status"], "converged") << then[0];
  near(then[0]["wrench"], {0, 0, 0, 0, 0, 0}, 1e-4);
  ASSERT_EQ(then[1]["status"], "converged") << then[1];
  near(then[1]["pose"]["position"], there["pose"]["position"], 1e-7);
}

/// A platform that only moves a little is pushed alike by what turns with it and what does not; and what has
/// no potential says from which load on it is not known to hold.
TEST(ArmLegsQuery, LoadsThatTurnAreTakenByEveryQuestion) {
  const Json turning = {
      {"following", {0.05, -0.02, 0.03, 1e-3, 2e-3, -1e-3}},
      {"distributed_following", {0.1, -0.1, 0.05}},
      {"loads",
       {{{"leg", 0}, {"place", 0.05}, {"wrench", {0.05, 0, 0, 0, 1e-3, 1e-3}}},
        {{"leg", 1}, {"place", 0.2}, {"wrench", {0, 0.05, 0, 1e-3, 0, 0}}, {"following", true}}}}};
  const auto with = [&](Json query) {
    query.update(turning);
    return query;
  };
  const Json held = {{"query", "forward"}, {"tensions", some_tensions}};
  Json path = turning;
  path["tensions"] = some_tensions;
  const std::vector<Json> first =
      ask(tripod, {with(held),
                   {{"query", "track"}, {"points", {{{"tensions", some_tensions}}, path}}, {"steps", 2}},
                   with({{"query", "forward"},
                         {"tensions", some_tensions},
                         {"until", {{"wrench", {0, 0, 0, 0, 0, 1}}, {"limit", 10}}}}),
                   with({{"query", "forward"}, {"tensions", some_tensions}, {"all", true}})});
  const Json& there = first[0];
  ASSERT_EQ(there["status"], "converged") << there;
  EXPECT_EQ(there["stable"], true);
  const auto near = [](const Json& a, const Json& b, double by) {
    for (std::size_t i = 0; i < b.size(); ++i) EXPECT_NEAR(a[i].get<double>(), b[i].get<double>(), by) << i;
  };
  near(first[1]["pose"]["position"], there["pose"]["position"], 1e-6);
  EXPECT_GT(first[2]["definite_until"], 0) << first[2];
  EXPECT_GE(first[2]["load"], first[2]["definite_until"]);
  EXPECT_GE(first[3]["count"], 1);
  const std::vector<Json> then =
      ask(tripod, {with({{"query", "statics"}, {"tensions", some_tensions}, {"pose", there["pose"]}}),
                   with({{"query", "inverse"}, {"pose", there["pose"]}})});
  ASSERT_EQ(then[0]["status"], "converged") << then[0];
  near(then[0]["wrench"], {0, 0, 0, 0, 0, 0}, 1e-4);
  ASSERT_EQ(then[1]["status"], "converged") << then[1];
  near(then[1]["pose"]["position"], there["pose"]["position"], 1e-7);
}

TEST(ArmLegsQuery, BadLoadsOnLegsSayWhatIsWrong) {
  const auto code = [](const Json& load) {
    return status({{"query", "forward"}, {"tensions", some_tensions}, {"loads", Json::array({load})}});
  };
  const Json force = {0.1, 0, 0, 0, 0, 0};
  EXPECT_EQ(code({{"leg", 1}, {"place", 0.1}, {"wrench", force}}), "converged");
  EXPECT_EQ(code({{"place", 0.1}, {"wrench", force}}), "missing_key");
  EXPECT_EQ(code({{"leg", 1}, {"wrench", force}}), "missing_key");
  EXPECT_EQ(code({{"leg", 1}, {"place", 0.1}}), "missing_key");
  EXPECT_EQ(code({{"leg", 3}, {"place", 0.1}, {"wrench", force}}), "out_of_range");
  EXPECT_EQ(code({{"leg", -1}, {"place", 0.1}, {"wrench", force}}), "out_of_range");
  EXPECT_EQ(code({{"leg", 0.5}, {"place", 0.1}, {"wrench", force}}), "not_whole");
  EXPECT_EQ(code({{"leg", 1}, {"place", 0}, {"wrench", force}}), "out_of_range");
  EXPECT_EQ(code({{"leg", 1}, {"place", 0.2001}, {"wrench", force}}), "out_of_range");
  EXPECT_EQ(code({{"leg", 1}, {"place", 0.1}, {"wrench", {0.1, 0, 0}}}), "wrong_length");
  EXPECT_EQ(code({{"leg", 1}, {"place", 0.1}, {"wrench", {0, 0, 0, 0, 0, 1e-3}}}), "converged");
  EXPECT_EQ(code({{"leg", 1}, {"place", 0.1}, {"wrench", force}, {"following", true}}), "converged");
  EXPECT_EQ(code({{"leg", 1}, {"place", 0.1}, {"wrench", force}, {"following", 1}}), "wrong_type");
  EXPECT_EQ(code({{"leg", 1}, {"place", 0.1}, {"wrench", force}, {"nonsense", 1}}), "unknown_key");
  EXPECT_EQ(code(1), "wrong_type");
  EXPECT_EQ(status({{"query", "forward"}, {"distributed", {0, 0}}}), "wrong_length");
  const Json of_arm = ask(
      "two-segment",
      {{{"query", "forward"}, {"loads", Json::array({{{"leg", 0}, {"place", 0.1}, {"wrench", force}}})}}})[0];
  EXPECT_EQ(of_arm["error"]["code"], "no_effect") << of_arm;
}

TEST(ArmLegsQuery, WhatIsNotBuiltIsNamed) {
  EXPECT_EQ(status({{"query", "inverse"}}), "missing_key");
  EXPECT_EQ(status({{"query", "statics"}}), "missing_key");
  EXPECT_EQ(status({{"query", "track"}}), "missing_key");
  EXPECT_EQ(status({{"query", "track"}, {"points", Json::array()}}), "empty_list");
  EXPECT_EQ(
      status({{"query", "track"}, {"points", {{{"following", {1, 0, 0}}, {"tensions", Json::array()}}}}}),
      "wrong_length");
  EXPECT_EQ(status({{"query", "inverse"}, {"position", {0, 0, 1}}}), "unreachable");
  EXPECT_EQ(status({{"query", "statics"}, {"position", {0, 0, 0.19}}, {"force_alone", false}}), "bad_input");
  EXPECT_EQ(status({{"query", "forward"}, {"following", {1, 2, 3}}}), "wrong_length");
  EXPECT_EQ(status({{"query", "forward"}, {"distributed_following", {1, 2}}}), "wrong_length");
  EXPECT_EQ(status({{"query", "forward"}, {"balance", "projected"}}), "unsupported");
  EXPECT_EQ(status({{"query", "forward"}, {"nonsense", 1}}), "unknown_key");
  EXPECT_EQ(status({{"query", "forward"}, {"tensions", {{-1, 0, 0}}}}), "out_of_range");
  EXPECT_EQ(status({{"query", "forward"}, {"tensions", {{1, 0}}}}), "wrong_length");
  EXPECT_EQ(status({{"query", "forward"}, {"tensions", {{1e9, 0, 0}}}}), "stalled");
  EXPECT_EQ(status({{"query", "forward"}, {"wrench", {0, 0, -1e5, 0, 0, 0}}}), "stalled");
}

TEST(ArmLegsQuery, FilesAreRefusedWhereTheyAreWrong) {
  const auto code = [](const char* path, const Json& value) {
    return status({{"query", "forward"}, {"set", {{path, value}}}});
  };
  EXPECT_EQ(code("legs[1].link", {{"type", "rod"}}), "mixed_legs");
  EXPECT_EQ(code("space", "planar"), "no_effect");  // its gravity acts out of the plane
  EXPECT_EQ(code("defaults.closure.type", "chord"), "unknown_choice");
  EXPECT_EQ(code("legs[1].base.point.angle", "0 deg"), "coincident_base_points");
  EXPECT_EQ(code("legs[1].base.section_x", {0, 0, 1}), "no_direction");
  EXPECT_EQ(code("defaults.link.sections.count", 0), "out_of_range");
  EXPECT_EQ(code("defaults.link.sections.backbone.diameter", "-1 mm"), "out_of_range");
  EXPECT_EQ(code("defaults.link.sections.tendons", nullptr), "no_tendon");
  EXPECT_EQ(code("legs[2].tied", 0), "not_available");
  EXPECT_EQ(code("defaults.closure.type", "clamp"), "converged");
  EXPECT_EQ(code("defaults.link.sections.backbone.law", "kirchhoff"), "converged");
}

TEST(ArmLegsQuery, HasNoPathOfPosesAsOtherRobots) {
  const Json path = ask(tripod, {{{"query", "track"}, {"from", {{"position", {0, 0, 0.2}}}}, {"to", 7}}})[0];
  EXPECT_EQ(path["status"], "unsupported") << path;
  EXPECT_NE(path["message"].get<std::string>().find("points"), std::string::npos) << path;
}

}  // namespace arm_legs_query_test
}  // namespace sinew::test
