/// Pictures of pseudo-rigid chains.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "sinew/math/se2.hpp"
#include "sinew/math/se3.hpp"
#include "sinew_query.hpp"

namespace sinew::test {
namespace chain_shape_test {

constexpr double pi = std::numbers::pi;

/// A point of the plane or of space, third coordinate 0 in the plane.
Vec3<double> point(const Json& json) {
  return {json[0].get<double>(), json[1].get<double>(), json.size() > 2 ? json[2].get<double>() : 0.0};
}

double length_of(const Json& line) {
  double sum = 0;
  for (std::size_t k = 1; k < line.size(); ++k) sum += (point(line[k]) - point(line[k - 1])).norm();
  return sum;
}

Vec3<double> on_platform(const Json& pose, const Json& body) {
  if (pose.contains("phi")) {
    const auto frame =
        SE2<double>::from(pose["x"].get<double>(), pose["y"].get<double>(), pose["phi"].get<double>());
    const Vec2<double> at = frame.point(point(body).head<2>());
    return {at.x(), at.y(), 0};
  }
  return SE3<double>::from(
             SpatialPose{point(pose["position"]), pose["quaternion"].get<std::array<double, 4>>()})
      .point(point(body));
}

Json prb(Json query) {
  query["model"] = "prb";
  return query;
}

const Json& description(const std::string& robot) {
  static std::map<std::string, Json> all;
  auto& one = all[robot];
  if (one.is_null()) one = ask(robot, {{{"query", "describe"}}})[0];
  return one;
}

/// What must hold of every picture: where polylines begin and end, and how long their parts are.
void expect_closed(const std::string& robot, const Json& shape, std::size_t joints = 6) {
  const Json& legs = description(robot)["legs"];
  const std::size_t links = joints - (description(robot)["space"] == "spatial" ? 1 : 0);
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const Json &leg = legs[i], &backbone = shape["backbones"][i], &pair = shape["tendons"][i];
    const double length = leg["link"]["length"].get<double>(), d = leg["link"]["tendon_offset"].get<double>();
    const double step = length / static_cast<double>(links);
    ASSERT_EQ(backbone.size(), links + 1);
    for (std::size_t k = 0; k < links; ++k)
      EXPECT_NEAR((point(backbone[k + 1]) - point(backbone[k])).norm(), step, 1e-15);
    EXPECT_EQ(shape["base"][i], leg["base"]["point"]);
    EXPECT_LT((point(backbone[0]) - point(leg["base"]["point"])).norm(), 1e-16);
    const Vec3<double> head = on_platform(shape["pose"], leg["platform_point"]), tip = point(backbone[links]);
    EXPECT_LT((point(shape["platform"][i]) - head).norm(), 1e-15);
    EXPECT_LT((point(shape["lines"][i][1]) - head).norm(), 1e-15);
    if (leg["closure"]["type"] == "chord") {
      EXPECT_LT((tip - head).norm(), 1e-12);
      EXPECT_EQ(shape["lines"][i][0], shape["base"][i]);
    } else {
      EXPECT_NEAR((tip - head).norm(), leg["closure"]["length"].get<double>(), 1e-12);
      EXPECT_EQ(shape["lines"][i][0], backbone[links]);
    }
    for (std::size_t t = 0; t < 2; ++t) ASSERT_EQ(pair[t].size(), links + 2);
    for (std::size_t k = 0; k < links + 2; ++k) {  // base, middles of links, tip
      const Vec3<double> centre = k == 0 ? point(backbone[0])
                                  : k == links + 1
                                      ? tip
                                      : Vec3<double>(0.5 * (point(backbone[k - 1]) + point(backbone[k])));
      EXPECT_LT((0.5 * (point(pair[0][k]) + point(pair[1][k])) - centre).norm(), 1e-15);
      EXPECT_NEAR((point(pair[0][k]) - point(pair[1][k])).norm(), 2 * d, 1e-15);
    }
  }
  EXPECT_EQ(shape["frames"], Json::array({shape["pose"]}));
}

/// Inputs around those of home; every third time one leg is straight.
std::vector<Json> random_inputs(const std::string& robot, int count) {
  const Json& legs = description(robot)["legs"];
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> part(0.94, 0.985);
  std::vector<Json> all;
  for (int k = 0; k < count; ++k) {
    Json inputs = Json::array();
    for (const Json& leg : legs) inputs.push_back(part(engine) * leg["link"]["length"].get<double>());
    if (k % 3 == 2) inputs[0] = legs[0]["link"]["length"];
    all.push_back(inputs);
  }
  return all;
}

Json random_wrench(std::size_t size, std::mt19937& engine) {
  std::uniform_real_distribution<double> newton(-0.1, 0.1);
  Json wrench = Json::array();
  for (std::size_t k = 0; k < size; ++k) wrench.push_back(newton(engine) * (2 * k < size ? 1 : 0.01));
  return wrench;
}

TEST(ChainShape, IsThatOfForward) {
  std::mt19937 engine(5);
  for (const std::string robot : {"3-rfr", "3-frr", "6-ufs"}) {
    std::vector<Json> queries;
    const auto all = random_inputs(robot, 20);
    for (std::size_t k = 0; k < all.size(); ++k) {
      Json query{{"query", "forward"}, {"inputs", all[k]}};
      if (k % 2 == 1) query["wrench"] = random_wrench(robot == "6-ufs" ? 6 : 3, engine);
      queries.push_back(prb(query));
      query["query"] = "shape";
      queries.push_back(prb(query));
    }
    const auto answers = ask(robot, queries);
    int pictures = 0;
    for (std::size_t k = 0; k < answers.size(); k += 2) {
      const Json &forward = answers[k], &shape = answers[k + 1];
      EXPECT_EQ(shape["status"], forward["status"]) << shape;
      EXPECT_EQ(shape.value("message", ""), forward.value("message", ""));
      EXPECT_EQ(shape.contains("pose"), forward.contains("pose"));
      EXPECT_EQ(shape.contains("backbones"), forward.contains("pose"));
      if (!forward.contains("pose")) continue;
      EXPECT_EQ(shape["pose"], forward["pose"]);
      expect_closed(robot, shape);
      ++pictures;
    }
    EXPECT_GE(pictures, 10) << robot;
  }
}

TEST(ChainShape, StraightLegsAreStraight) {  // clamped: a regular point
  const Json shape = ask("3-frr", {prb({{"query", "shape"}, {"inputs", {0.2, 0.19, 0.195}}})})[0];
  ASSERT_EQ(shape["status"], "converged") << shape;
  expect_closed("3-frr", shape);
  for (std::size_t t = 0; t < 2; ++t) EXPECT_NEAR(length_of(shape["tendons"][0][t]), 0.2, 1e-13);
  EXPECT_NEAR((point(shape["backbones"][0][6]) - point(shape["backbones"][0][0])).norm(), 0.2, 1e-15);
  const double direction = description("3-frr")["legs"][0]["base"]["direction"].get<double>();
  const Vec3<double> along = (point(shape["backbones"][0][6]) - point(shape["backbones"][0][0])) / 0.2;
  EXPECT_LT((along - Vec3<double>(std::cos(direction), std::sin(direction), 0)).norm(), 1e-12);
}

/// Poses of all robots with chains, and branches.
struct Posed {
  std::string robot;
  Json pose;
  Json wrench;
};
const std::vector<Posed>& poses() {
  static const Json plane = {{"x", 0.01}, {"y", -0.005}, {"phi", 0.2}};
  static const std::vector<Posed> all = {
      {"3-rfr", plane, {0.03, -0.02, 0.0005}},
      {"3-frr", {{"x", 0.005}, {"y", 0.01}, {"phi", 0.1}}, {0.03, -0.02, 0.0005}},
      {"3-rfrr", plane, {0.03, -0.02, 0.0005}},
      {"6-ufs",
       {{"position", {0.01, -0.005, 0.19}}, {"tilt", 0.1}, {"torsion", 0.2}},
       {0.03, -0.02, 0.05, 0.001, 0, 0.001}}};
  return all;
}

TEST(ChainShape, IsThatOfInverseAndOfStatics) {
  for (const auto& [robot, pose, wrench] : poses()) {
    Json shape{{"query", "shape"}, {"pose", pose}},
        statics{{"query", "statics"}, {"inverse", true}, {"pose", pose}},
        inverse{{"query", "inverse"}, {"pose", pose}};
    statics["hold"] = "length";
    std::vector<Json> queries;
    for (const bool is_loaded : {false, true}) {
      for (Json* one : {&shape, &statics, &inverse}) {
        if (is_loaded) (*one)["wrench"] = wrench;
        queries.push_back(prb(*one));
      }
    }
    const auto answers = ask(robot, queries);
    for (std::size_t k = 0; k < answers.size(); k += 3) {
      ASSERT_TRUE(answers[k].contains("backbones")) << robot << answers[k];
      expect_closed(robot, answers[k]);
      EXPECT_EQ(answers[k]["pose"], answers[k + 1]["pose"]);
      EXPECT_EQ(answers[k]["status"], answers[k + 1]["status"]);
      if (robot != "3-rfrr") {
        EXPECT_EQ(answers[k]["status"], answers[k + 2]["status"]);
      }
    }
  }
}

TEST(ChainShape, TendonsBetweenDiscsAreAsLongAsTheyAre) {  // M1
  for (const auto& [robot, pose, wrench] : poses()) {
    const Json statics{
        {"query", "statics"}, {"inverse", true}, {"pose", pose}, {"law", "M1"}, {"wrench", wrench}};
    const Json shape{{"query", "shape"}, {"pose", pose}, {"law", "M1"}, {"wrench", wrench}};
    const auto answers = ask(robot, {statics, prb(shape)});
    ASSERT_TRUE(answers[1].contains("tendons")) << robot << answers[1];
    expect_closed(robot, answers[1]);
    for (std::size_t i = 0; i < answers[1]["tendons"].size(); ++i)
      for (std::size_t t = 0; t < 2; ++t)
        EXPECT_NEAR(length_of(answers[1]["tendons"][i][t]),
                    answers[0]["legs"][i]["tendon_lengths"][t].get<double>(), 1e-14);
  }
}

TEST(ChainShape, WithMoreLinksItIsTheArc) {  // of second order: backbone, tendons, tendon lengths
  for (const auto& [named, asked, wrench] : poses()) {
    const auto& robot = named;  // clang 14 captures no structured binding
    const auto& pose = asked;
    const int more = robot == "6-ufs" ? 1 : 0;
    const auto errors = [&](int links) {
      Json query{{"query", "shape"}, {"pose", pose}};
      if (robot == "3-rfrr") query["curvature"] = {4, -3, 5};  // its links may be straight
      Json chain = prb(query), arc = query, velocity = query;
      velocity["query"] = "velocity";
      chain["set"] = {{"defaults.link.joints", links + more}};
      arc["samples"] = 2 * links + 1;  // joints and middles of links
      const auto answers = ask(robot, {chain, arc, velocity});
      expect_closed(robot, answers[0], static_cast<std::size_t>(links + more));
      std::array<double, 3> worst{};
      const auto n = static_cast<std::size_t>(links);
      for (std::size_t i = 0; i < answers[0]["backbones"].size(); ++i) {
        const Json &chain_leg = answers[0]["backbones"][i], &arc_leg = answers[1]["backbones"][i];
        for (std::size_t k = 0; k <= n; ++k)
          worst[0] = std::max(worst[0], (point(chain_leg[k]) - point(arc_leg[2 * k])).norm());
        for (std::size_t t = 0; t < 2; ++t) {
          const Json &tendon = answers[0]["tendons"][i][t], &round = answers[1]["tendons"][i][t];
          for (std::size_t k = 0; k < n + 2; ++k) {
            const Json& there = round[k == 0 ? 0 : k == n + 1 ? 2 * n : 2 * k - 1];
            worst[1] = std::max(worst[1], (point(tendon[k]) - point(there)).norm());
          }
          const double length = answers[2]["legs"][i]["tendon_lengths"][t].get<double>();
          worst[2] = std::max(worst[2], std::abs(length_of(tendon) - length));
        }
      }
      return worst;
    };
    const auto coarse = errors(8), middle = errors(16), fine = errors(31);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(std::log2(coarse[k] / middle[k]), 2, 0.1) << robot << k;
      EXPECT_NEAR(std::log(middle[k] / fine[k]) / std::log(31.0 / 16), 2, 0.1) << robot << k;
      EXPECT_LT(fine[k], 2e-4);
    }
  }
}

