/// Equilibria of rods against tests/data/tripod/, whose numbers come from another implementation.
#include <gtest/gtest.h>

#include "kinematics/rods/solve.hpp"
#include "reference_3pfs.hpp"
#include "rod_robots.hpp"

namespace sinew::test {
namespace rod_reference_test {

using judge::Json;

/// A set of the reference, and a solver for it.
struct Set {
  explicit Set(const char* name)
      : json(judge::reference(name)),
        data(judge::tripod(json)),
        robot(tripod_robot(data, level(json["h_home"].get<double>()))),
        work(work_of<ElasticaSystem>(robot)) {}

  Report solve(const Json& c, RodQuestion question = {}) {
    for (int k = 0; k < 6; ++k)
      question.wrench[k] = c[k < 3 ? "F_ext" : "M_ext"][std::size_t(k % 3)].get<double>();
    const Vec3<double> inputs = judge::vector(c["L"]);
    return solve_rods(work, home(robot), std::span<const double>(inputs.data(), 3), question);
  }

  double pose_error(const Json& c) const {
    const SO3<double> q = work.system->platform().R.canonical();
    return std::max(judge::error(work.system->platform().p, c["p"]),
                    judge::error(Eigen::Vector4d(q.w, q.v[0], q.v[1], q.v[2]), c["e"]));
  }
  double force_error(const Json& c) const {
    double worst = 0;
    for (int k = 0; k < 6; ++k)
      worsen(worst, judge::error(work.system->rod(k).force, c["n"][std::size_t(k)]));
    return worst;
  }

  Json json;
  judge::Tripod data;
  RodRobot robot;
  RodWork work;
};

double row_error(const Eigen::MatrixXd& m, const Json& json) {
  double worst = 0;
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    worsen(worst, judge::error(m.row(i), json[std::size_t(i)]) / m.row(i).lpNorm<Eigen::Infinity>());
  return worst;
}

TEST(RodReference, GeometryIsWhatTheOtherTestsUse) {
  for (const RodTripod& t : {g1, g2}) {
    const Set set(t.name);
    const judge::Tripod built = t.data();
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_LT((built.base[k] - set.data.base[k]).norm(), 1e-15);
      EXPECT_LT((built.platform[k] - set.data.platform[k]).norm(), 1e-15);
    }
    EXPECT_NEAR(built.bending_stiffness, set.data.bending_stiffness, 1e-15);
    EXPECT_EQ(set.json["L_home"].get<double>(), t.length);
    EXPECT_EQ(set.json["h_home"].get<double>(), t.height);
  }
}

TEST(RodReference, AllCases) {  // @verifies 3PFS (25)-(30)
  int cases = 0, stiffnesses = 0;
  for (const char* name : {"G1", "G2"}) {
    Set set(name);
    for (const Json& c : set.json["cases"]) {
      SCOPED_TRACE(c["id"].get<std::string>());
      const Report report = set.solve(c);
      ASSERT_TRUE(report.ok()) << to_string(report);
      EXPECT_EQ(c["unstable_directions"].get<int>(), 0);
      EXPECT_LT(set.pose_error(c), 1e-13);
      EXPECT_LT(set.force_error(c), 1e-10);
      RodGroup& system = *set.work.system;
      double energy = 0;
      for (int k = 0; k < 6; ++k) {
        const auto i = std::size_t(k);
        const RodResult rod = system.rod(k);
        EXPECT_LT(judge::error(Vec2<double>(rod.curvature_0.head<2>()), c["u0"][i]), 1e-10);
        EXPECT_NEAR(rod.tip_angle, c["tip_angle"][i].get<double>(), 1e-12);
        EXPECT_NEAR(rod.energy, c["energy_rods"][i].get<double>(), 1e-12);
        energy += rod.energy;
      }
      EXPECT_NEAR(energy, c["energy"].get<double>(), 3e-12);
      Eigen::Matrix<double, 6, 3> by_input;
      for (int input = 0; input < 3; ++input) {
        const Wrench6 feed = -system.input_wrench_jacobian(input);
        system.factors().solve(feed.data(), by_input.col(input).data());
      }
      for (int i = 0; i < 6; ++i) EXPECT_LT(judge::error(by_input.row(i), c["J_L"][std::size_t(i)]), 1e-11);
      if (c.contains("stiffness")) {
        EXPECT_LT(row_error(system.stiffness(), c["stiffness"]), 1e-9);
        ++stiffnesses;
      }
      ++cases;
    }
  }
  EXPECT_EQ(cases, 20);
  EXPECT_EQ(stiffnesses, 8);
}

TEST(RodReference, AllMultipleEquilibriaFromAStartBeside) {
  const Json& file = judge::data("multiple_equilibria.json");
  int unstable = 0;
  for (const Json& c : file["equilibria"]) {
    SCOPED_TRACE(c["set"].get<std::string>() + " " + c["label"].get<std::string>());
    Set set(c["set"].get<std::string>().c_str());
    const auto number = [](const Json& x) { return x.get<double>(); };
    SE3<double> start;
    start.p = 1.001 * judge::vector(c["p"]);
    start.R = {number(c["e"][0]), Vec3<double>(number(c["e"][1]), number(c["e"][2]), number(c["e"][3]))};
    start.R = start.R.compose(SO3<double>::exp(Vec3<double>(1e-3, -5e-4, 1e-3)));
    const Report report = set.solve(c, {.start = start});
    const int directions = c["unstable_directions"].get<int>();
    ASSERT_EQ(report.status, directions == 0 ? Status::converged : Status::unstable) << to_string(report);
    EXPECT_EQ(unstable_directions(*set.work.system), directions);
    EXPECT_LT(set.pose_error(c), 1e-12);
    EXPECT_LT(set.force_error(c), 1e-9);
    double potential = -dot(set.work.system->wrench().head<3>(), set.work.system->platform().p);
    for (int k = 0; k < 6; ++k) potential += set.work.system->rod(k).energy;
    EXPECT_NEAR(potential, number(c["potential"]), 1e-12 * potential);
    unstable += directions > 0;
  }
  EXPECT_EQ(unstable, 4);
}

}  // namespace rod_reference_test
}  // namespace sinew::test
