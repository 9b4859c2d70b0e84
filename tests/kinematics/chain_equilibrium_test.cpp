/// Platforms on pseudo-rigid chains against the numbers of an independent implementation, and against
/// differences.
#include "kinematics/chains/chain.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numbers>

#include "paths.hpp"
#include "reference_file.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::test {
namespace chain_equilibrium_test {

using Json = nlohmann::json;

template <int N>
Vec<double, N> vector(const Json& list) {
  Vec<double, N> v;
  for (int i = 0; i < N; ++i) v[i] = list[static_cast<std::size_t>(i)].get<double>();
  return v;
}
PlanarPose planar_pose(const Json& pose) { return {pose[0], pose[1], pose[2]}; }

double stiffness() { return reference_file("data/tdpcr/statics.json")["about"]["EI"]; }

ChainLegs<Planar> three_rfr(PrbDiscretisation model, int links = 6) {
  const Json& robot = reference_file("data/tdpcr/poses.json")["3-RFR"];
  ChainLegs<Planar> result;
  for (std::size_t i = 0; i < 3; ++i)
    result.legs.push_back({.base = SE2<double>::from(robot["a"][i][0], robot["a"][i][1], 0),
                           .chain = {.length = robot["l"], .links = links, .model = model},
                           .bending_stiffness = stiffness(),
                           .tendon_offset = robot["d"],
                           .platform_point = vector<2>(robot["b"][i])});
  return result;
}

ChainLegs<Planar> three_frr(PrbDiscretisation model) {
  const Json& robot = reference_file("data/tdpcr/poses.json")["3-FRR"];
  ChainLegs<Planar> result;
  for (std::size_t i = 0; i < 3; ++i) {
    const double tangent = robot["tangent_angle"][i];
    result.legs.push_back(
        {.base = SE2<double>::from(robot["a"][i][0], robot["a"][i][1], tangent - std::numbers::pi / 2),
         .chain = {.length = robot["l"], .links = 6, .base = ChainBase::clamped, .model = model},
         .bending_stiffness = stiffness(),
         .tendon_offset = robot["d"],
         .strut = robot["v"][i],
         .platform_point = vector<2>(robot["c"][i])});
  }
  return result;
}

ChainLegs<Spatial> six_ufs() {
  const Json& robot = reference_file("data/tdpcr/poses.json")["6-UFS"];
  ChainLegs<Spatial> result;
  for (std::size_t i = 0; i < 6; ++i)
    result.legs.push_back({.base = {vector<3>(robot["a"][i]), {}},
                           .chain = {.length = robot["l"], .links = 5, .model = PrbDiscretisation::even},
                           .bending_stiffness = stiffness(),
                           .tendon_offset = robot["d"],
                           .platform_point = vector<3>(robot["b"][i])});
  return result;
}

const std::array<double, 3> towards_plus{1, 1, 1};

ChainState<Planar> base_state(const ChainLegs<Planar>& robot, bool holds_lengths = false) {
  const Json& about = reference_file("data/tdpcr/statics.json")["about"];
  std::vector<double> curvature;
  for (std::size_t i = 0; i < 3; ++i)
    curvature.push_back(-about["base_theta"][i][0].get<double>() / robot.legs[i].chain.link_length());
  ChainState<Planar> state;
  const Report report =
      unloaded_equilibrium(robot, planar_pose(about["base_pose"]), curvature, holds_lengths, state);
  EXPECT_TRUE(report.ok()) << to_string(report);
  return state;
}

PrbDiscretisation model_of(const Json& c) {
  return c["model"] == "M0" ? PrbDiscretisation::even : PrbDiscretisation::discs;
}
bool holds_lengths(const Json& c) { return c["mode"] == "length"; }
std::vector<TendonConstraint> hold_of(const Json& c) {
  std::vector<TendonConstraint> hold;
  for (std::size_t i = 0; i < c["T2"].size(); ++i)
    hold.push_back(holds_lengths(c) ? TendonConstraint{0, c["l1"][i], {0, c["T2"][i]}}
                                    : TendonConstraint{-1, 0, {c["T1"][i], c["T2"][i]}});
  return hold;
}

TEST(ChainEquilibrium, LoadedThreeRfrIsTheirs) {
  for (const Json& c : reference_file("data/tdpcr/statics.json")["equilibria"]) {
    const auto robot = three_rfr(model_of(c));
    ChainState<Planar> state = base_state(robot, holds_lengths(c));
    ChainWork work;
    const Report report = equilibrium(robot, hold_of(c), vector<3>(c["W"]), state, work);
    ASSERT_TRUE(report.ok() || report.status == Status::slack) << to_string(report);
    EXPECT_EQ(report.status == Status::slack, c["slack"].get<bool>());
    EXPECT_LT(report.residual, 1e-13);
    if (c.contains("potential")) {
      EXPECT_NEAR(potential(robot, state), c["potential"].get<double>(), 1e-11);
    }
    EXPECT_NEAR(state.pose.x, c["pose"][0].get<double>(), 1e-10);
    EXPECT_NEAR(state.pose.y, c["pose"][1].get<double>(), 1e-10);
    EXPECT_NEAR(state.pose.phi, c["pose"][2].get<double>(), 1e-10);
    for (std::size_t i = 0; i < 3; ++i) {
      const ChainLegState& leg = state.legs[i];
      EXPECT_NEAR(leg.force, c["chord_force"][i].get<double>(), 1e-9);
      EXPECT_NEAR(leg.tension[0], c["T1"][i].get<double>(), 1e-8);
      EXPECT_NEAR(leg.tendon_length[0], c["l1"][i].get<double>(), 1e-11);
      EXPECT_NEAR(leg.tendon_length[1], c["l2"][i].get<double>(), 1e-11);
      for (std::size_t j = 0; j < 5; ++j) EXPECT_NEAR(leg.angles[j], c["theta"][i][j].get<double>(), 1e-9);
    }
    EXPECT_NEAR(smallest_hessian_eigenvalue(robot, state), c["min_reduced_hessian_eig"].get<double>(), 1e-9);
  }
}

TEST(ChainEquilibrium, ComplianceIsTheirs) {
  for (const Json& c : reference_file("data/tdpcr/statics2.json")["tangent_compliance"]) {
    const auto robot = three_rfr(model_of(c));
    ChainState<Planar> state = base_state(robot, holds_lengths(c));
    ChainWork work;
    const Report report = equilibrium(robot, std::vector(state.hold), vector<3>(c["W"]), state, work);
    ASSERT_TRUE(report.ok()) << to_string(report);
    const auto found = compliance(robot, state, work);
    Mat<double, 3, 3> theirs;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        theirs(i, j) = c["compliance"][static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    EXPECT_LT((found - theirs).norm(), 1e-9 * theirs.norm()) << c["model"] << c["mode"];
  }
}

ChainLoadPath path_to(PrbDiscretisation model, const Vec<double, 3>& direction, double limit,
                      ChainState<Planar>& state) {
  const auto robot = three_rfr(model);
  state = base_state(robot);
  ChainWork work;
  return follow_load(robot, direction, limit, state, work);
}

TEST(ChainEquilibrium, ALoadGrowsUntilWhereTheirsEnds) {
  for (const Json& c : reference_file("data/tdpcr/statics2.json")["stability_limits"]) {
    ChainState<Planar> state;
    const double load = c["load"];
    const bool ends = c["why"] != "limit not reached";
    const auto path = path_to(model_of(c), vector<3>(c["direction"]), ends ? 2 * load : load, state);
    EXPECT_EQ(path.end == ChainLoadEnd::limit, !ends) << to_string(path.end);
    EXPECT_NEAR(path.load, load, 2e-4 * load) << c["direction"];  // theirs stops a little short
    if (!ends) {
      EXPECT_NEAR(state.pose.phi, c["pose"][2].get<double>(), 1e-9);
    }
  }
}

TEST(ChainEquilibrium, ATwistedPlatformFolds) {
  ChainState<Planar> state;
  const auto even = path_to(PrbDiscretisation::even, {0, 0, 1}, 0.02, state);
  EXPECT_EQ(even.end, ChainLoadEnd::fold) << to_string(even.end);
  EXPECT_NEAR(even.load, 6.32e-3, 0.5e-5);
  EXPECT_NEAR(path_to(PrbDiscretisation::discs, {0, 0, 1}, 0.02, state).load, 3.94e-3, 0.5e-5);
}

TEST(ChainEquilibrium, ThePathSaysWhereItEnds) {
  const auto robot = three_rfr(PrbDiscretisation::even);
  ChainState<Planar> state = base_state(robot);
  ChainWork work;
  const Report report = equilibrium(robot, std::vector(state.hold), {0, 0, 0.01}, state, work);
  EXPECT_EQ(report.status, Status::stalled);
  EXPECT_NE(report.message.view().find("63.2"), std::string_view::npos) << report.message.view();
  EXPECT_LT(report.residual, 1e-11);  // the last one on the path is one
  EXPECT_NEAR(state.wrench[2], 6.32e-3, 0.5e-5);
}

std::vector<TendonConstraint> tensions_of_moments(const Json& moments, double offset) {
  std::vector<TendonConstraint> tensions;
  for (const Json& m : moments) {
    const double pull = -m.get<double>() / offset;
    tensions.push_back({-1, 0, {std::max(pull, 0.0), std::max(-pull, 0.0)}});
  }
  return tensions;
}

TEST(ChainEquilibrium, LoadedThreeFrrIsTheirs) {
  for (const Json& c : reference_file("data/tdpcr/statics2.json")["3-FRR_equilibria_M0"]["cases"]) {
    if (c["branch_lost"].get<bool>()) continue;
    const auto robot = three_frr(PrbDiscretisation::even);
    std::vector<double> curvature;
    for (std::size_t i = 0; i < 3; ++i)
      curvature.push_back(-c["theta0"][i][0].get<double>() / robot.legs[i].chain.link_length());
    ChainState<Planar> state;
    ASSERT_TRUE(unloaded_equilibrium(robot, planar_pose(c["pose0"]), curvature, false, state).ok());
    ChainWork work;
    const Report report = equilibrium(robot, tensions_of_moments(c["m"], robot.legs[0].tendon_offset),
                                      vector<3>(c["W"]), state, work);
    ASSERT_TRUE(report.ok()) << to_string(report);
    EXPECT_NEAR(state.pose.x, c["pose"][0].get<double>(), 1e-10);
    EXPECT_NEAR(state.pose.y, c["pose"][1].get<double>(), 1e-10);
    EXPECT_NEAR(state.pose.phi, c["pose"][2].get<double>(), 1e-10);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(state.legs[i].force, c["f"][i].get<double>(), 1e-9);
      for (std::size_t j = 0; j < 6; ++j)
        EXPECT_NEAR(state.legs[i].angles[j], c["theta"][i][j].get<double>(), 1e-9);
    }
  }
}

TEST(ChainEquilibrium, LoadedSixUfsIsTheirs) {
  const Json& all = reference_file("data/tdpcr/statics2.json")["6-UFS_equilibria_M0"];
  const auto robot = six_ufs();
  std::vector<double> curvature;
  for (std::size_t i = 0; i < 6; ++i)
    curvature.push_back(-all["theta0"][i][0].get<double>() / robot.legs[i].chain.link_length());
  SpatialPose home;
  home.position = vector<3>(all["p0"]);
  ChainState<Spatial> at_rest;
  ASSERT_TRUE(unloaded_equilibrium(robot, home, curvature, false, at_rest).ok());
  ChainWork work;
  const auto tensions = tensions_of_moments(all["m"], robot.legs[0].tendon_offset);
  for (const Json& c : all["cases"]) {
    ChainState<Spatial> state = at_rest;
    const Report report = equilibrium(robot, tensions, vector<6>(c["W"]), state, work);
    ASSERT_TRUE(report.ok()) << to_string(report);
    EXPECT_LT((state.pose.position - vector<3>(c["p"])).norm(), 1e-10);
    const Mat<double, 3, 3> turn = SE3<double>::from(state.pose).R.matrix();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        EXPECT_NEAR(turn(i, j),
                    c["R"][static_cast<std::size_t>(i)][static_cast<std::size_t>(j)].get<double>(), 1e-10);
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_NEAR(state.legs[i].force, c["f"][i].get<double>(), 1e-9);
      for (std::size_t j = 0; j < 4; ++j)
        EXPECT_NEAR(state.legs[i].angles[j], c["theta"][i][j].get<double>(), 1e-9);
    }
  }
}

