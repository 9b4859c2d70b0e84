/// Curves of equilibria on chains: their points are equilibria, their folds those of growing loads.
#include "kinematics/chains/chain_curve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "chain_robots.hpp"
#include "kinematics/chains/chain_analysis.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::test {
namespace chain_curve_test {

template <class Space>
struct Begun {
  ChainsAt<Space> at;
  ChainState<Space> state;
};

template <class Space>
Begun<Space> begun(const char* name, PrbDiscretisation model, const typename Space::Pose& pose,
                   bool holds_lengths) {
  Begun<Space> one{chains_at<Space>(name, model, pose), {}};
  EXPECT_TRUE(unloaded_equilibrium(one.at.robot, pose, one.at.curvature, holds_lengths, one.state).ok());
  return one;
}

const PlanarPose planar_pose{0.01, 0, 0.35};

/// What legs hold at a parameter of a curve.
std::vector<TendonConstraint> held_at(const std::vector<TendonConstraint>& from,
                                      const std::vector<TendonConstraint>& to, double part) {
  std::vector<TendonConstraint> hold = from;
  for (std::size_t i = 0; i < to.size(); ++i) {
    hold[i].length = std::lerp(from[i].length, to[i].length, part);
    for (std::size_t k = 0; k < 2; ++k)
      hold[i].tension[k] = std::lerp(from[i].tension[k], to[i].tension[k], part);
  }
  return hold;
}

/// Every point is in equilibrium with what it is to hold, by the solver of single ones.
template <class Space>
void expect_equilibria(const Begun<Space>& one, const ChainCurveOptions<Space>& how,
                       const ChainCurve<Space>& curve) {
  for (const auto& point : curve.points) {
    SCOPED_TRACE(point.parameter);
    const std::vector<TendonConstraint> hold = held_at(one.state.hold, how.hold, point.parameter);
    ChainState<Space> state = point.state;
    ChainWork work;
    const Vec<double, Space::dof> wrench = one.state.wrench + point.parameter * how.added_wrench;
    EXPECT_LT((state.wrench - wrench).norm(), 1e-12);
    if (point.event == CurveEvent::fold || point.event == CurveEvent::bifurcation)
      continue;  // singular there
    ASSERT_TRUE(is_equilibrium(equilibrium(one.at.robot, hold, wrench, state, work)));
    EXPECT_LT(twist_between(state.pose, point.state.pose).norm(), 1e-8);
    EXPECT_EQ(check_stability(one.at.robot, point.state, work).unstable_directions,
              point.unstable_directions);
    EXPECT_LT(point.residual, 1e-9);
  }
}

template <class Space>
const ChainCurvePoint<Space>* first_of(const ChainCurve<Space>& curve, CurveEvent event) {
  const auto found = std::ranges::find(curve.points, event, &ChainCurvePoint<Space>::event);
  return found == curve.points.end() ? nullptr : &*found;
}

TEST(ChainCurves, TurnBackWhereAGrowingMomentFolds) {
  for (const bool holds_lengths : {false, true}) {
    const auto one = begun<Planar>("3-rfr", PrbDiscretisation::weighted, planar_pose, holds_lengths);
    const Vec3<double> moment(0, 0, 0.05);
    ChainWork work;
    ChainState<Planar> grown = one.state;
    const ChainLoadPath load = follow_load(one.at.robot, moment, 1, grown, work);
    ASSERT_EQ(load.end, ChainLoadEnd::fold);
    ChainCurveOptions<Planar> how{.added_wrench = moment, .lowest = -0.2};
    how.max_points = 200;
    const auto curves = chain_curves(one.at.robot, one.state, how, work);
    ASSERT_EQ(curves.size(), 1u);
    const auto* fold = first_of(curves[0], CurveEvent::fold);
    ASSERT_TRUE(fold);
    EXPECT_NEAR(fold->parameter, load.load, 1e-8);
    const auto beyond =
        std::ranges::find_if(curves[0].points, [&](const auto& point) { return &point > fold; });
    ASSERT_NE(beyond, curves[0].points.end());
    EXPECT_EQ(beyond->unstable_directions, fold->unstable_directions + 1);
    EXPECT_LT(beyond->parameter, fold->parameter);
    expect_equilibria(one, how, curves[0]);
  }
}

TEST(ChainCurves, FollowWhatTendonsHold) {
  for (const bool holds_lengths : {false, true}) {
    const auto one = begun<Planar>("3-rfr", PrbDiscretisation::weighted, planar_pose, holds_lengths);
    ChainCurveOptions<Planar> how{.hold = one.state.hold, .added_wrench = Vec3<double>(0.005, 0, 0)};
    for (TendonConstraint& hold : how.hold) {
      hold.length -= 0.004;
      for (double& tension : hold.tension) tension *= 1.2;
    }
    ChainWork work;
    const auto curves = chain_curves(one.at.robot, one.state, how, work);
    ASSERT_EQ(curves.size(), 1u);
    const auto* target = first_of(curves[0], CurveEvent::target);
    ASSERT_TRUE(target);
    ChainState<Planar> state = one.state;
    ASSERT_TRUE(is_equilibrium(equilibrium(one.at.robot, how.hold, how.added_wrench, state, work)));
    EXPECT_LT(twist_between(state.pose, target->state.pose).norm(), 1e-9);
    expect_equilibria(one, how, curves[0]);
  }
}

TEST(ChainCurves, FollowLoadsInSpace) {
  const auto one = begun<Spatial>("6-ufs", PrbDiscretisation::weighted, reached_by_6_ufs(), true);
  ChainCurveOptions<Spatial> how{.max_points = 60};
  how.added_wrench << 0.05, 0.02, -0.3, 0, 0, 0;
  ChainWork work;
  const auto curves = chain_curves(one.at.robot, one.state, how, work);
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_GT(curves[0].points.size(), 3u);
  expect_equilibria(one, how, curves[0]);
}

TEST(ChainCurves, RefuseWhatLeadsNowhere) {
  const auto one = begun<Planar>("3-rfr", PrbDiscretisation::weighted, planar_pose, true);
  ChainWork work;
  const auto is_refused = [&](const ChainCurveOptions<Planar>& how) {
    return chain_curves(one.at.robot, one.state, how, work).empty();
  };
  const Vec3<double> load(0, 0, 1e-3);
  const double none = std::nan("");
  EXPECT_TRUE(is_refused({}));
  EXPECT_TRUE(is_refused({.hold = one.state.hold}));
  EXPECT_TRUE(is_refused({.hold = {one.state.hold[0]}, .added_wrench = load}));
  EXPECT_TRUE(is_refused({.added_wrench = Vec3<double>(none, 0, 0)}));
  EXPECT_TRUE(is_refused({.added_wrench = load, .lowest = 0.5}));
  EXPECT_TRUE(is_refused({.added_wrench = load, .highest = none}));
  EXPECT_TRUE(is_refused({.added_wrench = load, .max_points = 0}));
  auto other = one.state.hold;
  other[1].length_of = 1 - other[1].length_of;
  EXPECT_TRUE(is_refused({.hold = other, .added_wrench = load}));
  other = one.state.hold;
  other[2].length = 10;
  EXPECT_TRUE(is_refused({.hold = other}));
  ChainState<Planar> foreign = one.state;
  foreign.legs.pop_back();
  EXPECT_TRUE(chain_curves(one.at.robot, foreign, {.added_wrench = load}, work).empty());
}

}  // namespace chain_curve_test
}  // namespace sinew::test
