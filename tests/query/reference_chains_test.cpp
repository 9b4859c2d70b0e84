/// Robots on pseudo-rigid chains through `sinew query` against tests/data/tdpcr, whose numbers come from
/// another implementation.
#include <gtest/gtest.h>

#include "sinew/math/se3.hpp"
#include "sinew_query.hpp"

namespace sinew::test {
namespace reference_chains_test {

const Json& statics() { return read_json("data/tdpcr/statics.json"); }
const Json& statics2() { return read_json("data/tdpcr/statics2.json"); }
const Json& poses() { return read_json("data/tdpcr/poses.json"); }

Json planar(const Json& pose) { return {{"x", pose[0]}, {"y", pose[1]}, {"phi", pose[2]}}; }

double gap_of(const Json& ours, const Json& theirs) {
  if (!theirs.is_array()) return std::abs(ours.get<double>() - theirs.get<double>());
  double gap = ours.size() == theirs.size() ? 0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < std::min(ours.size(), theirs.size()); ++i)
    gap = std::max(gap, gap_of(ours[i], theirs[i]));
  return gap;
}

double pose_gap(const Json& ours, const Json& theirs) {
  return gap_of({ours["x"], ours["y"], ours["phi"]}, theirs);
}

void expect_velocity(const char* robot, const Json& c, const Json& pose) {
  Json angles = c["theta"];
  if (c.contains("gamma1"))
    for (std::size_t i = 0; i < angles.size(); ++i) angles[i].insert(angles[i].begin(), c["gamma1"][i]);
  const Json answer =
      ask(robot, {{{"query", "velocity"}, {"model", "prb"}, {"pose", pose}, {"angles", angles}}}).front();
  ASSERT_EQ(answer["status"], "converged") << answer.dump();
  EXPECT_LT(gap_of(answer["J"], c.contains("J_prb") ? c["J_prb"] : c["J"]), 1e-13);
  if (c.contains("K_theta")) {
    EXPECT_LT(gap_of(answer["K"], c["K_theta"]), 1e-13);
  } else {
    const std::size_t joints = c["K_theta_blocks"][0].size();
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j < joints; ++j)
        EXPECT_NEAR(answer["K"][i][i * joints + j].get<double>(), c["K_theta_blocks"][i][j].get<double>(),
                    1e-13);
  }
  if (!c.contains("PRB_indices")) return;
  const Json& theirs = c["PRB_indices"];
  EXPECT_NEAR(answer["indices"]["position"].get<double>(), theirs["Up"].get<double>(),
              1e-11 * theirs["Up"].get<double>());
  EXPECT_NEAR(answer["indices"]["rotation"].get<double>(), theirs["Ur"].get<double>(),
              1e-11 * theirs["Ur"].get<double>());
}

TEST(ChainQuery, VelocityOfAllRobotsIsTheirs) {  // @verifies TDPCR (34)-(38), (40), (60)-(62)
  const Json& all = poses();
  for (const auto& [name, robot] :
       {std::pair("3-RFR", "3-rfr"), std::pair("3-FRR", "3-frr"), std::pair("3-RFRR", "3-rfrr")})
    for (const Json& c : all[name]["poses"]) expect_velocity(robot, c, planar(c["pose"]));
  for (const Json& c : all["6-UFS"]["poses"]) {
    const auto turn = SO3<double>::exp(Vec3<double>(
        c["rotvec"][0].get<double>(), c["rotvec"][1].get<double>(), c["rotvec"][2].get<double>()));
    expect_velocity("6-ufs", c,
                    {{"position", c["p"]}, {"quaternion", {turn.w, turn.v[0], turn.v[1], turn.v[2]}}});
  }
}

Json at_base() { return planar(statics()["about"]["base_pose"]); }

/// The case's robot, set at the base pose and loaded.
Json loaded(const Json& c) {
  return ask("3-rfr", {{{"query", "statics"},
                        {"set_at", at_base()},
                        {"law", c["model"]},
                        {"hold", c["mode"]},
                        {"wrench", c["W"]}}})
      .front();
}

