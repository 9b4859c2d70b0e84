/// Joints of chains along a path of the platform: the numbers of an independent implementation, and what the
/// flow must keep.
#include "kinematics/chains/chain_motion.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "paths.hpp"
#include "reference_file.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::test {
namespace chain_motion_test {

template <class Space>
ChainLegs<Space> made_of(const char* file, PrbDiscretisation model = PrbDiscretisation::even) {
  const auto chains =
      read_robot(*read_robot_file(std::string(source_folder) + "/robots/" + file))->as(Model::prb, model);
  EXPECT_TRUE(chains.has_value()) << to_string(chains.error());
  return chains_of<Space>(*chains);
}

PlanarPose pose_of(int k) { return {0.03 * k / 59, 0, std::numbers::pi / 3 * k / 59}; }

std::vector<ChainLegState> at_start(const ChainLegs<Planar>& robot) {
  ChainState<Planar> state;
  const std::array<double, 3> towards_plus{1, 1, 1};
  EXPECT_TRUE(unloaded_equilibrium(robot, pose_of(0), towards_plus, false, state).ok());
  return state.legs;
}

double gap(const ChainLegs<Planar>& robot, std::span<const ChainLegState> a,
           std::span<const ChainLegState> b) {
  double gap = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < static_cast<std::size_t>(robot.legs[i].chain.joints()); ++j)
      gap = std::max(gap, std::abs(a[i].angles[j] - b[i].angles[j]));
  return gap;
}

TEST(ChainMotion, AlongTheExampleIsTheirs) {
  const nlohmann::json& reference = reference_file("data/tdpcr/example51.json");
  auto robot = made_of<Planar>("3-rfr.yaml");
  auto legs = at_start(robot);
  int k = 0;
  const auto go_to = [&](int next) {
    const Report report = follow_least_norm(robot, pose_of(k), pose_of(next), legs);
    ASSERT_TRUE(report.ok()) << to_string(report);
    EXPECT_LT(report.residual, 1e-15);
    k = next;
  };
  const auto expect_angles = [&](const nlohmann::json& theirs) {
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 5; ++j) EXPECT_NEAR(legs[i].angles[j], theirs[i][j].get<double>(), 1e-13);
  };
  for (const nlohmann::json& row : reference["PRB"]) {
    go_to(row["k"]);
    expect_angles(row["theta"]);
  }
  go_to(59);  // the singular pose is no obstacle: the flow knows chords, not J
  expect_angles(reference["PRB_theta_at_k59"]);
}

/// Tendon lengths of least-norm shapes, and chord forces that (54) reads from them, are not those of statics.
TEST(ChainMotion, LeastNormShapesAreNoEquilibria) {  // @verifies TDPCR (54)
  const nlohmann::json& statics = reference_file("data/tdpcr/statics.json");
  const nlohmann::json& lengths =
      reference_file("data/tdpcr/statics2.json")["tendon_lengths_min_norm_vs_static"];
  auto robot = made_of<Planar>("3-rfr.yaml");
  const std::array<double, 3> towards_plus{1, 1, 1};
  for (const nlohmann::json& row : lengths) {
    auto legs = at_start(robot);
    const int k = row["k"];
    ASSERT_TRUE(follow_least_norm(robot, pose_of(0), pose_of(k), legs).ok());
    ChainState<Planar> even, weighted;
    ASSERT_TRUE(unloaded_equilibrium(robot, pose_of(k), towards_plus, false, even).ok());
    ASSERT_TRUE(unloaded_equilibrium(made_of<Planar>("3-rfr.yaml", PrbDiscretisation::weighted), pose_of(k),
                                     towards_plus, false, weighted)
                    .ok());
    for (std::size_t i = 0; i < 3; ++i) {
      const PseudoRigid& chain = robot.legs[i].chain;
      EXPECT_NEAR(chain.tendon_length(legs[i].of(chain), 0.005, 1), row["l1_min_norm"][i].get<double>(),
                  1e-13);
      EXPECT_NEAR(even.legs[i].tendon_length[0], row["l1_static"][i].get<double>(), 1e-13);
      EXPECT_NEAR(weighted.legs[i].tendon_length[0], row["l1_static_tributary"][i].get<double>(), 1e-13);
    }
    for (const nlohmann::json& c : statics["eq54_on_min_norm_shapes"]) {
      if (c["k"] != k) continue;
      const auto i = c["leg"].get<std::size_t>() - 1;
      const PseudoRigid& chain = robot.legs[i].chain;
      const auto angles = legs[i].of(chain);
      std::vector<double> torques;
      for (std::size_t j = 0; j < 5; ++j)
        torques.push_back(robot.legs[i].spring(static_cast<int>(j)) * angles[j]);
      const TipWrench found = tip_wrench(chain, torques, angles);
      const Vec2<double> u = chain.tip(angles).position;
      EXPECT_NEAR(dot(found.force, u) / u.norm(), c["chord_force"].get<double>(), 1e-10);
      EXPECT_NEAR(cross(found.force, u), 0, 1e-10);
      EXPECT_NEAR(found.moment, c["Ft"][2].get<double>(), 1e-12);
      EXPECT_NEAR(found.closure_error, c["rel_residual"].get<double>(), 1e-10);
    }
  }
}

