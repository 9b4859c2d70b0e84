/// Arms along paths, their tendons rubbing, through the real `sinew query`.
#include <gtest/gtest.h>

#include <cmath>

#include "sinew_query.hpp"

namespace sinew::test {
namespace arm_track_test {

/// `tendon-rod` or `two-segment` whose tendons rub.
Json rubbing(const std::string& robot, double friction) {
  if (robot == "tendon-rod") return {{"sections[0].tendons.friction", friction}};
  Json set = Json::object();
  for (const char* tendon : {"[0]", "[1]", "[2]"})
    set[std::string("sections.tendons") + tendon + ".friction"] = friction;
  return set;
}
Json pulls(std::initializer_list<double> tensions) {
  Json points = Json::array();
  for (const double tension : tensions) points.push_back({{"tensions", {{tension, 0, 0, 0}}}});
  return points;
}
double across(const Json& row) { return row["tip"]["position"][0].get<double>(); }
double far(const Json& a, const Json& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i)
    sum += std::pow(a["tip"]["position"][i].get<double>() - b["tip"]["position"][i].get<double>(), 2);
  return std::sqrt(sum);
}
std::string code(const std::string& robot, const Json& query) {
  const Json answer = ask(robot, {query})[0];
  return answer.contains("error") ? answer["error"]["code"].get<std::string>()
                                  : answer["status"].get<std::string>();
}
std::string where(const Json& query) { return ask("two-segment", {query})[0]["error"]["where"]; }

TEST(ArmTrack, WithoutFrictionPointsAreThoseOfForward) {
  const Json points{
      {{"tensions", {{2, 0, 0}, {0, 1, 0}}}},
      {{"tensions", {{2, 0, nullptr}, nullptr}},
       {"changes", {{nullptr, nullptr, 0.002}, {-0.001, 0, 0.001}}},
       {"wrench", {0.02, 0, 0, 0, 0, 0}}},
      {{"changes", {{-0.002, 0.001, 0.001}, {0, 0, 0}}},
       {"gravity", {0, 0, -9.81}},
       {"following", {0, 0.01, 0, 0, 0, 0}},
       {"distributed", {0.01, 0, 0}},
       {"loads", {{{"place", 0.2}, {"wrench", {0, 0.02, 0, 0, 0, 0}}}}}},
  };
  const Json set{{"sections.discs", {{"count", 10}, {"mass", 1e-4}}}};
  const Json path = ask("two-segment", {{{"query", "track"},
                                         {"set", set},
                                         {"points", points},
                                         {"gravity", {0, 0, 0}},
                                         {"steps", 2},
                                         {"order", 3}}})[0];
  ASSERT_EQ(path["status"], "converged") << path;
  ASSERT_EQ(path["rows"].size(), 6U);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Json& row = path["rows"][2 * k + 1];
    EXPECT_EQ(row["point"], k);
    EXPECT_EQ(row["part"], 1);
    Json question = points[k];
    question["query"] = "forward";
    question["set"] = set;
    question["order"] = 3;
    const Json alone = ask("two-segment", {question})[0];
    ASSERT_EQ(alone["status"], "converged") << alone;
    EXPECT_LT(far(row, alone), 1e-8) << k;
    for (std::size_t m = 0; m < 2; ++m)
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(row["tensions"][m][i].get<double>(), alone["tensions"][m][i].get<double>(), 1e-5) << k;
        EXPECT_NEAR(row["changes"][m][i].get<double>(), alone["changes"][m][i].get<double>(), 1e-8) << k;
        EXPECT_EQ(row["tensions"][m][i], row["end_tensions"][m][i]);
      }
    EXPECT_NEAR(row["friction_loss"].get<double>(), 0, 1e-15);
  }
  EXPECT_LT(far(path, path["rows"][5]), 1e-15);  // the answer's own are where it ends
}

TEST(ArmTrack, MotorsPutInWhatFrictionTakesOverALoop) {
  const Json set = rubbing("tendon-rod", 0.2);
  const auto track = [&](const Json& points, int steps, bool goes_on) {
    Json query{{"query", "track"}, {"set", set}, {"points", points}, {"steps", steps}, {"elements", 2}};
    if (goes_on) query["start"] = "last";
    return query;
  };
  const auto answers =
      ask("tendon-rod", {track(pulls({3, 1, 3}), 20, false), track(pulls({1, 3}), 300, true)});
  ASSERT_EQ(answers[0]["status"], "converged") << answers[0];
  const Json& loop = answers[1];
  ASSERT_EQ(loop["status"], "converged");
  ASSERT_EQ(loop["rows"].size(), 600U);
  EXPECT_LT(far(loop, answers[0]), 1e-9);  // closed
  const double work = loop["motor_work"], loss = loop["friction_loss"];
  EXPECT_GT(loss, 5e-5);
  EXPECT_NEAR(work / loss, 1, 1e-6);
  // let go, the arm stays bent more than pulled
  EXPECT_GT(std::abs(across(loop["rows"][149])), std::abs(across(loop["rows"][449])) + 1e-4);
  for (const std::size_t k : {149U, 449U}) {
    const double held = loop["rows"][k]["tensions"][0][0], end = loop["rows"][k]["end_tensions"][0][0];
    EXPECT_NEAR(held, 2, 1e-12);
    EXPECT_EQ(end > held, k == 149) << end;
  }
}

