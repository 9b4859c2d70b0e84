/// What must hold of chains whatever the numbers: forces are slopes of the energy, linearisations are slopes
/// of the forces, and many links are a constant-curvature backbone.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <random>

#include "kinematics/chains/leg_factors.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::test {
namespace chain_properties_test {

Robot robot_of(const char* name) { return *load(name); }

template <class Space>
ChainLegs<Space> made_of(const char* name, PrbDiscretisation model) {
  return chains_of<Space>(*robot_of(name).as(Model::prb, model));
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

/// A leg's equations in full: A δz + B δx = −r in z = angles, force and the tension of a length that is held.
struct Dense {
  Eigen::MatrixXd A, B;
  Eigen::VectorXd r;
};
template <class Space>
Dense dense(const LegSystem<Space>& system) {
  const Eigen::Index n = system.joints, size = n + (system.holds_length ? 2 : 1);
  const auto& closure = system.closure;
  Dense all{Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Zero(size, Space::dof),
            Eigen::VectorXd::Zero(size)};
  const auto at = [](Eigen::Index k) { return static_cast<std::size_t>(k); };
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index k = 0; k < n; ++k) all.A(j, k) = system.force * closure.c_qq(at(j), at(k));
    all.A(j, j) += system.stiffness[at(j)];
    all.A(j, n) = all.A(n, j) = closure.c_q[at(j)];
    if (system.holds_length) all.A(j, n + 1) = all.A(n + 1, j) = system.tendon[at(j)];
    all.B.row(j) = system.force * closure.across[at(j)] * closure.turn.transpose();
    all.r[j] = system.balance[at(j)];
  }
  all.B.row(n) = closure.c_x.transpose();
  all.r[n] = closure.c;
  if (system.holds_length) all.r[n + 1] = system.length_error;
  return all;
}