TEST(ChainEquilibrium, ComplianceIsTheDerivative) {  // for every model, closure and what is held
  for (const PrbDiscretisation model :
       {PrbDiscretisation::even, PrbDiscretisation::weighted, PrbDiscretisation::discs})
    for (const bool lengths : {false, true}) {
      const auto robot = three_rfr(model);
      const ChainState<Planar> at_rest = base_state(robot, lengths);
      const Vec<double, 3> wrench(0.01, -0.005, 0.0005);
      ChainWork work;
      const auto under = [&](const Vec<double, 3>& load) {
        ChainState<Planar> state = at_rest;
        const Report report = equilibrium(robot, at_rest.hold, load, state, work);
        EXPECT_TRUE(report.ok()) << to_string(report);
        return state;
      };
      const auto found = compliance(robot, under(wrench), work);
      for (int k = 0; k < 3; ++k) {
        const double step = k == 2 ? 1e-6 : 1e-5;
        const auto at = [&](double sign) {
          const auto one = under(wrench + sign * step * Vec<double, 3>::Unit(k));
          return Vec<double, 3>(one.pose.x, one.pose.y, one.pose.phi);
        };
        const Vec<double, 3> slope = (at(1) - at(-1)) / (2 * step);
        EXPECT_LT((slope - found.col(k)).norm(), 1e-5 * found.col(k).norm());
      }
    }
}

