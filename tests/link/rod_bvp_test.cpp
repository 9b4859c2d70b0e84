#include "shooting_rod/rod_bvp.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <numbers>
#include <random>

#include "check_jacobian.hpp"
#include "link/elastica_map.hpp"
#include "random_rod.hpp"
#include "reference_file.hpp"
#include "sanitizers.hpp"

namespace sinew {
namespace held_rod_test {

using std::numbers::pi;
using test::any_rod;
using test::any_vector;
using test::RodKind;
using test::uniform;
using Base = RodEnds::Base;
using Tip = RodEnds::Tip;

constexpr double length = 0.5;
constexpr RodEnds clamped{Base::held, Tip::clamp}, pinned{Base::held, Tip::ball};

struct Task {
  SpatialRod rod;
  RodEnds ends;
  SE3<double> base, tip;

  RodBvpSolution held() const { return solve_rod_bvp(rod, base, length, ends, tip); }
  /// The equilibrium near another, with the tip moved and the rod fed.
  RodBvpSolution near(const RodBvpSolution& other, const Vec<double, 7>& x) const {
    return solve_rod_bvp(rod, base, length + x[6], ends, tip.displaced(x.head<6>()),
                         {other.base.n, other.base.m, other.axial_rotation}, {.steps = other.steps});
  }
};

/// Tips ahead of the base, half to nearly the whole length away.
Task any_task() {
  Task task;
  task.rod =
      any_rod(*rc::gen::element(RodKind::plain, RodKind::cosserat, RodKind::general, RodKind::general));
  task.ends = {*rc::gen::element(Base::held, Base::spins),
               *rc::gen::element(Tip::ball, Tip::clamp, Tip::tangent)};
  task.base = {any_vector(1), SO3<double>::exp(any_vector(2))};
  const Vec3<double> way =
      (Vec3<double>(0, 0, 1) + any_vector(0.4)).normalized() * uniform(0.5, 0.95) * length;
  task.tip = {task.base.point(way), task.base.R.compose(SO3<double>::exp(any_vector(0.6)))};
  return task;
}

Vec<double, 6> wrench(const RodBvpSolution& x) {
  Vec<double, 6> w;
  w << x.tip.n, x.tip.m;
  return w;
}

/// Whether `there`, after this motion, continues `x`: another equilibrium is far away in force.
bool continues(const RodBvpSolution& x, const RodBvpSolution& there, const Vec<double, 7>& motion,
               double force_unit) {
  const Vec<double, 6> expected = x.stiffness * motion.head<6>() + x.feed * motion[6];
  const Vec<double, 6> off = wrench(there) - wrench(x) - expected;
  return there.report.ok() && off.head<3>().norm() < 0.3 * expected.head<3>().norm() + 0.1 * force_unit;
}

/// A rod in space meets its ends: what any answer is judged by.
void check_ends(const Task& task, const RodBvpSolution& x) {
  const double EI = task.rod.bending_stiffness[0], moment = 1e-8 * EI / length;
  const RodTip again = integrate(task.rod, length, x.base, {.steps = 2 * x.steps});
  RC_ASSERT((again.state.p - x.tip.p).norm() < 1e-9);
  RC_ASSERT((x.tip.p - task.tip.p).norm() < 1e-10);
  RC_ASSERT((x.base.p - task.base.p).norm() == 0);
  RC_ASSERT((x.base.tangent() - task.base.rotate({0, 0, 1})).norm() < 1e-12);
  if (task.ends.base == Base::held) RC_ASSERT(x.base.R.compose(task.base.R.inverse()).log().norm() < 1e-12);
  if (task.ends.base == Base::spins) RC_ASSERT(std::abs(x.base.m.dot(x.base.tangent())) < moment);
  const Vec3<double> t = task.tip.rotate({0, 0, 1});
  if (task.ends.tip == Tip::ball) RC_ASSERT(x.tip.m.norm() < moment);
  if (task.ends.tip == Tip::clamp) RC_ASSERT(x.tip.R.compose(task.tip.R.inverse()).log().norm() < 1e-9);
  if (task.ends.tip == Tip::tangent) {
    RC_ASSERT((x.tip.tangent() - t).norm() < 1e-9);
    RC_ASSERT(std::abs(x.tip.m.dot(t)) < moment);
  }
}

RC_GTEST_PROP(RodBvpSolution, MeetsItsEndsOrSaysThatItDoesNot, ()) {
  const Task task = any_task();
  const RodBvpSolution x = task.held();
  RC_CLASSIFY(x.report.ok());
  if (x.report.ok()) {
    RC_ASSERT(x.report.residual < 1e-11 * length);
    check_ends(task, x);
  } else {
    RC_ASSERT(!x.report.message.empty() && !x.stiffness.allFinite());
  }
}

// A search may fail; how often is known. The same tasks every time.
TEST(RodBvpSolution, IsFoundFromAnArcNearlyAlways) {
  std::mt19937 engine(7);
  const auto vector = [&](double size) {
    const auto one = [&] { return size * (static_cast<double>(engine() % 20001) / 1e4 - 1); };
    const double x = one(), y = one();
    return Vec3<double>(x, y, one());
  };
  int tasks = 0, found = 0, stable = 0;
  for (const Base base_end : {Base::held, Base::spins}) {
    for (const Tip tip_end : {Tip::ball, Tip::clamp, Tip::tangent}) {
      for (int k = 0; k < 20; ++k) {
        SpatialRod rod = SpatialRod::round(200e9, 80e9, 0.002, k % 2 ? RodLaw::cosserat : RodLaw::kirchhoff);
        if (k % 4 > 1) {
          rod.bending_stiffness[1] *= 1.7;
          rod.precurvature = vector(2);
          rod.load = vector(0.5);
        }
        const Vec3<double> way = (Vec3<double>(0, 0, 1) + vector(0.5)).normalized();
        const SE3<double> tip{way * (0.72 + 0.23 * vector(1)[0]) * length, SO3<double>::exp(vector(0.6))};
        const RodBvpSolution x = solve_rod_bvp(rod, {}, length, {base_end, tip_end}, tip);
        ++tasks;
        found += x.report.ok();
        stable += x.report.ok() && unstable_directions(rod, length, x.base, {base_end, tip_end}) == 0;
      }
    }
  }
  EXPECT_GE(found, tasks - 2);
  EXPECT_GE(stable, tasks - 4);
}

/// Properties that hold dozens of rods a case let most cases be, under sanitizers nearly all.
bool is_let_be() { return *rc::gen::inRange(0, test::addresses_are_checked ? 20 : 3) != 0; }

RC_GTEST_PROP(RodBvpSolution, StiffnessAndFeedAreTheDerivatives, ()) {
  if (is_let_be()) return;
  const Task task = any_task();
  const RodBvpSolution x = task.held();
  RC_PRE(x.report.ok());
  const double EI = task.rod.bending_stiffness[0];
  RC_PRE(x.stiffness.norm() < 150 * EI / std::pow(length, 3));  // away from folds and from straight
  Mat<double, 6, 7> exact;
  exact << x.stiffness, x.feed;
  bool all_found = true;
  const auto moved = [&](const Vec<double, 7>& motion) {
    const RodBvpSolution there = task.near(x, motion);
    all_found = all_found && continues(x, there, motion, EI / (length * length));
    return wrench(there);
  };
  const Vec<double, 7> none = Vec<double, 7>::Zero();
  const Eigen::MatrixXd differences = test::central_jacobian(moved, none, 5e-4 * length);
  RC_PRE(all_found);
  RC_ASSERT(test::jacobian_error(exact, differences, 0.01 * EI / (length * length)) < 1e-5);
}

RC_GTEST_PROP(RodBvpSolution, StiffnessIsSymmetricButForTheMomentItself, ()) {
  const Task task = any_task();
  const RodBvpSolution x = task.held();
  RC_PRE(x.report.ok());
  // Turns do not commute: the work of two small ones in either order differs by m·(δ₁ × δ₂).
  Mat<double, 6, 6> odd = x.stiffness - x.stiffness.transpose();
  const double size = 1e-7 * x.stiffness.norm();
  if (task.ends.tip == Tip::clamp) odd.bottomRightCorner<3, 3>() += skew<double>(x.tip.m);
  if (task.ends.tip != Tip::tangent) RC_ASSERT(odd.norm() < size);
  const Mat<double, 3, 6> by_force = odd.topRows<3>();
  RC_ASSERT(by_force.norm() < size);
}

RC_GTEST_PROP(RodBvpSolution, WrenchIsTheDerivativeOfTheEnergy, ()) {
  if (is_let_be()) return;
  const Task task = any_task();
  const RodBvpSolution x = task.held();
  RC_PRE(x.report.ok());
  const double EI = task.rod.bending_stiffness[0];
  RC_PRE(x.stiffness.norm() < 150 * EI / std::pow(length, 3));
  bool all_found = true;
  const auto energy = [&](const Vec<double, 6>& motion) {
    Vec<double, 7> all;
    all << motion, 0;
    const RodBvpSolution there = task.near(x, all);
    all_found = all_found && continues(x, there, all, EI / (length * length));
    return Vec<double, 1>(there.energy);
  };
  const Vec<double, 6> none = Vec<double, 6>::Zero();
  const Eigen::MatrixXd slope = test::central_jacobian(energy, none, 5e-4 * length);
  RC_PRE(all_found);
  RC_ASSERT(test::jacobian_error(wrench(x).transpose(), slope, 0.1 * EI / (length * length)) < 1e-7);
}

RC_GTEST_PROP(RodBvpSolution, BallTipIsTheStableElastica, ()) {
  const double d = uniform(0.05, 0.5), w = uniform(0.5, 0.95) * std::sqrt(1 - d * d);
  const SpatialRod rod = any_rod(RodKind::plain);
  const ElasticaMap map = elastica_map({d, w});
  RC_PRE(map.report.ok() && map.equilibria[0].is_stable());
  SE3<double> tip;
  tip.p = Vec3<double>(d, 0, w) * length;
  const RodBvpSolution x =
      solve_rod_bvp(rod, {}, length, {*rc::gen::element(Base::held, Base::spins), Tip::ball}, tip);
  RC_ASSERT(x.report.ok());
  const ElasticaEquilibrium& e = map.equilibria[0];
  const ElasticaUnits unit{length, rod.bending_stiffness[0]};
  const Vec3<double> force(e.state.force[0], 0, e.state.force[1]);
  RC_ASSERT((x.tip.n - unit.force() * force).norm() < 1e-8 * unit.force() * (1 + force.norm()));
  RC_ASSERT(std::abs(x.energy - unit.energy() * e.state.energy) < 1e-9 * unit.energy());
  Mat<double, 3, 3> stiffness = Mat<double, 3, 3>::Zero();
  stiffness(0, 0) = e.stiffness(0, 0), stiffness(0, 2) = stiffness(2, 0) = e.stiffness(0, 1);
  stiffness(2, 2) = e.stiffness(1, 1), stiffness(1, 1) = e.out_of_plane_stiffness;
  const Mat<double, 3, 3> ours = x.stiffness.topLeftCorner<3, 3>() / unit.stiffness();
  RC_ASSERT((ours - stiffness).norm() < 1e-7 * stiffness.norm());
}

TEST(RodBvpSolution, AgreesWithAnotherCosseratRod) {
  const auto& file = test::reference_file("data/field/rod_ivp_bvp.json");
  const auto& robot = file["robot"];
  const auto vector = [](const auto& x) { return Vec3<double>(x[0], x[1], x[2]); };
  const double r = robot["radius_m"], L = robot["L_m"];
  SpatialRod rod = SpatialRod::round(robot["E_Pa"], robot["G_Pa"], 2 * r, RodLaw::cosserat);
  rod.load = vector(robot["g_m_s2"]) * (robot["rho_kg_m3"].get<double>() * pi * r * r);
  SE3<double> tip;
  tip.p = vector(file["bvp"]["pL_m"]);
  const auto& wanted = file["bvp"]["outputs"];
  const Vec3<double> force = vector(wanted["n0"]), moment = vector(wanted["m0"]);
  const RodBvpSolution x = solve_rod_bvp(rod, {}, L, clamped, tip, {force * 1.1, moment * 0.9, 0});
  ASSERT_TRUE(x.report.ok());
  EXPECT_LT((x.base.n - force).norm(), file["tolerance"]["bvp_n0_N"].get<double>());
  EXPECT_LT((x.base.m - moment).norm(), file["tolerance"]["bvp_m0_Nm"].get<double>());
  EXPECT_LT((x.tip.n - vector(wanted["nL"])).norm(), 1e-5);
  EXPECT_LT((x.tip.m - vector(wanted["mL"])).norm(), 1e-7);
  // It bends across the weight and would swing down; from nothing known, the one that has is found.
  EXPECT_EQ(unstable_directions(rod, L, x.base, clamped), 1);
  const RodBvpSolution swung = solve_rod_bvp(rod, {}, L, clamped, tip);
  ASSERT_TRUE(swung.report.ok());
  EXPECT_EQ(unstable_directions(rod, L, swung.base, clamped), 0);
  EXPECT_LT(swung.energy, x.energy - 0.02);
}

/// Straight under an axial push and a twist, in EI = 1, L = 1.
int unstable_column(double push, double torque, const RodEnds& ends, double stiffer = 1) {
  SpatialRod rod;
  rod.bending_stiffness = {1, stiffer};
  rod.torsion_stiffness = 0.8;
  RodState<double> base;
  base.n = {0, 0, -push};
  base.m = {0, 0, torque};
  return unstable_directions(rod, 1, base, ends);
}

TEST(UnstableDirections, OfColumnsBeginAtEulersLoads) {
  const double both = 4 * pi * pi, one = 20.190728556426630;  // tan x = x
  for (const Base base : {Base::held, Base::spins}) {
    for (const Tip tip : {Tip::clamp, Tip::tangent, Tip::ball}) {
      const RodEnds ends{base, tip};
      const double first = tip == Tip::ball ? one : both;
      EXPECT_EQ(unstable_column(-first, 0, ends), 0);
      EXPECT_EQ(unstable_column(first * 0.9999, 0, ends), 0);
      EXPECT_EQ(unstable_column(first * 1.0001, 0, ends), 2);  // either way
      EXPECT_EQ(unstable_column(first * 1.4999, 0, ends, 1.5), 1);
      EXPECT_EQ(unstable_column(first * 1.5001, 0, ends, 1.5), 2);
    }
  }
  EXPECT_EQ(unstable_column(80.7629 * 0.9999, 0, clamped), 2);  // tan(x/2) = x/2: the next mode
  EXPECT_EQ(unstable_column(80.7629 * 1.0001, 0, clamped), 4);
}

TEST(UnstableDirections, OfTwistedRodsBeginAtGreenhillsTorque) {
  const double torque = 8.9868189158;  // 2 x, tan x = x
  EXPECT_EQ(unstable_column(0, 0.9999 * torque, clamped), 0);
  EXPECT_EQ(unstable_column(0, 1.0001 * torque, clamped), 2);
}

RC_GTEST_PROP(UnstableDirections, AreThoseOfTheElastica, ()) {
  const Vec2<double> local = elastica_local_force(160 * std::pow(uniform(0, 1), 2), uniform(0, pi));
  const ElasticaEquilibrium e = elastica_equilibrium(local);
  SpatialRod rod;
  rod.bending_stiffness = {1, 1};
  rod.torsion_stiffness = 0.8;
  RodState<double> base;
  base.n = {e.state.force[0], 0, e.state.force[1]};
  base.m = {0, e.state.base_curvature, 0};
  RC_PRE((integrate(rod, 1, base).state.p - Vec3<double>(e.state.tip[0], 0, e.state.tip[1])).norm() < 1e-7);
  RC_PRE(e.stiffness.norm() < 1e5 && std::abs(e.out_of_plane_stiffness) < 1e6);  // folds
  const RodEnds ends{*rc::gen::element(Base::held, Base::spins), Tip::ball};
  RC_ASSERT(unstable_directions(rod, 1, base, ends) == e.unstable_in_plane + e.unstable_out_of_plane);
}

TEST(RodBvpSolution, SaysWhatCannotBe) {
  const SpatialRod rod = SpatialRod::round(200e9, 80e9, 0.002);
  SE3<double> tip;
  tip.p = {0, 0, 0.51};
  const RodBvpSolution beyond = solve_rod_bvp(rod, {}, length, pinned, tip);
  EXPECT_EQ(beyond.report.status, Status::unreachable);
  EXPECT_NEAR(beyond.report.residual, 0.01, 1e-12);
  EXPECT_EQ(beyond.report.message.view(), "the tip is farther away than the rod is long, by 10 mm");
  tip.p = {0, 0, length};
  EXPECT_EQ(solve_rod_bvp(rod, {}, length, pinned, tip).report.status, Status::singular);  // straight
  tip.p = {0, 0, 0.4};
  EXPECT_EQ(solve_rod_bvp(rod, {}, length, pinned, tip).report.status,
            Status::singular);  // turns about the base
  tip.p = {0.1, 0, 0.4};
  EXPECT_TRUE(solve_rod_bvp(rod, {}, length, pinned, tip).report.ok());
  for (const double L : {0.0, -1.0, std::nan("")})
    EXPECT_EQ(solve_rod_bvp(rod, {}, L, pinned, tip).report.status, Status::left_domain);
  EXPECT_EQ(solve_rod_bvp(SpatialRod{}, {}, length, pinned, tip).report.status, Status::left_domain);
  tip.p[0] = std::nan("");
  EXPECT_EQ(solve_rod_bvp(rod, {}, length, pinned, tip).report.status, Status::left_domain);
  EXPECT_FALSE(solve_rod_bvp(rod, {}, length, pinned, tip).stiffness.allFinite());
}

TEST(RodBvpSolution, OfABadStartItFallsBackToTheArc) {
  const SpatialRod rod = SpatialRod::round(200e9, 80e9, 0.002);
  SE3<double> tip;
  tip.p = {0.1, 0.05, 0.4};
  const RodBvpSolution good = solve_rod_bvp(rod, {}, length, clamped, tip);
  ASSERT_TRUE(good.report.ok());
  const double nan = std::nan("");
  const RodBvpSolution again = solve_rod_bvp(rod, {}, length, clamped, tip, {{nan, 0, 0}, {0, 0, 0}, 0});
  EXPECT_TRUE(again.report.ok());
  EXPECT_NEAR(again.energy, good.energy, 1e-10);
}

TEST(RodBvpSolution, StretchesWhereItMay) {
  SpatialRod rod = SpatialRod::round(200e9, 80e9, 0.002, RodLaw::cosserat);
  rod.extension_compliance = 1e-3;
  SE3<double> tip;
  tip.p = {0, 0, 0.51};
  const RodBvpSolution x = solve_rod_bvp(rod, {}, length, clamped, tip);
  ASSERT_TRUE(x.report.ok());
  EXPECT_NEAR(x.tip.n[2], 20, 1e-7);
  EXPECT_NEAR(x.stiffness(2, 2), 2000, 1e-5);
  EXPECT_NEAR(x.energy, 0.1, 1e-8);
  EXPECT_EQ(unstable_directions(rod, length, x.base, clamped), 0);
}

}  // namespace held_rod_test
}  // namespace sinew