TEST(ArmTrack, GoesOnWhereItEnded) {
  const Json set = rubbing("two-segment", 0.3);
  const auto point = [](double first, double second) {
    return Json{{"tensions", {{first, 0, 0}, {0, second, 0}}}};
  };
  const auto track = [&](const Json& points) {
    return Json{{"query", "track"}, {"set", set}, {"points", points}, {"steps", 3}};
  };
  Json second = track(Json::array({point(1, 2)})), anew = second;
  second["start"] = "last";
  const auto answers = ask(
      "two-segment", {track({point(3, 0), point(1, 2)}), track(Json::array({point(3, 0)})), second, anew});
  for (const Json& answer : answers) ASSERT_EQ(answer["status"], "converged") << answer;
  EXPECT_LT(far(answers[2], answers[0]), 1e-12);
  EXPECT_GT(far(answers[3], answers[0]), 1e-4);  // another way to the same tensions, another place
}

TEST(ArmTrack, WhatIsNotReachedEndsTheAnswer) {
  const Json answer =
      ask("two-segment",
          {{{"query", "track"},
            {"set", rubbing("two-segment", 0.2)},
            {"steps", 4},
            {"points",
             {{{"tensions", {{1, 0, 0}}}}, {{"tensions", {{1e9, 0, 0}}}}, {{"tensions", {{1, 0, 0}}}}}}}})[0];
  ASSERT_FALSE(answer.contains("error")) << answer;
  EXPECT_EQ(answer["status"], "stalled") << answer["status"];
  EXPECT_LT(answer["rows"].size(), 8U);
  EXPECT_EQ(answer["reached"]["rows"], answer["rows"].size());
  EXPECT_EQ(answer["reached"]["point"], 1);
  EXPECT_NE(answer["message"].get<std::string>().find("points[1]"), std::string::npos) << answer["message"];
  EXPECT_TRUE(answer.contains("tip"));
}

TEST(ArmTrack, Refusals) {
  const auto of = [](const Json& points) { return Json{{"query", "track"}, {"points", points}}; };
  const auto track = [&](const Json& point) { return of(Json::array({point})); };
  const Json good{{"tensions", {{1, 0, 0}}}};
  const std::string two = "two-segment";
  EXPECT_EQ(code(two, {{"query", "track"}}), "missing_key");
  EXPECT_EQ(code(two, of(Json::array())), "empty_list");
  EXPECT_EQ(code(two, of(3)), "wrong_type");
  EXPECT_EQ(code(two, track(3)), "wrong_type");
  EXPECT_EQ(code(two, track(Json::object())), "missing_key");
  EXPECT_EQ(code(two, track({{"tensions", {{1, 0}}}})), "wrong_length");
  EXPECT_EQ(where(of({good, {{"tensions", Json::array({{1, 0}})}}})), "points[1].tensions[0]");
  EXPECT_EQ(code(two, track({{"tensions", {{-1, 0, 0}}}})), "out_of_range");
  EXPECT_EQ(code(two, track({{"tensions", {{"nan", 0, 0}}}})), "not_a_number");
  EXPECT_EQ(code(two, track({{"tensions", {{"1 mm", 0, 0}}}})), "wrong_dimension");
  EXPECT_EQ(code(two, track({{"tensions", {{1, 0, 0}}}, {"changes", {{0.001, nullptr, nullptr}}}})),
            "ambiguous");
  EXPECT_EQ(code(two, track({{"tensions", {{1, 0, 0}}}, {"wrench", {1, 2}}})), "wrong_length");
  EXPECT_EQ(code(two, track({{"tensions", {{1, 0, 0}}}, {"wrensh", {1, 2}}})), "unknown_key");
  for (const int steps : {0, -1, 10001}) {
    Json query = track(good);
    query["steps"] = steps;
    EXPECT_EQ(code(two, query), "out_of_range") << steps;
  }
  Json long_path = of(Json::array());
  long_path["steps"] = 10000;
  for (int k = 0; k < 11; ++k) long_path["points"].push_back(good);
  EXPECT_EQ(code(two, long_path), "path_too_long");
  for (const char* field : {"poses", "from", "to", "objective"}) {
    Json query = track(good);
    query[field] = 2;
    EXPECT_EQ(code(two, query), "unsupported") << field;
  }
  for (const char* field : {"until", "all", "pose"}) {  // of other questions: named, not ignored
    Json query = track(good);
    query[field] = Json::object();
    EXPECT_EQ(code(two, query), "unknown_key") << field;
    EXPECT_EQ(where(query), field);
  }
  Json query = track(good);
  query["balance"] = "projected";
  EXPECT_EQ(code(two, query), "unsupported");
  query.erase("balance");
  const Json joints{{"query", "track"}, {"model", "prb"}, {"points", {{{"tensions", {{5, 0, 0, 0}}}}}}};
  EXPECT_EQ(code("tendon-rod", joints), "unsupported");
  Json fit{{"query", "identify"}, {"model", "prb"}};
  for (int k = 0; k < 12; ++k) {
    fit["rows"]["pulls"].push_back({1e-3 * k, 0, -1e-3 * k, 0});
    fit["rows"]["markers"].push_back({0.01 * k, 0, 0.5});
  }
  EXPECT_EQ(code("tendon-rod", fit), "unsupported");
  query["set"] = {{"sections.tendons[0].friction", -0.1}};
  EXPECT_EQ(code(two, query), "out_of_range");
  query["set"] = {{"sections.tendons[0].outside", 1.1}};
  EXPECT_EQ(code(two, query), "out_of_range");
  const Json of_legs = ask("3-rfr", {track(good)})[0]["error"];
  EXPECT_NE(of_legs["message"].get<std::string>().find("unknown key \"points\""), std::string::npos)
      << of_legs;
}