/// Every linearisation of one leg against central differences of what it linearises.
template <class Space>
void expect_slopes(const ChainLeg<Space>& leg, const typename Space::Pose& pose, const ChainLegState& state) {
  constexpr double step = 1e-6;
  const TendonConstraint hold{0, 0.19, {}};
  const auto joints = static_cast<std::size_t>(leg.chain.joints());
  LegSystem<Space> here, plus, minus;
  form(leg, Space::frame(pose), state, hold, here);
  const Dense all = dense(here);
  const double scale =
      leg.spring(0) + std::abs(state.force) * leg.chain.length + state.tension[0] * leg.tendon_offset;
  const auto column = [&](std::size_t j, double size) {
    const Eigen::VectorXd slope = (dense(plus).r - dense(minus).r) / (2 * step);
    for (Eigen::Index i = 0; i < slope.size(); ++i)
      EXPECT_NEAR(all.A(i, static_cast<Eigen::Index>(j)), slope[i], 1e-7 * size) << i << " " << j;
  };
  for (std::size_t j = 0; j < joints; ++j) {
    ChainLegState up = state, down = state;
    up.angles[j] += step, down.angles[j] -= step;
    form(leg, Space::frame(pose), up, hold, plus);
    form(leg, Space::frame(pose), down, hold, minus);
    EXPECT_NEAR(
        here.balance[j],
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
    const Eigen::VectorXd change = (dense(plus).r - dense(minus).r) / (2 * step);
    for (Eigen::Index j = 0; j < change.size(); ++j)
      EXPECT_NEAR(all.B(j, k), change[j], 1e-7 * scale) << j << " " << k;
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
  for (const PrbDiscretisation model :
       {PrbDiscretisation::even, PrbDiscretisation::weighted, PrbDiscretisation::discs}) {
    const auto robot = made_of<Space>(name, model);
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

/// What a leg's unknowns move by, and what it adds to the platform's equation, against the equations in full.
template <class Space>
void expect_moves(const ChainLeg<Space>& leg, const LegSystem<Space>& system, bool is_even, bool is_fed,
                  const ChainLegState& state) {
  constexpr int dof = Space::dof;
  Dense all = dense(system);
  const Eigen::Index n = system.joints;
  Eigen::MatrixXd by = all.B;  // what is free
  if (is_fed) {                // by a length that is held, or a tension
    by = Eigen::MatrixXd::Zero(all.r.size(), 1);
    if (system.holds_length) by(all.r.size() - 1, 0) = -1;
    for (Eigen::Index j = 0; j < n && !system.holds_length; ++j)
      by(j, 0) = system.tendon[static_cast<std::size_t>(j)];
  }
  Eigen::MatrixXd shape = Eigen::MatrixXd::Identity(all.r.size(), all.r.size());  // unknowns by fewer of them
  if (is_even) {
    shape = Eigen::MatrixXd::Zero(all.r.size(), all.r.size() - n + 1);
    for (Eigen::Index j = 0; j < n; ++j) shape(j, 0) = even_bend(leg.chain, static_cast<int>(j));
    shape.bottomRightCorner(all.r.size() - n, all.r.size() - n).setIdentity();
  }
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(shape.transpose() * all.A * shape);
  const Eigen::VectorXd constant = shape * lu.solve(-shape.transpose() * all.r);
  const Eigen::MatrixXd moves = shape * lu.solve(-shape.transpose() * by);

  LegFactors<Space> found;
  found.factor(leg.chain, system, is_even);
  const double scale = constant.head(n).cwiseAbs().maxCoeff() + moves.topRows(n).cwiseAbs().maxCoeff();
  const double condition = lu.maxPivot() / std::abs(lu.matrixLU().diagonal().cwiseAbs().minCoeff());
  if (!(condition < 1e12)) return;  // of two links in line any turn is as good
  // Eigenvalues below zero: one for each of its constraints, and those of what is unstable
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> spectrum(shape.transpose() * all.A * shape);
  const Eigen::Index unstable = (spectrum.eigenvalues().array() < 0).count() - (all.r.size() - n);
  EXPECT_EQ(found.unstable(), unstable);
  const double tolerance = 1e-13 * std::max(1e2, condition);
  for (Eigen::Index side = -1; side < by.cols(); ++side) {
    Eigen::VectorXd y = Eigen::VectorXd::Zero(by.cols());
    if (side >= 0) y[side] = 1;
    const Eigen::VectorXd expected = constant + moves * y;
    ChainLegState moved = state;
    Vec<double, dof> twist = Vec<double, dof>::Zero();
    if (!is_fed) twist = y;
    found.plan(leg.chain, twist, is_fed ? y[0] : 0);
    found.move(leg.chain, moved, system.fed);
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto joint = static_cast<std::size_t>(j);
      ASSERT_NEAR(moved.angles[joint] - state.angles[joint], expected[j], tolerance * scale)
          << j << " of " << n;
    }
    ASSERT_NEAR(moved.force - state.force, expected[n],
                tolerance * (expected.cwiseAbs().maxCoeff() + std::abs(state.force)));
  }
  Mat<double, dof, dof> S = Mat<double, dof, dof>::Zero();
  Vec<double, dof> g = Vec<double, dof>::Zero();
  g = system.force * system.closure.c_x + found.push(system, found.own);
  if (is_fed) S.col(0) = found.push(system, found.feed);
  for (std::size_t k = 0; k < dof && !is_fed; ++k)
    S.col(static_cast<Eigen::Index>(k)) = found.push(system, found.platform + k);
  if (!is_fed) S += system.force * system.closure.c_xx;
  Eigen::MatrixXd expected_S = Eigen::MatrixXd::Zero(dof, dof);
  expected_S.leftCols(by.cols()) = all.B.transpose() * moves;
  if (!is_fed) expected_S += system.force * Eigen::MatrixXd(system.closure.c_xx);
  const Eigen::VectorXd expected_g =
      system.force * Eigen::VectorXd(system.closure.c_x) + all.B.transpose() * constant;
  EXPECT_LT((S - expected_S).norm(), tolerance * (1e-12 + expected_S.norm() + moves.norm() * all.B.norm()));
  EXPECT_LT((g - expected_g).norm(),
            tolerance * (1e-12 + expected_g.norm() + constant.norm() * all.B.norm()));
}

template <class Space>
void expect_moves_of(const char* name) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> part(-1, 1);
  for (const PrbDiscretisation model :
       {PrbDiscretisation::even, PrbDiscretisation::weighted, PrbDiscretisation::discs}) {
    const auto robot = made_of<Space>(name, model);
    for (const int links : {2, 3, 6, 32})
      for (const double size : {1e-3, 0.1, 0.8})
        for (int repeat = 0; repeat < 8; ++repeat) {
          ChainLeg<Space> leg = robot.legs[static_cast<std::size_t>(repeat) % robot.legs.size()];
          leg.chain.links = links;
          ChainLegState state;
          for (double& angle : state.angles) angle = size * part(random);
          state.force = repeat == 0 ? 0 : 3 * part(random);
          state.tension = {1 + part(random), part(random)};
          const auto platform = Space::frame(random_pose(random, Space{}));
          for (const int length_of : {-1, 0, 1}) {
            if (length_of >= 0 && leg.chain.joints() <= (leg.has_strut() ? 1 : 2))
              continue;  // it leaves nothing
            const TendonConstraint hold{length_of, 0.19, {}};
            LegSystem<Space> system;
            form(leg, platform, state, hold, system);
            expect_moves(leg, system, false, false, state);
            expect_moves(leg, system, false, true, state);
            if (length_of < 0) expect_moves(leg, system, true, false, state);
          }
        }
  }
}

TEST(ChainLegFactors, AreThoseOfTheEquationsInFull) {
  expect_moves_of<Planar>("3-rfr");
  expect_moves_of<Planar>("3-frr");
  expect_moves_of<Spatial>("6-ufs");
}

/// Where springs and force leave some motion of the links no stiffness at all, the closure still holds the
/// leg.
TEST(ChainLegFactors, PassThroughTheForceAtWhichAChainBuckles) {
  const auto robot = made_of<Planar>("3-rfr", PrbDiscretisation::weighted);
  ChainLeg<Planar> leg = robot.legs[0];
  for (const int links : {3, 6, 32}) {
    leg.chain.links = links;
    ChainLegState state;
    for (double& angle : state.angles) angle = 0.6 / links;
    const auto platform = Planar::frame(PlanarPose{0.01, 0, 0.3});
    const TendonConstraint hold{-1, 0, {}};
    LegSystem<Planar> system;
    const auto least = [&](double force) {  // of T, in angles
      state.force = force;
      form(leg, platform, state, hold, system);
      Eigen::MatrixXd T = dense(system).A.topLeftCorner(system.joints, system.joints);
      for (Eigen::Index j = 0; j < T.rows(); ++j)
        for (Eigen::Index k = 0; k < T.rows(); ++k)
          T(j, k) -= force * system.closure.sway * system.closure.across[static_cast<std::size_t>(j)] *
                     system.closure.across[static_cast<std::size_t>(k)];
      return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(T).eigenvalues()[0];
    };
    double low = -1000, high = 1000;
    const bool rises = least(high) > 0;
    ASSERT_NE(rises, least(low) > 0);
    for (int round = 0; round < 100; ++round) {
      const double middle = 0.5 * (low + high);
      ((least(middle) > 0) == rises ? high : low) = middle;
    }
    for (const double force : {low, high, low + 1e-9, low - 1e-6}) {
      least(force);
      expect_moves(leg, system, false, false, state);
    }
  }
}

/// The energy of the whole robot is stationary at an equilibrium, along whatever keeps it closed.
TEST(ChainForces, DoNoWorkAlongMotionsThatStayClosed) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> part(-1, 1);
  for (const char* name : {"3-rfr", "3-frr"})
    for (const PrbDiscretisation model :
         {PrbDiscretisation::even, PrbDiscretisation::weighted, PrbDiscretisation::discs}) {
      const auto robot = made_of<Planar>(name, model);
      const bool is_frr = robot.legs[0].has_strut();
      const PlanarPose pose = is_frr ? PlanarPose{0, 0, 0.1} : PlanarPose{0.01, 0, 0.3};
      Robot any = robot_of(name);
      Workspace memory(any);
      const Inverse arcs = inverse(any, pose, {}, memory);
      ChainState<Planar> state;
      ASSERT_TRUE(unloaded_equilibrium(robot, pose, arcs.coordinates, false, state).ok());
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
void expect_order(const char* name, const typename Space::Pose& pose, PrbDiscretisation model, double order) {
  Robot any = robot_of(name);
  Workspace memory(any);
  const Inverse arcs = inverse(any, pose, {}, memory);
  ASSERT_TRUE(arcs.ok());
  const std::vector<double> curvature(arcs.coordinates.begin(), arcs.coordinates.end()),
      lengths(arcs.inputs.begin(), arcs.inputs.end());
  std::vector<double> errors;
  for (const int links : {8, 16, 32}) {
    auto robot = made_of<Space>(name, model);
    for (auto& leg : robot.legs) leg.chain.links = links;
    ChainState<Space> state;
    ASSERT_TRUE(unloaded_equilibrium(robot, pose, curvature, false, state).ok());
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
       {std::pair(PrbDiscretisation::weighted, 2.0), std::pair(PrbDiscretisation::even, 1.0)}) {
    expect_order<Planar>("3-rfr", PlanarPose{0.01, 0, 0.3}, model, order);
    expect_order<Spatial>("6-ufs", high, model, order);
  }
  expect_order<Planar>("3-frr", PlanarPose{0, 0, 0.1}, PrbDiscretisation::weighted, 2);
}

}  // namespace chain_properties_test
}  // namespace sinew::test