TEST(ChainEquilibrium, RestIsOneForEveryLawAndClosure) {
  for (const PrbDiscretisation model :
       {PrbDiscretisation::even, PrbDiscretisation::weighted, PrbDiscretisation::discs}) {
    const auto robot = three_frr(model);
    const std::array<double, 3> curvature{5, 5, 5};
    ChainState<Planar> state;
    const Report report = unloaded_equilibrium(robot, PlanarPose{0.01, 0, 0.1}, curvature, false, state);
    ASSERT_TRUE(report.ok()) << to_string(report);
    const ChainState<Planar> at_rest = state;
    ChainWork work;
    ASSERT_TRUE(equilibrium(robot, at_rest.hold, Vec<double, 3>::Zero().eval(), state, work).ok());
    EXPECT_NEAR(state.pose.x, at_rest.pose.x, 1e-13);
    EXPECT_NEAR(state.pose.phi, at_rest.pose.phi, 1e-12);
  }
}

TEST(ChainEquilibrium, OfTooFewJointsAndAtTypeTwoIsSingular) {
  const auto robot = three_rfr(PrbDiscretisation::even, 3);
  ChainState<Planar> state = [&] {
    ChainState<Planar> at_rest;
    EXPECT_TRUE(unloaded_equilibrium(robot, PlanarPose{0.01, 0, 0.3}, towards_plus, true, at_rest).ok());
    return at_rest;
  }();
  ChainWork work;
  EXPECT_EQ(equilibrium(robot, std::vector(state.hold), {0.01, 0, 0}, state, work).status, Status::singular);
  EXPECT_GT(smallest_hessian_eigenvalue(robot, state), 0);  // what little is left is stiff

  const auto six = three_rfr(PrbDiscretisation::even);
  ASSERT_TRUE(
      unloaded_equilibrium(six, PlanarPose{0.03, 0, std::numbers::pi / 3}, towards_plus, false, state).ok());
  EXPECT_EQ(equilibrium(six, std::vector(state.hold), {0.01, 0, 0}, state, work).status, Status::singular);
}

