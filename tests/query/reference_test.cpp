/// Numbers of an independent implementation (tests/data/), through the real `sinew query`.
#include <gtest/gtest.h>

#include <cmath>

#include "sinew_query.hpp"

namespace sinew::test {
namespace reference_test {

Json pose_of(const Json& p) { return {{"x", p[0]}, {"y", p[1]}, {"phi", p[2]}}; }

Json diagonal(const Json& values) {
  Json matrix = Json::array();
  for (std::size_t i = 0; i < values.size(); ++i) {
    Json row = Json::array();
    for (std::size_t j = 0; j < values.size(); ++j) row.push_back(i == j ? values[i] : Json(0.0));
    matrix.push_back(row);
  }
  return matrix;
}

/// J, K, U, indices, tendons of one robot of poses.json (constant curvature), by velocity and inverse
/// queries.
void expect_poses(const std::string& robot, const std::string& key, const std::string& branch,
                  const std::string& branch_data) {
  const Json& reference = read_json("data/tdpcr/poses.json")[key];
  std::vector<Json> queries;
  for (const Json& p : reference["poses"]) {
    queries.push_back({{"query", "velocity"}, {"pose", pose_of(p["pose"])}, {branch, p[branch_data]}});
    queries.push_back({{"query", "inverse"}, {"pose", pose_of(p["pose"])}, {branch, p[branch_data]}});
    queries.push_back({{"query", "forward"}, {"inputs", p["l1"]}, {"start", pose_of(p["pose"])}});
  }
  const auto answers = ask(robot, queries);
  for (std::size_t i = 0; i < reference["poses"].size(); ++i) {
    const Json& p = reference["poses"][i];
    const Json &velocity = answers[3 * i], &inverse = answers[3 * i + 1], &forward = answers[3 * i + 2];
    ASSERT_EQ(velocity["status"], "converged") << velocity;
    EXPECT_LT(relative_error(velocity["J"], p["J"]), 1e-11);
    EXPECT_LT(relative_error(velocity["K"], diagonal(p["K_diag"])), 1e-11);
    EXPECT_LT(relative_error(velocity["U"], p["U"]), 1e-11);
    const Json& indices = p["CC_indices"];
    EXPECT_NEAR(velocity["indices"]["condition"].get<double>() / indices["cond"].get<double>(), 1, 1e-11);
    EXPECT_NEAR(velocity["indices"]["position"].get<double>() / indices["Up"].get<double>(), 1, 1e-11);
    EXPECT_NEAR(velocity["indices"]["rotation"].get<double>() / indices["Ur"].get<double>(), 1, 1e-11);
    EXPECT_NEAR(velocity["determinant"].get<double>() / indices["det"].get<double>(), 1, 1e-11);
    EXPECT_LT(relative_error(inverse["inputs"], p["l1"]), 1e-12);
    for (std::size_t leg = 0; leg < 3; ++leg)
      EXPECT_NEAR(inverse["legs"][leg]["curvature"].get<double>(), p["kappa"][leg].get<double>(), 1e-10);
    ASSERT_EQ(forward["status"], "converged") << forward;
    EXPECT_NEAR(forward["pose"]["x"].get<double>(), p["pose"][0].get<double>(), 1e-13);
    EXPECT_NEAR(forward["pose"]["y"].get<double>(), p["pose"][1].get<double>(), 1e-13);
    EXPECT_NEAR(forward["pose"]["phi"].get<double>(), p["pose"][2].get<double>(), 1e-12);
  }
}

TEST(Reference, PosesOf3Rfr) {  // @verifies TDPCR (17)-(20), (39)
  expect_poses("3-rfr", "3-RFR", "bending", "bending_signs");
}

TEST(Reference, PosesOf3Frr) {  // @verifies TDPCR (21)-(24), (28)-(30)
  expect_poses("3-frr", "3-FRR", "curvature", "kappa");
}

TEST(Reference,
     EveryWorkingModeOf3Frr) {  // all roots of each leg within a full turn: none missing, none invented
  const Json& reference = read_json("data/tdpcr/poses.json")["3-FRR"]["poses"];
  std::vector<Json> queries;
  for (const Json& p : reference)
    queries.push_back({{"query", "inverse"}, {"pose", pose_of(p["pose"])}, {"all", true}});
  const auto answers = ask("3-frr", queries);
  for (std::size_t i = 0; i < reference.size(); ++i) {
    std::size_t modes = 1;
    for (const Json& roots : reference[i]["all_ik_kappa"]) modes *= roots.size();
    ASSERT_EQ(answers[i]["solutions"].size(), modes);
    for (const Json& solution : answers[i]["solutions"])
      for (std::size_t leg = 0; leg < 3; ++leg) {
        double nearest = 1;
        for (const Json& root : reference[i]["all_ik_kappa"][leg])
          nearest = std::min(nearest,
                             std::abs(root.get<double>() - solution["legs"][leg]["curvature"].get<double>()));
        EXPECT_LT(nearest, 1e-11);
      }
  }
}

TEST(Reference, MapsOfBothRobots) {  // singularities over a grid: det J, condition numbers, reachable or not
  const Json& all = read_json("data/tdpcr/singular.json");
  std::vector<Json> rfr, frr;
  const auto over = [](const Json& map, std::vector<Json>& queries) {
    for (const Json& phi : map["phi"])
      for (const Json& y : map["y"])
        for (const Json& x : map["x"])
          queries.push_back({{"query", "velocity"}, {"pose", pose_of({x, y, phi})}});
  };
  over(all["3-RFR_map"], rfr);
  over(all["3-FRR_map"], frr);
  for (std::size_t i = 0; i < frr.size(); ++i)  // the reference takes the smallest signed root of each leg
    if (const Json& expected = all["3-FRR_map"]["data"][i]; !expected.is_null())
      frr[i]["curvature"] = expected[0];
  const auto rfr_answers = ask("3-rfr", rfr), frr_answers = ask("3-frr", frr);
  for (std::size_t i = 0; i < rfr.size(); ++i) {
    const Json &expected = all["3-RFR_map"]["data"][i], &found = rfr_answers[i];
    ASSERT_EQ(found["status"] != "unreachable", expected[3].get<bool>()) << rfr[i];
    if (found["status"] != "converged") continue;
    EXPECT_NEAR(found["determinant"].get<double>(), expected[0].get<double>(), 1e-16);
    EXPECT_NEAR(1 / found["indices"]["condition"].get<double>(), expected[1].get<double>(), 1e-13);
    EXPECT_NEAR(1 / found["indices"]["condition_homogenised"].get<double>(), expected[2].get<double>(),
                1e-13);
  }
  for (std::size_t i = 0; i < frr.size(); ++i) {
    const Json &expected = all["3-FRR_map"]["data"][i], &found = frr_answers[i];
    ASSERT_EQ(found["status"], expected.is_null() ? "unreachable" : "converged") << frr[i];
    if (expected.is_null()) continue;
    EXPECT_NEAR(found["determinant"].get<double>(), expected[1].get<double>(), 1e-14);
    EXPECT_NEAR(1 / found["indices"]["condition"].get<double>(), expected[2].get<double>(), 1e-12);
    for (std::size_t leg = 0; leg < 3; ++leg)
      EXPECT_NEAR(found["K"][leg][leg].get<double>(), expected[3][leg].get<double>(), 1e-9);
  }
}

TEST(Reference, AStraightFrrLegIsRegular) {
  const Json& all = read_json("data/tdpcr/singular.json");
  const Json& straight = all["3-FRR_kappa0_regular"];
  std::vector<Json> queries{
      {{"query", "velocity"}, {"pose", pose_of(straight["pose"])}, {"curvature", straight["kappa"]}}};
  const auto answers = ask("3-frr", queries);
  EXPECT_EQ(answers[0]["status"], "converged");
  EXPECT_EQ(answers[0]["type_1"], Json::array());
  EXPECT_LT(relative_error(answers[0]["J"], straight["J"]), 1e-11);
  EXPECT_LT(relative_error(answers[0]["K"], diagonal(straight["K"])), 1e-11);
}

TEST(Reference, BaseTangentsOf3Rfr) {
  const Json& reference = read_json("data/tdpcr/poses.json")["3-RFR"]["poses"];
  std::vector<Json> queries;
  for (const Json& p : reference)
    queries.push_back({{"query", "inverse"}, {"pose", pose_of(p["pose"])}, {"bending", p["bending_signs"]}});
  const auto answers = ask("3-rfr", queries);
  for (std::size_t i = 0; i < reference.size(); ++i)
    for (std::size_t leg = 0; leg < 3; ++leg) {
      const double found = answers[i]["legs"][leg]["base_tangent"].get<double>();
      const double expected = reference[i]["base_tangent_angle"][leg].get<double>();
      EXPECT_NEAR(std::remainder(found - expected, 2 * std::acos(-1.0)), 0, 1e-13);
      EXPECT_LE(std::abs(found), std::acos(-1.0));
    }
}

TEST(Reference, CurvesOfExample51) {  // TDPCR 5.1, Fig. 9: 1e-10 for k ≤ 55, 1e-9 at k = 58
  const Json& reference = read_json("data/tdpcr/example51.json")["CC"];
  std::vector<Json> queries;
  for (const Json& p : reference) queries.push_back({{"query", "velocity"}, {"pose", pose_of(p["pose"])}});
  const auto answers = ask("3-rfr", queries);
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const double tolerance = reference[i]["k"].get<int>() <= 55 ? 1e-10 : 1e-9;
    const Json& found = answers[i]["indices"];
    EXPECT_NEAR(found["condition"].get<double>() / reference[i]["cond"].get<double>(), 1, tolerance);
    EXPECT_NEAR(found["position"].get<double>() / reference[i]["Up"].get<double>(), 1, tolerance);
    EXPECT_NEAR(found["rotation"].get<double>() / reference[i]["Ur"].get<double>(), 1, tolerance);
    for (std::size_t leg = 0; leg < 3; ++leg)
      EXPECT_NEAR(answers[i]["legs"][leg]["curvature"].get<double>(),
                  reference[i]["kappa"][leg].get<double>(), 1e-10);
  }
}

TEST(Reference, LastPoseOfExample51IsConcurrent) {
  const auto answers =
      ask("3-rfr", {{{"query", "velocity"}, {"pose", pose_of({0.03, 0, std::acos(-1.0) / 3})}}});
  EXPECT_EQ(answers[0]["status"], "singular");
  EXPECT_EQ(answers[0]["type_2"]["class"], "concurrent");
  EXPECT_NEAR(answers[0]["type_2"]["point"][0].get<double>(), 0.0407142857142857, 1e-13);
  EXPECT_NEAR(answers[0]["type_2"]["point"][1].get<double>(), 0, 1e-13);
  EXPECT_FALSE(answers[0].contains("U"));
}

TEST(Query, AnswersHoldNoNullAndRepeatTheirId) {
  const auto answers =
      ask("3-rfr", {{{"id", "a7"}, {"query", "velocity"}, {"pose", pose_of({0.03, 0, std::acos(-1.0) / 3})}},
                    {{"id", 12}, {"query", "inverse"}, {"pose", pose_of({0.5, 0, 0})}},
                    {{"id", 13}, {"query", "shape"}, {"pose", pose_of({0.01, 0, 0})}, {"samples", 5}},
                    {{"id", 14}, {"query", "describe"}}});
  EXPECT_EQ(answers[0]["id"], "a7");
  EXPECT_EQ(answers[1]["id"], 12);
  EXPECT_EQ(answers[1]["status"], "unreachable");
  EXPECT_EQ(answers[2]["backbones"][0].size(), 5U);
  EXPECT_EQ(answers[3]["inputs"].size(), 3U);
  for (const Json& answer : answers) EXPECT_EQ(answer.dump().find("null"), std::string::npos) << answer;
}

}  // namespace reference_test
}  // namespace sinew::test