TEST(ChainShape, GivenAnglesAreDrawnAsTheyAre) {  // those of a path are no equilibria
  const Json from = {{"x", 0}, {"y", 0}, {"phi", 0.1}}, to = {{"x", 0.01}, {"y", 0.005}, {"phi", 0.2}};
  for (const std::string robot : {"3-rfr", "3-frr", "3-rfrr"}) {
    const Json track = ask(robot, {prb({{"query", "track"}, {"from", from}, {"to", to}, {"samples", 4}})})[0];
    ASSERT_EQ(track["status"], "converged") << track;
    for (const Json& row : track["rows"]) {
      const Json shape =
          ask(robot, {prb({{"query", "shape"}, {"pose", row["pose"]}, {"angles", row["angles"]}})})[0];
      ASSERT_EQ(shape["status"], "converged") << shape;
      expect_closed(robot, shape);
    }
  }
  const Json inputs = {0.19, 0.195, 0.188};
  const Json forward = ask("3-rfr", {prb({{"query", "forward"}, {"inputs", inputs}})})[0];
  Json angles = Json::array();
  for (const Json& leg : forward["legs"]) angles.push_back(leg["angles"]);
  const auto answers =
      ask("3-rfr", {prb({{"query", "shape"}, {"inputs", inputs}}),
                    prb({{"query", "shape"}, {"pose", forward["pose"]}, {"angles", angles}})});
  EXPECT_EQ(answers[0].dump(), answers[1].dump());
}