/// Where the fold is does not depend on the unit that the load is counted in.
TEST(ChainEquilibrium, AFoldIsFoundWhateverTheLimit) {
  for (const double limit : {0.02, 20.0, 1e8}) {
    ChainState<Planar> state;
    const auto path = path_to(PrbDiscretisation::even, {0, 0, 1}, limit, state);
    EXPECT_EQ(path.end, ChainLoadEnd::fold);
    EXPECT_NEAR(path.load, 6.3236e-3, 1e-6) << limit;
    EXPECT_LT(path.report.residual, 1e-13);
  }
}

ChainState<Planar> at_rest(const ChainLegs<Planar>& robot, const PlanarPose& pose) {
  ChainState<Planar> state;
  const Report report = unloaded_equilibrium(robot, pose, towards_plus, false, state);
  EXPECT_TRUE(report.ok()) << to_string(report);
  return state;
}

/// Nor does a limit far beyond lead over a fold onto the next branch, or a bifurcation to where it holds
/// again.
TEST(ChainEquilibrium, NothingIsSteppedOver) {
  const auto chains = [](const char* name) {
    const std::string file = std::string(source_folder) + "/robots/" + name;
    return chains_of<Planar>(
        *read_robot(*read_robot_file(file))->as(Model::prb, PrbDiscretisation::weighted));
  };
  struct Case {
    ChainLegs<Planar> robot;
    Vec<double, 3> direction;
    double load;
    ChainLoadEnd end;
  };
  for (const Case& one : {Case{chains("3-frr.yaml"), {0, -1, 0}, 0.0155017, ChainLoadEnd::fold},
                          Case{chains("3-rfr.yaml"), {0, 1, 0}, 1.115808, ChainLoadEnd::bifurcation}}) {
    for (const double share : {1.001, 1.3, 10.0, 1e5}) {
      ChainState<Planar> state = at_rest(one.robot, {0, 0, 0});
      ChainWork work;
      const auto path = follow_load(one.robot, one.direction, share * one.load, state, work);
      EXPECT_EQ(path.end, one.end) << to_string(path.end) << share;
      EXPECT_NEAR(path.load, one.load, 1e-6 * one.load) << share;
      EXPECT_NEAR(smallest_hessian_eigenvalue(one.robot, state), 0, 1e-6);
    }
  }
}