TEST(ChainMotion, DependsOnTheChordsAlone) {
  auto robot = made_of<Planar>("3-rfr.yaml");
  auto straight = at_start(robot), around = straight;
  ASSERT_TRUE(follow_least_norm(robot, pose_of(0), pose_of(50), straight).ok());
  const PlanarPose away{-0.01, 0.01, -0.1};
  ASSERT_TRUE(follow_least_norm(robot, pose_of(0), away, around).ok());
  ASSERT_TRUE(follow_least_norm(robot, away, pose_of(50), around).ok());
  EXPECT_LT(gap(robot, straight, around), 1e-12);
  ASSERT_TRUE(follow_least_norm(robot, pose_of(50), pose_of(0), around).ok());
  EXPECT_LT(gap(robot, around, at_start(robot)), 1e-12);
}

TEST(ChainMotion, RungeKuttaOfThePaperDriftsALittle) {
  auto robot = made_of<Planar>("3-rfr.yaml");
  auto exact = at_start(robot), theirs = exact;
  double drift = 0;
  for (int k = 0; k < 59; ++k) {
    ASSERT_TRUE(follow_least_norm(robot, pose_of(k), pose_of(k + 1), exact).ok());
    const Report report = follow_least_norm(robot, pose_of(k), pose_of(k + 1), theirs, {.rk4_steps = 1});
    ASSERT_TRUE(report.ok()) << to_string(report);
    drift = std::max(drift, report.residual);
  }
  EXPECT_LT(drift, 1e-9);
  EXPECT_GT(drift, 1e-12);
  EXPECT_LT(gap(robot, exact, theirs), 1e-8);
}

double energy(const ChainLegs<Planar>& robot, std::span<const ChainLegState> legs) {
  double sum = 0;
  for (std::size_t i = 0; i < legs.size(); ++i)
    for (int j = 0; j < robot.legs[i].chain.joints(); ++j)
      sum += 0.5 * robot.legs[i].spring(j) * std::pow(legs[i].angles[static_cast<std::size_t>(j)], 2);
  return sum;
}

double largest_angle(const ChainLegs<Planar>& robot, std::span<const ChainLegState> legs) {
  double most = 0;
  for (std::size_t i = 0; i < legs.size(); ++i)
    for (std::size_t j = 0; j < static_cast<std::size_t>(robot.legs[i].chain.joints()); ++j)
      most = std::max(most, std::abs(legs[i].angles[j]));
  return most;
}

