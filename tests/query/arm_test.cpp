/// Questions to arms through the real `sinew query`.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sinew_query.hpp"

namespace sinew::test {
namespace arm_test {

TEST(ArmQueries, TensionsAndTheirChangesAgree) {
  const Json under{
      {"query", "forward"}, {"tensions", {{4, 0.5, 0}, {0, 2, 1}}}, {"wrench", {0.05, 0, 0, 0, 0, 0}}};
  const Json pulled = ask("two-segment", {under})[0];
  ASSERT_EQ(pulled["status"], "converged") << pulled;
  EXPECT_LT(pulled["resolution"].get<double>(), 4e-7);
  // tendon 2 of the first section pulls nothing: its change tells nothing but its way
  Json held = under;
  held["tensions"] = {{4, nullptr, 0}, nullptr};
  held["changes"] = {{nullptr, pulled["changes"][0][1], nullptr}, pulled["changes"][1]};
  const Json again = ask("two-segment", {held})[0];
  ASSERT_EQ(again["status"], "converged") << again;
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(again["tip"]["position"][i].get<double>(), pulled["tip"]["position"][i].get<double>(), 1e-7);
  EXPECT_NEAR(again["tensions"][1][1].get<double>(), 2, 1e-5);
}

/// Rigid tendons are softened while they are searched for: nothing of that stays for the next question.
TEST(ArmQueries, AnswersDoNotDependOnQuestionsBefore) {
  const Json loose{{"query", "forward"}, {"tensions", {{0, 0, 0}, {0, 0, 0}}}},
      pulled{{"query", "forward"}, {"tensions", {{4, 0.5, 0}, {0, 2, 1}}}},
      short_by{{"query", "forward"},
               {"changes", {{-0.002, nullptr, nullptr}, {0.001, 0.002, nullptr}}},
               {"tensions", {{nullptr, 0, 0}, {nullptr, nullptr, 0.3}}}},
      mixed{{"query", "forward"},
            {"changes", {{nullptr, 0.012, 0.004}, {-0.004, -0.001, 0.005}}},
            {"tensions", {{3, nullptr, nullptr}, nullptr}}},
      back{{"query", "inverse"}, {"position", {0.01, 0.02, 0.395}}};
  const std::vector<Json> questions{loose, pulled, short_by, mixed, back};
  std::vector<Json> alone, all;
  for (const Json& question : questions) alone.push_back(ask("two-segment", {question})[0]);
  std::mt19937 random(5);
  std::vector<std::size_t> order;
  for (int k = 0; k < 40; ++k) order.push_back(random() % questions.size());
  for (const std::size_t which : order) all.push_back(questions[which]);
  const auto answers = ask("two-segment", all);
  for (std::size_t k = 0; k < order.size(); ++k) EXPECT_EQ(answers[k], alone[order[k]]) << k << all[k];
  for (const Json& answer : alone) EXPECT_EQ(answer["status"], "converged") << answer;
}

/// Tendons held and a force with a moment, which has no potential: the speed of the tip alone tells of the
/// fold. Steps from an equilibrium whose stiffness is not definite went back to the straight arm before.
TEST(ArmQueries, AFoldUnderAMoment) {
  Json question{
      {"query", "forward"},
      {"changes", {{-6.4e-05, 6.1e-4, 7.6e-4}, {-0.0266, 2.2e-4, 6.1e-05}, {6e-05, -0.003, -0.0054}}},
      {"wrench", {1.775, 0.011, 0.547, 0.057, -0.00014, -0.0023}},
      {"until", {{"wrench", {-0.2067, -0.0174, -0.006, -0.0045, 1.334, -0.036}}, {"limit", 1}}}};
  std::vector<double> loads;
  for (const int order : {0, 1}) {
    question["order"] = order;
    const Json path = ask("ftdcr-v4", {question})[0];
    EXPECT_EQ(path["why"], "fold") << path;
    loads.push_back(path["load"]);
  }
  EXPECT_NEAR(loads[0] / loads[1], 1, 0.01);
}

TEST(ArmQueries, InverseIsForwardBack) {
  const Json there = ask("two-segment", {{{"query", "forward"}, {"tensions", {{2, 0, 0}, {0, 1, 0}}}}})[0];
  const Json back = ask("two-segment", {{{"query", "inverse"}, {"position", there["tip"]["position"]}}})[0];
  ASSERT_EQ(back["status"], "converged") << back;
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(back["tip"]["position"][i].get<double>(), there["tip"]["position"][i].get<double>(), 1e-6);
}

TEST(ArmQueries, TheForceThatTensionsTell) {
  const Json pushed =
      ask("ftdcr-v4",
          {{{"query", "forward"},
            {"changes", {{-0.003, -0.001, -0.001}, {-0.002, -0.001, -0.001}, {-0.001, -0.001, -0.001}}},
            {"wrench", {0.05, -0.03, 0.02, 0, 0, 0}}}})[0];
  ASSERT_EQ(pushed["status"], "converged") << pushed;
  Json measured = Json::array();
  for (const Json& section : pushed["tensions"])
    for (const Json& tension : section) measured.push_back(tension);
  const Json felt =
      ask("ftdcr-v4",
          {{{"query", "statics"},
            {"changes", {{-0.003, -0.001, -0.001}, {-0.002, -0.001, -0.001}, {-0.001, -0.001, -0.001}}},
            {"measured_tensions", measured}}})[0];
  ASSERT_EQ(felt["status"], "converged") << felt;
  EXPECT_NEAR(felt["wrench"][0].get<double>(), 0.05, 1e-4);
  EXPECT_NEAR(felt["wrench"][1].get<double>(), -0.03, 1e-4);
  EXPECT_NEAR(felt["wrench"][2].get<double>(), 0.02, 1e-3);
  EXPECT_GT(felt["covariance"][0][0].get<double>(), 0);
  EXPECT_GT(felt["condition"].get<double>(), 1);
}

/// A covariance of zeros would say that the wrench is known exactly.
/// Tips of known tensions are reached by no larger sum of squares.
TEST(ArmQueries, InverseFindsTheLeastTensionsNearby) {
  for (const std::vector<double>& pull : {std::vector{1.14, 0.0, 0.78},
                                          {1.654, 0, 1.321},
                                          {0, 1.28, 0.865},
                                          {1.724, 0.814, 0},
                                          {0.264, 0.61, 0},
                                          {0, 0.524, 1},
                                          {0.763, 0.544, 0}}) {
    const Json there = ask("two-segment", {{{"query", "forward"}, {"tensions", {pull, {0, 0, 0}}}}})[0];
    const Json found =
        ask("two-segment", {{{"query", "inverse"}, {"position", there["tip"]["position"]}}})[0];
    ASSERT_EQ(found["status"], "converged") << found.dump();
    double sum = 0, given = 0;
    for (const double tension : pull) given += tension * tension;
    for (const Json& section : found["tensions"])
      for (const double tension : section) sum += tension * tension;
    EXPECT_LT(sum, given) << found["tensions"].dump();
  }
}

/// Of a force and a moment six tensions tell two that explain them: the lesser is answered, and the other
/// told.
TEST(ArmQueries, AnotherWrenchThatExplainsTensionsIsTold) {
  const std::vector<double> force{0.05, -0.03, 0.02, 0, 0, 0};
  const auto ask_two = [](const Json& question) { return ask("two-segment", {question})[0]; };
  const Json there =
      ask_two({{"query", "forward"}, {"tensions", {{1.0, 0.5, 0.7}, {0.4, 0.8, 0.3}}}, {"wrench", force}});
  ASSERT_EQ(there["status"], "converged") << there.dump();
  Json question = {{"query", "statics"},
                   {"changes", there["changes"]},
                   {"measured_tensions", {1.0, 0.5, 0.7, 0.4, 0.8, 0.3}},
                   {"deviation", 0.01}};
  question["force_alone"] = false;
  const Json found = ask_two(question);
  ASSERT_EQ(found["status"], "converged") << found.dump();
  EXPECT_LT(found["misfit"], 1e-4);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(found["wrench"][i], force[i], 1e-5) << i;
  EXPECT_EQ(found.value("message", "").rfind("another wrench, [0.022, -0.0174, -0.078", 0), 0U)
      << found.dump();
  question["force_alone"] = true;
  EXPECT_FALSE(ask_two(question).contains("message"));
}

TEST(ArmQueries, TellsNoCovarianceOfAWrenchThatIsNotTold) {
  const Json loose = ask("tendon-rod", {{{"query", "statics"},
                                         {"changes", {{0, 0, 0, 0}}},
                                         {"measured_tensions", {0.1, 0.1, 0.1, 0.1}},
                                         {"force_alone", false},
                                         {"max_iterations", 0}}})[0];
  EXPECT_NE(loose["status"], "converged") << loose;
  EXPECT_FALSE(loose.contains("covariance")) << loose;
  EXPECT_FALSE(loose.contains("condition")) << loose;
  // Tensions are held: that they are measured tells nothing.
  const Json refused = ask("tendon-rod", {{{"query", "forward"}, {"tensions", {{1, 0, 0, 0}}}},
                                          {{"query", "statics"},
                                           {"tensions", {{1, 0, 0, 0}}},
                                           {"measured_tensions", {1, 0, 0, 0}},
                                           {"start", "last"}}})[1];
  EXPECT_EQ(refused["status"], "bad_input") << refused;
  EXPECT_FALSE(refused.contains("wrench")) << refused;
  EXPECT_FALSE(refused.contains("tip")) << refused;
}

TEST(ArmQueries, EveryWantAndModel) {
  for (const char* model : {"rod", "subsegment_rod", "subsegment_cc", "cc", "prb"}) {
    const Json answer = ask(
        "two-segment", {{{"query", "forward"},
                         {"model", model},
                         {"tensions", {{1, 0, 0}}},
                         {"loads", {{{"place", 0.13}, {"wrench", {0, 0.02, 0, 0, 0, 0}}}}},
                         {"distributed", {0, 0.01, 0}},
                         {"following", {0, 0, -0.01, 0, 0, 0}},
                         {"want", {"pose", "velocity", "shape", "stiffness", "stability", "margins"}}}})[0];
    ASSERT_EQ(answer["status"], "converged") << answer;
    EXPECT_EQ(answer["U"].size(), 6U);
    EXPECT_EQ(answer["U"][0].size(), 6U);
    EXPECT_EQ(answer["compliance"].size(), 6U);
    EXPECT_EQ(answer["tendons"].size(), 2U);
    EXPECT_GT(answer["buckling_margin"].get<double>(), 0);
    EXPECT_LT(answer["buckling_margin"].get<double>(), 1.5);
  }
}

TEST(ArmQueries, LoadsWhereSpansOfAChannelEnd) {
  for (const double place : {0.05, 0.1, 0.15, 0.2, 0.35, 0.45}) {
    const auto query = [&](double by) {
      return Json{{"query", "forward"},
                  {"tensions", {{2, 0, 0, 0}}},
                  {"loads", Json::array({{{"place", place + by}, {"wrench", {0, 0.05, 0, 0, 0, 0}}}})}};
    };
    const auto answers = ask("tendon-rod", {query(0), query(1e-7)});
    ASSERT_EQ(answers[0]["status"], "converged") << place << answers[0];
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(answers[0]["tip"]["position"][i].get<double>(),
                  answers[1]["tip"]["position"][i].get<double>(), 1e-7)
          << place;
  }
}

/// Each of the solutions is where a search ends that begins at its curvatures.
TEST(ArmQueries, SolutionsAreStarts) {
  const Json pushed{{"query", "forward"},
                    {"changes", {{0.01, 0.01, 0.01, 0.01}}},
                    {"wrench", {0, 0, -60, 0, 0, 0}},
                    {"tilt", true}};
  Json every = pushed;
  every["all"] = true;
  const Json all = ask("tendon-rod", {every})[0];
  ASSERT_GE(all["count"].get<int>(), 5) << all;
  std::vector<Json> again;
  for (const Json& one : all["solutions"]) {
    EXPECT_FALSE(one.contains("continuum"));
    EXPECT_TRUE(one["tip"].contains("azimuth"));
    EXPECT_EQ(one["curvatures"].size(), 16U);
    again.push_back(pushed);
    again.back()["start"] = one["curvatures"];
  }
  const auto answers = ask("tendon-rod", again);
  for (std::size_t k = 0; k < again.size(); ++k) {
    ASSERT_EQ(answers[k]["status"], "converged") << answers[k];
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(answers[k]["tip"]["position"][i].get<double>(),
                  all["solutions"][k]["tip"]["position"][i].get<double>(), 5e-6);
  }
}

/// However bent the shape is at which the search begins: an equilibrium, or a word.
TEST(ArmQueries, AnyStartEndsHonestly) {
  std::mt19937 gen(11);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 60; ++k) {
    Json start = Json::array();
    const int parts = 1 + static_cast<int>(gen() % 30);
    const double size = std::pow(10.0, static_cast<double>(gen() % 8) - 2);
    for (int part = 0; part < parts; ++part)
      start.push_back({size * normal(gen), size * normal(gen), size * normal(gen)});
    const Json answer = ask("two-segment", {{{"query", "forward"},
                                             {"tensions", {{2, 0, 0}, {0, 1, 0}}},
                                             {"model", k % 2 ? "prb" : "subsegment_rod"},
                                             {"start", start}}})[0];
    if (answer.contains("error")) {
      EXPECT_EQ(answer["error"]["code"], "out_of_range") << answer;
      continue;
    }
    const auto status = answer["status"].get<std::string>();
    if (status == "converged") {
      EXPECT_LT(answer["residual"].get<double>(), 1e-8);
    } else {
      EXPECT_TRUE(status == "stalled" || status == "iteration_limit" || status == "left_domain") << status;
    }
  }
}

/// At rest, where nothing is easier, and of the inverse: no order is too high for the model's elements.
TEST(ArmQueries, EveryOrderIsAnswered) {
  std::vector<Json> queries;
  for (int order = 0; order <= 9; ++order) {
    queries.push_back({{"query", "forward"}, {"tensions", {{0, 0, 0}, {0, 0, 0}}}, {"order", order}});
    if (order % 3 == 0)
      queries.push_back({{"query", "inverse"}, {"position", {0.05, 0.03, 0.38}}, {"order", order}});
  }
  for (const Json& answer : ask("two-segment", queries)) EXPECT_EQ(answer["status"], "converged") << answer;
  const Json refused =
      ask("two-segment",
          {{{"query", "inverse"}, {"position", {0.05, 0.03, 0.38}}, {"order", 6}, {"elements", 2}}})[0];
  EXPECT_EQ(refused["error"]["code"], "out_of_range") << refused;
  EXPECT_EQ(refused["error"]["message"],
            "order: polynomials of order 6 need at least 4 elements, found 2: two Gauss points in each have "
            "to tell "
            "their 7 coefficients; give more elements, an order up to 3, or leave elements out")
      << refused;
}

/// There is an equilibrium, so no other shape to begin at is the way out: an accuracy that can be had is.
TEST(ArmQueries, SaysWhatAccuracyCanBeHad) {
  const auto at = [](double accuracy) {
    return ask("two-segment",
               {{{"query", "forward"}, {"tensions", {{4, 0, 0}, {0, 2, 0}}}, {"accuracy", accuracy}}})[0];
  };
  const Json fine = at(1e-11);
  EXPECT_EQ(fine["status"], "stalled");
  EXPECT_EQ(
      fine["message"],
      "the finest polynomials still move the tip by 1.1e-10 m, accuracy: 1e-11 asks for 4.0e-12 m: give "
      "accuracy: 3e-10 or more, or smaller loads and tensions");
  EXPECT_EQ(at(3e-10)["status"], "converged");
}

/// What is wanted is answered, or the message says why not.
TEST(ArmQueries, StiffnessOrTheReason) {
  for (const char* model : {"rod", "cc", "prb"}) {
    const Json answer = ask(
        "tendon-rod",
        {{{"query", "forward"}, {"model", model}, {"tensions", {{5, 0, 0, 0}}}, {"want", {"stiffness"}}}})[0];
    ASSERT_EQ(answer["status"], "converged") << answer;
    EXPECT_TRUE(answer.contains("compliance"));
    EXPECT_EQ(answer.contains("stiffness"), model != std::string("cc")) << answer;
    EXPECT_EQ(answer.contains("message"), !answer.contains("stiffness")) << answer;
  }
}

TEST(ArmQueries, GravityOfWhatHasNoMassIsRefused) {
  const auto code = [](const char* robot, Json query) {
    query["gravity"] = {0, 0, -9.81};
    const Json answer = ask(robot, {query})[0];
    return answer.contains("error") ? answer["error"]["code"].get<std::string>()
                                    : answer["status"].get<std::string>();
  };
  const Json pulled{{"query", "forward"}, {"tensions", {{1, 0, 0}}}};
  EXPECT_EQ(code("two-segment", pulled), "no_effect");
  Json weighs = pulled;
  weighs["set"] = {{"sections.discs", {{"count", 10}, {"mass", 0.001}}}};
  EXPECT_EQ(code("two-segment", weighs), "converged");
  EXPECT_EQ(code("two-segment", {{"query", "inverse"}, {"position", {0.05, 0.03, 0.38}}}), "no_effect");
  EXPECT_EQ(code("tendon-rod", {{"query", "forward"}, {"tensions", {{1, 0, 0, 0}}}}), "converged");
  EXPECT_EQ(code("tripod-two-section", {{"query", "forward"}}), "converged");
  const Json light{{"platform.mass", 0},
                   {"defaults.link.sections.discs.mass", 0},
                   {"defaults.link.sections.backbone.material.density", 0}};
  EXPECT_EQ(code("tripod-two-section", {{"query", "forward"}, {"set", light}}), "no_effect");
}

TEST(ArmQueries, Refusals) {
  const auto code = [](const Json& query) {
    const Json answer = ask("two-segment", {query})[0];
    return answer.contains("error") ? answer["error"]["code"].get<std::string>()
                                    : answer["status"].get<std::string>();
  };
  EXPECT_EQ(code({{"query", "forward"}, {"tensions", {{-1, 0, 0}}}}), "out_of_range");
  EXPECT_EQ(code({{"query", "forward"}, {"tensions", {{1, 0}}}}), "wrong_length");
  EXPECT_EQ(code({{"query", "forward"}, {"tensions", {{1, 0, 0}, {0, 0, 0}, {0, 0, 0}}}}), "wrong_length");
  EXPECT_EQ(code({{"query", "forward"}, {"tensions", {{1, 0, 0}}}, {"changes", {{0.001, nullptr, nullptr}}}}),
            "ambiguous");
  EXPECT_EQ(code({{"query", "forward"},
                  {"tensions", {{1, 0, 0}}},
                  {"loads", {{{"place", 0.5}, {"wrench", {0, 0, 0, 0, 0, 0}}}}}}),
            "out_of_range");
  EXPECT_EQ(code({{"query", "forward"}, {"model", "elastica"}}), "unknown_choice");
  EXPECT_EQ(code({{"query", "forward"}, {"accuracy", 0}}), "out_of_range");
  EXPECT_EQ(code({{"query", "forward"}, {"accuracy", 1}}), "converged");
  EXPECT_EQ(code({{"query", "forward"}, {"want", {"legs"}}}), "unsupported");
  EXPECT_EQ(code({{"query", "track"}, {"poses", Json::array()}}), "unsupported");
  const auto from = [&](Json start, const char* query = "forward") {
    return code({{"query", query}, {"position", {0, 0.02, 0.39}}, {"start", std::move(start)}});
  };
  EXPECT_EQ(from(Json::array()), "wrong_length");
  EXPECT_EQ(from(Json::parse("[[1, 2]]")), "wrong_length");
  EXPECT_EQ(from(Json::parse("[1, 2, 3]")), "wrong_type");
  EXPECT_EQ(from(Json::parse("[[1, 2, null]]")), "wrong_type");
  EXPECT_EQ(from(Json::parse("[[1e9, 2, 3]]")), "out_of_range");
  EXPECT_EQ(from(Json::parse("[[1, 2, 3]]"), "inverse"), "wrong_type");
  EXPECT_EQ(code({{"query", "inverse"}}), "missing_key");
  EXPECT_EQ(code({{"query", "inverse"}, {"position", {0.6, 0, 0}}}), "unreachable");
}

}  // namespace arm_test
}  // namespace sinew::test
