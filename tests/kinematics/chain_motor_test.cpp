/// Motors at the bases of chains: what they bear.
#include <gtest/gtest.h>

#include <numbers>

#include "kinematics/chains/chain.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::test {
namespace chain_motor_test {

struct Case {
  ChainLegs<Planar> robot;
  ChainState<Planar> state;
};

/// At rest, bent by unlike tendons, with each first link half a link's bend beyond its arc's tangent.
Case at_rest(PrbDiscretisation model, bool holds_lengths) {
  const Robot any = *load("3-rfrr");
  Workspace memory(any);
  const PlanarPose pose{0.01, -0.005, 0.1};
  const std::vector<double> curvature{3, -4, 5};
  const Inverse arcs = inverse(any, pose, {.curvature = curvature}, memory);
  EXPECT_TRUE(arcs.ok());
  Case one{chains_of<Planar>(*any.as(Model::prb, model)), {}};
  for (std::size_t i = 0; i < 3; ++i) {
    auto& leg = one.robot.legs[i];
    leg.base = SE2<double>::from(
        leg.base.p.x(), leg.base.p.y(),
        arcs.coordinates[2 * i] - 0.5 * curvature[i] * leg.chain.link_length() - std::numbers::pi / 2);
  }
  EXPECT_TRUE(unloaded_equilibrium(one.robot, pose, curvature, holds_lengths, one.state).ok());
  return one;
}

bool is_solved(const Report& report) { return report.ok() || report.status == Status::slack; }

const Vec<double, 3> wrench(0.02, -0.012, 4e-4);

/// Energy at the equilibrium with one first link turned, all that is held kept.
double energy(Case one, std::size_t leg, double turn) {
  auto& base = one.robot.legs[leg].base;
  ChainWork work;
  const std::vector<TendonConstraint> hold = one.state.hold;
  EXPECT_TRUE(is_solved(equilibrium(one.robot, hold, wrench, one.state, work)));
  base = SE2<double>::from(base.p.x(), base.p.y(), base.angle() + turn);
  EXPECT_TRUE(is_solved(equilibrium(one.robot, hold, wrench, one.state, work)));
  return potential(one.robot, one.state);
}

TEST(ChainMotors, BearTheDerivativeOfTheEnergyByTheirAngle) {
  for (const PrbDiscretisation model :
       {PrbDiscretisation::even, PrbDiscretisation::weighted, PrbDiscretisation::discs})
    for (const bool holds_lengths : {false, true}) {
      Case one = at_rest(model, holds_lengths);
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(motor_torque(one.robot.legs[i], one.state.legs[i], SE2<double>::from(one.state.pose)), 0,
                    1e-15);
      ChainWork work;
      ASSERT_TRUE(is_solved(equilibrium(one.robot, std::vector(one.state.hold), wrench, one.state, work)));
      for (std::size_t i = 0; i < 3; ++i) {
        const double torque =
            motor_torque(one.robot.legs[i], one.state.legs[i], SE2<double>::from(one.state.pose));
        EXPECT_GT(std::abs(torque), 1e-5);
        const double slope = (energy(one, i, 1e-4) - energy(one, i, -1e-4)) / 2e-4;
        EXPECT_NEAR(slope, torque, 1e-6 * std::abs(torque) + 1e-9) << i;
      }
    }
}

/// Motors and the load on the platform balance about any point of the base frame.
TEST(ChainMotors, BalanceTheLoadWithTheForcesOfTheStruts) {
  Case one = at_rest(PrbDiscretisation::weighted, true);
  ChainWork work;
  ASSERT_TRUE(is_solved(equilibrium(one.robot, std::vector(one.state.hold), wrench, one.state, work)));
  const auto platform = SE2<double>::from(one.state.pose);
  double moment = wrench[2] + one.state.pose.x * wrench[1] - one.state.pose.y * wrench[0];
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& leg = one.robot.legs[i];
    const auto points = chain_points(leg, one.state.legs[i].of(leg.chain), platform);
    const Vec2<double> along = (platform.point(leg.platform_point) - points.back()).normalized();
    const Vec2<double> force = one.state.legs[i].force * along;  // pulls the tip towards the platform
    const double at_base = cross(Vec2<double>(points.back() - points.front()), force);
    EXPECT_NEAR(motor_torque(leg, one.state.legs[i], platform), -at_base, 1e-12);
    moment -= cross(points.back(), force);  // and the platform towards the tip
  }
  EXPECT_NEAR(moment, 0, 1e-12);
}

}  // namespace chain_motor_test
}  // namespace sinew::test
