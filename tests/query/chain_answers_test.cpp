/// Questions about robots on pseudo-rigid chains, through the protocol.
#include <gtest/gtest.h>

#include <algorithm>

#include "sinew_query.hpp"

namespace sinew::test {
namespace chain_answers_test {

Json prb(Json query) {
  query["model"] = "prb";
  return query;
}
const std::string four_legs = std::string(source_folder) + "/examples/robots/four-legged.yaml";
const Json here{{"x", 0.01}, {"y", 0}, {"phi", 0.1}}, wrench{0.02, -0.01, 3e-4};

double apart(const Json& a, const Json& b) {
  double most = 0;
  for (const char* key : {"x", "y", "phi"})
    most = std::max(most, std::abs(a[key].get<double>() - b[key].get<double>()));
  return most;
}

TEST(ChainAnswers, OfFourPlanarLegsFitTogether) {
  const Json inverse = ask(four_legs, {prb({{"query", "inverse"}, {"pose", here}, {"wrench", wrench}})})[0];
  ASSERT_EQ(inverse["status"], "converged") << inverse;
  const auto answers =
      ask(four_legs, {prb({{"query", "forward"}, {"inputs", inverse["inputs"]}, {"wrench", wrench}}),
                      prb({{"query", "forward"}, {"inputs", {0.188, 0.19, 0.189, 0.188}}}),  // of no arcs
                      prb({{"query", "shape"}, {"inputs", {0.188, 0.19, 0.189, 0.188}}}),
                      prb({{"query", "velocity"}, {"pose", here}, {"twist", {1, 0, 0}}}),
                      {{"query", "statics"}, {"set_at", here}, {"wrench", wrench}},
                      {{"query", "forward"}, {"inputs", {0.188, 0.19, 0.189, 0.188}}}});
  EXPECT_LT(apart(answers[0]["pose"], here), 1e-9) << answers[0];
  EXPECT_EQ(answers[1]["status"], "converged") << answers[1];
  EXPECT_EQ(answers[1]["legs"].size(), 4U);
  EXPECT_EQ(answers[2]["pose"], answers[1]["pose"]);
  EXPECT_EQ(answers[3]["J"].size(), 4U);
  EXPECT_FALSE(answers[3].contains("U"));
  EXPECT_FALSE(answers[3].contains("determinant"));
  EXPECT_EQ(answers[3]["rates"].size(), 20U);
  EXPECT_LT(answers[4]["linear_error"].get<double>(), 0.05) << answers[4];
  EXPECT_NE(answers[5]["status"], "converged");
}

TEST(ChainAnswers, OfMotorsGoBackAndForth) {
  for (const char* theta_is : {"tangent", "chord"})
    for (const Json& load : {Json{0, 0, 0}, Json{0.02, -0.01, 3e-4}}) {
      const auto common = [&](Json query) {
        query["wrench"] = load;
        query["theta_is"] = theta_is;
        return prb(query);
      };
      const Json inverse =
          ask("3-rfrr", {common({{"query", "inverse"}, {"pose", here}, {"curvature", {3, 4, 5}}})})[0];
      ASSERT_EQ(inverse["status"], "converged") << inverse;
      ASSERT_EQ(inverse["inputs"].size(), 6U);
      const auto answers =
          ask("3-rfrr", {common({{"query", "forward"}, {"inputs", inverse["inputs"]}, {"start", here}}),
                         common({{"query", "shape"}, {"inputs", inverse["inputs"]}, {"start", here}})});
      for (const Json& answer : answers) {
        ASSERT_EQ(answer["status"], "converged") << answer;
        EXPECT_LT(apart(answer["pose"], here), 1e-9);
      }
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(answers[0]["legs"][i]["angles"][0].get<double>(),
                    inverse["legs"][i]["angles"][0].get<double>(), 1e-12);
        EXPECT_NEAR(answers[0]["legs"][i]["motor_torque"].get<double>(),
                    inverse["legs"][i]["motor_torque"].get<double>(), 1e-9);
      }
    }
}

TEST(ChainAnswers, OfMotorsAreThoseOfArcsAsLinksBecomeMany) {
  const Json inputs{-1.7, 0.147, 1.2, 0.148, 2.35, 0.149};
  std::vector<double> errors;
  for (const int joints : {8, 16, 32}) {
    const Json set{{"defaults.link.joints", joints}};
    const auto answers = ask("3-rfrr", {{{"query", "forward"}, {"inputs", inputs}, {"set", set}},
                                        prb({{"query", "forward"}, {"inputs", inputs}, {"set", set}})});
    ASSERT_EQ(answers[1]["status"], "converged") << answers[1];
    errors.push_back(apart(answers[0]["pose"], answers[1]["pose"]));
  }
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), 2, 0.05);
}

