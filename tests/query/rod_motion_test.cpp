/// Robots on rods that move: rates, paths of poses, and searches that begin somewhere, through `sinew query`.
#include <gtest/gtest.h>

#include <cmath>

#include "sinew_query.hpp"

namespace sinew::test {
namespace rod_motion_test {

const Json tripod = {0.44, 0.42, 0.41}, six = {0.41, 0.41, 0.405, 0.405, 0.405, 0.405};
const Json held = {{"z", 0.39}, {"e1", 0.1}, {"e2", 0.05}};

Json pose_at(double x, double y, double z, double turn = 0) {
  return {{"position", {x, y, z}}, {"quaternion", {std::cos(turn / 2), std::sin(turn / 2), 0, 0}}};
}

double gap(const Json& a, const Json& b) {
  if (a.size() != b.size() || a.empty()) return std::numeric_limits<double>::infinity();
  double worst = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    worst = std::max(worst, std::abs(a[k].get<double>() - b[k].get<double>()));
  return worst;
}

TEST(RodVelocity, RatesAndTwistAreEachOthers) {
  const Json rates = {0.01, -0.02, 0.005};
  const Json twist =
      ask("3pfs-g2", {{{"query", "velocity"}, {"inputs", tripod}, {"rates", rates}}})[0]["twist"];
  ASSERT_EQ(twist.size(), 6U);
  const auto found =
      ask("3pfs-g2", {{{"query", "velocity"}, {"inputs", tripod}, {"twist", twist}},
                      {{"query", "velocity"}, {"inputs", tripod}, {"twist", {twist[2], twist[3], twist[4]}}},
                      {{"query", "velocity"}, {"inputs", tripod}, {"twist", {0, 0.1, 0, 0, 0, 0}}},
                      {{"query", "velocity"}, {"inputs", tripod}, {"twist", twist}, {"rates", rates}},
                      {{"query", "velocity"}, {"inputs", tripod}, {"rates", {1, 2}}}});
  EXPECT_LT(gap(found[0]["rates"], rates), 1e-10) << found[0];
  EXPECT_FALSE(found[0].contains("twist"));
  EXPECT_LT(gap(found[1]["rates"], rates), 1e-12) << found[1];
  EXPECT_LT(gap(found[1]["twist"], twist), 1e-12) << found[1];
  EXPECT_EQ(found[2]["status"], "singular") << found[2];
  EXPECT_FALSE(found[2].contains("rates"));
  EXPECT_TRUE(found[2].contains("U"));
  EXPECT_EQ(found[3]["error"]["code"], "ambiguous");
  EXPECT_EQ(found[4]["error"]["code"], "wrong_length");
}

TEST(RodVelocity, SixInputsFollowAnyTwist) {
  const Json twist = {0.01, -0.02, 0.005, 0.1, -0.2, 0.3}, pose = pose_at(0.01, 0, 0.4, 0.05);
  const auto found = ask("hexapod", {{{"query", "velocity"}, {"pose", pose}, {"twist", twist}},
                                     {{"query", "velocity"}, {"pose", pose}, {"twist", {0.01, 0, 0}}}});
  ASSERT_EQ(found[0]["status"], "converged") << found[0];
  const Json again =
      ask("hexapod", {{{"query", "velocity"}, {"pose", pose}, {"rates", found[0]["rates"]}}})[0];
  EXPECT_LT(gap(again["twist"], twist), 1e-10) << again;
  EXPECT_EQ(found[1]["error"]["code"], "wrong_length");
}

/// Every row is what `inverse` answers at that pose alone.
TEST(RodTrack, RowsAreHeldPoses) {
  const Json from = pose_at(0, 0, 0.4), to = pose_at(0.03, -0.02, 0.43, 0.15),
             wrench = {0.1, 0, -0.5, 0, 0.01, 0};
  const Json path = ask(
      "hexapod", {{{"query", "track"}, {"from", from}, {"to", to}, {"samples", 6}, {"wrench", wrench}}})[0];
  ASSERT_EQ(path["status"], "converged") << path;
  ASSERT_EQ(path["rows"].size(), 6U);
  std::vector<Json> alone;
  Json poses = Json::array();
  for (const Json& row : path["rows"]) {
    alone.push_back(
        {{"query", "inverse"}, {"pose", row["pose"]}, {"wrench", wrench}, {"want", {"stability"}}});
    poses.push_back(row["pose"]);
  }
  const auto found = ask("hexapod", alone);
  for (std::size_t k = 0; k < found.size(); ++k) {
    const Json& row = path["rows"][k];
    EXPECT_LT(gap(row["inputs"], found[k]["inputs"]), 1e-10) << k;
    EXPECT_EQ(row["status"], found[k]["status"]);
    EXPECT_EQ(row["unstable_directions"], found[k]["unstable_directions"]);
    EXPECT_LT(row["residual"].get<double>(), 1e-11);
  }
  EXPECT_LT(gap(path["rows"][5]["pose"]["position"], to["position"]), 1e-15);
  const Json listed = ask("hexapod", {{{"query", "track"}, {"poses", poses}, {"wrench", wrench}}})[0];
  for (std::size_t k = 0; k < found.size(); ++k)
    EXPECT_LT(gap(listed["rows"][k]["inputs"], found[k]["inputs"]), 1e-10) << k;
}

TEST(RodTrack, ThreeInputsHoldThreeCoordinates) {
  for (const char* robot : {"3pfs-g2", "2prs-1pfs"}) {
    const double z = robot[0] == '3' ? 0.39 : 0.45;
    const Json from = {{"z", z}, {"e1", 0.0}, {"e2", 0.0}},
               to = {{"z", z + 0.02}, {"e1", 0.05}, {"e2", -0.02}};
    const auto path = ask(robot, {{{"query", "track"}, {"from", from}, {"to", to}, {"samples", 5}},
                                  {{"query", "inverse"}, {"independent", to}},
                                  {{"query", "track"}, {"poses", {from, to}}}});
    ASSERT_EQ(path[0]["rows"].size(), 5U) << path[0];
    EXPECT_LT(gap(path[0]["rows"][4]["inputs"], path[1]["inputs"]), 1e-9) << robot;
    EXPECT_LT(gap(path[2]["rows"][1]["inputs"], path[1]["inputs"]), 1e-9) << robot;
    EXPECT_NEAR(path[0]["rows"][2]["pose"]["position"][2].get<double>(), z + 0.01, 1e-14);
  }
}

TEST(RodTrack, EndsWhereNoLengthsHoldThePose) {
  const auto found =
      ask("hexapod",
          {{{"query", "track"}, {"from", pose_at(0, 0, 0.4)}, {"to", pose_at(0, 0, 0.4, 3)}, {"samples", 12}},
           {{"query", "track"}, {"poses", Json::array()}},
           {{"query", "track"}, {"from", held}, {"to", held}},
           {{"query", "track"},
            {"from", pose_at(0, 0, 0.4)},
            {"to", pose_at(0, 0, 0.41)},
            {"start", {-1, 1, 1, 1, 1, 1}}}});
  const Json& end = found[0];
  EXPECT_NE(end["status"], "converged") << end;
  ASSERT_TRUE(end.contains("reached")) << end;
  EXPECT_LT(end["rows"].size(), 12U);
  EXPECT_EQ(end["reached"]["rows"], end["rows"].size());
  EXPECT_GT(end["reached"]["part"].get<double>(), 0);
  EXPECT_TRUE(end["message"].get<std::string>().starts_with("the path ends between poses ")) << end;
  EXPECT_EQ(found[1]["error"]["code"], "empty_list");
  EXPECT_TRUE(found[2].contains("error"));
  EXPECT_TRUE(found[3]["message"].get<std::string>().starts_with("from start: ")) << found[3];
}

/// Poses that do not hold by themselves are passed, and counted.
TEST(RodTrack, SaysWhereThePlatformDoesNotHoldByItself) {
  const Json wrench = {0, 0, -100, 0, 0, 0};
  const Json path = ask("3pfs-g2", {{{"query", "track"},
                                     {"from", {{"z", 0.36}, {"e1", 0}, {"e2", 0}}},
                                     {"to", {{"z", 0.44}, {"e1", 0}, {"e2", 0}}},
                                     {"samples", 9},
                                     {"wrench", wrench}}})[0];
  ASSERT_EQ(path["rows"].size(), 9U) << path;
  int unstable = 0;
  for (const Json& row : path["rows"]) {
    EXPECT_EQ(row["status"], row["stable"].get<bool>() ? "converged" : "unstable");
    unstable += !row["stable"].get<bool>();
  }
  EXPECT_GT(unstable, 0);
  EXPECT_EQ(path["status"], "unstable");
  EXPECT_NE(path["message"].get<std::string>().find("at " + std::to_string(unstable) + " of 9"),
            std::string::npos)
      << path["message"];
}

/// A pose, lengths, or the last answer: each is where the way to the lengths begins.
TEST(RodInverse, BeginsWhereItIsTold) {
  const Json near = pose_at(0.02, 0.025, 0.418, 0.1), pose = pose_at(0.02, 0.03, 0.42, 0.12);
  const auto found = ask("hexapod", {{{"query", "inverse"}, {"pose", pose}},
                                     {{"query", "inverse"}, {"pose", pose}, {"start", near}},
                                     {{"query", "inverse"}, {"pose", near}, {"start", "last"}},
                                     {{"query", "describe"}},
                                     {{"query", "inverse"}, {"pose", pose}, {"start", "last"}},
                                     {{"query", "inverse"}, {"pose", near}},
                                     {{"query", "inverse"}, {"pose", pose}, {"start", "last"}},
                                     {{"query", "inverse"}, {"pose", pose}, {"start", "first"}},
                                     {{"query", "inverse"}, {"pose", pose}, {"start", true}}});
  for (const std::size_t k : {1U, 4U, 6U}) EXPECT_LT(gap(found[k]["inputs"], found[0]["inputs"]), 1e-9) << k;
  EXPECT_EQ(found[7]["error"]["code"], "unknown_choice");
  EXPECT_EQ(found[8]["error"]["code"], "wrong_type");
  const Json other = {{"z", 0.4}, {"e1", 0.09}, {"e2", 0.05}};
  const auto three = ask("3pfs-g2", {{{"query", "inverse"}, {"independent", held}},
                                     {{"query", "inverse"}, {"independent", held}, {"start", other}},
                                     {{"query", "inverse"}, {"independent", held}, {"start", tripod}},
                                     {{"query", "forward"}, {"inputs", tripod}, {"start", "last"}},
                                     {{"query", "inverse"}, {"independent", held}, {"start", "last"}}});
  for (const std::size_t k : {1U, 2U, 4U})
    EXPECT_LT(gap(three[k]["inputs"], three[0]["inputs"]), 1e-9) << three[k];
}

TEST(RodStatics, WalksFromTheLastPose) {
  std::vector<Json> queries, alone;
  for (int k = 0; k < 6; ++k) {
    Json query{{"query", "statics"}, {"inputs", six}, {"axial_forces", {0.1, -0.2, 0.01 * k, 0, 0.1, 0}}};
    query["inputs"][0] = 0.41 + 0.0005 * k;
    alone.push_back(query);
    query["start"] = "last";
    queries.push_back(query);
  }
  const auto walked = ask("hexapod", queries), expected = ask("hexapod", alone);
  for (std::size_t k = 0; k < walked.size(); ++k) {
    ASSERT_EQ(walked[k]["status"], expected[k]["status"]) << walked[k];
    EXPECT_LT(gap(walked[k]["wrench"], expected[k]["wrench"]), 1e-9) << k;
    EXPECT_LT(gap(walked[k]["pose"]["position"], expected[k]["pose"]["position"]), 1e-10) << k;
  }
  EXPECT_LT(walked[5]["iterations"].get<int>(), 10);
}

/// A walk goes on from where the rods are, and from the pose it names where another question moved them.
TEST(RodStart, LastGoesOnFromTheRodsAsTheyAre) {
  const auto walk = [](int k) {
    Json inputs = tripod;
    inputs[0] = 0.44 + 0.001 * k;
    return Json{{"query", "forward"}, {"inputs", inputs}, {"start", "last"}};
  };
  const Json elsewhere = {{"query", "inverse"}, {"independent", {{"z", 0.36}, {"e1", -0.1}, {"e2", 0}}}};
  const auto warm = ask("3pfs-g2", {walk(0), walk(1), walk(2)});
  const auto moved = ask("3pfs-g2", {walk(0), elsewhere, walk(1), elsewhere, walk(2)});
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_LT(gap(warm[k]["pose"]["position"], moved[2 * k]["pose"]["position"]), 1e-11);
  EXPECT_EQ(warm[0].dump(), moved[0].dump());
}

}  // namespace rod_motion_test
}  // namespace sinew::test
