/// Equilibria of rods against the paper's own 37 unknowns.
#include <gtest/gtest.h>

#include "kinematics/rods/solve.hpp"
#include "rod_robots.hpp"
#include "shooting_3pfs.hpp"

namespace sinew::test {
namespace rod_shooting_test {

/// The unknowns (32) of the equilibrium a system holds.
judge::Vector37<double> unknowns(const RodGroup& system) {
  judge::Vector37<double> v;
  for (int k = 0; k < 6; ++k) {
    const RodResult rod = system.rod(k);
    v.segment<2>(5 * k) = rod.curvature_0.head<2>();
    v.segment<3>(5 * k + 2) = rod.force;
  }
  const SO3<double> q = system.platform().R;
  v.segment<3>(30) = system.platform().p;
  v.tail<4>() << q.w, q.v[0], q.v[1], q.v[2];
  return v;
}

TEST(RodShooting, ThePapersNewtonStaysWhereItIsStarted) {  // @verifies 3PFS (24), (27)-(29)
  for (const RodTripod& t : {g1, g2}) {
    const judge::Tripod data = t.data();
    const RodRobot robot = tripod_robot(t);
    RodWork work = work_of<ElasticaSystem>(robot);
    RodRandom random(1);
    for (int trial = 0; trial < 4; ++trial) {
      const Vec3<double> L = Vec3<double>::Constant(t.length) + random.vector(0.06);
      const Wrench6 w = random.wrench(5, 0.3);
      ASSERT_TRUE(solve_rods(work, home(robot), std::span<const double>(L.data(), 3), {.wrench = w}).ok());
      RodGroup& system = *work.system;
      const judge::PerRod<double> lengths{L[0], L[0], L[1], L[1], L[2], L[2]};
      const judge::Wrench wrench{w.head<3>(), w.tail<3>()};
      const judge::Vector37<double> start = unknowns(system);
      const judge::Solution s = judge::solve(data, lengths, wrench, start, {.tolerance = 2e-12});
      ASSERT_TRUE(s.converged) << s.residual;
      EXPECT_LE(s.iterations, 1);
      EXPECT_LT((s.v - start).tail<7>().lpNorm<Eigen::Infinity>(), 1e-12);
      EXPECT_LT((s.v - start).head<30>().lpNorm<Eigen::Infinity>(), 1e-9);

      // and the slopes there, which it takes by complex steps
      const judge::Linear around = judge::linear_around(data, lengths, wrench, s);
      const Eigen::MatrixXd stiffness = system.stiffness();
      Eigen::Matrix<double, 6, 3> feed, by_wrench;
      for (int input = 0; input < 3; ++input) {
        feed.col(input) = system.input_wrench_jacobian(input);
        // δw = K δx + (feed) δL, at fixed load
        by_wrench.col(input) =
            -around.stiffness.lazyProduct(around.length.col(2 * input) + around.length.col(2 * input + 1));
      }
      for (int r = 0; r < 6; ++r) {
        EXPECT_LT((stiffness.row(r) - around.stiffness.row(r)).norm(), 1e-10 * stiffness.row(r).norm());
        EXPECT_LT((feed.row(r) - by_wrench.row(r)).norm(), 1e-9 * feed.row(r).norm());
      }
    }
  }
}

}  // namespace rod_shooting_test
}  // namespace sinew::test
