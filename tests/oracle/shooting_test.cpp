/// The paper's own 37 unknowns, before they judge anything else: against tests/data/tripod/, whose numbers
/// come from another implementation, and against themselves.
#include "shooting_3pfs.hpp"

#include <gtest/gtest.h>

#include <random>

#include "reference_3pfs.hpp"

namespace sinew::test::shooting {
namespace shooting_test {

/// Largest error of a row over the largest entry of that row: a row has one unit of measure.
double row_error(const Matrix6& m, const Json& json) {
  double worst = 0;
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    const double off = error(m.row(i), json[std::size_t(i)]) / m.row(i).lpNorm<Eigen::Infinity>();
    worst = std::isnan(worst) || off <= worst ? worst : off;
  }
  return worst;
}

double sum(const Json& numbers) {
  double all = 0;
  for (const Json& x : numbers) all += x.get<double>();
  return all;
}

struct Robot {
  Json set;
  Tripod t;
  PerRod<double> L;  ///< home lengths
  Solution home;
};

Robot robot(const char* name) {
  Robot r{reference(name), {}, {}, {}};
  r.t = tripod(r.set);
  r.L.fill(r.set["L_home"].get<double>());
  r.home = solve(r.t, r.L, {}, first_guess(r.t, r.L));
  return r;
}

TEST(Shooting, JacobianIsTheSlopeOfTheWholeResidual) {  // all rods integrated, one random direction at a time
  const Robot r = robot("G2");
  const Wrench w{{3, -2, -7}, {0.2, 0.1, -0.3}};
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 5; ++trial) {
    Vector37<double> v = r.home.v, way;
    for (int i = 0; i < 37; ++i) {
      v[i] += 0.1 * uniform(random);
      way[i] = uniform(random);
    }
    const auto tips = rod_tips(r.t, r.L, v, {});
    const auto g = residual(r.t, w, v, tips);
    const Vector37<Complex> at = v + Complex(0, imaginary_step) * way;
    const Vector37<double> slope = residual(r.t, w, at, rod_tips(r.t, r.L, at, {})).imag() / imaginary_step;
    const auto off = [&](Derivative derivative) {
      const Matrix37 J = jacobian(r.t, r.L, w, v, tips, g, {.derivative = derivative});
      return (J.lazyProduct(way) - slope).lpNorm<Eigen::Infinity>() / slope.lpNorm<Eigen::Infinity>();
    };
    EXPECT_LT(off(Derivative::complex_step), 1e-14);
    EXPECT_LT(off(Derivative::forward_difference), 1e-6);
  }
}

TEST(Shooting, FindsHomeFromNothing) {
  for (const char* name : {"G1", "G2"}) {
    const Robot r = robot(name);
    ASSERT_TRUE(r.home.converged) << name;
    EXPECT_LE(r.home.iterations, 4);
    EXPECT_LT((r.home.p() - Vector3d(0, 0, r.set["h_home"].get<double>())).norm(), 1e-12);
    EXPECT_LT((r.home.e() - Vector4d(1, 0, 0, 0)).norm(), 1e-12);
  }
}

TEST(Shooting, AgreesWithTheReference) {
  int cases = 0, stiffnesses = 0;
  for (const char* name : {"G1", "G2"}) {
    const Robot r = robot(name);
    for (const Json& c : r.set["cases"]) {
      SCOPED_TRACE(c["id"].get<std::string>());
      const Task task{pairs(vector(c["L"])), {vector(c["F_ext"]), vector(c["M_ext"])}};
      const Solution s = walk(r.t, {r.L, {}}, task, r.home.v, 8);
      ASSERT_TRUE(s.converged) << s.residual;
      EXPECT_LT(error(s.p(), c["p"]), 1e-12);
      EXPECT_LT(error(s.e(), c["e"]), 1e-12);
      double energy = 0;
      for (int i = 0; i < 6; ++i) {
        const auto k = std::size_t(i);
        EXPECT_LT(error(s.n(i), c["n"][k]), 1e-9);
        EXPECT_LT(error(s.u0(i), c["u0"][k]), 1e-10);
        EXPECT_NEAR(s.tip_angle(i), c["tip_angle"][k].get<double>(), 1e-12);
        const double one = s.energy(i, task.lengths[k], r.t.bending_stiffness);
        EXPECT_NEAR(one, c["energy_rods"][k].get<double>(), 1e-12);
        energy += one;
      }
      EXPECT_NEAR(energy, c["energy"].get<double>(), 1e-12);
      const Linear around = linear_around(r.t, task.lengths, task.wrench, s);
      Eigen::Matrix<double, 6, 3> by_pair;
      for (int j = 0; j < 3; ++j) by_pair.col(j) = around.length.col(2 * j) + around.length.col(2 * j + 1);
      for (int i = 0; i < 6; ++i) EXPECT_LT(error(by_pair.row(i), c["J_L"][std::size_t(i)]), 1e-11);
      if (c.contains("stiffness")) {
        EXPECT_LT(row_error(around.stiffness, c["stiffness"]), 1e-10);
        ++stiffnesses;
      }
      ++cases;
    }
  }
  EXPECT_EQ(cases, 20);
  EXPECT_EQ(stiffnesses, 8);
}

/// Pose b seen from pose a: (p_b − p_a, θ), to second order in θ.
Eigen::Matrix<double, 6, 1> twist(const Solution& a, const Solution& b) {
  Eigen::Matrix<double, 6, 1> d;
  d << b.p() - a.p(), 4 * quaternion_rate(a.e()).transpose().lazyProduct(b.e() - a.e());
  return d;
}

