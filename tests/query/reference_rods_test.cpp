/// The flexible 3PFS against numbers of an independent implementation (tests/data/tripod/), and of another
/// one with Cosserat rods (tests/data/field/), through the real `sinew query`.
#include <gtest/gtest.h>

#include <cmath>

#include "sinew_query.hpp"

namespace sinew::test {
namespace reference_rods_test {

const Json everything = {"stiffness", "stability", "margins", "sensitivity"};

/// Largest |found − expected| of lists of numbers, lists of lists and numbers.
double error(const Json& found, const Json& expected) {
  if (!expected.is_array()) return std::abs(found.get<double>() - expected.get<double>());
  double worst = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double one = error(found.at(i), expected[i]);
    if (!(one <= worst)) worst = one;  // NaN, too
  }
  return worst;
}

Json wrench_of(const Json& c) {
  Json wrench = c["F_ext"];
  for (const Json& part : c["M_ext"]) wrench.push_back(part);
  return wrench;
}

void expect_pose(const Json& found, const Json& c, double tolerance) {
  EXPECT_LT(error(found["position"], c["p"]), tolerance);
  EXPECT_LT(error(found["quaternion"], c["e"]), tolerance);
}

/// Forces are EI/L² times numbers of 1e-12: G1 is the stiff one.
void expect_rods(const Json& answer, const Json& c, double bending_stiffness, double tolerance) {
  Json sum = {0.0, 0.0, 0.0};
  for (std::size_t i = 0; i < 6; ++i) {
    const Json& leg = answer["legs"][i];
    EXPECT_LT(error(leg["force"], c["n"][i]), tolerance);
    EXPECT_EQ(leg["force_0"], leg["force"]);
    EXPECT_LT(error(leg["curvature_0"], c["u0"][i]), tolerance);
    EXPECT_NEAR(leg["tip_angle"].get<double>(), c["tip_angle"][i].get<double>(), tolerance);
    for (std::size_t k = 0; k < 2; ++k)
      EXPECT_NEAR(leg["moment_0"][k].get<double>(), bending_stiffness * c["u0"][i][k].get<double>(),
                  tolerance);
    EXPECT_NEAR(leg["moment_0"][2].get<double>(), 0, tolerance);  // guides are upright, rods bear no torque
    for (std::size_t k = 0; k < 3; ++k) sum[k] = sum[k].get<double>() + leg["force"][k].get<double>();
    if (!c.contains("energy_rods")) continue;
    EXPECT_NEAR(leg["energy"].get<double>(), c["energy_rods"][i].get<double>(), 1e-11);
  }
  EXPECT_LT(error(sum, c["F_ext"]), 1e-9);
  // forces do work on a closure that is solved to 1e-12 of the length
  EXPECT_NEAR(answer["energy"].get<double>(), c["energy"].get<double>(),
              3e-12 * (1 + c["energy"].get<double>()));
}

/// Largest curvature times half the diameter, by the first integral ½ EI κ² + n·t along each rod.
double largest_strain(const Json& c, double bending_stiffness) {
  double largest = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const double ux = c["u0"][i][0], uy = c["u0"][i][1], curvature = std::hypot(ux, uy);
    const double axial = c["n"][i][2],
                 aside = (c["n"][i][0].get<double>() * uy - c["n"][i][1].get<double>() * ux) / curvature;
    for (int k = 0; k <= 10000; ++k) {
      const double angle = c["tip_angle"][i].get<double>() * k / 10000,
                   drop = axial - (aside * std::sin(angle) + axial * std::cos(angle));
      largest = std::max(largest, curvature * curvature + 2 / bending_stiffness * drop);
    }
  }
  return std::sqrt(largest) * 0.003 / 2;
}

void expect_potential(const Json& answer, const Json& c) {
  double work = 0, moment = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    work += c["F_ext"][k].get<double>() * c["p"][k].get<double>();
    moment += std::abs(c["M_ext"][k].get<double>());
  }
  if (moment > 0)
    EXPECT_FALSE(answer.contains("potential"));
  else
    EXPECT_NEAR(answer["potential"].get<double>(), c["energy"].get<double>() - work, 1e-10);
}

struct Set {
  const char *robot, *name;
};
class ReferenceRods : public testing::TestWithParam<Set> {
 protected:
  static Json cases(const char* name) {
    const Json& all = read_json("data/tripod/cases.json");
    for (const Json& set : all["sets"])
      if (set["name"] == name) return set["cases"];
    throw std::runtime_error("no such set");
  }
  static constexpr double bending_stiffness = 0.3300144907825653;
};

