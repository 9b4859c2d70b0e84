/// A platform in the plane on legs of two sections, through the real `sinew query`.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>

#include "sinew/io/robot_file.hpp"
#include "sinew_query.hpp"

namespace sinew::test {
namespace planar_arm_legs_query_test {

const std::string robot = "3-rfr-two-section";
const Json some_tensions = {{4, 0}, {0, 0.5}, {4, 0}, {0, 0}, {4, 0}, {0, 0}};

/// A file of the test, away when it ends.
class OwnFile {
 public:
  explicit OwnFile(const std::string& text)
      : path_(std::filesystem::temp_directory_path() /
              ("sinew-planar-" + std::to_string(::getpid()) + ".yaml")) {
    std::ofstream(path_) << text;
  }
  OwnFile(const OwnFile&) = delete;
  OwnFile& operator=(const OwnFile&) = delete;
  ~OwnFile() { std::filesystem::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};
std::string with(const std::string& what, const std::string& instead) {
  std::string all = read_robot_text(robot).value();
  for (std::size_t at = all.find(what); at != std::string::npos; at = all.find(what, at + instead.size()))
    all.replace(at, what.size(), instead);
  return all;
}

TEST(PlanarArmLegsQuery, OfConstantCurvatureItIsTheKinematicRobot) {
  // in channels, where a tendon's length is that of an arc beside the backbone
  const OwnFile channels(with("discs: {count: 5}", "guides: channel"));
  for (const std::array<double, 3>& pull :
       {std::array{5e-4, 6e-4, 7e-4}, {5e-3, 6e-3, 7e-3}, {9e-3, 4e-3, 7e-3}}) {
    Json changes = Json::array(), tensions = Json::array(), inputs = Json::array();
    for (const double one : pull) {
      changes.push_back({-one / 2, nullptr});
      changes.push_back({-one, nullptr});
      for (int section = 0; section < 2; ++section) tensions.push_back({nullptr, 0});
      inputs.push_back(0.2 - one);
    }
    const Json found = ask(channels.path(), {{{"query", "forward"},
                                              {"model", "cc"},
                                              {"changes", changes},
                                              {"tensions", tensions}}})[0],
               known = ask("3-rfr", {{{"query", "forward"}, {"inputs", inputs}, {"all", true}}})[0];
    ASSERT_EQ(found["status"], "converged") << found.dump();
    double nearest = 1;
    for (const Json& one : known["solutions"]) {
      double off = 0;
      for (const char* key : {"x", "y", "phi"})
        off = std::max(off, std::abs(one["pose"][key].get<double>() - found["pose"][key].get<double>()));
      nearest = std::min(nearest, off);
    }
    EXPECT_LT(nearest, 1e-9) << found["pose"].dump() << known["solutions"].dump();
  }
}

Json same_of_all(const Json& pair) { return {pair, pair, pair, pair, pair, pair}; }

/// Legs of these models do not stretch and tendons neither: two of a section hold one bend twice.
TEST(PlanarArmLegsQuery, TendonsThatHoldEachOtherHaveTheLeastTensions) {
  for (const char* model : {"cc", "subsegment_cc", "prb"}) {
    const Json rest = {{"query", "forward"}, {"model", model}, {"changes", same_of_all({0, 0})}};
    const Json pulled = {{"query", "forward"}, {"model", model}, {"tensions", same_of_all({1, 1})}};
    const auto answers = ask(robot, {rest, pulled});
    for (const Json& found : answers) {
      ASSERT_EQ(found["status"], "converged") << model << found.dump();
      EXPECT_LT(std::abs(found["pose"]["x"].get<double>()), 1e-9) << model;
    }
    for (const Json& pair : answers[0]["tensions"])
      for (const Json& tension : pair) EXPECT_LT(tension.get<double>(), 1e-9) << model;
  }
}

TEST(PlanarArmLegsQuery, ChangesOfTensionsLeadBackToTheirPose) {
  const Json tensions = {{1.27, 1.93}, {0.72, 1.92}, {0.97, 1.13}, {1.74, 1.11}, {1.32, 0.54}, {1.63, 1.31}};
  for (const char* model : {"cc", "subsegment_cc", "prb", "subsegment_rod"}) {
    Json question = {{"query", "forward"}, {"model", model}, {"wrench", {0.05, 0.04, 0.002}}};
    question["tensions"] = tensions;
    const Json there = ask(robot, {question})[0];
    ASSERT_EQ(there["status"], "converged") << there.dump();
    question.erase("tensions");
    question["changes"] = there["changes"];
    const Json back = ask(robot, {question})[0];
    ASSERT_EQ(back["status"], "converged") << model << back.dump();
    for (const char* key : {"x", "y", "phi"})
      EXPECT_NEAR(back["pose"][key].get<double>(), there["pose"][key].get<double>(), 1e-8) << model;
    // Sections of one bend each: of a pair one tendon holds it.
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t k = 0; k < 2; ++k) {
        const double tension = back["tensions"][i][k], before = tensions[i][k];
        if (model == std::string("cc"))
          EXPECT_LT(tension, before) << i << k;
        else
          EXPECT_NEAR(tension, before, 1e-3) << model << i << k;
      }
  }
}

/// Of tensions that lengths do not determine, whatever was measured explains itself; and where the way from
/// no wrench has no equilibrium the search begins elsewhere.
TEST(PlanarArmLegsQuery, ExactTensionsTellTheWrench) {
  const Json tensions = {{1.81, 0.74}, {1.41, 1.04}, {1.27, 0.95}, {1.55, 1.09}, {0.77, 1.34}, {1.79, 0.97}};
  const std::vector<double> wrench{0.05, 0.04, 0.002};
  const Json load = {{"leg", 1}, {"place", 0.1}, {"wrench", {0.05, -0.02, 0}}};
  for (const char* model : {"cc", "subsegment_cc", "prb"})
    for (const bool has_loads : {true, false}) {
      Json question = {{"query", "forward"}, {"model", model}};
      if (has_loads) question["distributed"] = {0.1, 0.2, 0}, question["loads"] = Json::array({load});
      Json forward = question;
      forward["tensions"] = tensions;
      forward["wrench"] = wrench;
      const Json there = ask(robot, {forward})[0];
      ASSERT_EQ(there["status"], "converged") << there.dump();
      question["query"] = "statics";
      question["changes"] = there["changes"];
      question["deviation"] = 0.01;
      question["force_alone"] = false;
      question["measured_tensions"] = Json::array();
      for (const Json& pair : tensions)
        for (const Json& tension : pair) question["measured_tensions"].push_back(tension);
      const Json found = ask(robot, {question})[0];
      ASSERT_EQ(found["status"], "converged") << model << found.dump();
      EXPECT_LT(found["misfit"], 1e-3) << model;
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found["wrench"][i], wrench[i], 1e-5) << model << i;
      EXPECT_FALSE(found.contains("message")) << found["message"];
    }
}

TEST(PlanarArmLegsQuery, WhatNoWrenchExplainsIsSaid) {
  const Json found = ask(robot, {{{"query", "statics"},
                                  {"changes", same_of_all({-1e-3, 1e-3})},
                                  {"measured_tensions", {2, 0, 3, 0, 2, 0, 1, 0, 9, 0, 2, 0}},
                                  {"deviation", 0.01},
                                  {"force_alone", false}}})[0];
  EXPECT_TRUE(found.contains("message")) << found.dump();
  EXPECT_GT(found["misfit"], 5) << found.dump();
}

TEST(PlanarArmLegsQuery, ATendonThatIsTooShortIsNamed) {
  Json changes = same_of_all({0, 0});
  changes[3][0] = -1e-6;
  for (const char* model : {"cc", "subsegment_cc", "prb"}) {
    const Json found = ask(robot, {{{"query", "forward"}, {"model", model}, {"changes", changes}}})[0];
    EXPECT_EQ(found["status"], "unreachable") << model;
    EXPECT_NE(found["message"].get<std::string>().find("of leg 1 does not stretch and is held too short"),
              std::string::npos)
        << found["message"];
  }
}

/// What turns with a place is in its axes, x to the right of the way along the backbone and y along it. Small
/// loads: as dead ones in these axes at rest, but for how far they turn.
TEST(PlanarArmLegsQuery, WhatTurnsIsInTheAxesOfItsPlace) {
  const double c = 1e-4;
  const auto pose = [&](const Json& more) {
    Json query{{"query", "forward"}, {"elements", 2}, {"want", {"shape"}}};
    query.update(more);
    const Json found = ask(robot, {query})[0];
    EXPECT_EQ(found["status"], "converged") << found.dump();
    return found;
  };
  const Json rest = pose(Json::object());
  const Json line = rest["backbones"][1];
  double right[2] = {line.back()[1].get<double>() - line[0][1].get<double>(),
                     line[0][0].get<double>() - line.back()[0].get<double>()};
  const double length = std::hypot(right[0], right[1]);
  for (double& x : right) x /= length;
  const auto turned = [&](double across, double along) {
    return std::array{across * right[0] - along * right[1], across * right[1] + along * right[0]};
  };
  const auto load = [&](const Json& wrench, bool following) {
    return Json{
        {"loads", Json::array({{{"leg", 1}, {"place", 0.1}, {"wrench", wrench}, {"following", following}}})}};
  };
  for (const std::array<double, 3>& own : {std::array{c, 0., 0.}, {0., 20 * c, 0.}, {0., 0., 0.05 * c}}) {
    const auto [x, y] = turned(own[0], own[1]);
    const Json a = pose(load(own, true))["pose"], b = pose(load({x, y, own[2]}, false))["pose"];
    for (const char* key : {"x", "y", "phi"}) {
      const double home = rest["pose"][key], one = a[key].get<double>() - home,
                   other = b[key].get<double>() - home;
      EXPECT_NEAR(one, other, 0.02 * std::abs(other) + 1e-9) << own[0] << own[1] << key;
    }
  }
  const Json a = pose({{"following", {c, 0, 0.1 * c}}})["pose"],
             b = pose({{"wrench", {c, 0, 0.1 * c}}})["pose"];
  for (const char* key : {"x", "y", "phi"})
    EXPECT_NEAR(a[key].get<double>(), b[key].get<double>(), 1e-7) << key;
  EXPECT_EQ(pose({{"distributed_following", {0.1, 0.2, 0}}})["stable"], true);
}

TEST(PlanarArmLegsQuery, EveryQuestionHasNumbersOfThePlane) {
  const Json load = {0.3, -0.2, 0.004}, by_pose{{"x", 0.0005}, {"y", 0}, {"phi", -0.5}};
  const std::vector<Json> answers = ask(
      robot,
      {{{"query", "forward"},
        {"tensions", some_tensions},
        {"wrench", load},
        {"want", {"shape", "velocity", "stiffness"}},
        {"samples", 5}},
       {{"query", "inverse"}, {"pose", by_pose}},
       {{"query", "inverse"}, {"position", {0.002, 0.001}}},
       {{"query", "track"}, {"points", {{{"tensions", some_tensions}}, {{"pose", by_pose}}}}, {"steps", 2}},
       {{"query", "describe"}}});
  const Json& forward = answers[0];
  ASSERT_EQ(forward["status"], "converged") << forward.dump();
  EXPECT_EQ(forward["pose"].size(), 3U);
  double x = 0, y = 0;
  for (const Json& leg : forward["legs"])
    x += leg["force"][0].get<double>(), y += leg["force"][1].get<double>();
  EXPECT_NEAR(x, 0.3, 1e-9);
  EXPECT_NEAR(y, -0.2, 1e-9);
  EXPECT_EQ(forward["U"].size(), 3U);
  EXPECT_EQ(forward["U"][0].size(), 12U);
  EXPECT_EQ(forward["stiffness"][2].size(), 3U);
  EXPECT_EQ(forward["answers_by_wrench"].size(), 12U);
  EXPECT_EQ(forward["backbones"][2][4].size(), 2U);
  EXPECT_EQ(forward["curvatures"][0].size(), 5U);
  EXPECT_EQ(forward["platform"][0].size(), 2U);
  for (std::size_t k = 0; k < 3; ++k)  // joints have no gap
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_NEAR(forward["backbones"][k][4][i].get<double>(), forward["platform"][k][i].get<double>(), 1e-9);
  for (const std::size_t k : {1U, 3U}) {
    ASSERT_EQ(answers[k]["status"], "converged") << answers[k].dump();
    EXPECT_NEAR(answers[k]["pose"]["phi"].get<double>(), -0.5, 1e-6);
  }
  EXPECT_NEAR(answers[2]["pose"]["x"].get<double>(), 0.002, 1e-7);
  EXPECT_EQ(answers[3]["rows"].size(), 4U);
  EXPECT_EQ(answers[4]["space"], "planar");
  EXPECT_EQ(answers[4]["legs"][0]["closure"]["type"], "chord");

  const Json pose = forward["pose"];
  const std::vector<Json> back =
      ask(robot, {{{"query", "statics"}, {"tensions", some_tensions}, {"pose", pose}},
                  {{"query", "statics"},
                   {"tensions", some_tensions},
                   {"wrench", {0, 0, 0.004}},
                   {"position", {pose["x"], pose["y"]}}},
                  {{"query", "forward"},
                   {"tensions", some_tensions},
                   {"until", {{"wrench", {1, 0, 0}}, {"limit", 0.5}}}}});
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(back[0]["wrench"][i].get<double>(), load[i].get<double>(), 1e-3) << back[0].dump();
  ASSERT_EQ(back[1]["status"], "converged") << back[1].dump();
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_NEAR(back[1]["wrench"][i].get<double>(), load[i].get<double>(), 1e-3) << back[1].dump();
  EXPECT_EQ(back[1]["covariance"].size(), 3U);
  EXPECT_EQ(back[2]["why"], "limit") << back[2].dump();
}

TEST(PlanarArmLegsQuery, AllTellsOtherEquilibriaAndStartGoesToThem) {
  const Json query{{"query", "forward"}, {"tensions", some_tensions}, {"all", true}};
  const Json answer = ask(robot, {query})[0];
  ASSERT_EQ(answer["status"], "converged") << answer.dump();
  EXPECT_EQ(answer["complete"], false);
  EXPECT_EQ(answer["count"], answer["solutions"].size());
  ASSERT_EQ(answer["solutions"].size(), 2U);  // as many as the kinematic robot's assembly modes
  bool has_forward = false;
  std::vector<Json> again;
  for (const Json& one : answer["solutions"]) {
    EXPECT_LE(one["residual"].get<double>(), 1e-9);
    again.push_back({{"query", "forward"},
                     {"tensions", some_tensions},
                     {"start", {{"pose", one["pose"]}, {"curvatures", one["curvatures"]}}}});
    has_forward = has_forward ||
                  std::abs(one["pose"]["phi"].get<double>() - answer["pose"]["phi"].get<double>()) < 1e-6;
  }
  EXPECT_TRUE(has_forward);
  const auto answers = ask(robot, again);
  for (std::size_t k = 0; k < again.size(); ++k) {
    const Json& one = answer["solutions"][k];
    EXPECT_EQ(answers[k]["status"], one["stable"].get<bool>() ? "converged" : "unstable")
        << answers[k].dump();
    for (const char* key : {"x", "y", "phi"})
      EXPECT_NEAR(std::remainder(answers[k]["pose"][key].get<double>() - one["pose"][key].get<double>(),
                                 2 * std::numbers::pi),
                  0, 1e-5);
  }
  const auto code = [](const Json& start) {
    const Json refused =
        ask(robot, {{{"query", "forward"}, {"tensions", some_tensions}, {"start", start}}})[0];
    return refused.contains("error") ? refused["error"]["code"].get<std::string>()
                                     : refused["status"].get<std::string>();
  };
  EXPECT_EQ(code({{"pose", answer["pose"]}}), "missing_key");
  EXPECT_EQ(code({{"pose", answer["pose"]}, {"curvatures", Json::array()}}), "wrong_length");
  EXPECT_EQ(code({{"pose", answer["pose"]}, {"curvatures", {Json::array(), Json::array(), Json::array()}}}),
            "wrong_length");
  EXPECT_EQ(code({{"pose", answer["pose"]}, {"curvatures", {{{0, 0}}, {{0, 0, 0}}, {{0, 0, 0}}}}}),
            "wrong_length");
  EXPECT_EQ(code("first"), "unknown_choice");
}

TEST(PlanarArmLegsQuery, LegsOfEveryClosureAreRead) {
  const std::string chord = "closure: {type: chord}", angle = "point: {radius: 190 mm, angle: 90 deg}";
  for (const char* closure : {"{type: strut, length: 40 mm}", "{type: pin}", "{type: clamp}"}) {
    std::string text = with(chord, std::string("closure: ") + closure);
    for (const auto& [at, direction] :
         {std::pair{"90 deg}}", "-72 deg"}, {"210 deg}}", "48 deg"}, {"330 deg}}", "168 deg"}}) {
      const std::string key = std::string("angle: ") + at + ", platform",
                        with_direction = std::string("angle: ") +
                                         std::string(at).substr(0, std::string(at).size() - 1) +
                                         ", direction: " + direction + "}, platform";
      text.replace(text.find(key), key.size(), with_direction);
    }
    const OwnFile file(text);
    const auto answers = ask(
        file.path(), {{{"query", "forward"}, {"tensions", {{0.4, 0}, {0, 0.2}}}}, {{"query", "describe"}}});
    EXPECT_EQ(answers[0]["status"], "converged") << closure << answers[0].dump();
    EXPECT_TRUE(answers[1]["legs"][0]["base"].contains("direction"));
  }
}

TEST(PlanarArmLegsQuery, BadFilesAndQuestionsSayWhatIsWrong) {
  const auto code = [](const Json& query) {
    const Json answer = ask(robot, {query})[0];
    return answer.contains("error") ? answer["error"]["code"].get<std::string>()
                                    : answer["status"].get<std::string>();
  };
  EXPECT_EQ(code({{"query", "forward"}, {"tensions", some_tensions}, {"wrench", {0, 0, 0, 0, 0, 0}}}),
            "wrong_length");
  EXPECT_EQ(code({{"query", "forward"}, {"tensions", some_tensions}, {"gravity", {0, 0, -9.81}}}),
            "no_effect");
  for (const char* key : {"distributed", "distributed_following"})
    EXPECT_EQ(code({{"query", "forward"}, {"tensions", some_tensions}, {key, {0, 0, 1}}}), "no_effect");
  EXPECT_EQ(code({{"query", "forward"}, {"tensions", some_tensions}, {"following", {0, 0, 0, 0, 0, 0}}}),
            "wrong_length");
  const auto at_middle = [&](const Json& wrench) {
    const Json load{{"leg", 2}, {"place", 0.1}, {"wrench", wrench}};
    return code({{"query", "forward"},
                 {"tensions", some_tensions},
                 {"distributed", {0.1, 0, 0}},
                 {"loads", Json::array({load})}});
  };
  EXPECT_EQ(at_middle({0.1, 0.1, 0}), "converged");
  EXPECT_EQ(at_middle({0, 0, 0.01}), "converged");
  EXPECT_EQ(at_middle({0, 0, 0, 0, 0, 0}), "wrong_length");
  EXPECT_EQ(code({{"query", "forward"}, {"tensions", some_tensions}, {"tilt", true}}), "no_effect");
  EXPECT_EQ(code({{"query", "inverse"}, {"direction", {0, 0, 1}}}), "not_available");
  EXPECT_EQ(code({{"query", "inverse"}, {"position", {0, 0, 0}}}), "wrong_length");
  EXPECT_EQ(code({{"query", "inverse"}}), "missing_key");
  EXPECT_EQ(code({{"query", "inverse"}, {"pose", {{"position", {0, 0, 0}}}}}), "missing_key");
  EXPECT_EQ(code({{"query", "inverse"}, {"position", {1, 1}}}), "unreachable");
  for (const auto& [what, instead, wanted] :
       {std::array{"angle: 0 deg each", "angle: 90 deg each", "out_of_plane"},
        {"      discs: {count: 5}", "      precurvature: [1, 0, 0]\n      discs: {count: 5}", "out_of_plane"},
        {"name: 3-RFR", "gravity: [0, 0, -9.81]\nname: 3-RFR", "no_effect"},
        {"{type: chord}", "{type: ball}", "unknown_choice"},
        {"{type: chord}", "{type: strut}", "missing_key"},
        {"{type: chord}", "{type: pin}", "missing_key"},
        {"angle: 90 deg}}", "angle: 90 deg}, direction: 0 deg}", "no_effect"},
        {"  - {base: {point: {radius: 190 mm, angle: 330 deg}}, platform_point: {radius: 50 mm, angle: 270 "
         "deg}}\n",
         "", "loose_platform"},
        {"{radius: 50 mm, angle: 270 deg}", "{radius: 190 mm, angle: 270 deg, height: 1 mm}",
         "unknown_key"}}) {
    const OwnFile file(with(what, instead));
    const std::string line = std::string(command_path) + " check '" + file.path() + "' 2>&1";
    FILE* pipe = ::popen(line.c_str(), "r");
    std::string text;
    for (std::array<char, 512> part; std::fgets(part.data(), part.size(), pipe) != nullptr;)
      text += part.data();
    EXPECT_NE(::pclose(pipe), 0);
    EXPECT_NE(text.find(wanted), std::string::npos) << what << '\n' << text;
  }
}

}  // namespace planar_arm_legs_query_test
}  // namespace sinew::test
