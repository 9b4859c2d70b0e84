#include "shooting_rod/shooting_rod.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <complex>
#include <numbers>
#include <vector>

#include "check_jacobian.hpp"
#include "link/elastica.hpp"
#include "random_rod.hpp"
#include "reference_file.hpp"
#include "rod_3pfs.hpp"
#include "shooting_rod/rod_steps.hpp"

namespace sinew {
namespace spatial_rod_test {

using std::numbers::pi;
using test::any_rod;
using test::any_vector;
using test::RodKind;
using test::uniform;

constexpr double length = 0.5;

/// Straight and unloaded a sixth of the time, gently loaded another.
RodState<double> any_base(const SpatialRod& rod) {
  const double EI = rod.bending_stiffness[0], size = *rc::gen::element(0.0, 1e-6, 1.0, 1.0, 3.0, 3.0);
  RodState<double> base;
  base.p = any_vector(1);
  base.R = SO3<double>::exp(any_vector(2));
  base.n = any_vector(size * 3 * EI / (length * length));
  base.m = any_vector(size * EI / length);
  return base;
}

double turn_between(const RodState<double>& a, const RodState<double>& b) {
  return a.R.compose(b.R.inverse()).log().norm();
}

TEST(SpatialRod, RoundSectionHasItsStiffnesses) {
  const double d = 0.002, E = 200e9, G = 80e9, area = pi * d * d / 4, second = pi * std::pow(d, 4) / 64;
  const SpatialRod rod = SpatialRod::round(E, G, d, RodLaw::cosserat);
  EXPECT_NEAR(rod.bending_stiffness[0] / (E * second), 1, 1e-15);
  EXPECT_EQ(rod.bending_stiffness[0], rod.bending_stiffness[1]);
  EXPECT_NEAR(rod.torsion_stiffness / (G * 2 * second), 1, 1e-15);
  EXPECT_NEAR(rod.extension_compliance * E * area, 1, 1e-15);
  EXPECT_NEAR(rod.shear_compliance[1] * G * area, 1, 1e-15);
  EXPECT_TRUE(rod.is_valid() && rod.is_isotropic() && !rod.is_kirchhoff());
  EXPECT_TRUE(SpatialRod::round(E, G, d).is_kirchhoff());
}

// The paper's equations in its own variables, integrated by the tests' own method.
RC_GTEST_PROP(SpatialRod, IsThePapersRodWithoutTorsion, ()) {  // 3PFS (20)-(23)
  SpatialRod rod = any_rod(RodKind::plain);
  const double EI = rod.bending_stiffness[0];
  RodState<double> base;
  base.n = any_vector(2 * EI / (length * length));
  const double ux = uniform(-4, 4), uy = uniform(-4, 4);
  base.m = Vec3<double>(ux, uy, 0) * EI;
  const RodTip tip = integrate(rod, length, base);
  const auto paper = test::shooting::tip<double>(base.n, ux, uy, length, EI, {});
  RC_ASSERT(tip.status == Status::converged);
  for (int i = 0; i < 3; ++i)
    RC_ASSERT(std::abs(tip.state.p[i] - paper[static_cast<std::size_t>(i)]) < 5e-12);
  const SO3<double> R{paper[3], Vec3<double>(paper[4], paper[5], paper[6])};
  RC_ASSERT(tip.state.R.compose(R.inverse()).log().norm() < 1e-11);
  const Vec3<double> curvature = tip.state.R.rotate_back(tip.state.m) / EI;
  RC_ASSERT((curvature - Vec3<double>(paper[7], paper[8], 0)).norm() < 1e-10);
  RC_ASSERT((rod_steps::matrix(Vec<double, 4>(R.w, R.v[0], R.v[1], R.v[2])) - R.matrix()).norm() < 1e-14);
}

TEST(SpatialRod, AgreesWithAnotherCosseratRod) {
  const auto& file = test::reference_file("data/field/rod_ivp_bvp.json");
  const auto& robot = file["robot"];
  const auto vector = [](const auto& x) { return Vec3<double>(x[0], x[1], x[2]); };
  const double r = robot["radius_m"], L = robot["L_m"];
  SpatialRod rod = SpatialRod::round(robot["E_Pa"], robot["G_Pa"], 2 * r, RodLaw::cosserat);
  rod.load = vector(robot["g_m_s2"]) * (robot["rho_kg_m3"].get<double>() * pi * r * r);
  RodState<double> base;
  base.n = vector(file["ivp"]["n0_N"]);
  base.m = vector(file["ivp"]["m0_Nm"]);
  const RodTip tip = integrate(rod, L, base);
  const auto& wanted = file["ivp"]["outputs"];
  const double tolerance = file["tolerance"]["ivp"];
  EXPECT_EQ(tip.status, Status::converged);
  EXPECT_LT((tip.state.p - vector(wanted["pL"])).norm(), tolerance);
  EXPECT_LT((tip.state.n - vector(wanted["nL"])).norm(), tolerance);
  EXPECT_LT((tip.state.m - vector(wanted["mL"])).norm(), tolerance);
  const Mat<double, 3, 3> R = tip.state.R.matrix();
  for (int i = 0; i < 9; ++i)
    EXPECT_NEAR(R(i / 3, i % 3), wanted["RL_rowmajor"][static_cast<std::size_t>(i)].get<double>(), tolerance)
        << i;
}

RC_GTEST_PROP(SpatialRod, UnderATipForceIsTheElastica, ()) {
  const Vec2<double> local = elastica_local_force(uniform(0, 45), uniform(-pi, pi));
  const ElasticaState<double> x = elastica(local);
  const SpatialRod rod = any_rod(RodKind::plain);
  const ElasticaUnits unit{length, rod.bending_stiffness[0]};
  const double turn = uniform(-pi, pi), c = std::cos(turn), s = std::sin(turn);
  RodState<double> base;
  base.n = unit.force() * Vec3<double>(x.force[0] * c, x.force[0] * s, x.force[1]);
  base.m = unit.energy() * x.base_curvature * Vec3<double>(-s, c, 0);
  const RodTip tip = integrate(rod, length, base, {.steps = 0, .tolerance = 1e-11});
  const double growth = std::cosh(std::sqrt(local.norm()));
  RC_ASSERT(tip.error < 1e-11);
  RC_ASSERT((tip.state.p / length - Vec3<double>(x.tip[0] * c, x.tip[0] * s, x.tip[1])).norm() <
            1e-13 * growth + 5e-11);
  RC_ASSERT(tip.state.m.norm() < (1e-12 * growth + 1e-9) * unit.energy());
  RC_ASSERT(std::abs(tip.energy - unit.energy() * x.energy) < (1e-12 * growth + 1e-9) * unit.energy());
}

// Constant u solves the equations where its own moment does not turn it: u × K(u − u*) = 0.
RC_GTEST_PROP(SpatialRod, PrecurvedRodAtRestIsAHelix, ()) {
  SpatialRod rod = any_rod(RodKind::general);
  rod.load.setZero();
  rod.precurvature = any_vector(8);
  RodState<double> base;
  base.p = any_vector(1);
  base.R = SO3<double>::exp(any_vector(1));
  const RodTip tip = integrate(rod, length, base);
  const Vec3<double> turn = rod.precurvature * length;
  RC_ASSERT(tip.state.R.compose(base.R.compose(SO3<double>::exp(turn)).inverse()).log().norm() < 3e-12);
  const Vec3<double> chord = SO3<double>::left_jacobian(turn) * Vec3<double>(0, 0, length);
  RC_ASSERT((tip.state.p - base.p - base.R.rotate(chord)).norm() < 2e-12);
  RC_ASSERT(tip.state.m.norm() == 0 && tip.energy == 0);
}

TEST(SpatialRod, TwistedAndPulledStraightIsABar) {
  const SpatialRod rod = SpatialRod::round(200e9, 80e9, 0.002, RodLaw::cosserat);
  RodState<double> base;
  base.n = {0, 0, 30};
  base.m = {0, 0, 0.7};
  const RodTip tip = integrate(rod, length, base);
  EXPECT_NEAR(tip.state.p[2], length * (1 + 30 * rod.extension_compliance), 1e-13);
  EXPECT_NEAR(tip.state.R.log()[2], length * 0.7 / rod.torsion_stiffness, 1e-12);
  EXPECT_NEAR(tip.energy, 0.5 * length * (0.49 / rod.torsion_stiffness + 900 * rod.extension_compliance),
              1e-13);
  EXPECT_LT(tip.state.p.head<2>().norm() + (tip.state.m - base.m).norm(), 1e-14);
}

TEST(SpatialRod, ShearsUnderATransverseForceAsATimoshenkoBeam) {
  SpatialRod rod = SpatialRod::round(200e9, 80e9, 0.002);
  rod.shear_compliance = {1e-3, 2e-3};  // much softer than any solid section
  const double force = 1e-6;            // linear
  RodState<double> base;
  base.n = {force, 0, 0};
  base.m = {0, length * force, 0};
  const double bend = force * std::pow(length, 3) / (3 * rod.bending_stiffness[1]),
               shear = force * length * 1e-3;
  EXPECT_NEAR(integrate(rod, length, base).state.p[0], bend + shear, 1e-12);
}

RC_GTEST_PROP(SpatialRod, KeepsWhatTheEquationsKeep, ()) {
  SpatialRod rod = any_rod(RodKind::general);
  rod.load.setZero();
  const RodState<double> base = any_base(rod);
  std::array<RodState<double>, 9> sections;
  RC_ASSERT(rod_sections(rod, length, base, sections) == Status::converged);
  const Vec3<double> bend(1 / rod.bending_stiffness[0], 1 / rod.bending_stiffness[1],
                          1 / rod.torsion_stiffness);
  const Vec3<double> stretch(rod.shear_compliance[0], rod.shear_compliance[1], rod.extension_compliance);
  const auto first_integral = [&](const RodState<double>& x) {  // the Hamiltonian of a uniform rod
    const Vec3<double> n = x.R.rotate_back(x.n), m = x.R.rotate_back(x.m);
    return m.dot(rod.precurvature) + n[2] +
           0.5 * (m.dot(bend.cwiseProduct(m)) + n.dot(stretch.cwiseProduct(n)));
  };
  const double size = 1e-10 * (1 + base.n.norm() + base.m.norm() * 20);
  for (const RodState<double>& x : sections) {
    RC_ASSERT((x.n - base.n).norm() == 0);
    const Vec3<double> about = x.m - base.m + cross(Vec3<double>(x.p - base.p), base.n);
    RC_ASSERT(about.norm() < size);
    RC_ASSERT(std::abs(first_integral(x) - first_integral(base)) < size);
    if (rod.is_isotropic()) RC_ASSERT(std::abs(x.m.dot(x.tangent()) - base.m.dot(base.tangent())) < size);
  }
}

RC_GTEST_PROP(SpatialRod, WeightIsHeldByItsEnds, ()) {
  SpatialRod rod = any_rod(RodKind::general);
  const RodState<double> base = any_base(rod);
  std::array<RodState<double>, 65> sections;
  rod_sections(rod, length, base, sections);
  RC_ASSERT((sections[64].n + rod.load * length - base.n).norm() < 1e-13 * (1 + base.n.norm()));
  Vec3<double> centre = Vec3<double>::Zero();  // Boole
  for (std::size_t k = 0; k <= 64; ++k) {
    const double weight = k % 4 == 0 ? (k == 0 || k == 64 ? 7 : 14) : k % 2 == 0 ? 12 : 32;
    centre += weight * 2 / 45 / 64 * (sections[k].p - base.p);
  }
  const Vec3<double> arm = sections[64].p - base.p, load = rod.load * length;
  const Vec3<double> moment = sections[64].m + cross(arm, sections[64].n) + cross(centre, load) - base.m;
  RC_ASSERT(moment.norm() < 1e-6 * (base.m.norm() + length * (load.norm() + base.n.norm())) + 1e-14);
}

/// Everything at the tip as a function of what the columns of RodTangent mean, in complex numbers.
template <class S>
Vec<S, 12> tip_of(const SpatialRod& rod, const RodState<double>& base, int steps, const SO3<double>& around,
                  const Vec<S, 8>& x) {
  RodState<S> at{
      base.p.cast<S>(), {S(base.R.w), base.R.v.template cast<S>()}, base.n.cast<S>(), base.m.cast<S>()};
  at.n += x.template head<3>();
  at.m += x.template segment<3>(3);
  at.R = at.R.compose(SO3<S>::exp(Vec3<S>(S(0), S(0), x[6])));
  rod_steps::Walk<S> walk(rod, S(length) + x[7], at, steps);
  for (int i = 0; i < steps; ++i) walk.step();
  const RodState<S> tip = walk.state(at);
  const SO3<S> from{S(around.w), around.v.template cast<S>()};
  Vec<S, 12> out;
  out << tip.p, tip.R.compose(from.inverse()).log(), tip.n, tip.m;
  return out;
}

RC_GTEST_PROP(SpatialRod, RatesAreTheDerivativesOfTheNumbersThemselves, ()) {
  const SpatialRod rod = any_rod(*rc::gen::element(RodKind::plain, RodKind::cosserat, RodKind::general));
  const RodState<double> base = any_base(rod);
  const int steps = *rc::gen::inRange(3, 12);  // coarse too: exact for any
  const RodTangent tangent = integrate_tangent(rod, length, base, {.steps = steps});
  RC_PRE(tangent.tip.status == Status::converged && tangent.rate.norm() < 1e4);
  const auto tip = [&](const auto& x) {
    using S = typename std::decay_t<decltype(x)>::Scalar;
    return tip_of<S>(rod, base, steps, tangent.tip.state.R, x);
  };
  const Vec<double, 8> none = Vec<double, 8>::Zero();
  RC_ASSERT(test::jacobian_error(tangent.rate, test::complex_step_jacobian(tip, none), 1e-6) < 1e-10);
  RC_ASSERT((integrate(rod, length, base, {.steps = steps}).state.p - tangent.tip.state.p).norm() == 0);
}

RC_GTEST_PROP(SpatialRod, LengthsRateIsTheSlopeAtTheTip, ()) {
  const SpatialRod rod = any_rod(RodKind::general);
  const RodState<double> base = any_base(rod);
  const RodTangent tangent = integrate_tangent(rod, length, base);
  RC_ASSERT(tangent.tip.status == Status::converged);
  const RodState<double>& tip = tangent.tip.state;
  const Vec3<double> stretch(rod.shear_compliance[0], rod.shear_compliance[1], rod.extension_compliance);
  const Vec3<double> strain = stretch.cwiseProduct(tip.R.rotate_back(tip.n)) + Vec3<double>(0, 0, 1);
  const Vec3<double> slope = tip.R.rotate(strain);
  RC_ASSERT((tangent.rate.col(7).head<3>() - slope).norm() < 1e-9);
  RC_ASSERT((tangent.rate.col(7).segment<3>(6) + rod.load).norm() < 1e-12);
  RC_ASSERT((tangent.rate.col(7).tail<3>() + cross(slope, tip.n)).norm() < 1e-9 * (1 + tip.n.norm()));
}

TEST(SpatialRod, ErrorFallsByTheEighthPower) {
  SpatialRod rod = SpatialRod::round(200e9, 80e9, 0.002, RodLaw::cosserat);
  rod.load = {0.25, 0, 0};
  RodState<double> base;
  base.n = {1.25, -2, -5};
  base.m = {0.3, 0.2, 0.1};
  const RodTip exact = integrate(rod, length, base, {.steps = 512});
  const auto off = [&](int steps) {
    const RodTip x = integrate(rod, length, base, {.steps = steps});
    return (x.state.p - exact.state.p).norm() / length + turn_between(x.state, exact.state);
  };
  EXPECT_NEAR(std::log2(off(8) / off(16)), 8, 0.5);
  EXPECT_NEAR(std::log2(off(16) / off(32)), 8, 0.5);
  EXPECT_LT(off(64), 1e-14);
}

RC_GTEST_PROP(SpatialRod, EstimatedErrorIsAboutTheTrueOne, ()) {
  const SpatialRod rod = any_rod(RodKind::general);
  const RodState<double> base = any_base(rod);
  const double tolerance = *rc::gen::element(1e-5, 1e-8, 1e-11);
  const RodTip x = integrate(rod, length, base, {.steps = 0, .tolerance = tolerance});
  if (x.status == Status::stalled) {  // what finer steps no longer mend, multiplied along the rod: it is said
    RC_ASSERT(x.error > tolerance);
    return;
  }
  RC_ASSERT(x.status == Status::converged && x.error <= tolerance);
  const RodTip exact = integrate(rod, length, base, {.steps = 8 * x.steps});
  const double off =
      std::max((x.state.p - exact.state.p).norm() / length, turn_between(x.state, exact.state));
  RC_ASSERT(off < 5 * tolerance);  // of few steps the order is not yet 8
  RC_ASSERT(off < 10 * x.error + 1e-12);
}

TEST(SpatialRod, BadInputIsNotAnswered) {
  const double nan = std::nan("");
  const SpatialRod good = SpatialRod::round(200e9, 80e9, 0.002);
  for (const double L : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()})
    EXPECT_EQ(integrate(good, L, {}).status, Status::left_domain) << L;
  RodState<double> base;
  base.n[1] = nan;
  EXPECT_EQ(integrate(good, length, base).status, Status::left_domain);
  EXPECT_EQ(integrate_tangent(good, length, base, {.steps = 4}).tip.status, Status::left_domain);
  EXPECT_EQ(integrate(SpatialRod{}, length, {}).status, Status::left_domain);
  SpatialRod rod = good;
  rod.load[2] = nan;
  EXPECT_EQ(integrate(rod, length, {}).status, Status::left_domain);
  rod = good;
  rod.extension_compliance = -1;
  EXPECT_FALSE(rod.is_valid());
  RodState<double> wild;
  wild.m = {1e6, 0, 0};  // 10⁶ turns: more steps than are allowed
  const RodTip tip = integrate(good, length, wild);
  EXPECT_NE(tip.status, Status::converged);
  EXPECT_LE(tip.steps, max_rod_steps);
}

TEST(SpatialRod, StripsTwistAsTheTablesSay) {  // Timoshenko and Goodier, article 109: square, 2 : 1, thin
  const auto constant = [](double a, double b) {
    return SpatialRod::strip(200e9, 80e9, a, b).torsion_stiffness / (80e9 * a * b * b * b);
  };
  EXPECT_NEAR(constant(2e-3, 2e-3), 0.140577, 1e-6);
  EXPECT_NEAR(constant(4e-3, 2e-3), 0.228682, 1e-6);
  EXPECT_NEAR(constant(1, 1e-3), (1 - 0.630249e-3) / 3, 1e-9);
  const SpatialRod strip = SpatialRod::strip(200e9, 80e9, 5e-3, 2e-3, RodLaw::cosserat);
  const SpatialRod upright = SpatialRod::strip(200e9, 80e9, 2e-3, 5e-3);
  EXPECT_NEAR(strip.torsion_stiffness, upright.torsion_stiffness, 1e-15);
  EXPECT_NEAR(strip.bending_stiffness[0], 200e9 * 5e-3 * 8e-9 / 12, 1e-12);
  EXPECT_NEAR(strip.bending_stiffness[1], 200e9 * 2e-3 * 125e-9 / 12, 1e-12);
  EXPECT_NEAR(1 / strip.extension_compliance, 200e9 * 1e-5, 1e-3);
  EXPECT_NEAR(1 / strip.shear_compliance[0], 80e9 * 1e-5, 1e-3);
  EXPECT_FALSE(strip.is_isotropic());
}

TEST(SpatialRod, PotentialIsThatOfTheLoadAlone) {
  SpatialRod rod = SpatialRod::round(200e9, 80e9, 2e-3, RodLaw::cosserat);
  rod.load = {0.3, -0.2, 0.5};
  RodState<double> base;
  base.n = {0.4, 0.1, 0.3};
  base.m = {0.02, 0.01, 0.03};
  const RodTip tip = integrate(rod, length, base, {64, 0});
  std::array<RodState<double>, 129> sections;  // Simpson's rule
  ASSERT_EQ(rod_sections(rod, length, base, sections, {128, 0}), Status::converged);
  double potential = 0;
  for (std::size_t k = 0; k < sections.size(); ++k) {
    const double weight = k == 0 || k == 128 ? 1 : k % 2 == 1 ? 4 : 2;
    potential -= weight * dot(rod.load, sections[k].p) * length / (3 * 128);
  }
  EXPECT_NEAR(tip.potential, potential, 1e-10);
}

}  // namespace spatial_rod_test
}  // namespace sinew