/// ∂(pose)/∂(inputs) of `forward`, by differences of its answers.
void expect_sensitivity(const std::string& robot, const Json& inputs, const Json& more) {
  Json query = prb({{"query", "forward"},
                    {"inputs", inputs},
                    {"wrench", wrench},
                    {"start", here},
                    {"want", {"sensitivity"}}});
  query.update(more);
  const double step = 1e-6;
  std::vector<Json> queries{query};
  for (std::size_t k = 0; k < inputs.size(); ++k)
    for (const double by : {-step, step}) {
      Json moved = query;
      moved["inputs"][k] = inputs[k].get<double>() + by;
      queries.push_back(moved);
    }
  const auto answers = ask(robot, queries);
  ASSERT_EQ(answers[0]["status"], "converged") << answers[0];
  const Json& found = answers[0]["sensitivity"];
  ASSERT_EQ(found.size(), 3U);
  const char* keys[] = {"x", "y", "phi"};
  for (std::size_t k = 0; k < inputs.size(); ++k)
    for (std::size_t r = 0; r < 3; ++r) {
      const double slope = (answers[2 * k + 2]["pose"][keys[r]].get<double>() -
                            answers[2 * k + 1]["pose"][keys[r]].get<double>()) /
                           (2 * step);
      EXPECT_NEAR(found[r][k].get<double>(), slope, 1e-5 * std::abs(slope) + 1e-6) << robot << r << k;
    }
}

TEST(ChainAnswers, HaveWhatIsWanted) {
  for (const char* theta_is : {"tangent", "chord"})
    expect_sensitivity("3-rfrr", {-1.6, 0.1475, 0.55, 0.147, 2.7, 0.1465}, {{"theta_is", theta_is}});
  expect_sensitivity("3-rfr", {0.188, 0.19, 0.189}, Json::object());
  expect_sensitivity("3-rfr", {0.188, 0.212, 0.189},
                     Json::object());  // the inner tendon of leg 2 is the other
  const auto answers = ask(
      "3-rfr", {{{"query", "statics"}, {"set_at", here}, {"want", {"stability", "margins", "sensitivity"}}},
                {{"query", "statics"}, {"set_at", here}, {"want", {"lines"}}},
                prb({{"query", "inverse"}, {"pose", here}, {"want", {"stiffness"}}})});
  EXPECT_EQ(answers[0]["unstable_directions"], 0);
  EXPECT_EQ(answers[0]["unstable"].size() + answers[0]["unstable_legs"].size(), 0U);
  EXPECT_GT(answers[0]["margins"]["strain"].get<double>(), 1e-3);
  EXPECT_EQ(answers[0]["sensitivity"][0].size(), 6U);  // two tensions a leg
  EXPECT_EQ(answers[1]["status"], "unsupported");
  EXPECT_TRUE(answers[2].contains("stiffness"));
  EXPECT_FALSE(answers[2].contains("margins"));
}

