/// One rod as a field of frames, between its base and where it is held: against the rod shot from its base,
/// closed forms, another code's numbers, and the loads at which columns buckle.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>

#include "link/elastica_map.hpp"
#include "random_rod.hpp"
#include "reference_file.hpp"
#include "robot/rods/spectral_rod.hpp"
#include "rod_robots.hpp"
#include "shooting_rod/rod_bvp.hpp"

namespace sinew::test {
namespace general_rod_test {

using std::numbers::pi;
using Base = RodEnds::Base;
using Tip = RodEnds::Tip;

/// Of EI and GJ as given, thin.
Rod rod_of(double bending, double torsion, double diameter = 1e-3) {
  Rod rod;
  rod.diameter = diameter;
  rod.youngs_modulus = 1;
  rod.youngs_modulus = bending / rod.bending_stiffness();
  rod.shear_modulus = torsion / (2 * rod.bending_stiffness() / rod.youngs_modulus);
  return rod;
}

/// A platform on one rod that rises from the origin: nothing else holds it.
struct One {
  RodLeg leg;
  std::unique_ptr<GeneralSystem> system;

  One(const Rod& rod, const RodEnds& ends) {
    leg.base = {Vec3<double>::Zero(), turn_to({0, 0, 1})};
    leg.link = rod;
    leg.is_spin_held = ends.base == Base::held;
    leg.is_clamped = ends.tip != Tip::ball;
    leg.is_tip_spin_free = ends.tip == Tip::tangent;
    leg.platform_across = leg.base.rotate(Vec3<double>(1, 0, 0));
    system = std::make_unique<GeneralSystem>(RodRobot{{leg}, pose_of(level(0.9)), 1});
  }
  /// The rod that this base state leads to, its platform at its tip; on as many elements as may be.
  void take(const SpatialRod& rod, double length, const RodState<double>& base) {
    std::vector<double> coordinates(RodLeg::coordinates);
    auto to = coordinates.begin();
    for (int node = 0; node < rod_tangents; ++node) {
      const double s = spectral::place_of(node, GeneralSystem::coordinate_elements).along * length;
      const SO3<double> R = node == 0 ? base.R : integrate(rod, s, base).state.R;
      to = std::ranges::copy(R.log(), to).out;
    }
    const RodState<double> tip = integrate(rod, length, base).state;
    to = std::ranges::copy(tip.n, to).out;
    *to = length;
    system->set_platform({tip.p, tip.R});
    system->set_rods(coordinates);
    while (!system->is_finest()) system->refine();
  }
  bool settle() {
    const bool closed = close_rods(*system);
    balance(*system);
    return closed;
  }
  int unstable() const { return system->unstable_with_tip_held(0)[0]; }
};

/// Straight and pushed together by its ends; shear and stretch are next to nothing.
int unstable_column(double push, const RodEnds& ends, double stiffer = 1) {
  Rod rod = rod_of(1, 0.8);
  if (stiffer != 1) {
    rod.width = rod.diameter * std::sqrt(stiffer), rod.height = rod.diameter, rod.diameter = 0;
    rod.youngs_modulus = 12 / (rod.area() * rod.height * rod.height);
    rod.shear_modulus = rod.youngs_modulus / 2.6;
  }
  rod.is_cosserat = true;
  One one(rod, ends);
  const double shorter = push / (rod.youngs_modulus * rod.area());
  one.system->set_platform(level(1 - shorter));
  EXPECT_TRUE(one.system->draw_rods());
  one.system->set_feed(0, 1);
  while (!one.system->is_finest()) one.system->refine();
  EXPECT_TRUE(one.settle());
  EXPECT_NEAR(one.system->rod(0).force[2], -push, 1e-6 * push);
  return one.unstable();
}

TEST(GeneralRod, ColumnsBuckleAtEulersLoads) {
  const double both = 4 * pi * pi, one = 20.190728556426630;  // tan x = x
  for (const Base base : {Base::held, Base::spins})
    for (const Tip tip : {Tip::clamp, Tip::tangent, Tip::ball}) {
      const RodEnds ends{base, tip};
      const double first = tip == Tip::ball ? one : both;
      EXPECT_EQ(unstable_column(first * 0.9999, ends), 0);
      EXPECT_EQ(unstable_column(first * 1.0001, ends), 2);  // either way
      EXPECT_EQ(unstable_column(first * 1.4999, ends, 1.5), 1);
      EXPECT_EQ(unstable_column(first * 1.5001, ends, 1.5), 2);
    }
  const RodEnds clamped{Base::held, Tip::clamp};
  EXPECT_EQ(unstable_column(80.7629 * 0.9999, clamped), 2);  // tan(x/2) = x/2: the next mode
  EXPECT_EQ(unstable_column(80.7629 * 1.0001, clamped), 4);
}

/// Sharp ones are beyond eight elements, and refused elsewhere.
RC_GTEST_PROP(GeneralRod, UnstableDirectionsAreThoseOfTheElastica, ()) {
  const Vec2<double> local = elastica_local_force(160 * std::pow(uniform(0, 1), 2), uniform(0, pi));
  const ElasticaEquilibrium e = elastica_equilibrium(local);
  const Rod link = rod_of(1, 0.8);
  const SpatialRod rod = spatial_rod(link);
  RodState<double> base;
  base.n = {e.state.force[0], 0, e.state.force[1]};
  base.m = {0, e.state.base_curvature, 0};
  RC_PRE((integrate(rod, 1, base).state.p - Vec3<double>(e.state.tip[0], 0, e.state.tip[1])).norm() < 1e-7);
  RC_PRE(e.stiffness.norm() < 1e5 && std::abs(e.out_of_plane_stiffness) < 1e6);  // folds
  One one(link, {*rc::gen::element(Base::held, Base::spins), Tip::ball});
  base.R = SO3<double>::from([&] {
    Mat<double, 3, 3> axes;
    const Vec3<double> x = one.leg.base.rotate(Vec3<double>(1, 0, 0));
    axes << x, cross(Vec3<double>(0, 0, 1), x), Vec3<double>(0, 0, 1);
    return axes;
  }());
  one.take(rod, 1, base);
  one.system->evaluate();
  RC_PRE(one.system->truncation() < 1e-10);
  RC_ASSERT(one.settle());
  RC_ASSERT((one.system->rod(0).force - base.n).norm() < 1e-6 * (1 + base.n.norm()));
  RC_ASSERT(one.unstable() == e.unstable_in_plane + e.unstable_out_of_plane);
}

TEST(GeneralRod, AgreesWithAnotherCosseratRod) {
  const auto& file = reference_file("data/field/rod_ivp_bvp.json");
  const auto& robot = file["robot"];
  const auto vector = [](const auto& x) { return Vec3<double>(x[0], x[1], x[2]); };
  const double r = robot["radius_m"], L = robot["L_m"];
  Rod link;
  link.diameter = 2 * r;
  link.youngs_modulus = robot["E_Pa"];
  link.shear_modulus = robot["G_Pa"];
  link.is_cosserat = true;
  link.load = vector(robot["g_m_s2"]) * (robot["rho_kg_m3"].get<double>() * pi * r * r);
  const RodEnds clamped{Base::held, Tip::clamp};
  One one(link, clamped);
  SE3<double> tip;
  tip.p = vector(file["bvp"]["pL_m"]);
  const auto& wanted = file["bvp"]["outputs"];
  const Vec3<double> force = vector(wanted["n0"]), moment = vector(wanted["m0"]);
  const RodBvpSolution near =
      solve_rod_bvp(spatial_rod(link), {}, L, clamped, tip, {force * 1.1, moment * 0.9, 0});
  ASSERT_TRUE(near.report.ok());
  one.take(spatial_rod(link), L, near.base);
  one.system->set_platform(tip);
  ASSERT_TRUE(one.settle());
  const RodResult x = one.system->rod(0);
  EXPECT_LT((x.force_0 - force).norm(), file["tolerance"]["bvp_n0_N"].get<double>());
  EXPECT_LT((x.moment_0 - moment).norm(), file["tolerance"]["bvp_m0_Nm"].get<double>());
  EXPECT_LT((x.force - vector(wanted["nL"])).norm(), 1e-5);
  EXPECT_LT((x.moment - vector(wanted["mL"])).norm(), 1e-7);
  EXPECT_EQ(one.unstable(), 1);  // it bends across the weight and would swing down
}

/// A rod that single shooting cannot follow: n L²/EI = 4000, and what changes at its base grows by e⁶³ to its
/// tip.
TEST(GeneralRod, BearsATautRod) {
  Rod rod = rod_of(1, 0.8, 2e-2);
  rod.is_cosserat = true;
  const double stretch = 4000 / (rod.youngs_modulus * rod.area());
  One one(rod, {Base::held, Tip::clamp});
  one.system->set_platform({Vec3<double>(1e-3, 2e-3, 1 + stretch), SO3<double>::exp({0.01, 0.02, 0.03})});
  ASSERT_TRUE(one.system->draw_rods());
  one.system->set_feed(0, 1);
  while (!one.system->is_finest()) one.system->refine();
  ASSERT_TRUE(one.settle());
  const RodResult x = one.system->rod(0);
  EXPECT_NEAR(x.force[2], 4000, 40);
  EXPECT_EQ(one.unstable(), 0);
  const Vec3<double> whole = x.moment + cross(Vec3<double>(x.tip - one.system->base(0)), x.force);
  EXPECT_LT((x.moment_0 - whole).norm(), 1e-8);
}

}  // namespace general_rod_test
}  // namespace sinew::test