TEST(ChainShape, WhatDoesNotHoldIsDrawnAndWhatIsNotThereIsNot) {
  const Json far = {{"x", 0.5}, {"y", 0}, {"phi", 0}}, home = {{"x", 0}, {"y", 0}, {"phi", 0}},
             turned = {{"x", 0.047}, {"y", -0.0118}, {"phi", 1.145}};
  const auto answers =
      ask("3-rfr",
          {prb({{"query", "shape"}, {"pose", far}}), prb({{"query", "shape"}, {"inputs", {0.3, 0.19, 0.19}}}),
           prb({{"query", "shape"}, {"inputs", {0.2, 0.2, 0.2}}}),
           prb({{"query", "shape"}, {"pose", home}, {"wrench", {0, 1.6, 0}}}),
           prb({{"query", "shape"}, {"pose", turned}, {"wrench", {-0.133, -0.069, -0.003}}})});
  EXPECT_EQ(answers[0]["status"], "unreachable");
  EXPECT_EQ(answers[1]["status"], "left_domain");
  EXPECT_EQ(answers[2]["status"], "stalled");
  for (std::size_t k = 0; k < 3; ++k)
    for (const char* key : {"pose", "backbones", "frames"})
      EXPECT_FALSE(answers[k].contains(key)) << answers[k];
  EXPECT_EQ(answers[3]["status"], "slack") << answers[3];
  EXPECT_EQ(answers[4]["status"], "unstable") << answers[4];
  expect_closed("3-rfr", answers[3]);
  expect_closed("3-rfr", answers[4]);
}