TEST(ChainAnswers, UnloadedAreAsManyAsArcsHaveModes) {
  struct Case {
    const char* robot;
    Json inputs;
  };
  for (const Case& one : {Case{"3-rfr", {0.188, 0.19, 0.189}}, Case{"3-frr", {0.198, 0.199, 0.198}},
                          Case{"3-rfrr", {-1.7, 0.147, 1.2, 0.148, 2.35, 0.149}},
                          Case{"6-ufs", {0.24, 0.24, 0.24, 0.24, 0.24, 0.24}}}) {
    const Json query{{"query", "forward"}, {"inputs", one.inputs}, {"all", true}};
    const auto answers = ask(one.robot, {query, prb(query)});
    EXPECT_EQ(answers[1]["count"], answers[0]["count"]) << one.robot;
    EXPECT_EQ(answers[1]["complete"], false);
    EXPECT_EQ(answers[1]["solutions"].size(), answers[1]["count"].get<std::size_t>());
  }
}

TEST(ChainAnswers, AllEquilibriaAreOfTheInputsAndTheLoad) {
  const Json inputs{0.19, 0.19, 0.19}, load{0, 3, 0};
  const Json all =
      ask("3-rfr", {prb({{"query", "forward"}, {"inputs", inputs}, {"wrench", load}, {"all", true}})})[0];
  ASSERT_GE(all["solutions"].size(), 3U) << all;
  int unstable = 0;
  double lowest = -1e300;
  for (const Json& one : all["solutions"]) {
    EXPECT_LT(one["residual"].get<double>(), 1e-12);
    EXPECT_EQ(one["stable"].get<bool>(), one["unstable_directions"] == 0);
    EXPECT_GE(one["potential"].get<double>(), lowest - 1e-12);
    lowest = one["potential"];
    unstable += one["unstable_directions"].get<int>();
    for (const Json& leg : one["legs"]) {
      EXPECT_NEAR(leg["tendon_lengths"][0].get<double>(), 0.19, 1e-12);
    }
    // the angles close the legs at the pose
    const Json velocity = ask(
        "3-rfr", {prb({{"query", "velocity"}, {"pose", one["pose"]}, {"angles", [&] {
                                                                        Json angles = Json::array();
                                                                        for (const Json& leg : one["legs"])
                                                                          angles.push_back(leg["angles"]);
                                                                        return angles;
                                                                      }()}})})[0];
    ASSERT_TRUE(velocity.contains("J")) << velocity;
    double balance[3] = {load[0], load[1],
                         load[2]};  // and the chords' forces, along rows of J, hold the load
    for (std::size_t i = 0; i < 3; ++i) {
      const Json& row = velocity["J"][i];
      const double length = std::hypot(row[0].get<double>(), row[1].get<double>());
      for (std::size_t k = 0; k < 3; ++k)
        balance[k] -= one["legs"][i]["chord_force"].get<double>() * row[k].get<double>() / length;
    }
    for (const double left : balance) EXPECT_NEAR(left, 0, 1e-9);
  }
  EXPECT_GE(unstable, 1);
}

TEST(ChainAnswers, AllInversesHoldThePose) {
  struct Case {
    const char* robot;
    Json more;
    std::size_t count;
  };
  for (const Case& one : {Case{"3-rfr", Json::object(), 8}, Case{"3-frr", Json::object(), 8},
                          Case{"3-rfrr", {{"curvature", {3, 4, 5}}}, 8}}) {
    Json query =
        prb({{"query", "inverse"}, {"pose", here}, {"wrench", {0.002, -0.001, 3e-5}}, {"all", true}});
    query.update(one.more);
    const Json all = ask(one.robot, {query})[0];
    ASSERT_EQ(all["count"], one.count) << all;
    std::vector<Json> back;
    for (const Json& solution : all["solutions"])
      back.push_back(prb({{"query", "forward"},
                          {"inputs", solution["inputs"]},
                          {"wrench", query["wrench"]},
                          {"start", here}}));
    for (const Json& answer : ask(one.robot, back)) {
      ASSERT_TRUE(answer.contains("pose")) << one.robot << answer;
      EXPECT_LT(apart(answer["pose"], here), 1e-8) << one.robot;
    }
  }
}

