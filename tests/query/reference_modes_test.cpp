/// All assembly modes of the reference cases (tests/data/tdpcr/fk.json), through the real `sinew query`: none
/// missing, none invented.
#include <gtest/gtest.h>

#include <cmath>

#include "sinew_query.hpp"

namespace sinew::test {
namespace reference_modes_test {

/// Curvature of a link whose chord is known, positive; by halving, independent of the library.
double curvature_of(double chord, double length) {
  double low = 0, high = std::acos(-1.0);  // half the bend
  for (int i = 0; i < 200; ++i) {
    const double x = (low + high) / 2;
    (std::sin(x) / x > chord / length ? low : high) = x;
  }
  return 2 * low / length;
}

/// `set` that gives a planar robot these base and platform points.
Json with_points(const Json& base, const Json& platform) {
  Json set = Json::object();
  for (std::size_t i = 0; i < base.size(); ++i) {
    set["legs[" + std::to_string(i) + "].base.point"] = base[i];
    set["legs[" + std::to_string(i) + "].platform_point"] = platform[i];
  }
  return set;
}

double gap(const Json& pose, const Json& expected) {
  return std::max({std::abs(pose["x"].get<double>() - expected["x"].get<double>()),
                   std::abs(pose["y"].get<double>() - expected["y"].get<double>()),
                   std::abs(std::remainder(pose["phi"].get<double>() - expected["phi"].get<double>(),
                                           2 * std::acos(-1.0)))});
}

void expect_same_modes(const Json& answer, const Json& known) {
  ASSERT_EQ(answer["status"], "converged") << answer;
  EXPECT_EQ(answer["complete"], true);
  ASSERT_EQ(answer["solutions"].size(), known["solutions"].size()) << answer;
  EXPECT_EQ(answer["solutions"].size(), known["n_real"].get<std::size_t>());
  for (const Json& expected : known["solutions"]) {
    double nearest = 1;
    for (const Json& solution : answer["solutions"])
      nearest = std::min(nearest, gap(solution["pose"], expected));
    EXPECT_LT(nearest, 1e-9) << expected;
  }
  for (const Json& solution : answer["solutions"]) EXPECT_LT(solution["residual"].get<double>(), 1e-12);
}

TEST(ReferenceModes, Of3RfrAndItsRigidTwins) {  // @verifies TDPCR (42)
  const Json& all = read_json("data/tdpcr/fk.json");
  std::vector<Json> queries, known;
  for (const char* name : {"3-RFR_example_geometry", "3-RFR_generic_geometry",
                           "3-RPR_phi_pi_root_at_infinity", "3-RPR_w2_parallel_w3"}) {
    const Json& robot = all[name];
    for (const Json& c : robot["cases"]) {
      Json inputs = Json::array();
      for (const Json& chord : c["lengths"])
        inputs.push_back(0.3 * (1 - 0.005 * curvature_of(chord.get<double>(), 0.3)));  // chords up to 0.22 m
      Json set = with_points(robot["a"], robot["b"]);
      set["defaults.link.length"] = 0.3;
      queries.push_back({{"query", "forward"}, {"inputs", inputs}, {"all", true}, {"set", set}});
      known.push_back(c);
    }
  }
  const auto answers = ask("3-rfr", queries);
  for (std::size_t i = 0; i < answers.size(); ++i) expect_same_modes(answers[i], known[i]);
}

TEST(ReferenceModes, Of3Frr) {
  const Json& cases = read_json("data/tdpcr/fk.json")["3-FRR"]["cases"];
  std::vector<Json> queries;
  for (const Json& c : cases) queries.push_back({{"query", "forward"}, {"inputs", c["l1"]}, {"all", true}});
  const auto answers = ask("3-frr", queries);
  for (std::size_t i = 0; i < answers.size(); ++i) expect_same_modes(answers[i], cases[i]);
}

TEST(ReferenceModes, Of3Rfrr) {  // inputs as the paper has them: angle of the chord
  const Json& robot = read_json("data/tdpcr/fk.json")["3-RFRR"];
  std::vector<Json> queries;
  for (const Json& c : robot["cases"]) {
    Json inputs = Json::array();
    for (std::size_t leg = 0; leg < 3; ++leg) {
      inputs.push_back(c["q"][leg]);
      inputs.push_back(0.15 * (1 - 0.005 * c["kappa"][leg].get<double>()));
    }
    queries.push_back({{"query", "forward"}, {"inputs", inputs}, {"all", true}, {"theta_is", c["mode"]}});
  }
  const auto answers = ask("3-rfrr", queries);
  for (std::size_t i = 0; i < answers.size(); ++i) expect_same_modes(answers[i], robot["cases"][i]);
}

/// Rotation matrix of a quaternion [w, x, y, z].
std::array<std::array<double, 3>, 3> matrix_of(const Json& q) {
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
           {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
           {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

double spatial_gap(const Json& pose, const Json& expected) {
  double worst = 0;
  const auto R = matrix_of(pose["quaternion"]);
  for (std::size_t i = 0; i < 3; ++i) {
    worst = std::max(worst, std::abs(pose["position"][i].get<double>() - expected["p"][i].get<double>()));
    for (std::size_t j = 0; j < 3; ++j)
      worst = std::max(worst, std::abs(R[i][j] - expected["R"][i][j].get<double>()));
  }
  return worst;
}

TEST(ReferenceModes, Of6UfsAreAllThereAre) {  // the reference's counts are lower bounds; ours are complete
  const Json& cases = read_json("data/tdpcr/fk.json")["6-UFS"]["cases"];
  std::vector<Json> queries;
  for (const Json& c : cases) queries.push_back({{"query", "forward"}, {"inputs", c["l1"]}, {"all", true}});
  const auto answers = ask("6-ufs", queries);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    ASSERT_EQ(answers[i]["status"], "converged") << answers[i];
    EXPECT_EQ(answers[i]["complete"], true);
    EXPECT_GE(answers[i]["count"].get<int>(), cases[i]["n_found"].get<int>());
    for (const Json& expected : cases[i]["solutions"]) {
      double nearest = 1;
      for (const Json& solution : answers[i]["solutions"])
        nearest = std::min(nearest, spatial_gap(solution["pose"], expected));
      EXPECT_LT(nearest, 1e-9) << expected;
    }
    for (const Json& solution : answers[i]["solutions"]) EXPECT_LT(solution["residual"].get<double>(), 1e-12);
  }
}

}  // namespace reference_modes_test
}  // namespace sinew::test