TEST(ChainMotion, ObjectivesUseTheFreedomLeft) {
  auto robot = made_of<Planar>("3-rfr.yaml");
  const auto follow = [&](Objective objective) {
    auto legs = at_start(robot);
    for (int k = 0; k < 50; ++k) {
      const Report report =
          follow_least_norm(robot, pose_of(k), pose_of(k + 1), legs, {.objective = objective});
      EXPECT_TRUE(report.ok()) << to_string(report);
      EXPECT_LT(report.residual, 1e-14);
    }
    return legs;
  };
  const auto least = follow(Objective::none), smooth = follow(Objective::smooth),
             limits = follow(Objective::limits);
  EXPECT_LT(energy(robot, smooth), energy(robot, least));
  EXPECT_LT(largest_angle(robot, limits), largest_angle(robot, least));
  // of one chord least energy is that of a column that its chord alone bends: spring moments along g
  const auto rates = chain_rates(robot, pose_of(50), smooth);
  for (std::size_t i = 0; i < 3; ++i) {
    double along = 0, moments = 0, slopes = 0;
    for (std::size_t j = 0; j < 5; ++j) {
      const double moment = robot.legs[i].spring(static_cast<int>(j)) * smooth[i].angles[j];
      along += moment * rates.K[i][j], moments += moment * moment, slopes += rates.K[i][j] * rates.K[i][j];
    }
    EXPECT_GT(along * along, 0.99 * moments * slopes);
  }
}

TEST(ChainMotion, MotorsAtTheBaseMoveToo) {
  const nlohmann::json& c = reference_file("data/tdpcr/poses.json")["3-RFRR"]["poses"][0];
  auto robot = made_of<Planar>("3-rfrr.yaml");
  std::vector<ChainLegState> legs(3);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::vector<double> theta = c["theta"][i];
    std::copy(theta.begin(), theta.end(), legs[i].angles.begin());
    robot.legs[i].base = SE2<double>::from(robot.legs[i].base.p.x(), robot.legs[i].base.p.y(),
                                           c["gamma1"][i].get<double>() - std::numbers::pi / 2);
  }
  const PlanarPose from{c["pose"][0], c["pose"][1], c["pose"][2]}, to{from.x + 0.01, from.y, from.phi + 0.1};
  const auto before = legs;
  const double angle = robot.legs[0].base.angle();
  const Report report = follow_least_norm(robot, from, to, legs);
  ASSERT_TRUE(report.ok()) << to_string(report);
  EXPECT_LT(chain_rates(robot, to, legs).closure_error, 1e-15);
  EXPECT_GT(std::abs(robot.legs[0].base.angle() - angle), 1e-4);
  ASSERT_TRUE(follow_least_norm(robot, to, from, legs).ok());
  EXPECT_LT(chain_rates(robot, from, legs).closure_error, 1e-15);
  EXPECT_LT(gap(robot, legs, before), 1e-11);
}

TEST(ChainMotion, OfSixLegsInSpaceStaysClosed) {
  auto robot = made_of<Spatial>("6-ufs.yaml");
  SpatialPose from, to;
  from.position = {0, 0, 0.18};
  to = spatial_pose(SE3<double>{{0.01, -0.005, 0.17}, SO3<double>::exp(Vec3<double>(0.05, 0.1, -0.08))});
  ChainState<Spatial> state;
  const std::array<double, 6> towards_plus{1, 1, 1, 1, 1, 1};
  ASSERT_TRUE(unloaded_equilibrium(robot, from, towards_plus, false, state).ok());
  const Report report = follow_least_norm(robot, from, to, state.legs);
  ASSERT_TRUE(report.ok()) << to_string(report);
  EXPECT_LT(chain_rates(robot, to, state.legs).closure_error, 1e-15);
}

TEST(ChainMotion, SaysWhereAChainCannotFollow) {
  auto robot = made_of<Planar>("3-rfr.yaml");
  std::vector<ChainLegState> straight(3);
  EXPECT_EQ(follow_least_norm(robot, pose_of(0), pose_of(1), straight).status, Status::singular);
  auto legs = at_start(robot);
  const Report report = follow_least_norm(robot, pose_of(0), PlanarPose{0.2, 0, 0}, legs);
  EXPECT_EQ(report.status, Status::unreachable) << to_string(report);
  EXPECT_NE(report.message.view().find("legs["), std::string_view::npos);
}

}  // namespace chain_motion_test
}  // namespace sinew::test
