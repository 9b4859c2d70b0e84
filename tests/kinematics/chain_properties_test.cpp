/// What must hold of chains whatever the numbers: forces are slopes of the energy, linearisations are slopes
/// of the forces, and many links are a constant-curvature backbone.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "kinematics/chains/leg_system.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::test {
namespace chain_properties_test {

AnyRobot robot_of(const char* name) { return *load(name); }

template <class Space>
ChainRobot<Space> chains_of(const char* name, ChainModel model) {
  return std::get<ChainRobot<Space>>(*chain_robot(robot_of(name), model));
}

/// Springs, tendons and the closure's multiplier: what a leg adds to the Lagrangian.
template <class Space>
double lagrangian(const ChainLeg<Space>& leg, const typename Space::template Frame<double>& platform,
                  const ChainLegState& state) {
  ChainClosure<Space> at;
  const auto angles = state.of(leg.chain);
  close_chain(leg, platform, angles, at);
  double sum = state.force * at.c;
  for (int j = 0; j < leg.chain.joints(); ++j)
    sum += 0.5 * leg.spring(j) * angles[static_cast<std::size_t>(j)] * angles[static_cast<std::size_t>(j)];
  for (int k = 0; k < 2; ++k)
    sum += state.tension[static_cast<std::size_t>(k)] *
           leg.chain.tendon_length(angles, leg.tendon_offset, k == 0 ? 1 : -1);
  return sum;
}

/// Every linearisation of one leg against central differences of what it linearises.
template <class Space>
void expect_slopes(const ChainLeg<Space>& leg, const typename Space::Pose& pose, const ChainLegState& state) {
  constexpr double step = 1e-6;
  const ChainHold hold{0, 0.19, {}};
  const auto joints = static_cast<std::size_t>(leg.chain.joints());
  LegSystem<Space> here, plus, minus;
  form(leg, Space::frame(pose), state, hold, here);
  const double scale =
      leg.spring(0) + std::abs(state.force) * leg.chain.length + state.tension[0] * leg.tendon_offset;
  const auto column = [&](std::size_t j, double size) {
    for (std::size_t i = 0; i < joints + 2; ++i)
      EXPECT_NEAR(here.A[i][j], (plus.r[i] - minus.r[i]) / (2 * step), 1e-7 * size) << i << " " << j;
  };
  for (std::size_t j = 0; j < joints; ++j) {
    ChainLegState up = state, down = state;
    up.angles[j] += step, down.angles[j] -= step;
    form(leg, Space::frame(pose), up, hold, plus);
    form(leg, Space::frame(pose), down, hold, minus);
    EXPECT_NEAR(
        here.r[j],
        (lagrangian(leg, Space::frame(pose), up) - lagrangian(leg, Space::frame(pose), down)) / (2 * step),
        1e-7 * scale);
    column(j, scale);
  }
  ChainLegState up = state, down = state;
  up.force += step, down.force -= step;
  form(leg, Space::frame(pose), up, hold, plus);
  form(leg, Space::frame(pose), down, hold, minus);
  column(joints, scale);
  up = down = state;
  up.tension[0] += step, down.tension[0] -= step;
  form(leg, Space::frame(pose), up, hold, plus);
  form(leg, Space::frame(pose), down, hold, minus);
  column(joints + 1, scale);

  for (int k = 0; k < Space::dof; ++k) {
    const Vec<double, Space::dof> way = step * Vec<double, Space::dof>::Unit(k);
    const auto ahead = Space::frame(Space::moved(pose, way)), back = Space::frame(Space::moved(pose, -way));
    form(leg, ahead, state, hold, plus);
    form(leg, back, state, hold, minus);
    EXPECT_NEAR(here.closure.c_x[k], (plus.closure.c - minus.closure.c) / (2 * step), 1e-8);
    for (std::size_t j = 0; j < joints + 2; ++j)
      EXPECT_NEAR(here.B[j][k], (plus.r[j] - minus.r[j]) / (2 * step), 1e-7 * scale) << j << " " << k;
    const Vec<double, Space::dof> slope = (plus.closure.c_x - minus.closure.c_x) / (2 * step);
    for (int l = 0; l < Space::dof; ++l)
      EXPECT_NEAR(here.closure.c_xx(l, k), slope[l], 1e-6 / here.closure.distance) << l << " " << k;
  }
}

PlanarPose random_pose(std::mt19937& random, const Planar&) {
  std::uniform_real_distribution<double> part(-1, 1);
  return {0.03 * part(random), 0.03 * part(random), 0.5 * part(random)};
}
SpatialPose random_pose(std::mt19937& random, const Spatial&) {
  std::uniform_real_distribution<double> part(-1, 1);
  return spatial_pose(
      SE3<double>{{0.03 * part(random), 0.03 * part(random), 0.17 + 0.03 * part(random)},
                  SO3<double>::exp(0.4 * Vec3<double>(part(random), part(random), part(random)))});
}

template <class Space>
void expect_slopes_of(const char* name) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(-1, 1);
  for (const ChainModel model : {ChainModel::even, ChainModel::weighted, ChainModel::discs}) {
    const auto robot = chains_of<Space>(name, model);
    for (const double size : {0.0, 1e-9, 1e-3, 0.4, 1.2})  // straight, nearly so, bent, folded
      for (int repeat = 0; repeat < 6; ++repeat) {
        ChainLegState state;
        for (double& angle : state.angles) angle = size * part(random);
        state.force = part(random);
        state.tension = {5 + 5 * part(random), 1 + part(random)};
        const auto& leg = robot.legs[static_cast<std::size_t>(repeat) % robot.legs.size()];
        expect_slopes<Space>(leg, random_pose(random, Space{}), state);
      }
  }
}