TEST(ChainQuery, EquilibriaAreTheirs) {
  for (const Json& c : statics()["equilibria"]) {
    const Json answer = loaded(c);
    ASSERT_EQ(answer["status"], "converged") << answer.dump();
    EXPECT_LT(pose_gap(answer["pose"], c["pose"]), 1e-10);
    EXPECT_LT(answer["residual"].get<double>(), 1e-13);
    EXPECT_NEAR(answer["smallest_eigenvalue"].get<double>(), c["min_reduced_hessian_eig"].get<double>(),
                1e-9);
    EXPECT_LT(gap_of(answer["linear"], c["dpose_linear"]), 1e-12);
    for (std::size_t i = 0; i < 3; ++i) {
      const Json& leg = answer["legs"][i];
      EXPECT_LT(gap_of(leg["angles"], c["theta"][i]), 1e-9);
      EXPECT_LT(gap_of(leg["chord_force"], c["chord_force"][i]), 1e-9);
      EXPECT_LT(gap_of(leg["tensions"], {c["T1"][i], c["T2"][i]}), 1e-8);
      EXPECT_LT(gap_of(leg["tendon_lengths"], {c["l1"][i], c["l2"][i]}), 1e-11);
      if (c["model"] == "M0") {
        EXPECT_LT(gap_of(leg["tip_wrench"], c["tip_wrench"][i]["Ft"]), 1e-9);
      }
    }
    if (!c.contains("CC_energy_gap")) continue;
    EXPECT_LT(pose_gap(answer["cc_pose"], c["CC_restricted_pose"]), 1e-10);
    EXPECT_NEAR(answer["cc_gap"].get<double>(), c["CC_energy_gap"].get<double>(), 1e-14);
    EXPECT_NEAR(answer["cc_gap_estimate"].get<double>(), c["CC_energy_gap_estimate"].get<double>(), 1e-16);
    EXPECT_NEAR(answer["potential"].get<double>(), c["potential"].get<double>(), 1e-11);
  }
}

TEST(ChainQuery, TensionsAndLengthsAloneLeadThereToo) {
  for (const Json& c : statics()["equilibria"]) {
    Json query{{"query", "statics"}, {"start", at_base()}, {"law", c["model"]}, {"wrench", c["W"]}};
    Json held = Json::array();
    const bool lengths = c["mode"] == "length";
    for (std::size_t i = 0; i < 3; ++i)
      held.push_back(lengths ? Json{c["l1"][i], nullptr} : Json{c["T1"][i], c["T2"][i]});
    query[lengths ? "lengths" : "tensions"] = held;
    const Json answer = ask("3-rfr", {query}).front();
    ASSERT_EQ(answer["status"], "converged") << answer.dump();
    EXPECT_LT(pose_gap(answer["pose"], c["pose"]), 1e-10);
  }
}

TEST(ChainQuery, LoadsGrowUntilWhereTheirsEnd) {
  for (const Json& c : statics2()["stability_limits"]) {
    const bool ends = c["why"] != "limit not reached";
    const double load = c["load"];
    const Json answer =
        ask("3-rfr", {{{"query", "statics"},
                       {"set_at", at_base()},
                       {"law", c["model"]},
                       {"until", {{"wrench", c["direction"]}, {"limit", ends ? 2 * load : load}}}}})
            .front();
    EXPECT_EQ(answer["why"], ends ? "fold" : "limit") << answer.dump();
    EXPECT_NEAR(answer["load"].get<double>(), load, 2e-4 * load);  // theirs stops a little short
  }
}

TEST(ChainQuery, ComplianceIsTheirs) {
  for (const Json& c : statics2()["tangent_compliance"]) {
    const Json answer = loaded(c);
    EXPECT_LT(gap_of(answer["compliance"], c["compliance"]),
              1e-9 * std::abs(c["compliance"][2][2].get<double>()));
  }
}