TEST(ChainShape, WalksFromTheLastPose) {
  std::vector<Json> queries;
  for (int k = 0; k < 4; ++k)
    queries.push_back(prb({{"query", k % 2 == 0 ? "forward" : "shape"},
                           {"inputs", {0.19 + 0.001 * k, 0.195, 0.188}},
                           {"start", "last"}}));
  const auto walked = ask("3-rfr", queries);
  for (std::size_t k = 1; k < queries.size(); ++k) {
    queries[k]["start"] = walked[k - 1]["pose"];
    EXPECT_EQ(ask("3-rfr", {queries[k]})[0].dump(), walked[k].dump());
  }
}

TEST(ChainShape, SaysOneThingOnce) {
  const auto code = [](const std::string& robot, Json fields) {
    fields["query"] = "shape";
    return ask(robot, {prb(fields)})[0]["error"]["code"];
  };
  const Json pose = {{"x", 0.01}, {"y", 0}, {"phi", 0.1}}, inputs = {0.19, 0.19, 0.188};
  const Json straight = Json::array({{0, 0, 0, 0, 0}, {0, 0, 0, 0, 0}, {0, 0, 0, 0, 0}});
  EXPECT_EQ(code("3-rfr", Json::object()), "missing_key");
  EXPECT_EQ(code("3-rfr", {{"pose", pose}, {"inputs", inputs}}), "ambiguous");
  EXPECT_EQ(code("3-rfr", {{"pose", pose}, {"start", pose}}), "ambiguous");
  EXPECT_EQ(code("3-rfr", {{"inputs", inputs}, {"bending", {1, 1, 1}}}), "ambiguous");
  EXPECT_EQ(code("3-rfr", {{"pose", pose}, {"bending", {1, 1, 1}}, {"angles", straight}}), "ambiguous");
  EXPECT_EQ(code("3-rfr", {{"inputs", inputs}, {"angles", straight}}), "missing_key");
  EXPECT_EQ(code("3-rfr", {{"pose", pose}, {"angles", straight}, {"wrench", {0, 0, 0}}}), "no_effect");
  EXPECT_EQ(code("3-rfr", {{"pose", pose}, {"angles", straight}}), "not_closed");
  EXPECT_EQ(code("3-rfr", {{"pose", pose}, {"samples", 5}}), "no_effect");
}

}  // namespace chain_shape_test
}  // namespace sinew::test