TEST(ChainEquilibrium, ALoadThatIsNoneGrowsWithoutEffect) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                   inf = std::numeric_limits<double>::infinity();
  ChainState<Planar> state;
  for (const double wrong : {nan, inf, -inf})
    EXPECT_EQ(path_to(PrbDiscretisation::even, {0, wrong, 1}, 1, state).report.status, Status::bad_input);
  EXPECT_EQ(path_to(PrbDiscretisation::even, {0, 0, 1}, nan, state).report.status, Status::bad_input);
  EXPECT_EQ(path_to(PrbDiscretisation::even, {0, 0, 0}, 7, state).load, 7);
  const PlanarPose before = state.pose;
  EXPECT_EQ(path_to(PrbDiscretisation::even, {0, 0, 1}, 0, state).load, 0);
  EXPECT_EQ(path_to(PrbDiscretisation::even, {0, 0, 1}, -1, state).load, 0);
  EXPECT_EQ(state.pose.x, before.x);
  const auto unbounded = path_to(PrbDiscretisation::even, {0, 0, 1}, inf, state);
  EXPECT_EQ(unbounded.end, ChainLoadEnd::fold);
  EXPECT_NEAR(unbounded.load, 6.3236e-3, 1e-6);
}

TEST(ChainEquilibrium, ALoadMayBeCountedInAnyUnit) {  // squares of 1e±300 are no numbers, or zero
  for (const double unit : {1e-300, 1e-200, 1e200, 1e300}) {
    ChainState<Planar> state;
    const auto path = path_to(PrbDiscretisation::even, {0, 0, unit}, 20 / unit, state);
    EXPECT_EQ(path.end, ChainLoadEnd::fold) << unit;
    EXPECT_NEAR(path.load * unit, 6.3236e-3, 1e-6) << unit;
  }
}

TEST(ChainEquilibrium, LegsOutOfReachAreNamed) {
  const auto robot = three_rfr(PrbDiscretisation::even);
  ChainState<Planar> state;
  const Report report = unloaded_equilibrium(robot, PlanarPose{0.3, 0, 0}, towards_plus, false, state);
  EXPECT_EQ(report.status, Status::unreachable);
  EXPECT_TRUE(report.message.view().starts_with("legs[")) << report.message.view();
}

TEST(ChainEquilibrium, ATendonThatWouldPushIsSlack) {
  const auto robot = three_rfr(PrbDiscretisation::even);
  ChainState<Planar> state = base_state(robot, true);
  ChainWork work;
  const Report report = equilibrium(robot, std::vector(state.hold), {0, 1.6, 0}, state, work);
  EXPECT_EQ(report.status, Status::slack) << to_string(report);
  EXPECT_TRUE(report.message.view().starts_with("legs[0]")) << report.message.view();
}

