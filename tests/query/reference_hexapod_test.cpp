/// Hexapods of rods against the field's public codes (tests/data/field/), through the real `sinew query`.
#include <gtest/gtest.h>

#include <cmath>

#include "sinew/math/vec.hpp"
#include "sinew_query.hpp"

namespace sinew::test {
namespace reference_hexapod_test {

struct Set {
  const char *robot, *file;
  double force, moment;  ///< tolerances the file states [N, N m]; of its others, the ones of these
};
class ReferenceHexapod : public testing::TestWithParam<Set> {};

TEST_P(ReferenceHexapod, LengthsForcesAndMoments) {
  const Json& source = read_json(std::string("data/field/") + GetParam().file);
  std::vector<Json> queries;
  for (const Json& c : source["cases"]) {
    EXPECT_EQ(c["rotvec_rad"], Json({0, 0, 0}));
    queries.push_back(
        {{"query", "inverse"}, {"pose", {{"position", c["p_m"]}, {"quaternion", {1, 0, 0, 0}}}}});
  }
  const auto held = ask(GetParam().robot, queries);
  std::vector<Json> back;
  for (std::size_t i = 0; i < held.size(); ++i) {
    const Json& c = source["cases"][i];
    ASSERT_EQ(held[i]["status"], "converged") << held[i];
    EXPECT_LT(held[i]["residual"].get<double>(), 1e-12);
    back.push_back({{"query", "forward"}, {"inputs", held[i]["inputs"]}});
    for (std::size_t k = 0; k < 6; ++k) {
      const Json& leg = held[i]["legs"][k];
      EXPECT_NEAR(leg["length"].get<double>(), c["L_m"][k].get<double>(),
                  source["tolerance"]["L_m"].get<double>());
      for (std::size_t r = 0; r < 3; ++r)
        EXPECT_NEAR(leg["force_0"][r].get<double>(), c["n0_N_rod_major"][3 * k + r].get<double>(),
                    GetParam().force);
      for (std::size_t r = 0; r < 2; ++r)
        EXPECT_NEAR(leg["moment_0"][r].get<double>(), c["m0xy_Nm_rod_major"][2 * k + r].get<double>(),
                    GetParam().moment);
    }
  }
  const auto poses = ask(GetParam().robot, back);  // usable forwards
  for (std::size_t i = 0; i < poses.size(); ++i) {
    ASSERT_TRUE(poses[i].contains("pose")) << poses[i];
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(poses[i]["pose"]["position"][k].get<double>(), source["cases"][i]["p_m"][k].get<double>(),
                  1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Sets, ReferenceHexapod,
                         testing::Values(Set{"hexapod", "csg_ik_till2015_noload.json", 1e-5, 1e-7},
                                         Set{"hexapod-heavy", "csg_ik_gravity_plate0p1kg.json", 1e-5, 1e-6},
                                         Set{"hexapod-self-weight",
                                             "csg_ik_rod_selfweight_cross_checked.json", 1e-5, 1e-6}),
                         [](const auto& set) {
                           std::string name = set.param.robot;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

/// Poses of six rods on ball joints under Cosserat's law, with and without a wrench.
TEST(ReferenceHexapodOnBalls, ForwardUnderEveryWrench) {  // @verifies 3PFS (25)-(30)
  const Json& source = read_json("data/field/pfs_tripod_hexapod_fk.json");
  std::vector<Json> queries;
  for (const Json& c : source["cases"]) {
    Json wrench = c["F_ext"];
    for (const Json& part : c["M_ext_about_plate_origin"]) wrench.push_back(part);
    queries.push_back({{"query", "forward"}, {"inputs", c["L"]}, {"wrench", wrench}});
  }
  const auto answers = ask("6pfs", queries);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const Json& c = source["cases"][i];
    ASSERT_EQ(answers[i]["status"], "converged") << answers[i];
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(answers[i]["pose"]["position"][k].get<double>(), c["p"][k].get<double>(),
                  source["tolerance"]["p_m"].get<double>());
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_NEAR(answers[i]["pose"]["quaternion"][k].get<double>(), c["quat_wxyz"][k].get<double>(),
                  source["tolerance"]["quat"].get<double>());
  }
}

/// The way to a pose begins where given lengths hold the platform: from those of a pose near by it comes to
/// the same branch.
TEST(HexapodInverse, StartsAtLengths) {
  const Json pose = {{"position", {0.02, 0.03, 0.42}}, {"quaternion", {0.995, 0.08, -0.04, 0.03}}},
             near = {{"position", {0.02, 0.025, 0.418}}, {"quaternion", {0.996, 0.07, -0.04, 0.03}}};
  const auto found =
      ask("hexapod", {{{"query", "inverse"}, {"pose", pose}}, {{"query", "inverse"}, {"pose", near}}});
  ASSERT_TRUE(found[0].contains("inputs") && found[1].contains("inputs")) << found[0] << found[1];
  EXPECT_EQ(found[0]["complete"], false);
  const auto again =
      ask("hexapod", {{{"query", "inverse"}, {"pose", pose}, {"start", found[1]["inputs"]}},
                      {{"query", "inverse"}, {"pose", pose}, {"start", {0.4, 0.4, 0.4}}},
                      {{"query", "inverse"}, {"pose", pose}, {"start", {-0.4, 0.4, 0.4, 0.4, 0.4, 0.4}}}});
  ASSERT_TRUE(again[0].contains("inputs")) << again[0];
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_NEAR(again[0]["inputs"][k].get<double>(), found[0]["inputs"][k].get<double>(), 1e-9);
  EXPECT_TRUE(again[1].contains("error")) << again[1];
  EXPECT_EQ(again[2]["status"], "left_domain") << again[2];
  EXPECT_TRUE(again[2]["message"].get<std::string>().starts_with("from start: ")) << again[2];
}

/// Other lengths that hold the same pose are counted, and each of them does: what its rods do to the platform
/// adds up to nothing.
TEST(HexapodInverse, AllFindsOtherLengths) {
  const Json pose = {{"position", {0, 0, 0.4}}, {"quaternion", {1, 0, 0, 0}}};
  const auto found = ask("hexapod", {{{"query", "inverse"}, {"pose", pose}, {"all", true}}})[0];
  ASSERT_EQ(found["status"], "converged");
  EXPECT_EQ(found["complete"], false);
  EXPECT_EQ(found["count"], found["solutions"].size());
  EXPECT_GE(found["solutions"].size(), 3U);
  const auto vector = [](const Json& list) { return Vec3<double>(list[0], list[1], list[2]); };
  bool has_answer = false;
  for (const Json& one : found["solutions"]) {
    EXPECT_LT(one["residual"].get<double>(), 1e-11);
    has_answer =
        has_answer || std::abs(one["inputs"][0].get<double>() - found["inputs"][0].get<double>()) < 1e-9;
    Vec3<double> force = Vec3<double>::Zero(), moment = force;
    for (std::size_t k = 0; k < 6; ++k) {
      const Json& leg = one["legs"][k];
      EXPECT_EQ(leg["length"], one["inputs"][k]);
      force += vector(leg["force"]);
      moment += vector(leg["moment"]) + cross(vector(leg["tip"]), vector(leg["force"]));
    }
    EXPECT_LT(force.norm(), 1e-9);
    EXPECT_LT(moment.norm(), 1e-10);
  }
  EXPECT_TRUE(has_answer);
}

TEST(TripodInverse, AllIsOfSixRods) {
  const auto asked =
      ask("3pfs-g1",
          {{{"query", "inverse"}, {"independent", {{"z", 0.3}, {"e1", 0}, {"e2", 0}}}, {"all", true}}})[0];
  EXPECT_EQ(asked["status"], "unsupported") << asked;
}

}  // namespace reference_hexapod_test
}  // namespace sinew::test
