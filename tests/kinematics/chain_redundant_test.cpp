/// Platforms on more, or fewer, chains than they have freedoms.
#include <gtest/gtest.h>

#include <numbers>

#include "analysis/chain_velocity.hpp"
#include "base/limits.hpp"
#include "chain_robots.hpp"
#include "kinematics/chains/chain.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::test {
namespace chain_redundant_test {

template <class Space>
using Case = ChainsAt<Space>;

/// The same legs once more.
template <class Space>
Case<Space> doubled(Case<Space> one) {
  const auto legs = one.robot.legs;
  one.robot.legs.insert(one.robot.legs.end(), legs.begin(), legs.end());
  const auto curvature = one.curvature;
  one.curvature.insert(one.curvature.end(), curvature.begin(), curvature.end());
  return one;
}

/// Four legs that do not meet in a point, or seven.
Case<Planar> four_legs() {
  Case<Planar> one = chains_at<Planar>("3-rfr", PrbDiscretisation::weighted, {0.01, 0, 0.3});
  auto leg = one.robot.legs[0];
  leg.base = SE2<double>::from(-0.15, 0.12, 0);
  leg.platform_point = Vec2<double>(-0.02, 0.05);
  one.robot.legs.push_back(leg);
  one.curvature.push_back(5);
  return one;
}
Case<Spatial> seven_legs() {
  Case<Spatial> one = chains_at<Spatial>("6-ufs", PrbDiscretisation::weighted, reached_by_6_ufs());
  auto leg = one.robot.legs[0];
  leg.base.p += Vec3<double>(-0.03, 0.02, 0);
  one.robot.legs.push_back(leg);
  one.curvature.push_back(one.curvature[0]);
  return one;
}

template <class Space>
Vec<double, Space::dof> some_wrench() {
  Vec<double, Space::dof> wrench = Vec<double, Space::dof>::Constant(2e-4);
  wrench[0] = 0.012, wrench[1] = -0.008;
  return wrench;
}

/// Each leg bears half of twice the load: all numbers of the robot with single legs are told once more.
template <class Space>
void expect_twice(const char* name, PrbDiscretisation model, const typename Space::Pose& pose) {
  const Case<Space> one = chains_at<Space>(name, model, pose), two = doubled(one);
  const std::size_t legs = one.robot.legs.size();
  const Vec<double, Space::dof> wrench = some_wrench<Space>();
  ChainWork work;
  for (const bool holds_lengths : {false, true})
    for (const bool is_pose_held : {false, true}) {
      ChainState<Space> a, b;
      ASSERT_TRUE(unloaded_equilibrium(one.robot, pose, one.curvature, holds_lengths, a).ok());
      ASSERT_TRUE(unloaded_equilibrium(two.robot, pose, two.curvature, holds_lengths, b).ok());
      EXPECT_NEAR(constant_curvature_energy_gap(two.robot, b, 2 * wrench) /
                      constant_curvature_energy_gap(one.robot, a, wrench),
                  2, 1e-9);
      const auto linear = linear_compliance(one.robot, a), half = linear_compliance(two.robot, b);
      EXPECT_LT((linear - 2 * half).norm(), 1e-10 * linear.norm());
      if (is_pose_held) {
        ASSERT_TRUE(inverse_statics(one.robot, wrench, a, work).ok());
        ASSERT_TRUE(inverse_statics(two.robot, 2 * wrench, b, work).ok());
      } else {
        ASSERT_TRUE(equilibrium(one.robot, std::vector(a.hold), wrench, a, work).ok());
        ASSERT_TRUE(equilibrium(two.robot, std::vector(b.hold), 2 * wrench, b, work).ok());
      }
      EXPECT_LT(twist_between(a.pose, b.pose).norm(), 1e-11);
      for (std::size_t i = 0; i < 2 * legs; ++i) {
        EXPECT_NEAR(a.legs[i % legs].force, b.legs[i].force, 1e-10);
        for (std::size_t k = 0; k < 2; ++k) {
          EXPECT_NEAR(a.legs[i % legs].tension[k], b.legs[i].tension[k], 1e-8);
          EXPECT_NEAR(a.legs[i % legs].tendon_length[k], b.legs[i].tendon_length[k], 1e-11);
        }
      }
      const auto S = stiffness(one.robot, a, work), twice = stiffness(two.robot, b, work);
      EXPECT_LT((2 * S - twice).norm(), 1e-8 * twice.norm());
      EXPECT_GT(smallest_hessian_eigenvalue(two.robot, b), 0);
    }
}

TEST(RedundantChains, BearTwiceTheLoadWithTwiceTheLegs) {
  SpatialPose high;
  high.position = {0.01, 0, 0.18};
  for (const PrbDiscretisation model :
       {PrbDiscretisation::even, PrbDiscretisation::weighted, PrbDiscretisation::discs}) {
    expect_twice<Planar>("3-rfr", model, {0.01, 0, 0.3});
    expect_twice<Planar>("3-frr", model, {0, 0, 0.1});
    expect_twice<Spatial>("6-ufs", model, high);
  }
}

/// ∂(pose)/∂(wrench) of unlike legs against differences, and a pose that is held against what then holds it.
template <class Space>
void expect_consistent(const Case<Space>& one) {
  constexpr int dof = Space::dof;
  using Wrench = Vec<double, dof>;
  ChainWork work;
  const Wrench wrench = some_wrench<Space>();
  for (const bool holds_lengths : {false, true}) {
    ChainState<Space> state;
    ASSERT_TRUE(unloaded_equilibrium(one.robot, one.pose, one.curvature, holds_lengths, state).ok());
    const ChainState<Space> at_rest = state;
    const Report held = inverse_statics(one.robot, wrench, state, work);
    ASSERT_TRUE(held.ok()) << to_string(held);
    EXPECT_LT(held.residual, 1e-12);
    ChainState<Space> free = at_rest;
    ASSERT_TRUE(equilibrium(one.robot, std::vector(state.hold), wrench, free, work).ok());
    EXPECT_LT(twist_between(free.pose, state.pose).norm(), 1e-9);  // tensions hold what was held

    const auto C = compliance(one.robot, state, work);
    for (int k = 0; k < dof; ++k) {
      ChainState<Space> up = state, down = state;
      const Wrench step = 1e-6 * Wrench::Unit(k);
      ASSERT_TRUE(equilibrium(one.robot, std::vector(state.hold), wrench + step, up, work).ok());
      ASSERT_TRUE(equilibrium(one.robot, std::vector(state.hold), wrench - step, down, work).ok());
      const Wrench slope = twist_between(down.pose, up.pose) / 2e-6;
      EXPECT_LT((C.col(k) - slope).norm(), 1e-6 * slope.norm());
    }
  }
}

/// Of all tensions that hold the pose these are the nearest to those at rest: other ones, found by asking for
/// what is near to others, are farther away.
template <class Space>
void expect_nearest(const Case<Space>& one) {
  ChainWork work;
  ChainState<Space> at_rest;
  ASSERT_TRUE(unloaded_equilibrium(one.robot, one.pose, one.curvature, false, at_rest).ok());
  const auto change = [&](const ChainState<Space>& from) {
    ChainState<Space> state = from;
    EXPECT_TRUE(inverse_statics(one.robot, some_wrench<Space>(), state, work).ok());
    double sum = 0;
    for (std::size_t i = 0; i < state.legs.size(); ++i)
      for (std::size_t k = 0; k < 2; ++k)
        sum += std::pow(state.legs[i].tension[k] - at_rest.legs[i].tension[k], 2);
    return sum;
  };
  const double least = change(at_rest);
  for (const std::size_t leg : {std::size_t{0}, one.robot.legs.size() - 1})
    for (const double size : {-1e-2, 1e-2}) {
      ChainState<Space> other = at_rest;
      const std::size_t inner = other.legs[leg].tension[0] > 0 ? 0 : 1;
      other.legs[leg].tension[inner] += size;  // no equilibrium: where the search begins, and should end near
      const double more = change(other);
      EXPECT_GT(more, least);
      EXPECT_LT(more, least + 1e-3);
    }
}

TEST(RedundantChains, HoldAPoseWithTheTensionsNearestToThoseAtRest) {
  expect_consistent(four_legs());
  expect_consistent(seven_legs());
  expect_nearest(four_legs());
  expect_nearest(seven_legs());
}

TEST(RedundantChains, HaveNoSensitivitiesOfTheirJoints) {
  const Case<Planar> one = four_legs();
  ChainState<Planar> state;
  ASSERT_TRUE(unloaded_equilibrium(one.robot, one.pose, one.curvature, false, state).ok());
  const auto found = chain_velocity(one.robot, one.pose, state.legs);
  EXPECT_TRUE(found.report.ok());
  EXPECT_FALSE(found.has_inverse);
  EXPECT_TRUE(std::isnan(found.determinant));
  EXPECT_EQ(found.rates.J.rows(), 4);
  const Vec<double, 3> twist(1, 0.5, -2);
  const std::vector<double> joint_rates = least_norm_rates(found, twist);
  ASSERT_EQ(joint_rates.size(), 20U);
  for (std::size_t i = 0, k = 0; i < 4; ++i) {
    double moved = 0;
    for (std::size_t j = 0; j < 5; ++j) moved += found.rates.K[i][j] * joint_rates[k++];
    EXPECT_NEAR(moved, found.rates.J.row(static_cast<Eigen::Index>(i)).dot(twist), 1e-12) << i;
  }
}

TEST(FewChains, LeaveThePlatformFree) {
  Case<Planar> one = chains_at<Planar>("3-rfr", PrbDiscretisation::weighted, {0.01, 0, 0.3});
  ChainWork work;
  for (const std::size_t legs : {2U, 1U}) {
    one.robot.legs.resize(legs);
    one.curvature.resize(legs);
    ChainState<Planar> state;
    ASSERT_TRUE(unloaded_equilibrium(one.robot, one.pose, one.curvature, false, state).ok());
    EXPECT_EQ(chain_velocity(one.robot, one.pose, state.legs).report.status, Status::singular);
    for (const Vec<double, 3>& wrench : {Vec<double, 3>(0, 0, 0), Vec<double, 3>(0.01, 0, 0)}) {
      ChainState<Planar> moved = state;
      EXPECT_EQ(equilibrium(one.robot, std::vector(state.hold), wrench, moved, work).status,
                Status::singular);
      EXPECT_EQ(inverse_statics(one.robot, wrench, moved, work).status, Status::unreachable);
      EXPECT_EQ(follow_load(one.robot, wrench, 1, moved, work).report.status, Status::singular);
    }
    EXPECT_FALSE(smallest_hessian_eigenvalue(one.robot, state) > 1e-9);
    EXPECT_FALSE(std::isfinite(constant_curvature_energy_gap(one.robot, state, Vec<double, 3>(0.01, 0, 0))));
    EXPECT_FALSE(linear_compliance(one.robot, state).allFinite());
  }
}

TEST(ManyChains, AreSolvedButHaveNoRates) {
  Case<Planar> one = four_legs();
  while (one.robot.legs.size() <= static_cast<std::size_t>(max_rows)) one = doubled(one);
  ChainState<Planar> state;
  ASSERT_TRUE(unloaded_equilibrium(one.robot, one.pose, one.curvature, false, state).ok());
  ChainWork work;
  EXPECT_TRUE(equilibrium(one.robot, std::vector(state.hold), some_wrench<Planar>(), state, work).ok());
  EXPECT_TRUE(std::isnan(chain_rates(one.robot, one.pose, state.legs).closure_error));
  EXPECT_EQ(chain_velocity(one.robot, one.pose, state.legs).report.status, Status::bad_input);
  EXPECT_TRUE(std::isnan(constant_curvature_energy_gap(one.robot, state, some_wrench<Planar>())));
}

}  // namespace chain_redundant_test
}  // namespace sinew::test