TEST(ChainEquilibrium, EvenlyBentChainsStoreMore) {
  for (const Json& c : reference_file("data/tdpcr/statics.json")["equilibria"]) {
    if (!c.contains("CC_restricted_pose")) continue;  // with lengths held it is rigid
    const auto robot = three_rfr(model_of(c));
    ChainState<Planar> state = base_state(robot), even = state;
    ChainWork work;
    EXPECT_NEAR(constant_curvature_energy_gap(robot, state, vector<3>(c["W"])),
                c["CC_energy_gap_estimate"].get<double>(), 1e-16);
    ASSERT_TRUE(equilibrium(robot, hold_of(c), vector<3>(c["W"]), state, work).ok());
    const Report report =
        equilibrium(robot, hold_of(c), vector<3>(c["W"]), even, work, {.evenly_bent = true});
    ASSERT_TRUE(report.ok()) << to_string(report);
    EXPECT_NEAR(even.pose.x, c["CC_restricted_pose"][0].get<double>(), 1e-10);
    EXPECT_NEAR(even.pose.y, c["CC_restricted_pose"][1].get<double>(), 1e-10);
    EXPECT_NEAR(even.pose.phi, c["CC_restricted_pose"][2].get<double>(), 1e-10);
    EXPECT_NEAR(potential(robot, even) - potential(robot, state), c["CC_energy_gap"].get<double>(), 1e-14);
  }
}

/// Where closures leave the joints of a leg nothing, tensions and forces alone take up the load.
TEST(ChainEquilibrium, PosesAreHeldByLegsWhoseJointsCannotTurn) {
  const Vec<double, 3> wrench(0.002, -0.001, 1e-6);
  for (const auto& [name, links] : {std::pair("3-rfr", 2), std::pair("3-frr", 1)}) {
    auto robot = chains_of<Planar>(*load(name)->as(Model::prb, PrbDiscretisation::weighted));
    for (auto& leg : robot.legs) leg.chain.links = links;
    ChainState<Planar> state;
    const PlanarPose pose{0.01, 0, 0.1};
    ASSERT_TRUE(unloaded_equilibrium(robot, pose, towards_plus, false, state).ok()) << name;
    ChainWork work;
    const Report report = inverse_statics(robot, wrench, state, work);
    ASSERT_TRUE(report.ok() || report.status == Status::slack) << name << ": " << to_string(report);
    Vec<double, 3> borne = Vec<double, 3>::Zero();
    const auto rates = chain_rates(robot, state.pose, std::span<const ChainLegState>(state.legs));
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec<double, 3> row = rates.J.row(static_cast<Eigen::Index>(i)).transpose();
      borne += state.legs[i].force * row / row.head<2>().norm();
    }
    EXPECT_LT((borne - wrench).norm(), 1e-11) << name;
  }
}

TEST(ChainEquilibrium, TensionsThatHoldAPoseAreTheirs) {
  const auto robot = three_rfr(PrbDiscretisation::even);
  for (const Json& c : reference_file("data/tdpcr/statics.json")["inverse_statics_M0"]) {
    ChainState<Planar> state;
    ASSERT_TRUE(unloaded_equilibrium(robot, planar_pose(c["pose"]), towards_plus, false, state).ok());
    ChainWork work;
    const Report report = inverse_statics(robot, vector<3>(c["W"]), state, work);
    ASSERT_TRUE(report.ok()) << to_string(report);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(state.legs[i].force, c["f"][i].get<double>(), 1e-9);
      EXPECT_NEAR(state.legs[i].tension[0], c["dT"][i].get<double>(), 1e-8);
      EXPECT_NEAR(state.legs[i].tendon_length[0], c["l1"][i].get<double>(), 1e-11);
      for (std::size_t j = 0; j < 5; ++j)
        EXPECT_NEAR(state.legs[i].angles[j], c["theta"][i][j].get<double>(), 1e-10);
    }
    // and back: these tensions and the wrench bring it there
    ChainState<Planar> again;
    ASSERT_TRUE(unloaded_equilibrium(robot, planar_pose(c["pose"]), towards_plus, false, again).ok());
    ASSERT_TRUE(equilibrium(robot, state.hold, vector<3>(c["W"]), again, work).ok());
    EXPECT_NEAR(again.pose.x, state.pose.x, 1e-11);
    EXPECT_NEAR(again.pose.phi, state.pose.phi, 1e-10);
  }
}