/// What every other question leaves out is said, also where it has something else to say.
TEST(ArmTrack, OtherQuestionsSayThatTheyLeaveFrictionOut) {
  const Json set = rubbing("two-segment", 0.1);
  const Json tensions{{1, 0, 0}, {0, 0, 0}};
  for (Json query :
       {Json{{"query", "forward"}, {"tensions", tensions}},
        Json{{"query", "velocity"}, {"tensions", tensions}}, Json{{"query", "shape"}, {"tensions", tensions}},
        Json{{"query", "inverse"}, {"position", {0.02, 0.02, 0.38}}},
        Json{{"query", "statics"}, {"tensions", tensions}, {"position", {0, 0.05, 0.39}}}}) {
    query["set"] = set;
    const Json answer = ask("two-segment", {query})[0];
    EXPECT_NE(answer.value("message", "").find("as if they did not rub"), std::string::npos) << answer;
    query.erase("set");
    EXPECT_EQ(ask("two-segment", {query})[0].value("message", "").find("rub"), std::string::npos);
  }
  const Json path =
      ask("two-segment",
          {{{"query", "track"}, {"set", set}, {"points", Json::array({{{"tensions", tensions}}})}}})[0];
  EXPECT_FALSE(path.contains("message")) << path;
}

/// Its shape is that of where the path ends, with what friction leaves of tensions from guide to guide.
TEST(ArmTrack, ShowsWhereThePathEnds) {
  const Json points{{{"tensions", {{4, 0, 0}}}}, {{"tensions", {{1, 0, 0}}}}};
  const Json query{{"query", "track"},  {"set", rubbing("two-segment", 0.3)},
                   {"points", points},  {"steps", 2},
                   {"want", {"shape"}}, {"samples", 11}};
  const Json path = ask("two-segment", {query})[0];
  ASSERT_EQ(path["status"], "converged") << path;
  const Json& along = path["tensions_along"];
  ASSERT_EQ(along.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(along[i].front(), path["tensions"][i / 3][i % 3]);
    EXPECT_EQ(along[i].back(), path["end_tensions"][i / 3][i % 3]);
    EXPECT_EQ(along[i].size(), path["tendons"][i / 3][i % 3].size());  // spans, and what is before the base
  }
  // paid out: the motor holds least; what a guide holds back is at most what it turns by
  for (std::size_t k = 1; k < along[0].size(); ++k)
    EXPECT_GE(along[0][k].get<double>(), along[0][k - 1].get<double>());
  ASSERT_EQ(path["backbones"][0].size(), 11U);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(path["backbones"][0][10][i].get<double>(), path["tip"]["position"][i].get<double>(), 1e-12);
  Json plain = query;
  plain.erase("want");
  EXPECT_EQ(ask("two-segment", {plain})[0]["error"]["where"], "samples");
  plain.erase("samples");
  const Json without = ask("two-segment", {plain})[0];
  EXPECT_FALSE(without.contains("backbones"));
  EXPECT_EQ(without["rows"], path["rows"]);
  EXPECT_EQ(code("two-segment", {{"query", "track"}, {"points", points}, {"want", {"stiffness"}}}),
            "unsupported");
}

