/// Numbers of an independent implementation for the 3-RFRR and the 6-UFS, through the real `sinew query`.
#include <gtest/gtest.h>

#include <cmath>

#include "sinew_query.hpp"

namespace sinew::test {
namespace reference_redundant_test {

Json pose_of(const Json& p) { return {{"x", p[0]}, {"y", p[1]}, {"phi", p[2]}}; }

Json rfrr_inputs(const Json& angles, const Json& lengths) {
  Json inputs = Json::array();
  for (std::size_t leg = 0; leg < 3; ++leg) {
    inputs.push_back(angles[leg]);
    inputs.push_back(lengths[leg]);
  }
  return inputs;
}

TEST(Reference, PosesOf3RfrrInBothReadingsOfTheta) {  // @verifies TDPCR (63)-(67)
  const Json& reference = read_json("data/tdpcr/poses.json")["3-RFRR"]["poses"];
  for (const std::string theta : {"tangent", "chord"}) {
    std::vector<Json> queries;
    for (const Json& p : reference) {
      const Json inputs = rfrr_inputs(p["q_" + theta], p["l1"]);
      queries.push_back({{"query", "velocity"}, {"pose", pose_of(p["pose"])}, {"inputs", inputs}});
      for (int k = 0; k < 3; ++k) {
        Json query = queries[queries.size() - 1 - static_cast<std::size_t>(k)];
        query["twist"] = {k == 0 ? 1 : 0, k == 1 ? 1 : 0, k == 2 ? 1 : 0};
        queries.push_back(query);
      }
      queries.push_back({{"query", "forward"}, {"inputs", inputs}, {"start", pose_of(p["pose"])}});
      queries.push_back({{"query", "inverse"}, {"pose", pose_of(p["pose"])}, {"start", inputs}});
    }
    if (theta == "chord")  // the tangent is the default
      for (Json& query : queries) query["theta_is"] = "chord";
    const auto answers = ask("3-rfrr", queries);
    for (std::size_t i = 0; i < reference.size(); ++i) {
      const Json& p = reference[i];
      const Json& velocity = answers[6 * i];
      ASSERT_EQ(velocity["status"], "converged") << velocity;
      EXPECT_LT(relative_error(velocity["J"], p["J"]), 1e-11);
      EXPECT_LT(relative_error(velocity["K"], p["K_" + theta]), 1e-11);
      EXPECT_NEAR(velocity["determinant"].get<double>() / p["det_J"].get<double>(), 1, 1e-11);
      for (std::size_t leg = 0; leg < 3; ++leg)
        EXPECT_NEAR(velocity["legs"][leg]["curvature"].get<double>(), p["kappa"][leg].get<double>(), 1e-10);
      const Json& shortest = p["minnorm_inputs_for_unit_twists_" + theta];
      for (std::size_t k = 0; k < 3; ++k) {
        Json expected = Json::array();
        for (const Json& row : shortest) expected.push_back(row[k]);
        EXPECT_LT(relative_error(answers[6 * i + 1 + k]["rates"], expected), 1e-10);
      }
      const Json &forward = answers[6 * i + 4], &inverse = answers[6 * i + 5];
      ASSERT_EQ(forward["status"], "converged") << forward;
      EXPECT_NEAR(forward["pose"]["x"].get<double>(), p["pose"][0].get<double>(), 1e-12);
      EXPECT_NEAR(forward["pose"]["phi"].get<double>(), p["pose"][2].get<double>(), 1e-11);
      EXPECT_LT(relative_error(inverse["inputs"], queries[6 * i + 5]["start"]), 1e-12);
    }
  }
}

/// Pose of a spatial reference case: position and rotation vector.
Json spatial_pose_of(const Json& position, const Json& turn) {
  const double x = turn[0], y = turn[1], z = turn[2], angle = std::sqrt(x * x + y * y + z * z);
  const double factor = angle > 0 ? std::sin(angle / 2) / angle : 0.5;
  return {{"position", position}, {"quaternion", {std::cos(angle / 2), factor * x, factor * y, factor * z}}};
}

double dot(const Json& a, const Json& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += a[i].get<double>() * b[i].get<double>();
  return sum;
}

TEST(Reference, PosesOf6Ufs) {  // @verifies TDPCR (56)-(59)
  const Json& robot = read_json("data/tdpcr/poses.json")["6-UFS"];
  std::vector<Json> queries;
  for (const Json& p : robot["poses"]) {
    const Json pose = spatial_pose_of(p["p"], p["rotvec"]);
    queries.push_back({{"query", "velocity"}, {"pose", pose}, {"bending", p["bending_signs"]}});
    queries.push_back({{"query", "inverse"}, {"pose", pose}, {"bending", p["bending_signs"]}});
    queries.push_back({{"query", "forward"}, {"inputs", p["l1"]}, {"start", pose}});
  }
  const auto answers = ask("6-ufs", queries);
  for (std::size_t i = 0; i < robot["poses"].size(); ++i) {
    const Json& p = robot["poses"][i];
    const Json &velocity = answers[3 * i], &inverse = answers[3 * i + 1], &forward = answers[3 * i + 2];
    ASSERT_EQ(velocity["status"], "converged") << velocity;
    EXPECT_LT(relative_error(velocity["J"], p["J"]), 1e-11);
    for (std::size_t leg = 0; leg < 6; ++leg) {
      EXPECT_NEAR(velocity["K"][leg][leg].get<double>() / p["K_diag"][leg].get<double>(), 1, 1e-11);
      // e = unit(g × r) is perpendicular to the base tangent and to the chord
      EXPECT_NEAR(dot(inverse["legs"][leg]["base_tangent"], p["e"][leg]), 0, 1e-12);
      EXPECT_EQ(inverse["legs"][leg]["joint_angles"].size(), 2U);
    }
    EXPECT_NEAR(velocity["indices"]["condition"].get<double>() / p["CC_indices"]["cond"].get<double>(), 1,
                1e-11);
    EXPECT_LT(relative_error(inverse["inputs"], p["l1"]), 1e-12);
    ASSERT_EQ(forward["status"], "converged") << forward;
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(forward["pose"]["position"][k].get<double>(), p["p"][k].get<double>(), 1e-12);
  }
}

TEST(Reference, DeterminantOf6UfsTurnedAboutZ) {
  const Json& map = read_json("data/tdpcr/singular.json")["6-UFS_det_rotz"];
  std::vector<Json> queries;
  for (const Json& turn : map["rot"])
    queries.push_back({{"query", "velocity"},
                       {"pose", spatial_pose_of(map["p"], {0, 0, turn})},
                       {"set", {{"defaults.link.length", 0.3}}}});  // so that the legs reach; J is the same
  const auto answers = ask("6-ufs", queries);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    ASSERT_TRUE(answers[i].contains("determinant")) << answers[i];
    EXPECT_NEAR(answers[i]["determinant"].get<double>(), map["det"][i].get<double>(), 1e-18);
  }
}

TEST(Reference, FichtersPosesOf6UfsLeaveAScrewFree) {
  std::vector<Json> queries, known;
  const Json& classes = read_json("data/tdpcr/singular.json")["spatial_classification"];
  for (const Json& c : classes) {
    if (!c.contains("rot_z")) continue;
    known.push_back(c);
    queries.push_back({{"query", "velocity"},
                       {"pose", spatial_pose_of(c["p"], {0, 0, c["rot_z"]})},
                       {"set", {{"defaults.link.length", 0.3}}}});  // so that the legs reach; J is the same
  }
  const auto answers = ask("6-ufs", queries);
  ASSERT_EQ(answers.size(), 2U);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    EXPECT_EQ(answers[i]["status"], "singular") << answers[i];
    const Json& type = answers[i]["type_2"];
    EXPECT_EQ(type["rank"], 5);
    EXPECT_EQ(type["class"], known[i]["class"]);
    EXPECT_NEAR(type["pitch"].get<double>(), known[i]["pitch"].get<double>(), 1e-9);
    EXPECT_NEAR(std::abs(dot(type["axis"]["direction"], known[i]["axis_dir"])), 1, 1e-12);
  }
}

}  // namespace reference_redundant_test
}  // namespace sinew::test