TEST(ChainAnswers, AllIsNotAskedOfAGrowingLoad) {
  const Json answer = ask("3-rfr", {prb({{"query", "forward"},
                                         {"inputs", {0.19, 0.19, 0.19}},
                                         {"all", true},
                                         {"until", {{"wrench", wrench}, {"limit", 2}}}})})[0];
  EXPECT_EQ(answer["error"]["code"], "ambiguous");
}

TEST(ChainAnswers, SenseTheLoadThatWasPutOn) {
  const Json loaded =
      ask("3-rfr", {{{"query", "statics"}, {"set_at", here}, {"hold", "length"}, {"wrench", wrench}}})[0];
  ASSERT_EQ(loaded["status"], "converged") << loaded;
  Json lengths = Json::array(), tensions = Json::array();
  for (const Json& leg : loaded["legs"]) {
    const std::size_t inner = leg["tensions"][0].get<double>() > 0 ? 0 : 1;
    lengths.push_back({nullptr, nullptr});
    lengths.back()[inner] = leg["tendon_lengths"][inner];
    tensions.push_back(leg["tensions"][inner]);
  }
  const Json query{
      {"query", "statics"}, {"lengths", lengths}, {"measured_tensions", tensions}, {"start", here}};
  Json with_deviation = query, few = query, with_load = query, without = query;
  with_deviation["deviation"] = "10 mN";
  few["measured_tensions"][1] = nullptr;
  with_load["wrench"] = wrench;
  without.erase("lengths");
  const auto answers = ask("3-rfr", {query, with_deviation, few, with_load, without});
  ASSERT_EQ(answers[0]["status"], "converged") << answers[0];
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(answers[0]["wrench"][k].get<double>(), wrench[k].get<double>(), 1e-10);
  EXPECT_LT(apart(answers[0]["pose"], loaded["pose"]), 1e-10);
  EXPECT_FALSE(answers[0].contains("covariance"));
  const Json &rows = answers[1]["wrench_sensitivity"], &covariance = answers[1]["covariance"];
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k) sum += 1e-4 * rows[r][k].get<double>() * rows[c][k].get<double>();
      EXPECT_NEAR(covariance[r][c].get<double>(), sum, 1e-12 * std::abs(sum) + 1e-18);
    }
  EXPECT_EQ(answers[2]["error"]["code"], "out_of_range") << answers[2];
  EXPECT_EQ(answers[3]["error"]["code"], "ambiguous") << answers[3];
  EXPECT_EQ(answers[4]["error"]["code"], "missing_key") << answers[4];
}

TEST(ChainAnswers, SenseTheLoadOnLegsWithMotors) {
  const Json inputs{-1.7, 0.147, 1.2, 0.148, 2.35, 0.149};
  const Json loaded = ask("3-rfrr", {prb({{"query", "forward"}, {"inputs", inputs}, {"wrench", wrench}})})[0];
  ASSERT_EQ(loaded["status"], "converged") << loaded;
  Json tensions = Json::array();
  for (const Json& leg : loaded["legs"]) tensions.push_back(leg["tensions"][0]);
  Json query{{"query", "statics"}, {"inputs", inputs}, {"measured_tensions", tensions}};
  Json both = query;
  both["lengths"] = {{0.147, nullptr}, {0.148, nullptr}, {0.149, nullptr}};
  const auto answers = ask("3-rfrr", {query, both});
  ASSERT_EQ(answers[0]["status"], "converged") << answers[0];
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(answers[0]["wrench"][k].get<double>(), wrench[k].get<double>(), 1e-9);
    EXPECT_NEAR(answers[0]["legs"][k]["motor_torque"].get<double>(),
                loaded["legs"][k]["motor_torque"].get<double>(), 1e-9);
  }
  EXPECT_EQ(answers[1]["error"]["code"], "ambiguous");
}