TEST(Shooting, LinearAroundIsTheSlopeOfSolutions) {  // solved anew at both sides of every length and load
  const Robot r = robot("G1");
  const Task task{pairs({0.22, 0.2, 0.235}), {{0.5, -1, -4}, {0.1, 0.15, -0.1}}};
  const Solution s = walk(r.t, {r.L, {}}, task, r.home.v, 8);
  ASSERT_TRUE(s.converged);
  const Linear around = linear_around(r.t, task.lengths, task.wrench, s);
  Matrix6 by_wrench, by_length;
  for (int j = 0; j < 6; ++j) {
    Task ahead = task, behind = task;
    (j < 3 ? ahead.wrench.force : ahead.wrench.moment)[j % 3] += 1e-3;
    (j < 3 ? behind.wrench.force : behind.wrench.moment)[j % 3] -= 1e-3;
    by_wrench.col(j) =
        twist(solve(r.t, behind.lengths, behind.wrench, s.v), solve(r.t, ahead.lengths, ahead.wrench, s.v)) /
        2e-3;
    ahead = behind = task;
    ahead.lengths[std::size_t(j)] += 1e-6;
    behind.lengths[std::size_t(j)] -= 1e-6;
    by_length.col(j) =
        twist(solve(r.t, behind.lengths, task.wrench, s.v), solve(r.t, ahead.lengths, task.wrench, s.v)) /
        2e-6;
  }
  EXPECT_LT((around.stiffness.lazyProduct(by_wrench) - Matrix6::Identity()).lpNorm<Eigen::Infinity>(), 1e-6);
  EXPECT_LT((around.length - by_length).lpNorm<Eigen::Infinity>(), 1e-6);
}

TEST(Shooting, HoldsUnstableEquilibriaToo) {
  int unstable = 0;
  const Json& file = data("multiple_equilibria.json");
  for (const Json& c : file["equilibria"]) {
    SCOPED_TRACE(c["set"].get<std::string>() + " " + c["label"].get<std::string>());
    const Robot r = robot(c["set"].get<std::string>().c_str());
    const Task task{pairs(vector(c["L"])), {vector(c["F_ext"]), vector(c["M_ext"])}};
    Vector37<double> start;
    for (int i = 0; i < 6; ++i) {
      const Json &u = c["u0"][std::size_t(i)], &n = c["n"][std::size_t(i)];
      start.segment<5>(5 * i) << u[0].get<double>(), u[1].get<double>(), vector(n);
    }
    start.segment<3>(30) = vector(c["p"]);
    for (int i = 0; i < 4; ++i) start[33 + i] = c["e"][std::size_t(i)].get<double>();
    const Vector37<double> reference = start;
    for (int i = 0; i < 37; ++i) start[i] *= i % 2 == 0 ? 1.0003 : 0.9998;
    const Solution s = solve(r.t, task.lengths, task.wrench, start);
    ASSERT_TRUE(s.converged) << s.residual;
    EXPECT_LT((s.v - reference).tail<7>().lpNorm<Eigen::Infinity>(), 1e-12);
    EXPECT_LT((s.v - reference).head<30>().lpNorm<Eigen::Infinity>(), 1e-9);
    const Matrix6 K = linear_around(r.t, task.lengths, task.wrench, s).stiffness;
    EXPECT_NEAR(K.trace() / sum(c["eig_sym_K"]), 1, 1e-9);  // the sum of eigenvalues needs no solver
    if (c["unstable_directions"].get<int>() > 0) ++unstable;
  }
  EXPECT_EQ(unstable, 4);
}

TEST(Shooting, SaysWhenItFails) {
  const Robot r = robot("G2");
  const auto failed = [&](const PerRod<double>& L, const Wrench& w, const Vector37<double>& start) {
    const Solution s = solve(r.t, L, w, start);
    return !s.converged && !(s.residual <= 1e-12);
  };
  EXPECT_TRUE(failed(pairs({0.1, 0.1, 0.1}), {}, r.home.v));  // shorter than the way across
  EXPECT_TRUE(failed(r.L, {{std::nan(""), 0, 0}, {0, 0, 0}}, r.home.v));
  EXPECT_TRUE(failed(pairs({0.4, std::nan(""), 0.4}), {}, r.home.v));
  EXPECT_TRUE(failed(r.L, {}, Vector37<double>::Constant(std::nan(""))));
  EXPECT_TRUE(failed(r.L, {}, Vector37<double>::Zero()));  // singular: no quaternion
}

TEST(Shooting, BaselineIsAsGoodAsItsRungeKutta) {
  const Robot r = robot("G2");
  const Task task{pairs({0.45, 0.43, 0.41}), {{1, -0.5, -5}, {0.2, 0.1, -0.1}}};
  const Solution exact = walk(r.t, {r.L, {}}, task, r.home.v, 8);
  const Solution s = walk(r.t, {r.L, {}}, task, r.home.v, 8, baseline);
  ASSERT_TRUE(exact.converged && s.converged) << s.residual;
  const double off = (s.p() - exact.p()).norm();
  EXPECT_LT(off, 3e-9);
  EXPECT_GT(off, 1e-12);  // else it did not use its own method
}

}  // namespace shooting_test
}  // namespace sinew::test::shooting
