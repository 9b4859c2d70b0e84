/// The rigid 3PRS against numbers of an independent implementation (tests/data/tripod/rigid_cases.json),
/// through the real `sinew query`.
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/tripod_loci.hpp"
#include "sinew_query.hpp"

namespace sinew::test {
namespace reference_tripod_test {

const Json& reference() { return read_json("data/tripod/rigid_cases.json"); }
Json independent(const Json& p) { return {{"z", p["z"]}, {"e1", p["e1"]}, {"e2", p["e2"]}}; }

void expect_pose(const Json& found, const Json& p, double tolerance) {
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(found["position"][k].get<double>(), p["p"][k].get<double>(), tolerance);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_NEAR(found["quaternion"][k].get<double>(), p["e"][k].get<double>(), tolerance);
}

TEST(ReferenceTripod, RigidCases) {  // @verifies 3PFS (9)-(11), (15)-(19)
  std::vector<Json> queries;
  for (const Json& p : reference()["cases"]) {
    queries.push_back({{"query", "inverse"}, {"independent", independent(p)}});
    queries.push_back({{"query", "inverse"}, {"pose", {{"position", p["p"]}, {"quaternion", p["e"]}}}});
    queries.push_back({{"query", "forward"}, {"inputs", p["rho"]}});
    queries.push_back({{"query", "velocity"}, {"independent", independent(p)}});
  }
  const auto answers = ask("3prs", queries);
  for (std::size_t i = 0; i < reference()["cases"].size(); ++i) {
    const Json& p = reference()["cases"][i];
    for (std::size_t k = 0; k < 2; ++k) {
      const Json& inverse = answers[4 * i + k];
      ASSERT_EQ(inverse["status"], "converged") << inverse;
      EXPECT_LT(relative_error(inverse["inputs"], p["rho"]), 1e-12);
      expect_pose(inverse["pose"], p, 1e-14);
    }
    const Json &forward = answers[4 * i + 2], &velocity = answers[4 * i + 3];
    ASSERT_EQ(forward["status"], "converged") << forward;
    expect_pose(forward["pose"], p, 1e-12);
    ASSERT_EQ(velocity["status"], "converged") << velocity;
    EXPECT_LT(relative_error(velocity["U"], p["J_twist_per_rhodot"]), 1e-12);
    EXPECT_NEAR(velocity["determinant"].get<double>() / p["detJx"].get<double>(), 1, 1e-12);
    for (std::size_t row = 3; row < 6; ++row)
      for (std::size_t column = 0; column < 3; ++column) EXPECT_EQ(velocity["K"][row][column], 0.0);
    const auto left = radial_positions(p["e1"], p["e2"]);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(left[k], p["eq19_lhs"][k].get<double>(), 1e-14);
  }
}

TEST(ReferenceTripod, EveryModeLeadsBack) {
  const Json& p = reference()["cases"][0];
  const auto answers = ask("3prs", {{{"query", "inverse"}, {"independent", independent(p)}, {"all", true}},
                                    {{"query", "forward"}, {"inputs", p["rho"]}, {"all", true}}});
  ASSERT_EQ(answers[0]["solutions"].size(), 8U);  // a strut to either side of each leg
  ASSERT_EQ(answers[1]["complete"], true);
  std::vector<Json> back;
  for (const Json& solution : answers[0]["solutions"])
    back.push_back({{"query", "forward"}, {"inputs", solution["inputs"]}, {"start", answers[0]["pose"]}});
  for (const Json& solution : answers[1]["solutions"]) {
    std::vector<int> elbows;
    for (const Json& leg : solution["legs"]) elbows.push_back(leg["elbow"]);
    back.push_back({{"query", "inverse"}, {"pose", solution["pose"]}, {"elbow", elbows}});
  }
  const auto there = ask("3prs", back);
  for (std::size_t k = 0; k < 8; ++k) expect_pose(there[k]["pose"], p, 1e-12);
  for (std::size_t k = 8; k < there.size(); ++k)
    EXPECT_LT(relative_error(there[k]["inputs"], p["rho"]), 1e-12);
}

}  // namespace reference_tripod_test
}  // namespace sinew::test
