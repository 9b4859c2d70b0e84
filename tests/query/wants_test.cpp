/// One question with many wants says what as many questions say.
#include <gtest/gtest.h>

#include "query/fields/fields.hpp"
#include "sinew_query.hpp"

namespace sinew::test {
namespace wants_test {

struct Case {
  const char* robot;
  Json question;  ///< forward or inverse
  Json extra;     ///< fields of its wants
};

Json with_wants(Json question, const Json& wants, const Json& extra = {}) {
  question["want"] = wants;
  if (extra.is_object()) question.update(extra);
  return question;
}

/// The configuration that an answer found, as `velocity` and `shape` are asked of it.
Json there(const Case& one, const Json& answer) {
  Json query = Json::object();
  if (answer.contains("configuration"))
    query["configuration"] = answer["configuration"];
  else
    query["inputs"] = answer.contains("inputs") ? answer["inputs"] : one.question["inputs"];
  for (const char* key : {"wrench", "set"})
    if (one.question.contains(key)) query[key] = one.question[key];
  if (answer.contains("pose") && !answer.contains("configuration")) query["start"] = answer["pose"];
  return query;
}

/// Numbers may differ in their last digits: the searches begin elsewhere.
void expect_near(const Json& found, const Json& expected, const std::string& place) {
  ASSERT_EQ(found.is_number(), expected.is_number()) << place;
  if (expected.is_number()) {
    EXPECT_NEAR(found.get<double>(), expected.get<double>(),
                1e-7 * std::max(1.0, std::abs(expected.get<double>())))
        << place;
  } else if (expected.is_structured()) {
    ASSERT_EQ(found.size(), expected.size()) << place;
    for (const auto& [key, value] : expected.items()) {
      const bool is_list = expected.is_array();
      ASSERT_TRUE(is_list || found.contains(key)) << place << '.' << key;
      expect_near(is_list ? found[static_cast<std::size_t>(std::stoi(key))] : found[key], value,
                  place + '.' + key);
    }
  } else {
    EXPECT_EQ(found, expected) << place;
  }
}

void expect_fields(const Json& found, const Json& expected, std::initializer_list<const char*> fields) {
  for (const char* field : fields) {
    ASSERT_EQ(found.contains(field), expected.contains(field)) << field << ' ' << found.dump();
    if (expected.contains(field)) expect_near(found[field], expected[field], field);
  }
}

const std::initializer_list<const char*> of_velocity{"J",      "K",      "U",     "determinant", "indices",
                                                     "type_1", "type_2", "rates", "twist",       "steering"};
const std::initializer_list<const char*> of_shape{"backbones", "tendons", "platform",
                                                  "discs",     "lines",   "frames"};

class WantsOf : public testing::TestWithParam<Case> {};

TEST_P(WantsOf, AreWhatTheirQuestionsSay) {
  const Case& one = GetParam();
  const Json found = ask(one.robot, {with_wants(one.question, {"velocity", "shape"}, one.extra)})[0];
  Json velocity = there(one, found), shape = there(one, found);
  velocity["query"] = "velocity";
  velocity.update(one.extra);
  shape["query"] = "shape";
  const auto apart = ask(one.robot, {one.question, velocity, shape});
  ASSERT_EQ(apart[0]["status"], "converged") << apart[0];
  ASSERT_TRUE(found["status"] == apart[1]["status"]) << found << apart[1];
  expect_fields(found, apart[1], of_velocity);
  expect_fields(found, apart[2], of_shape);
  for (const auto& [key, value] : apart[0].items())
    if (key != "status" && key != "residual") expect_near(found[key], value, key);
}

TEST_P(WantsOf, ArePlacesAloneIfTheyAreNamed) {
  const Case& one = GetParam();
  const auto found =
      ask(one.robot, {with_wants(one.question, {"pose"}), with_wants(one.question, {"pose", "velocity"})});
  for (const Json& answer : found) {
    EXPECT_TRUE(answer.contains("pose") || answer.contains("tip"));
    EXPECT_FALSE(answer.contains("legs"));
  }
  EXPECT_FALSE(found[0].contains("J"));
  EXPECT_TRUE(found[1].contains("J"));
}

INSTANTIATE_TEST_SUITE_P(
    Robots, WantsOf,
    testing::Values(
        Case{"3-rfr", {{"query", "forward"}, {"inputs", {0.19, 0.19, 0.188}}}, {{"twist", {0.01, 0, 0.1}}}},
        Case{"3-rfrr",
             {{"query", "forward"}, {"inputs", {-1.7, 0.15, 1.2, 0.15, 2.3, 0.15}}},
             {{"twist", {0.01, 0, 0.1}}}},
        Case{"6-ufs",
             {{"query", "forward"}, {"inputs", {0.25, 0.25, 0.25, 0.25, 0.251, 0.249}}},
             {{"twist", {0.01, 0, 0, 0, 0, 0.1}}}},
        Case{"3prs", {{"query", "forward"}, {"inputs", {0.15, 0.16, 0.17}}}, Json::object()},
        Case{"3-rfr",
             {{"query", "inverse"}, {"pose", {{"x", 0.01}, {"y", -0.005}, {"phi", 0.17}}}},
             {{"twist", {0.01, 0, 0.1}}}},
        Case{"3pfs-g2",
             {{"query", "forward"}, {"inputs", {0.44, 0.42, 0.41}}, {"wrench", {1, 2, -3, 0.1, 0, 0}}},
             {{"rates", {0.01, 0, 0.02}}}},
        Case{"hexapod",
             {{"query", "inverse"}, {"pose", {{"position", {0.01, 0, 0.4}}}}},
             {{"twist", {0, 0, 0.01, 0, 0, 0.1}}}},
        Case{"nottingham-tpcj",
             {{"query", "forward"}, {"configuration", {{0.1, 0.05}, {-0.1, 0.2}}}},
             {{"twist", {0.001, 0, 0, 0, 0, 0}}}},
        Case{"nottingham-neutral",
             {{"query", "inverse"}, {"position", {0.01, 0.005, 0.165}}},
             Json::object()}));

TEST(WantsOfChains, AreOfTheLoadedEquilibrium) {
  const Json question = {
      {"query", "forward"}, {"model", "prb"}, {"inputs", {0.19, 0.19, 0.188}}, {"wrench", {0, 0.05, 0}}};
  const auto found = ask(
      "3-rfr",
      {with_wants(question, {"velocity", "shape"}),
       question,
       {{"query", "shape"}, {"model", "prb"}, {"inputs", {0.19, 0.19, 0.188}}, {"wrench", {0, 0.05, 0}}}});
  for (const auto& [key, value] : found[1].items()) expect_near(found[0][key], value, key);
  expect_fields(found[0], found[2], of_shape);
  Json angles = Json::array();
  for (const Json& leg : found[1]["legs"]) angles.push_back(leg["angles"]);
  const Json velocity =
      ask("3-rfr",
          {{{"query", "velocity"}, {"model", "prb"}, {"pose", found[1]["pose"]}, {"angles", angles}}})[0];
  expect_fields(found[0], velocity, of_velocity);
  const Json statics = {
      {"query", "statics"}, {"set_at", {{"x", 0.01}, {"y", 0}, {"phi", 0.2}}}, {"wrench", {0, 0.05, 0}}};
  const auto held = ask("3-rfr", {with_wants(statics, {"pose", "velocity", "stiffness"}), statics});
  EXPECT_FALSE(held[0].contains("legs"));
  expect_near(held[0]["pose"], held[1]["pose"], "pose");
  expect_near(held[0]["stiffness"], held[1]["stiffness"], "stiffness");
  EXPECT_TRUE(held[0].contains("J")) << held[0];
}

TEST(WantsOfSensing, AreOfTheEquilibriumThatWasSensed) {
  const Json inputs = {0.41, 0.41, 0.405, 0.405, 0.405, 0.405};
  const Json loaded =
      ask("hexapod", {{{"query", "forward"}, {"inputs", inputs}, {"wrench", {0.2, 0, -0.5, 0, 0, 0}}}})[0];
  Json axial = Json::array();
  for (const Json& leg : loaded["legs"]) axial.push_back(leg["force_0"][2]);
  const Json sensed = ask("hexapod", {{{"query", "statics"},
                                       {"inputs", inputs},
                                       {"axial_forces", axial},
                                       {"want", {"pose", "shape", "stiffness"}}}})[0];
  ASSERT_TRUE(sensed.contains("wrench")) << sensed;
  EXPECT_TRUE(sensed.contains("backbones"));
  EXPECT_TRUE(sensed.contains("stiffness"));
}

TEST(Wants, OfOtherModelsAreRefused) {
  const Json planar = {{"query", "forward"}, {"inputs", {0.19, 0.19, 0.188}}};
  const auto found = ask("3-rfr", {with_wants(planar, {"stiffness"}), with_wants(planar, {"modes"}),
                                   with_wants(planar, {"nothing"}), with_wants(planar, "shape"),
                                   with_wants(planar, {"pose"}, {{"samples", 9}}),
                                   with_wants(planar, {"sensitivity", "lines"})});
  EXPECT_NE(found[0].dump().find("shape, sensitivity, lines"), std::string::npos) << found[0];
  for (const std::size_t k : {2U, 3U, 4U}) EXPECT_TRUE(found[k].contains("error")) << found[k];
  EXPECT_EQ(found[5]["status"], "converged");
  EXPECT_EQ(found[5]["sensitivity"].size(), 3U);
  EXPECT_EQ(found[5]["lines"].size(), 3U);
}

/// No word of the table is an empty promise.
TEST(Wants, AreEachAnsweredBySomeRobot) {
  const Json planar = {{"query", "forward"}, {"inputs", {0.19, 0.19, 0.188}}},
             tripod = {{"query", "forward"}, {"inputs", {0.44, 0.42, 0.41}}};
  for (const std::string_view word : find_field("want")->words) {
    const auto is_answered = [&](const char* robot, const Json& question) {
      return ask(robot, {with_wants(question, {word})})[0].value("status", "") == "converged";
    };
    EXPECT_TRUE(is_answered("3-rfr", planar) || is_answered("3pfs-g2", tripod)) << word;
  }
  const Json modes = ask("3-rfr", {with_wants(planar, {"modes"})})[0];
  EXPECT_EQ(modes["status"], "unsupported");
  EXPECT_NE(modes.dump().find("all: true"), std::string::npos) << modes;
}

TEST(Wants, OfVelocityTellThatAPoseIsSingular) {
  const Json singular = {
      {"query", "inverse"}, {"pose", {{"x", 0.04}, {"y", 0}, {"phi", "60 deg"}}}, {"want", {"velocity"}}};
  const Json found = ask("3-rfr", {singular})[0];
  EXPECT_EQ(found["status"], "singular");
  EXPECT_TRUE(found.contains("inputs"));
  EXPECT_TRUE(found.contains("J"));
}

}  // namespace wants_test
}  // namespace sinew::test