TEST(ChainEquilibrium, LinearModelIsTheirs) {  // @verifies TDPCR (44), (45), (46)
  for (const Json& c : reference_file("data/tdpcr/statics.json")["equilibria"]) {
    const auto robot = three_rfr(model_of(c));
    const auto state = base_state(robot, holds_lengths(c));
    const Vec<double, 3> move = linear_compliance(robot, state) * vector<3>(c["W"]);
    EXPECT_LT((move - vector<3>(c["dpose_linear"])).norm(), 1e-11 * move.norm());
  }
}

/// A robot of a file with the angles of a reference pose; directions of first links where they are inputs.
template <class Space>
void expect_rates(const char* name, const Json& pose, const typename Space::Pose& at) {
  const auto chains = read_robot(*read_robot_file(std::string(source_folder) + "/robots/" + name))
                          ->as(Model::prb, PrbDiscretisation::even);
  ASSERT_TRUE(chains.has_value()) << to_string(chains.error());
  auto robot = chains_of<Space>(*chains);
  std::vector<ChainLegState> legs(robot.legs.size());
  for (std::size_t i = 0; i < legs.size(); ++i) {
    const std::vector<double> theta = pose["theta"][i];
    std::copy(theta.begin(), theta.end(), legs[i].angles.begin());
    if constexpr (Space::dimension == 2)
      if (robot.has_base_motors)
        robot.legs[i].base = SE2<double>::from(robot.legs[i].base.p.x(), robot.legs[i].base.p.y(),
                                               pose["gamma1"][i].get<double>() - std::numbers::pi / 2);
  }
  const auto found = chain_rates(robot, at, legs);
  EXPECT_LT(found.closure_error, 1e-13);
  const Json& J = pose.contains("J_prb") ? pose["J_prb"] : pose["J"];
  const bool is_whole = pose.contains("K_theta");
  for (std::size_t i = 0; i < legs.size(); ++i) {
    for (int k = 0; k < Space::dof; ++k)
      EXPECT_NEAR(found.J(static_cast<Eigen::Index>(i), k), J[i][static_cast<std::size_t>(k)].get<double>(),
                  1e-13);
    const auto columns = static_cast<std::size_t>(found.columns[i]);
    for (std::size_t j = 0; j < columns; ++j)
      EXPECT_NEAR(
          found.K[i][j],
          (is_whole ? pose["K_theta"][i][columns * i + j] : pose["K_theta_blocks"][i][j]).get<double>(),
          1e-13);
  }
}

TEST(ChainRates, AreTheirs) {  // @verifies TDPCR (34), (36)-(38), (60)-(62)
  const Json& all = reference_file("data/tdpcr/poses.json");
  for (const auto& [name, file] :
       {std::pair("3-RFR", "3-rfr.yaml"), {"3-FRR", "3-frr.yaml"}, {"3-RFRR", "3-rfrr.yaml"}})
    for (const Json& pose : all[name]["poses"]) expect_rates<Planar>(file, pose, planar_pose(pose["pose"]));
  for (const Json& pose : all["6-UFS"]["poses"]) {
    const SO3<double> R = SO3<double>::exp(vector<3>(pose["rotvec"]));
    expect_rates<Spatial>("6-ufs.yaml", pose, spatial_pose(SE3<double>{vector<3>(pose["p"]), R}));
  }
}

TEST(ChainEquilibrium, TipWrenchesAreTheirs) {  // @verifies TDPCR (54), (55)
  for (const Json& c : reference_file("data/tdpcr/statics.json")["equilibria"]) {
    if (c["model"] != "M0") continue;
    const auto robot = three_rfr(PrbDiscretisation::even);
    for (std::size_t i = 0; i < 3; ++i) {
      const PseudoRigid& chain = robot.legs[i].chain;
      std::vector<double> angles = c["theta"][i], torques;
      for (std::size_t j = 0; j < angles.size(); ++j)
        torques.push_back(robot.legs[i].spring(static_cast<int>(j)) * angles[j]);
      const TipWrench found = tip_wrench(chain, torques, angles);
      EXPECT_NEAR(found.moment, c["tip_wrench"][i]["Ft"][2].get<double>(), 1e-11);
      EXPECT_NEAR(found.force.norm(), std::abs(c["chord_force"][i].get<double>()), 1e-9);
      EXPECT_LT(found.closure_error, 1e-12);
    }
  }
}

}  // namespace chain_equilibrium_test
}  // namespace sinew::test