/// Rates of each tendon, on and back, against the next small step of the path.
TEST(ArmTrack, HasRatesOnAndBackWhereThePathEnds) {
  Json query{{"query", "track"}, {"set", rubbing("two-segment", 0.3)}, {"steps", 2}, {"order", 3}};
  query["points"] = {{{"tensions", {{3, 0, 0}, {1, 0, 0.5}}}}};
  Json asked = query;
  asked["want"] = {"velocity"};
  const Json path = ask("two-segment", {asked})[0];
  ASSERT_EQ(path["status"], "converged") << path;
  ASSERT_EQ(path["one_sided"].size(), 6U);
  const double step = 1e-4;
  for (const auto& [name, way] : {std::pair{"growing", 1.0}, {"shrinking", -1.0}}) {
    Json next = query;
    next["points"].push_back(next["points"][0]);
    next["points"][1]["tensions"][0][0] = 3 + way * step;
    const Json small = ask("two-segment", {next})[0];
    const Json& rates = path["one_sided"][0][name];
    ASSERT_TRUE(rates.contains("twist")) << rates;
    double largest = 0;
    for (const Json& part : rates["twist"]) largest = std::max(largest, std::abs(part.get<double>()));
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(
          (small["tip"]["position"][k].get<double>() - path["tip"]["position"][k].get<double>()) / step,
          rates["twist"][k].get<double>(), 2e-3 * largest)
          << name << ' ' << k;
    EXPECT_EQ(rates["tensions"][0][0], way);
  }
  EXPECT_NE(path["one_sided"][0]["growing"]["twist"], path["one_sided"][0]["shrinking"]["twist"]);
  EXPECT_NE(path["one_sided"][1]["shrinking"]["message"].get<std::string>().find("pull less"),
            std::string::npos);
  asked["points"] = {{{"tensions", {{0, 0, 0}, {0, 0, 0}}}}};
  EXPECT_TRUE(ask("two-segment", {asked})[0]["one_sided"][0]["growing"].contains("twist"));
  asked["points"] = {{{"tensions", {{1, 1, 1}, {0, 0, 0}}}}};  // straight: no guide turns a tendon yet
  EXPECT_TRUE(ask("two-segment", {asked})[0]["one_sided"][0]["growing"].contains("message"));
}

/// Rates as matrices while tendons move these ways, against the next small step of the path.
TEST(ArmTrack, HasMatricesForWaysToMove) {
  Json query{{"query", "track"}, {"set", rubbing("two-segment", 0.3)}, {"steps", 2}, {"order", 3}};
  query["points"] = {{{"tensions", {{3, 0, 0}, {1, 0, 0.5}}}}};
  Json asked = query;
  asked["motions"] = {{1, nullptr, 0}, {-0.5, 0, 0.2}};
  const Json path = ask("two-segment", {asked})[0];
  ASSERT_EQ(path["status"], "converged") << path;
  const Json& moves = path["in_motion"];
  ASSERT_TRUE(moves.contains("U")) << moves;
  const double step = 1e-4;
  Json next = query;
  next["points"].push_back(next["points"][0]);
  next["points"][1]["tensions"] = {{3 + step, 0, 0}, {1 - 0.5 * step, 0, 0.5 + 0.2 * step}};
  const Json small = ask("two-segment", {next})[0];
  for (std::size_t k = 0; k < 3; ++k) {
    const auto row = moves["U"][k].get<std::vector<double>>();
    const double rate = row[0] - 0.5 * row[3] + 0.2 * row[5];
    EXPECT_NEAR(rate, moves["twist"][k].get<double>(), 1e-12);
    EXPECT_NEAR((small["tip"]["position"][k].get<double>() - path["tip"]["position"][k].get<double>()) / step,
                rate, 2e-3 * std::abs(moves["twist"][0].get<double>()) + 1e-5);
  }
  EXPECT_EQ(moves["least"].size(), 2U);
  EXPECT_LE(moves["least"][0][0], 1.0);
  EXPECT_EQ(moves["compliance"].size(), 6U);
  EXPECT_EQ(moves["changes_by_wrench"].size(), 6U);
  EXPECT_EQ(moves["tensions_by_inputs"][0][0], 1.0);
  asked["motions"] = {{-1, -1, 0}};  // the second has no tension to lose
  EXPECT_NE(ask("two-segment", {asked})[0]["in_motion"]["message"].get<std::string>().find("pull less"),
            std::string::npos);
  asked["motions"] = {{0, 0, 0}};
  EXPECT_EQ(code("two-segment", asked), "out_of_range");
  asked["motions"] = {{1, 0}};
  EXPECT_EQ(code("two-segment", asked), "wrong_length");
}

}  // namespace arm_track_test
}  // namespace sinew::test