TEST(ChainAnswers, OfFourPlanarLegsFollowAPath) {
  const Json track = ask(four_legs, {prb({{"query", "track"},
                                          {"from", {{"x", 0}, {"y", 0}, {"phi", 0.1}}},
                                          {"to", here},
                                          {"samples", 5}})})[0];
  ASSERT_EQ(track["status"], "converged") << track;
  EXPECT_EQ(track["rows"].size(), 5U);
  EXPECT_LT(track["residual"].get<double>(), 1e-12);
}

TEST(ChainAnswers, FollowCurvesThroughFolds) {
  const Json moment{0, 0, 0.02};
  const auto answers =
      ask("3-rfr", {{{"query", "statics"}, {"set_at", here}, {"until", {{"wrench", moment}, {"limit", 1}}}},
                    prb({{"query", "track"}, {"set_at", here}, {"to", {{"wrench", moment}}}}),
                    prb({{"query", "track"},
                         {"lengths", {{0.19, nullptr}, {0.19, nullptr}, {0.19, nullptr}}},
                         {"wrench", wrench},
                         {"to", {{"lengths", {{0.188, nullptr}, {0.19, nullptr}, {0.187, nullptr}}}}}}),
                    {{"query", "statics"},
                     {"lengths", {{0.188, nullptr}, {0.19, nullptr}, {0.187, nullptr}}},
                     {"wrench", wrench}}});
  const Json& rows = answers[1]["curves"][0]["rows"];
  const auto fold =
      std::ranges::find_if(rows, [](const Json& row) { return row.value("event", "") == "fold"; });
  ASSERT_NE(fold, rows.end()) << answers[1];
  EXPECT_EQ(answers[0]["why"], "fold");
  EXPECT_NEAR((*fold)["parameter"].get<double>(), answers[0]["load"].get<double>(), 1e-8);
  EXPECT_EQ(answers[1]["status"], "singular");
  EXPECT_EQ(rows.back()["unstable_directions"], 1);
  ASSERT_EQ(answers[2]["status"], "converged") << answers[2];
  EXPECT_LT(apart(answers[2]["equilibria"][0]["pose"], answers[3]["pose"]), 1e-9);
  EXPECT_NEAR(answers[2]["equilibria"][0]["inputs"][0].get<double>(), 0.188, 1e-12);
}

TEST(ChainAnswers, RefuseCurvesThatAreNone) {
  const Json to{{"wrench", {0, 0, 0.01}}}, lengths{{0.19, nullptr}, {0.19, nullptr}, {0.19, nullptr}};
  const auto code = [&](Json query) {
    query["query"] = "track";
    return ask("3-rfr", {prb(std::move(query))})[0]["error"].value("code", "");
  };
  EXPECT_EQ(code({{"to", to}}), "missing_key");
  EXPECT_EQ(code({{"set_at", here}, {"lengths", lengths}, {"to", to}}), "ambiguous");
  EXPECT_EQ(code({{"lengths", lengths}, {"hold", "length"}, {"to", to}}), "no_effect");
  EXPECT_EQ(code({{"set_at", here}, {"start", here}, {"to", to}}), "no_effect");
  EXPECT_EQ(code({{"set_at", here}, {"poses", Json::array({here})}, {"to", to}}), "ambiguous");
  EXPECT_EQ(code({{"set_at", here}, {"to", {{"wrench", {0, 0, 0}}}}}), "no_effect");
  EXPECT_EQ(code({{"set_at", here}, {"to", {{"lengths", lengths}}}}), "no_effect");  // tensions are held
  EXPECT_EQ(code({{"set_at", here}, {"to", to}, {"backward", true}}), "no_effect");
  EXPECT_EQ(code({{"set_at", here}, {"to", {{"wrench", {0, 0, 0.01}}, {"load", 1}}}}), "unknown_key");
}

}  // namespace chain_answers_test
}  // namespace sinew::test
