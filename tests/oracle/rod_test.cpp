/// The rod and the judge of equilibria: what tells right from wrong must itself be right.
#include "reference_3pfs.hpp"

#include <gtest/gtest.h>

namespace sinew::test::shooting {
namespace rod_test {

double largest(const Section<double>& a, const Section<double>& b) {
  double worst = 0;
  for (std::size_t i = 0; i < 9; ++i) {
    const double off = std::abs(a[i] - b[i]);
    worst = std::isnan(worst) || off <= worst ? worst : off;
  }
  return worst;
}

// Half a metre, n L²/EI = 16: the cases of the reference carry at most 7.7.
const Vector3d hard_force(5, -8, -20);
Section<double> hard_rod(const Integration& how) { return tip(hard_force, 3.0, 2.0, 0.5, 0.33, how); }

TEST(ShootingRod, WithoutForceIsAnArc) {
  const double u = 4.2, L = 0.5;
  const auto y = tip<double>(Vector3d::Zero(), u * 0.6, u * 0.8, L, 0.33, {});
  const double reach = (1 - std::cos(u * L)) / u;  // bends about (0.6, 0.8, 0), towards (0.8, −0.6, 0)
  const Section<double> arc{0.8 * reach,
                            -0.6 * reach,
                            std::sin(u * L) / u,
                            std::cos(u * L / 2),
                            0.6 * std::sin(u * L / 2),
                            0.8 * std::sin(u * L / 2),
                            0,
                            u * 0.6,
                            u * 0.8};
  EXPECT_LT(largest(y, arc), 2e-15);
}

TEST(ShootingRod, IntegratesToRounding) {
  const auto exact = hard_rod({Method::order_8, 128});
  const auto off = [&](Method method, int steps) { return largest(hard_rod({method, steps}), exact); };
  EXPECT_NEAR(std::log2(off(Method::order_8, 8) / off(Method::order_8, 16)), 8, 0.2);
  EXPECT_NEAR(std::log2(off(Method::rk4, 40) / off(Method::rk4, 80)), 4, 0.2);
  const auto y = hard_rod({});
  for (std::size_t i = 0; i < 7; ++i) EXPECT_NEAR(y[i], exact[i], 1e-13) << i;  // curvature: rounding × 1/L
  EXPECT_LT(largest(y, exact), 2e-12);
}

TEST(ShootingRod, KeepsWhatTheEquationsKeep) {  // |q| = 1, H = ½ EI |u|² + n·t, and no moment about n
  const auto y = hard_rod({});
  const auto slope = rate(y, hard_force, 0.33);
  const Vector3d t(slope[0], slope[1], slope[2]), u(y[7], y[8], 0);
  EXPECT_NEAR(y[3] * y[3] + y[4] * y[4] + y[5] * y[5] + y[6] * y[6], 1, 1e-14);
  EXPECT_NEAR(0.165 * u.squaredNorm() + hard_force.dot(t), 0.165 * 13 - 20, 1e-12);
  const Vector3d moment = 0.33 * (rotation(y[3], y[4], y[5], y[6]) * u);
  EXPECT_NEAR(moment.dot(hard_force), 0.33 * Vector3d(3, 2, 0).dot(hard_force), 1e-13);
}

struct Claim {
  PerRod<double> lengths;
  Wrench wrench;
  Vector3d p;
  Eigen::Matrix3d R;
  PerRod<Vector3d> n;

  explicit Claim(const Json& c)
      : lengths(pairs(vector(c["L"]))),
        wrench{vector(c["F_ext"]), vector(c["M_ext"])},
        p(vector(c["p"])) {
    const Json& e = c["e"];
    R = rotation(e[0].get<double>(), e[1].get<double>(), e[2].get<double>(), e[3].get<double>());
    for (std::size_t i = 0; i < 6; ++i) n[i] = vector(c["n"][i]);
  }
  Mismatch judged(const Tripod& t) const { return reintegrate(t, lengths, wrench, p, R, n); }
};

double worst(const Mismatch& off) {
  double all = 0;
  for (double x : {off.closure, off.tip_curvature, off.torsion, off.force, off.moment})
    all = std::isnan(all) || x <= all ? all : x;
  return all;
}

TEST(Reintegration, AcceptsTheReference) {
  for (const char* name : {"G1", "G2"}) {
    const Json& set = reference(name);
    for (const Json& c : set["cases"]) {
      const Mismatch off = Claim(c).judged(tripod(set));
      EXPECT_LT(off.closure, 1e-13) << c["id"];
      EXPECT_LT(worst(off), 1e-10) << c["id"];
    }
  }
}

TEST(Reintegration, RejectsWhatIsSlightlyWrong) {
  const Json& set = reference("G2");
  const Tripod t = tripod(set);
  const Claim right(set["cases"].back());
  const double rounding = worst(right.judged(t));
  Claim moved = right;
  moved.p.z() += 1e-8;
  EXPECT_GT(moved.judged(t).closure, 5e-9);
  Claim turned = right;
  turned.R.col(0) += 1e-8 * right.R.col(1);
  EXPECT_GT(turned.judged(t).closure, 5e-10);
  Claim pushed = right;
  const Vector3d push(1e-6, 0, 0), arm = right.R * t.platform[0];
  pushed.n[0] += push;
  EXPECT_NEAR(pushed.judged(t).force, 1e-6, 1e-11);
  EXPECT_NEAR(pushed.judged(t).moment, cross(arm, push).norm(), 1e-11);
  EXPECT_GT(pushed.judged(t).closure, 1e-9);
  EXPECT_GT(pushed.judged(t).torsion, 1e-9);
  Claim longer = right;
  longer.lengths[5] += 1e-8;
  EXPECT_GT(longer.judged(t).closure, 5e-9);
  EXPECT_LT(rounding, 1e-10);
}

TEST(Reintegration, NeverAcceptsWhatIsNoNumber) {
  const Json& set = reference("G2");
  const Tripod t = tripod(set);
  Claim no_pose(set["cases"][0]), no_force = no_pose;
  no_pose.p.y() = std::nan("");
  EXPECT_TRUE(std::isnan(no_pose.judged(t).closure));
  no_force.n[0].x() = std::nan("");  // the first of six: those that follow are numbers
  const Mismatch off = no_force.judged(t);
  for (double x : {off.closure, off.tip_curvature, off.torsion, off.force, off.moment})
    EXPECT_TRUE(std::isnan(x));
}

}  // namespace rod_test
}  // namespace sinew::test::shooting
