/// Robots whose rods bear torque, from the text of a file to answers in JSON.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/document/parse.hpp"
#include "sinew/session.hpp"

namespace sinew::test {
namespace torque_query_test {

using Json = nlohmann::ordered_json;

/// The hexapod of robots/hexapod.yaml with links, guides and clamps of one kind.
std::string hexapod(const std::string& link, const std::string& base = "", const std::string& closure = "") {
  std::string text =
      "sinew: 1\nname: mine\nspace: spatial\n"
      "platform: {home: {position: [0 mm, 0 mm, 400 mm], quaternion: [1, 0, 0, 0]}, radius: 87 mm}\n"
      "defaults: {base: {" +
      base + "}, link: {type: rod, " + link + "}, closure: {type: clamp" + closure + "}}\nlegs:\n";
  const int bases[] = {-10, 10, 110, 130, 230, 250}, tips[] = {-50, 50, 70, 170, 190, 290};
  for (std::size_t k = 0; k < 6; ++k)
    text += "  - {base: {point: {radius: 87 mm, angle: " + std::to_string(bases[k]) +
            " deg}}, platform_point: {radius: 87 mm, angle: " + std::to_string(tips[k]) + " deg}}\n";
  return text;
}
const std::string round = "diameter: 1.3 mm, law: cosserat, material: {E: 207 GPa, poisson: 0.305}";
const std::string steel = "material: {E: 207 GPa, G: 79 GPa}";

Expected<Session> open(const std::string& text) {
  return Session::open(parse_yaml(text, "mine.yaml").value());
}

Json ask(Session& session, const Json& query) { return Json::parse(session.answer(query.dump())); }

Json pose(double x, double y, double z, double turn) {
  return {{"position", {x, y, z}}, {"quaternion", {std::cos(turn / 2), 0, 0, std::sin(turn / 2)}}};
}

TEST(TorqueQuery, HeldHexapodsHoldPosesAndAreLedToThem) {
  const char* bent = "diameter: 1.3 mm, precurvature: [0.5, 0.2 1/m, 1], load: [0, 0, -20 mN/m], ";
  for (const std::string& text :
       {hexapod(round, "spin: held"),
        hexapod("section: {width: 1.5 mm, height: 1.2 mm}, " + steel, "spin: held"),
        hexapod("section: {width: 1.5 mm, height: 1.2 mm}, " + steel), hexapod(bent + steel)}) {
    auto session = open(text);
    ASSERT_TRUE(session) << to_string(session.error());
    const Json wrench = {0.1, -0.2, 0.3, 0.01, 0.0, -0.02};
    const Json wanted = pose(0.01, -0.02, 0.41, 0.15);
    const Json held = ask(*session, {{"query", "inverse"}, {"pose", wanted}, {"wrench", wrench}});
    ASSERT_EQ(held["status"], "converged") << held << text;
    const Json back = ask(*session, {{"query", "forward"}, {"inputs", held["inputs"]}, {"wrench", wrench}});
    ASSERT_EQ(back["status"], "converged") << back;
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(back["pose"]["position"][k].get<double>(), wanted["position"][k].get<double>(), 1e-9);
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(back["pose"]["quaternion"][k].get<double>(), wanted["quaternion"][k].get<double>(), 1e-9);
    double sum[3] = {};  // what the rods bear is the wrench
    for (const Json& leg : held["legs"])
      for (std::size_t k = 0; k < 3; ++k) sum[k] += leg["force"][k].get<double>();
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(sum[k], wrench[k].get<double>(), 1e-9);
    const Json shape = ask(*session, {{"query", "shape"}, {"inputs", held["inputs"]}, {"samples", 20}});
    EXPECT_FALSE(shape.contains("error")) << shape;
  }
}

TEST(TorqueQuery, HeldSpinBearsTorque) {
  auto spinning = open(hexapod(round)), held = open(hexapod(round, "spin: held"));
  ASSERT_TRUE(spinning && held);
  const Json query = {{"query", "inverse"}, {"pose", pose(0, 0, 0.4, 0.3)}};
  const Json free = ask(*spinning, query), stiff = ask(*held, query);
  ASSERT_EQ(free["status"], "converged");
  ASSERT_EQ(stiff["status"], "converged") << stiff;
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_LT(std::abs(free["legs"][k]["moment_0"][2].get<double>()), 1e-12);  // guides are upright
    EXPECT_GT(std::abs(stiff["legs"][k]["moment_0"][2].get<double>()), 1e-3);
  }
}

TEST(TorqueQuery, TheFileIsDescribedAsItIs) {
  auto session = open(
      hexapod("section: {width: 4 mm, height: 1 mm}, precurvature: [1, 0, 0], load: [0, 0, 1 N/m], " + steel,
              "spin: held, section_x: [1, 0, 1]", ", spin: free, section_x: [0, 1, 5]"));
  ASSERT_TRUE(session) << to_string(session.error());
  const Json leg = ask(*session, {{"query", "describe"}})["legs"][0];
  EXPECT_EQ(leg["link"]["section"], Json({{"width", 4e-3}, {"height", 1e-3}}));
  EXPECT_FALSE(leg["link"].contains("diameter"));
  EXPECT_EQ(leg["link"]["precurvature"], Json({1, 0, 0}));
  EXPECT_EQ(leg["link"]["load"], Json({0, 0, 1}));
  EXPECT_EQ(leg["base"]["spin"], "held");
  EXPECT_EQ(leg["closure"]["spin"], "free");
  for (std::size_t k = 0; k < 3; ++k) {  // square to the guide, to the clamp
    EXPECT_NEAR(leg["base"]["section_x"][k].get<double>(), k == 0, 1e-15);
    EXPECT_NEAR(leg["closure"]["section_x"][k].get<double>(), k == 1, 1e-15);
  }
  auto plain = open(hexapod(round));
  const Json other = ask(*plain, {{"query", "describe"}})["legs"][0];
  for (const char* key : {"spin", "section_x"}) {
    EXPECT_FALSE(other["base"].contains(key));
    EXPECT_FALSE(other["closure"].contains(key));
  }
}

TEST(TorqueQuery, SlipsAreTold) {
  const std::pair<std::string, const char*> slips[] = {
      {hexapod("section: {width: 4 mm, height: 1 mm}, diameter: 1 mm, " + steel), "keep one"},
      {hexapod("section: {width: 4 mm}, " + steel), "height"},
      {hexapod("section: {width: 4 mm, height: 0 mm}, " + steel), "height"},
      {hexapod("section: {width: 4 mm, height: 1 mm}, material: {E: 207 GPa}"), "bears torque"},
      {hexapod("diameter: 1 mm, precurvature: [0, 1, 0], material: {E: 207 GPa}"), "bears torque"},
      {hexapod("diameter: 1 mm, material: {E: 207 GPa}", "spin: held"), "bears torque"},
      {hexapod("diameter: 1 mm, load: [0, 0, 1 N], " + steel), "load by length"},
      {hexapod(round, "spin: loose"), "spin"},
      {hexapod(round, "section_x: [0, 0, 1]"), "lies along the rod"},
      {hexapod(round, "", ", section_x: [0, 0, 1]"), "lies along the rod"}};
  for (const auto& [text, what] : slips) {
    const auto session = open(text);
    ASSERT_FALSE(session) << text;
    EXPECT_NE(to_string(session.error()).find(what), std::string::npos) << to_string(session.error());
  }
  EXPECT_TRUE(open(hexapod("diameter: 1 mm, material: {E: 207 GPa}", "spin: held", ", spin: free")));
}

}  // namespace torque_query_test
}  // namespace sinew::test