TEST(ChainQuery, InverseStaticsAreTheirs) {
  for (const Json& c : statics()["inverse_statics_M0"]) {
    const Json answer = ask("3-rfr", {{{"query", "statics"},
                                       {"inverse", true},
                                       {"pose", planar(c["pose"])},
                                       {"law", "M0"},
                                       {"wrench", c["W"]}}})
                            .front();
    // tensions alone do not hold it past the fold
    EXPECT_EQ(answer["status"], answer["stable"].get<bool>() ? "converged" : "unstable") << answer.dump();
    for (std::size_t i = 0; i < 3; ++i) {
      const Json& leg = answer["legs"][i];
      EXPECT_LT(gap_of(leg["angles"], c["theta"][i]), 1e-10);
      EXPECT_LT(gap_of(leg["chord_force"], c["f"][i]), 1e-9);
      EXPECT_LT(gap_of(leg["tensions"][0], c["dT"][i]), 1e-8);
      EXPECT_LT(gap_of(leg["tendon_lengths"], {c["l1"][i], c["l2"][i]}), 1e-11);
    }
  }
}

Json tensions_of(const Json& moments) {
  Json tensions = Json::array();
  for (const Json& m : moments) {
    const double pull = -m.get<double>() / 0.005;
    tensions.push_back({std::max(pull, 0.0), std::max(-pull, 0.0)});
  }
  return tensions;
}

TEST(ChainQuery, LoadedThreeFrrAndSixUfsAreTheirs) {
  const Json& data = statics2();
  for (const Json& c : data["3-FRR_equilibria_M0"]["cases"]) {
    Json curvature = Json::array();
    for (const Json& theta : c["theta0"]) curvature.push_back(-theta[0].get<double>() / 0.0333333333333);
    const Json answer = ask("3-frr", {{{"query", "statics"},
                                       {"start", planar(c["pose0"])},
                                       {"curvature", curvature},
                                       {"tensions", tensions_of(c["m"])},
                                       {"law", "M0"},
                                       {"wrench", c["W"]}}})
                            .front();
    if (c["branch_lost"].get<bool>()) continue;
    ASSERT_EQ(answer["status"], "converged") << answer.dump();
    EXPECT_LT(pose_gap(answer["pose"], c["pose"]), 1e-10);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LT(gap_of(answer["legs"][i]["angles"], c["theta"][i]), 1e-9);
      EXPECT_LT(gap_of(answer["legs"][i]["chord_force"], c["f"][i]), 1e-9);
    }
  }
  const Json& ufs = data["6-UFS_equilibria_M0"];
  for (const Json& c : ufs["cases"]) {
    const Json answer = ask("6-ufs", {{{"query", "statics"},
                                       {"start", {{"position", ufs["p0"]}, {"quaternion", {1, 0, 0, 0}}}},
                                       {"tensions", tensions_of(ufs["m"])},
                                       {"law", "M0"},
                                       {"wrench", c["W"]}}})
                            .front();
    ASSERT_EQ(answer["status"], "converged") << answer.dump();
    EXPECT_LT(gap_of(answer["pose"]["position"], c["p"]), 1e-10);
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_LT(gap_of(answer["legs"][i]["angles"], c["theta"][i]), 1e-9);
      EXPECT_LT(gap_of(answer["legs"][i]["chord_force"], c["f"][i]), 1e-9);
    }
  }
}

TEST(ChainQuery, ForwardAndInverseUndoOneAnother) {
  for (const char* robot : {"3-rfr", "3-frr"}) {
    const Json pose = robot == std::string("3-rfr") ? Json{{"x", 0.01}, {"y", -0.005}, {"phi", 0.3}}
                                                    : Json{{"x", -0.0169}, {"y", -0.0221}, {"phi", 0.0491}};
    const Json wrench{0.01, -0.01, 0.0002};
    const Json there =
        ask(robot, {{{"query", "inverse"}, {"model", "prb"}, {"pose", pose}, {"wrench", wrench}}}).front();
    ASSERT_EQ(there["status"], "converged") << there.dump();
    const Json back = ask(robot, {{{"query", "forward"},
                                   {"model", "prb"},
                                   {"inputs", there["inputs"]},
                                   {"start", pose},
                                   {"wrench", wrench}}})
                          .front();
    ASSERT_EQ(back["status"], "converged") << back.dump();
    EXPECT_LT(pose_gap(back["pose"], {pose["x"], pose["y"], pose["phi"]}), 1e-10);
  }
}

}  // namespace reference_chains_test
}  // namespace sinew::test