TEST_P(ReferenceRods, EveryCase) {  // @verifies 3PFS (17), (25)-(30)
  const Json known = cases(GetParam().name);
  ASSERT_EQ(known.size(), 10U);
  std::vector<Json> queries;
  for (const Json& c : known) {
    queries.push_back(
        {{"query", "forward"}, {"inputs", c["L"]}, {"wrench", wrench_of(c)}, {"want", everything}});
    queries.push_back({{"query", "velocity"}, {"inputs", c["L"]}, {"wrench", wrench_of(c)}});
    queries.push_back({{"query", "inverse"},
                       {"independent", {{"z", c["p"][2]}, {"e1", c["e"][1]}, {"e2", c["e"][2]}}},
                       {"wrench", wrench_of(c)}});
  }
  const auto answers = ask(GetParam().robot, queries);
  std::size_t stiffnesses = 0;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const Json &c = known[i], &forward = answers[3 * i], &velocity = answers[3 * i + 1],
               &inverse = answers[3 * i + 2];
    SCOPED_TRACE(c["id"].get<std::string>());
    for (const Json* answer : {&forward, &velocity, &inverse})
      ASSERT_EQ((*answer)["status"], "converged") << *answer;
    expect_pose(forward["pose"], c, 1e-12);
    expect_rods(forward, c, bending_stiffness, 1e-9);
    expect_potential(forward, c);
    EXPECT_LT(forward["residual"].get<double>(), 1e-12);
    EXPECT_EQ(forward["stable"], c["unstable_directions"] == 0);
    EXPECT_EQ(forward["unstable_directions"], c["unstable_directions"]);
    EXPECT_TRUE(forward["unstable"].empty());
    EXPECT_GT(forward["margins"]["fold"].get<double>(), 1e-3);
    EXPECT_NEAR(forward["margins"]["strain"].get<double>(), largest_strain(c, bending_stiffness), 1e-9);
    EXPECT_LT(error(inverse["inputs"], c["L"]), 1e-12);
    expect_pose(inverse["pose"], c, 1e-12);
    EXPECT_LT(relative_error(velocity["J"], forward["stiffness"]), 1e-9);
    EXPECT_LT(relative_error(velocity["U"], forward["sensitivity"]), 1e-9);
    EXPECT_LT(error(forward["sensitivity"], c["J_L"]), 1e-9);
    if (!c.contains("stiffness")) continue;
    ++stiffnesses;
    EXPECT_LT(relative_error(forward["stiffness"], c["stiffness"]), 1e-9);
  }
  EXPECT_EQ(stiffnesses, 4U);
}

INSTANTIATE_TEST_SUITE_P(OfGeometry, ReferenceRods,
                         testing::Values(Set{"3pfs-g1", "G1"}, Set{"3pfs-g2", "G2"}),
                         [](const auto& set) { return set.param.name; });

/// To so many digits after the point: whoever asks knows where about the robot is.
Json rounded(const Json& list) {
  Json result = Json::array();
  for (const Json& x : list) result.push_back(std::round(x.get<double>() * 1e4) / 1e4);
  return result;
}

TEST(ReferenceManyEquilibria, EachIsFoundFromNearby) {  // @verifies 3PFS (25)-(30)
  const Json& all = read_json("data/tripod/multiple_equilibria.json");
  for (const Set& set : {Set{"3pfs-g1", "G1"}, Set{"3pfs-g2", "G2"}}) {
    std::vector<Json> queries, known;
    for (const Json& c : all["equilibria"]) {
      if (c["set"] != set.name) continue;
      known.push_back(c);
      queries.push_back({{"query", "forward"},
                         {"inputs", c["L"]},
                         {"wrench", wrench_of(c)},
                         {"start", {{"position", rounded(c["p"])}, {"quaternion", rounded(c["e"])}}},
                         {"want", everything}});
    }
    ASSERT_GE(known.size(), 3U);
    const auto answers = ask(set.robot, queries);
    for (std::size_t i = 0; i < known.size(); ++i) {
      const Json &c = known[i], &answer = answers[i];
      SCOPED_TRACE(c["set"].get<std::string>() + " " + c["label"].get<std::string>());
      const bool is_stable = c["unstable_directions"] == 0;
      ASSERT_EQ(answer["status"], is_stable ? "converged" : "unstable") << answer;
      EXPECT_EQ(answer["stable"], is_stable);
      EXPECT_EQ(answer["unstable_directions"], c["unstable_directions"]);
      expect_pose(answer["pose"], c, 1e-10);
      expect_rods(answer, c, 0.3300144907825653, 1e-9);
      EXPECT_NEAR(answer["potential"].get<double>(), c["potential"].get<double>(), 1e-10);
    }
  }
}