TEST(ChainForces, AreSlopesOfTheEnergyAndTheirLinearisationsOfThem) {  // @verifies TDPCR (44)
  expect_slopes_of<Planar>("3-rfr");
  expect_slopes_of<Planar>("3-frr");
  expect_slopes_of<Planar>("3-rfrr");
  expect_slopes_of<Spatial>("6-ufs");
}

/// The energy of the whole robot is stationary at an equilibrium, along whatever keeps it closed.
TEST(ChainForces, DoNoWorkAlongMotionsThatStayClosed) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> part(-1, 1);
  for (const char* name : {"3-rfr", "3-frr"})
    for (const ChainModel model : {ChainModel::even, ChainModel::weighted, ChainModel::discs}) {
      const auto robot = chains_of<Planar>(name, model);
      const bool is_frr = robot.legs[0].has_strut();
      const PlanarPose pose = is_frr ? PlanarPose{0, 0, 0.1} : PlanarPose{0.01, 0, 0.3};
      AnyRobot any = robot_of(name);
      Workspace memory(any);
      const Inverse arcs = inverse(any, pose, {}, memory);
      ChainState<Planar> state;
      ASSERT_TRUE(rest(robot, pose, arcs.coordinates, false, state).ok());
      ChainWork work;
      const Vec<double, 3> wrench(0.01, -0.008, 2e-4);
      ASSERT_TRUE(equilibrium(robot, std::vector(state.hold), wrench, state, work).ok());
      for (int repeat = 0; repeat < 5; ++repeat) {
        // a random variation of the angles; the pose follows by the closures
        Vec<double, 3> needed;
        Mat<double, 3, 3> lines;
        std::vector<ChainLegState> change(3);
        for (std::size_t i = 0; i < 3; ++i) {
          ChainClosure<Planar> at;
          close_chain(robot.legs[i], SE2<double>::from(state.pose), state.legs[i].of(robot.legs[i].chain),
                      at);
          double along = 0;
          for (std::size_t j = 0; j < static_cast<std::size_t>(robot.legs[i].chain.joints()); ++j) {
            change[i].angles[j] = part(random);
            along += at.c_q[j] * change[i].angles[j];
          }
          needed[static_cast<Eigen::Index>(i)] = -along;
          lines.row(static_cast<Eigen::Index>(i)) = at.c_x.transpose();
        }
        const Vec<double, 3> motion = lines.inverse() * needed;
        const auto varied = [&](double by) {
          ChainState<Planar> moved = state;
          moved.pose = Planar::moved(state.pose, by * motion);
          for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < static_cast<std::size_t>(robot.legs[i].chain.joints()); ++j)
              moved.legs[i].angles[j] += by * change[i].angles[j];
            for (const int side : {1, -1})
              moved.legs[i].tendon_length[side > 0 ? 0 : 1] =
                  robot.legs[i].chain.tendon_length(moved.legs[i].of(robot.legs[i].chain), 0.005, side);
          }
          return potential(robot, moved);
        };
        const double work_done = (varied(1e-5) - varied(-1e-5)) / 2e-5;
        EXPECT_LT(std::abs(work_done), 1e-8) << name;
      }
    }
}

/// Tendon lengths of an unloaded pose against those of constant curvature, links doubled.
template <class Space>
void expect_order(const char* name, const typename Space::Pose& pose, ChainModel model, double order) {
  AnyRobot any = robot_of(name);
  Workspace memory(any);
  const Inverse arcs = inverse(any, pose, {}, memory);
  ASSERT_TRUE(arcs.ok());
  const std::vector<double> curvature(arcs.coordinates.begin(), arcs.coordinates.end()),
      lengths(arcs.inputs.begin(), arcs.inputs.end());
  std::vector<double> errors;
  for (const int links : {8, 16, 32}) {
    auto robot = chains_of<Space>(name, model);
    for (auto& leg : robot.legs) leg.chain.links = links;
    ChainState<Space> state;
    ASSERT_TRUE(rest(robot, pose, curvature, false, state).ok());
    double error = 0;
    for (std::size_t i = 0; i < lengths.size(); ++i)
      error = std::max(error, std::abs(state.legs[i].tendon_length[0] - lengths[i]));
    errors.push_back(error);
  }
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), order, 0.1) << name;
}

TEST(ChainsOfManyLinks, AreArcs) {
  SpatialPose high;
  high.position = {0.01, 0, 0.18};
  for (const auto& [model, order] :
       {std::pair(ChainModel::weighted, 2.0), std::pair(ChainModel::even, 1.0)}) {
    expect_order<Planar>("3-rfr", PlanarPose{0.01, 0, 0.3}, model, order);
    expect_order<Spatial>("6-ufs", high, model, order);
  }
  expect_order<Planar>("3-frr", PlanarPose{0, 0, 0.1}, ChainModel::weighted, 2);
}

}  // namespace chain_properties_test
}  // namespace sinew::test
