/// Stability as a count, margins, and what inputs do to an equilibrium of chains.
#include "kinematics/chains/chain_analysis.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <limits>

#include "chain_robots.hpp"
#include "kinematics/chains/chain_equilibria.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::test {
namespace chain_analysis_test {

template <class Space>
struct Case {
  ChainLegs<Space> robot;
  ChainState<Space> state;
};

/// At rest at a pose on a branch, lengths held or tensions.
template <class Space>
Case<Space> rest_of(const char* name, PrbDiscretisation model, const typename Space::Pose& pose,
                    const std::vector<int>& bending, bool holds_lengths) {
  const Robot any = *load(name);
  Workspace memory(any);
  InverseOptions options;
  const std::vector<double> bent{3, -4, 5};
  const bool has_motors = std::string_view(name) == "3-rfrr";
  if (has_motors)
    options.curvature = bent;
  else
    options.bending = bending;
  const Inverse arcs = inverse(any, pose, options, memory);
  EXPECT_TRUE(arcs.ok()) << name;
  Case<Space> one{chains_of<Space>(*any.as(Model::prb, model)), {}};
  const std::vector<double> coordinates(arcs.coordinates.begin(), arcs.coordinates.end());
  std::vector<double> curvature;
  for (std::size_t i = 0; i < one.robot.legs.size(); ++i) {
    curvature.push_back(coordinates[has_motors ? 2 * i + 1 : i]);
    if constexpr (Space::dimension == 2)
      if (has_motors) {
        auto& base = one.robot.legs[i].base;
        base = SE2<double>::from(base.p.x(), base.p.y(), coordinates[2 * i] - 1.6);
      }
  }
  EXPECT_TRUE(unloaded_equilibrium(one.robot, pose, curvature, holds_lengths, one.state).ok()) << name;
  return one;
}

/// By the inertia of a Schur complement the whole has as many unstable directions as the platform, legs
/// eliminated, and the legs with the platform held.
void expect_counted(const Case<Planar>& one, int& unstable, int& unstable_legs) {
  ChainWork work;
  const auto found = check_stability(one.robot, one.state, work);
  EXPECT_EQ(found.smallest_eigenvalue, smallest_hessian_eigenvalue(one.robot, one.state));
  EXPECT_EQ(found.unstable_directions > 0, found.smallest_eigenvalue < 0);
  const int platform = static_cast<int>(found.unstable.size()),
            legs = static_cast<int>(found.unstable_legs.size());
  EXPECT_GE(found.unstable_directions, platform + legs);
  if (legs == 0) {
    EXPECT_EQ(found.unstable_directions, platform);
  }
  const auto S = stiffness(one.robot, one.state, work);
  for (const auto& twist : found.unstable) {
    EXPECT_LT(twist.dot(S * twist), 0);
    EXPECT_NEAR(std::hypot(twist[0], twist[1], twist[2] * 0.2), 1, 1e-12);
  }
  unstable += found.unstable_directions > 0;
  unstable_legs += legs > 0;
}

TEST(ChainStability, CountsThePlatformAndTheLegs) {
  int unstable = 0, unstable_legs = 0, solved = 0;
  for (const bool holds_lengths : {false, true})
    for (const PlanarPose& pose :
         {PlanarPose{0, 0, 0}, PlanarPose{0.01, 0, 0.3}, PlanarPose{0.047, -0.0118, 1.145}})
      for (const double load : {0.0, 0.01, 0.1, 0.5, 1.0, 1.6, 3.0, 10.0})
        for (int way = 0; way < 8; ++way) {
          const int sign = way % 2 == 0 ? 1 : -1;
          Case<Planar> one =
              rest_of<Planar>("3-rfr", PrbDiscretisation::weighted, pose, {sign, sign, sign}, holds_lengths);
          ChainWork work;
          const double angle = 0.5 * way;  // a pose is held past where it would be lost
          const Vec<double, 3> wrench(load * std::cos(angle), load * std::sin(angle), 0.03 * load * sign);
          if (!is_equilibrium(inverse_statics(one.robot, wrench, one.state, work))) continue;
          expect_counted(one, unstable, unstable_legs);
          ++solved;
        }
  EXPECT_GE(solved, 200);
  EXPECT_GE(unstable, 50);
  EXPECT_GE(unstable_legs, 5);
}

TEST(ChainMargins, AreThoseOfArcsAtRest) {
  const Case<Planar> one =
      rest_of<Planar>("3-rfr", PrbDiscretisation::weighted, {0.01, 0, 0.3}, {1, 1, 1}, false);
  ChainWork work;
  const ChainMargins found = margins(one.robot, one.state, work);
  double most = 0;
  for (std::size_t i = 0; i < 3; ++i)
    most =
        std::max(most, std::abs(one.robot.legs[i].chain.turn(one.state.legs[i].of(one.robot.legs[i].chain))) /
                           one.robot.legs[i].chain.length);
  EXPECT_NEAR(found.strain, 0.5e-3 * most, 1e-12);
  EXPECT_GT(found.fold, 1e-4);
  EXPECT_LE(found.fold, 1);
}

template <class Space>
void expect_sensitivity(Case<Space> one, double force, int& columns) {
  SCOPED_TRACE(testing::Message() << one.robot.legs.size() << one.robot.has_base_motors
                                  << one.robot.legs[0].has_strut() << " " << force);
  using Motion = Vec<double, Space::dof>;
  ChainWork work;
  Motion wrench = Motion::Constant(2e-4 * force);
  wrench[0] = 0.012 * force, wrench[1] = -0.008 * force;
  ASSERT_TRUE(is_equilibrium(equilibrium(one.robot, std::vector(one.state.hold), wrench, one.state, work)));
  const auto found = input_sensitivity(one.robot, one.state, work);
  Eigen::Index column = 0;
  const auto check = [&](double step, auto&& change) {
    typename Space::Pose ends[2];
    for (const int side : {0, 1}) {
      Case<Space> moved = one;
      std::vector<TendonConstraint> hold = one.state.hold;
      change(moved.robot, hold, side == 0 ? -step : step);
      const Report report = equilibrium(moved.robot, hold, wrench, moved.state, work);
      ASSERT_TRUE(is_equilibrium(report)) << to_string(report);
      ends[side] = moved.state.pose;
    }
    const Motion slope = twist_between(ends[0], ends[1]) / (2 * step);
    EXPECT_LT((found.col(column) - slope).norm(), 2e-6 * slope.norm() + 1e-9) << column;
    ++column;
  };
  for (std::size_t i = 0; i < one.robot.legs.size(); ++i) {
    if constexpr (Space::dimension == 2)
      if (one.robot.has_base_motors)
        check(1e-5, [&](auto& robot, auto&, double by) {
          auto& base = robot.legs[i].base;
          base = SE2<double>::from(base.p.x(), base.p.y(), base.angle() + by);
        });
    if (one.state.hold[i].length_of >= 0)
      check(1e-7, [&](auto&, auto& hold, double by) { hold[i].length += by; });
    else
      for (std::size_t k = 0; k < 2; ++k)
        check(3e-4, [&](auto&, auto& hold, double by) { hold[i].tension[k] += by; });
  }
  EXPECT_EQ(column, found.cols());
  columns += static_cast<int>(column);
}

TEST(ChainSensitivity, IsTheSlopeOfThePoseByWhatIsHeld) {
  int columns = 0;
  for (const PrbDiscretisation model :
       {PrbDiscretisation::even, PrbDiscretisation::weighted, PrbDiscretisation::discs})
    for (const bool holds_lengths : {false, true})
      for (const double force : {0.0, 1.0}) {
        expect_sensitivity(rest_of<Planar>("3-rfr", model, {0.01, 0, 0.3}, {1, -1, 1}, holds_lengths), force,
                           columns);
        expect_sensitivity(rest_of<Planar>("3-frr", model, {0, 0, 0.1}, {}, holds_lengths), force, columns);
        expect_sensitivity(rest_of<Planar>("3-rfrr", model, {0.01, -0.005, 0.1}, {}, holds_lengths), force,
                           columns);
        expect_sensitivity(
            rest_of<Spatial>("6-ufs", model, reached_by_6_ufs(), {1, 1, 1, 1, 1, 1}, holds_lengths), force,
            columns);
      }
  EXPECT_EQ(columns, 6 * (3 + 3 + 6 + 6) + 6 * (6 + 6 + 9 + 12));
}

TEST(ChainAnalysis, OfAnotherRobotIsNone) {
  const Case<Planar> one =
      rest_of<Planar>("3-rfr", PrbDiscretisation::weighted, {0.01, 0, 0.3}, {1, 1, 1}, false);
  ChainState<Planar> state = one.state;
  state.legs.pop_back();
  ChainWork work;
  EXPECT_TRUE(std::isnan(check_stability(one.robot, state, work).smallest_eigenvalue));
  EXPECT_FALSE(check_stability(one.robot, state, work).is_stable());
  EXPECT_TRUE(std::isnan(margins(one.robot, state, work).fold));
  EXPECT_EQ(input_sensitivity(one.robot, state, work).cols(), 0);
}

TEST(ChainEquilibria, OfNothingAreNone) {
  const Case<Planar> one =
      rest_of<Planar>("3-rfr", PrbDiscretisation::weighted, {0.01, 0, 0.3}, {1, 1, 1}, true);
  const auto count = [&](std::vector<ChainStart<Planar>> starts, std::vector<TendonConstraint> hold,
                         const Vec<double, 3>& wrench, StopToken stop = {}) {
    ChainWork work{.stop = stop};
    return chain_equilibria<Planar>(one.robot, starts, hold, wrench, work).size();
  };
  const Vec<double, 3> none(0, 0, 0);
  const ChainStart<Planar> start{one.state.pose, {5, 5, 5}};
  EXPECT_EQ(count({start}, one.state.hold, none), 2U);
  EXPECT_EQ(count({}, one.state.hold, none), 0U);
  EXPECT_EQ(count({start}, {}, none), 0U);
  EXPECT_EQ(count({{one.state.pose, {5}}}, one.state.hold, none), 0U);
  EXPECT_EQ(count({start}, one.state.hold, none * std::numeric_limits<double>::quiet_NaN()), 0U);
  std::atomic<bool> is_late = true;
  EXPECT_EQ(count({start}, one.state.hold, none, StopToken(is_late)), 0U);
}

}  // namespace chain_analysis_test
}  // namespace sinew::test