TEST(ReferenceManyEquilibria, AllFindsTheSwayOfG2AndItsCopies) {
  const double length = 0.4346969702550149;
  const Json answer = ask("3pfs-g2", {{{"query", "forward"},
                                       {"inputs", {length, length, length}},
                                       {"wrench", {0, 0, -100, 0, 0, 0}},
                                       {"all", true}}})[0];
  EXPECT_EQ(answer["complete"], false);
  int sways = 0;
  for (const Json& solution : answer["solutions"]) {
    EXPECT_EQ(solution["legs"].size(), 6U);
    EXPECT_EQ(solution["stable"], solution["unstable_directions"] == 0);
    sways += std::abs(solution["potential"].get<double>() - 40.604136) < 1e-6 &&
             solution["unstable_directions"] == 1;
  }
  EXPECT_EQ(sways, 3);  // one for each plane of symmetry
  EXPECT_NEAR(answer["solutions"][0]["potential"].get<double>(), 40.569164, 1e-6);  // in ascending order
  EXPECT_EQ(answer["solutions"][0]["stable"], true);
}

TEST(ReferenceBuckling, UntilEndsWhereSwayBegins) {
  struct Load {
    const char* robot;
    double length, least, most;
  };
  for (const Load& known :
       {Load{"3pfs-g2", 0.4346969702550149, 110, 112}, Load{"3pfs-g1", 0.20755705266417177, 190, 200}}) {
    const Json lengths = {known.length, known.length, known.length}, down = {0, 0, -1, 0, 0, 0};
    const Json answer = ask(known.robot, {{{"query", "forward"},
                                           {"inputs", lengths},
                                           {"until", {{"wrench", down}, {"limit", 300}}},
                                           {"want", {"stability", "margins"}}}})[0];
    ASSERT_EQ(answer["status"], "converged") << answer;
    EXPECT_EQ(answer["why"], "bifurcation");
    EXPECT_EQ(answer["stable"], true);
    const double load = answer["load"].get<double>();
    EXPECT_GT(load, known.least);
    EXPECT_LT(load, known.most);
    std::vector<Json> queries;
    for (const double factor : {0.999, 1.001})
      queries.push_back(
          {{"query", "forward"}, {"inputs", lengths}, {"wrench", {0, 0, -factor * load, 0, 0, 0}}});
    const auto beside = ask(known.robot, queries);
    EXPECT_EQ(beside[0]["status"], "converged");
    EXPECT_EQ(beside[1]["status"], "unstable");
  }
}

TEST(ReferenceBuckling, UntilStopsAtItsLimit) {
  const auto answers =
      ask("3pfs-g2",
          {{{"query", "forward"}, {"inputs", {0.44, 0.42, 0.41}}, {"wrench", {1, -0.5, -25, 0.2, 0.1, -0.1}}},
           {{"query", "forward"},
            {"inputs", {0.44, 0.42, 0.41}},
            {"wrench", {1, -0.5, -5, 0.2, 0.1, -0.1}},
            {"until", {{"wrench", {0, 0, -1, 0, 0, 0}}, {"limit", 20}}}}});
  EXPECT_EQ(answers[1]["why"], "limit");
  EXPECT_EQ(answers[1]["load"], 20.0);
  EXPECT_LT(error(answers[1]["pose"]["position"], answers[0]["pose"]["position"]), 1e-11);
}

/// Rods that also stretch and shear are another model of the same robot: so near, and no nearer.
TEST(ReferenceRods, CosseratRodsOfAnotherSourceAreNear) {
  const Json& source = read_json("data/field/pfs_tripod_hexapod_fk.json");
  std::vector<Json> queries, known;
  for (const Json& c : source["cases"]) {
    const Json& L = c["L"];
    if (L[0] != L[1] || L[2] != L[3] || L[4] != L[5]) continue;
    Json wrench = c["F_ext"];
    for (const Json& part : c["M_ext_about_plate_origin"]) wrench.push_back(part);
    known.push_back(c);
    queries.push_back({{"query", "forward"}, {"inputs", {L[0], L[2], L[4]}}, {"wrench", wrench}});
  }
  ASSERT_GE(known.size(), 5U);
  const auto answers = ask("3pfs-g2", queries);
  for (std::size_t i = 0; i < known.size(); ++i) {
    ASSERT_EQ(answers[i]["status"], "converged");
    EXPECT_LT(error(answers[i]["pose"]["position"], known[i]["p"]), 1e-5);
    EXPECT_LT(2 * 0.125 * error(answers[i]["pose"]["quaternion"], known[i]["quat_wxyz"]),
              1e-5);  // at its rim
  }
}

}  // namespace reference_rods_test
}  // namespace sinew::test
