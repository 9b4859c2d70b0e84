#include "link/elastica.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <numbers>
#include <vector>

#include "check_jacobian.hpp"
#include "rod_3pfs.hpp"

namespace sinew {
namespace elastica_test {

using std::numbers::pi;

double uniform(double low, double high) {
  return low + (high - low) * 1e-6 * *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(0, 1000001));
}

/// Tension, compression and all between; a third of them close to straight on either end.
Vec2<double> any_local_force(double largest) {
  const double f = largest * uniform(0, 1), chi = uniform(-pi, pi);
  const double hair = std::pow(10.0, -uniform(0, 8));
  switch (*rc::gen::inRange(0, 3)) {
    case 0:
      return elastica_local_force(f, chi * hair);
    case 1:
      return elastica_local_force(f, pi - chi * hair);
    default:
      return elastica_local_force(f, chi);
  }
}

/// Everything of the state in one vector.
template <class S>
Vec<S, 7> numbers(const ElasticaState<S>& x) {
  Vec<S, 7> all;
  all << x.tip[0], x.tip[1], x.force[0], x.force[1], x.tip_angle, x.base_curvature, x.energy;
  return all;
}

Mat<double, 7, 2> rates(const ElasticaTangent& x) {
  Mat<double, 7, 2> all;
  all.row(0) = x.tip_rate.row(0);
  all.row(1) = x.tip_rate.row(1);
  all.row(2) = x.force_rate.row(0);
  all.row(3) = x.force_rate.row(1);
  all.row(4) = x.tip_angle_rate.transpose();
  all.row(5) = x.base_curvature_rate.transpose();
  all.row(6) = x.energy_rate.transpose();
  return all;
}

/// Each row over its own size, and forces over theirs.
double worst(const Vec<double, 7>& error, double f) {
  double largest = 0;
  const std::array<double, 7> size = {1, 1, 1 + f, 1 + f, 1, 1 + std::sqrt(f), 1 + f};
  for (int k = 0; k < 7; ++k)
    largest = std::fmax(largest, std::abs(error[k]) / size[static_cast<std::size_t>(k)]);
  return error.allFinite() ? largest : 1;
}

/// The rod from its base: θ″ = −fd cos θ + fw sin θ by Taylor series of order 30 in long double.
struct Shooting {
  using Real = long double;
  static constexpr int order = 30;
  Real cos = 1, sin = 0, angle = 0, curvature = 0, d = 0, w = 0, energy = 0;

  void step(Real h, Real fd, Real fw) {
    std::array<Real, order + 1> c{cos}, s{sin}, k{curvature};
    for (std::size_t n = 0; n < order; ++n) {
      Real turn = 0, side = 0;
      for (std::size_t i = 0; i <= n; ++i) turn += s[i] * k[n - i], side += c[i] * k[n - i];
      const Real next = static_cast<Real>(n) + 1;
      c[n + 1] = -turn / next, s[n + 1] = side / next;
      k[n + 1] = (fw * s[n] - fd * c[n]) / next;
    }
    cos = sin = curvature = 0;
    Real power = 1;
    for (std::size_t n = 0; n <= order; ++n) {
      const Real whole = power * h / (static_cast<Real>(n) + 1);
      cos += c[n] * power, sin += s[n] * power, curvature += k[n] * power;
      w += c[n] * whole, d += s[n] * whole, angle += k[n] * whole;
      power *= h;
    }
  }
};

RC_GTEST_PROP(Elastica, ShapeSolvesItsDifferentialEquation, ()) {
  const Vec2<double> local = any_local_force(45);
  const ElasticaState<double> x = elastica(local);
  Shooting rod;
  rod.curvature = x.base_curvature;
  for (int k = 0; k < 64; ++k) rod.step(1.0L / 64, x.force[0], x.force[1]);
  // The base multiplies what rounding left in κ and f by cosh √f, that is up to 400.
  const double growth = std::cosh(std::sqrt(local.norm()));
  RC_ASSERT(std::abs(static_cast<double>(rod.d) - x.tip[0]) < 1e-14 * growth);
  RC_ASSERT(std::abs(static_cast<double>(rod.w) - x.tip[1]) < 1e-14 * growth);
  RC_ASSERT(std::abs(static_cast<double>(rod.angle) - x.tip_angle) < 1e-14 * growth);
  RC_ASSERT(std::abs(static_cast<double>(rod.curvature)) < 1e-13 * growth);
}

RC_GTEST_PROP(Elastica, TipIsThatOfTheRodShotFromItsFreeEnd, ()) {
  // From rest at the tip nothing grows: this is the accuracy itself.
  const Vec2<double> local = any_local_force(*rc::gen::element(1e-6, 1.0, 45.0, 100.0));
  const ElasticaState<double> x = elastica(local);
  Shooting rod;  // seen from the tip, θ − θ_tip obeys the same equation
  for (int k = 0; k < 64; ++k) rod.step(1.0L / 64, local[0], local[1]);
  const long double c = std::cos(-rod.angle), s = std::sin(-rod.angle);
  Vec<double, 7> exact;
  exact << static_cast<double>(rod.w * s + rod.d * c), static_cast<double>(rod.w * c - rod.d * s),
      static_cast<double>(local[0] * c + local[1] * s), static_cast<double>(local[1] * c - local[0] * s),
      static_cast<double>(-rod.angle), static_cast<double>(-rod.curvature),
      static_cast<double>(local[1] - (local[1] * rod.w + local[0] * rod.d));
  RC_ASSERT(worst(numbers(x) - exact, local.norm()) < 3e-14);
}

RC_GTEST_PROP(Elastica, ClosedFormIsThatOfEllipticIntegrals, ()) {
  // ψ from the compression, sin(ψ/2) = k sin φ: φ = π/2 at the tip, φ₀ at the base, several inflections
  // between.
  const double k = uniform(0.01, 0.9), end = uniform(-5, 1);  // differences of integrals must not cancel
  const double first = std::comp_ellint_1(k) - std::ellint_1(k, end);
  const double second = std::comp_ellint_2(k) - std::ellint_2(k, end);
  const double f = first * first, psi = 2 * std::asin(k * std::sin(end));
  const double along = 1 - 2 * second / first, aside = 2 * k * std::cos(end) / first;  // ∫cos β, ∫sin β
  const double c = -std::cos(psi), s = std::sin(psi);  // of β₀ = π − ψ₀
  Vec<double, 7> exact;
  exact << c * aside - s * along, c * along + s * aside, -f * s, f * c, psi - 2 * std::asin(k),
      -2 * k * first * std::cos(end), f * ((2 * k * k - 1) - along);  // cos χ = 2k² − 1
  const Vec2<double> local = elastica_local_force(f, 2 * std::acos(k));
  RC_ASSERT(worst(numbers(elastica(local)) - exact, f) < 2e-13);  // of the elliptic integrals
}

RC_GTEST_PROP(Elastica, RatesAreTheDerivatives, ()) {
  const Vec2<double> local = any_local_force(*rc::gen::element(1e-12, 1e-3, 1.0, 45.0));
  const auto all = [](const auto& x) {
    return numbers(elastica<typename std::decay_t<decltype(x)>::Scalar>(x));
  };
  const Mat<double, 7, 2> exact = rates(elastica_tangent(local));
  RC_ASSERT(test::jacobian_error(exact, test::complex_step_jacobian(all, local), 0.1) < 1e-11);
  if (local.norm() < 10)
    RC_ASSERT(test::jacobian_error(exact, test::central_jacobian(all, local, 1e-3), 0.1) < 1e-8);
}

TEST(Elastica, ForceFreeIsARegularPoint) {
  const ElasticaTangent x = elastica_tangent({0, 0});
  EXPECT_EQ(x.state.tip, Vec2<double>(0, 1));
  EXPECT_EQ(x.state.tip_angle, 0);
  EXPECT_EQ(x.energy_rate, Vec2<double>(0, 0));
  EXPECT_NEAR(x.compliance()(0, 0), 1.0 / 3, 1e-16);  // the cantilever
  EXPECT_EQ(x.compliance()(0, 1), 0);
  EXPECT_EQ(x.compliance()(1, 1), 0);  // inextensible
  EXPECT_NEAR(x.tip_angle_rate[0], 0.5, 1e-16);
  const auto all = [](const auto& n) {
    return numbers(elastica<typename std::decay_t<decltype(n)>::Scalar>(n));
  };
  EXPECT_LT(test::check_jacobian(all, Vec2<double>(0, 0), rates(x)), 1e-10);
}

TEST(Elastica, StraightRodBendsAsABeamUnderAxialLoad) {
  for (const double f : {1e-9, 1e-3, 1.0, 2.4, 30.0}) {
    const double x = std::sqrt(f);
    const ElasticaTangent pulled = elastica_tangent({0, f}), pushed = elastica_tangent({0, -f});
    for (const ElasticaTangent& straight : {pulled, pushed}) {
      EXPECT_EQ(straight.state.tip, Vec2<double>(0, 1));
      EXPECT_EQ(straight.state.energy, 0);
    }
    if (f < 1e-3) continue;  // there tan x/x − 1 cancels
    EXPECT_NEAR(pulled.compliance()(0, 0), (1 - std::tanh(x) / x) / f, 1e-15 * (1 + 1 / f));
    EXPECT_NEAR(pushed.compliance()(0, 0), (std::tan(x) / x - 1) / f,
                1e-15 * (1 + 1 / f) * (1 + 10 * std::pow(std::tan(x), 2)));
  }
}

RC_GTEST_PROP(Elastica, MirrorImageIsTheSameShape, ()) {
  const Vec2<double> local = any_local_force(45);
  const ElasticaState<double> x = elastica(local), y = elastica(Vec2<double>(-local[0], local[1]));
  RC_ASSERT(x.tip[0] == -y.tip[0] && x.tip[1] == y.tip[1] && x.energy == y.energy);
  RC_ASSERT(x.force[0] == -y.force[0] && x.force[1] == y.force[1] && x.tip_angle == -y.tip_angle);
}

RC_GTEST_PROP(Elastica, EnergyIsThatOfItsCurvatureAndItsDerivativeIsTheForce, ()) {
  const Vec2<double> local = any_local_force(45);
  const ElasticaTangent x = elastica_tangent(local);
  const ElasticaState<double>& e = x.state;
  const double work = e.force[0] * std::sin(e.tip_angle) + e.force[1] * std::cos(e.tip_angle);
  RC_ASSERT(std::abs(e.energy - (work - e.force.dot(e.tip))) < 1e-12);
  const Vec2<double> by_work = x.tip_rate.transpose() * e.force;
  const double size = x.tip_rate.cwiseAbs().maxCoeff() * e.force.norm() + 1;
  RC_ASSERT((x.energy_rate - by_work).norm() < 1e-12 * size);

  std::vector<double> s;
  for (int k = 0; k <= 256; ++k) s.push_back(k / 256.0);
  std::vector<ElasticaSection> sections(s.size());
  elastica_sections(local, s, sections);
  double sum = 0;  // Boole: the error is of order h⁶
  for (std::size_t k = 0; k < s.size(); ++k) {
    const double weight = k % 4 == 0 ? (k == 0 || k + 1 == s.size() ? 7 : 14) : k % 2 == 0 ? 12 : 32;
    sum += weight * sections[k].curvature * sections[k].curvature / 2;
  }
  RC_ASSERT(std::abs(sum * 2 / 45 / 256 - e.energy) < 1e-8 * (1 + e.energy));
}

RC_GTEST_PROP(Elastica, SectionsLieOnTheShotRod, ()) {
  const Vec2<double> local = any_local_force(45);
  const ElasticaState<double> x = elastica(local);
  std::array<double, 5> s = {0, 0.25, 0.5, 0.75, 1};
  std::array<ElasticaSection, 5> sections;
  elastica_sections(local, s, sections);
  RC_ASSERT(sections[0].position.norm() == 0 && sections[0].angle == 0);
  RC_ASSERT(sections[0].curvature == x.base_curvature);
  RC_ASSERT(sections[4].position == x.tip && sections[4].angle == x.tip_angle && sections[4].curvature == 0);
  Shooting rod;
  rod.curvature = x.base_curvature;
  const double tolerance = 2e-14 * std::cosh(std::sqrt(local.norm()));
  for (std::size_t k = 1; k < 5; ++k) {
    for (int i = 0; i < 16; ++i) rod.step(1.0L / 64, x.force[0], x.force[1]);
    RC_ASSERT(std::abs(static_cast<double>(rod.d) - sections[k].position[0]) < tolerance);
    RC_ASSERT(std::abs(static_cast<double>(rod.w) - sections[k].position[1]) < tolerance);
    RC_ASSERT(std::abs(static_cast<double>(rod.angle) - sections[k].angle) < tolerance);
    RC_ASSERT(std::abs(static_cast<double>(rod.curvature) - sections[k].curvature) < 10 * tolerance);
  }
}

RC_GTEST_PROP(Elastica, RodInSpaceStaysInThePlaneOfBaseTangentAndForce, ()) {  // @verifies 3PFS (24)
  const Vec2<double> local = any_local_force(30);
  const ElasticaState<double> x = elastica(local);
  const ElasticaUnits unit{uniform(0.1, 0.5), uniform(0.05, 2)};
  const double turn = uniform(-pi, pi), c = std::cos(turn), s = std::sin(turn);  // of the plane about e3
  const Eigen::Vector3d force = unit.force() * Eigen::Vector3d(x.force[0] * c, x.force[0] * s, x.force[1]);
  const double curvature = unit.curvature() * x.base_curvature;
  const auto end = test::shooting::tip<double>(force, -curvature * s, curvature * c, unit.length,
                                               unit.bending_stiffness, {});
  const double tolerance = 2e-14 * std::cosh(std::sqrt(local.norm())) * unit.length;
  RC_ASSERT(std::abs(end[0] - unit.length * x.tip[0] * c) < tolerance);
  RC_ASSERT(std::abs(end[1] - unit.length * x.tip[0] * s) < tolerance);
  RC_ASSERT(std::abs(end[2] - unit.length * x.tip[1]) < tolerance);
  const double rest = 1e-12 * std::cosh(std::sqrt(local.norm())) * unit.curvature();
  RC_ASSERT(std::abs(end[7]) < rest && std::abs(end[8]) < rest);
}

Vec2<double> any_force(double largest) {
  const double f = largest * std::pow(10.0, -uniform(0, 6)), direction = uniform(-pi, pi);
  return {f * std::sin(direction), f * std::cos(direction)};
}

RC_GTEST_PROP(ElasticaUnderForce, FindsTheRodWithoutInflection, ()) {
  const Vec2<double> force = any_force(*rc::gen::element(45.0, 3000.0));
  const ElasticaTip x = elastica_under_force(force);
  RC_ASSERT(x.status == Status::converged);
  RC_ASSERT((x.state.force - force).norm() < 1e-13 * force.norm());
  const Mat<double, 2, 2> rate = elastica_tangent(x.local_force).force_rate;
  RC_ASSERT(rate(0, 0) * rate(1, 1) > rate(0, 1) * rate(1, 0));  // continues the rod under tension
  std::array<double, 33> s;
  for (std::size_t k = 0; k < s.size(); ++k) s[k] = static_cast<double>(k) / 32;
  std::array<ElasticaSection, 33> sections;
  elastica_sections(x.local_force, s, sections);
  for (std::size_t k = 0; k + 1 < s.size(); ++k)  // bends to the side it is pulled to, everywhere
    RC_ASSERT(sections[k].curvature * force[0] >= 0);
}

RC_GTEST_PROP(ElasticaUnderForce, TangentsAreTheDerivatives, ()) {
  const Vec2<double> force = any_force(20);
  RC_PRE(std::abs(std::atan2(force[0], force[1])) < 3);  // beyond, differences reach the mirror image
  const ElasticaTip x = elastica_under_force(force);
  RC_PRE(x.compliance.cwiseAbs().maxCoeff() < 2);  // away from buckling
  const auto tip = [](const Vec<double, 2>& f) { return elastica_under_force(f).state.tip; };
  RC_ASSERT(test::check_jacobian_real(tip, force, x.compliance, {.step = 1e-3, .unit = 0.1}) < 1e-8);
  const auto fed = [&](const Vec<double, 1>& length) -> Vec2<double> {
    return length[0] * elastica_under_force(Vec2<double>(force * (length[0] * length[0]))).state.tip;
  };
  RC_ASSERT(test::check_jacobian_real(fed, Vec<double, 1>(1.0), x.length_rate(),
                                      {.step = 1e-3, .unit = 0.1}) < 1e-8);
}

RC_GTEST_PROP(ElasticaUnderForce, ReturnsToAnyStateFromNearby, ()) {  // higher modes too
  const Vec2<double> local = any_local_force(45);
  const ElasticaTangent there = elastica_tangent(local);
  const double regular = std::abs(there.force_rate(0, 0) * there.force_rate(1, 1) -
                                  there.force_rate(0, 1) * there.force_rate(1, 0));
  RC_PRE(regular > 0.1 && regular < 10);
  const ElasticaTip x = elastica_under_force(there.state.force, there.state.tip_angle + 1e-3);
  RC_ASSERT(x.status == Status::converged);
  RC_ASSERT(std::abs(x.state.tip_angle - there.state.tip_angle) < 1e-11);
  RC_ASSERT((x.state.tip - there.state.tip).norm() < 1e-11);
}

TEST(ElasticaUnderForce, KnowsBothSolutionsOfOneForce) {
  const ElasticaTip first = elastica_under_force({-4.833594, -18.814924}, 0.87);
  EXPECT_NEAR(first.state.tip_angle, 0.875240, 1e-6);
  EXPECT_NEAR(first.state.tip[0], 0.1, 1e-6);
  EXPECT_NEAR(first.state.tip[1], 0.9, 1e-6);
  const ElasticaTip rising = elastica_under_force({-4.833594, -18.814924});
  EXPECT_LT(rising.state.tip_angle, -2);  // a dead force of this size folds the rod over
}

TEST(ElasticaUnderForce, BucklesAtEulersLoad) {
  const double euler = pi * pi / 4;
  const ElasticaTip below = elastica_under_force({0, -euler * (1 - 1e-6)});
  EXPECT_EQ(below.status, Status::converged);
  EXPECT_NEAR(below.state.tip_angle, 0, 1e-8);
  EXPECT_GT(below.compliance(0, 0), 1e4);
  EXPECT_EQ(elastica_under_force({0, -euler}).status, Status::singular);
  const ElasticaTip above = elastica_under_force({0, -euler * (1 + 1e-6)});
  EXPECT_EQ(above.status, Status::converged);
  EXPECT_GT(above.state.tip[0], 0);
  // sin²(θ_tip/2) = k²; K(k) = (π/2)(1 + k²/4 + …) = √f
  EXPECT_NEAR(std::pow(std::sin(above.state.tip_angle / 2), 2), 2e-6, 1e-10);
}

TEST(ElasticaUnderForce, ForceFreeRodIsStraight) {
  const ElasticaTip x = elastica_under_force({0, 0});
  EXPECT_EQ(x.status, Status::converged);
  EXPECT_EQ(x.state.tip, Vec2<double>(0, 1));
  EXPECT_NEAR(x.compliance(0, 0), 1.0 / 3, 1e-16);
}

TEST(ElasticaUnderForce, WhatIsNotANumberOrTooLargeIsNotAnswered) {
  const double nan = std::nan("");
  for (const Vec2<double>& force : {Vec2<double>(nan, 0), Vec2<double>(0, nan), Vec2<double>(1, -1.1e4)}) {
    for (const ElasticaTip& x : {elastica_under_force(force), elastica_under_force(force, 0.1)}) {
      EXPECT_EQ(x.status, Status::left_domain);
      EXPECT_TRUE(std::isnan(x.state.tip[0]) && std::isnan(x.state.tip[1]));
    }
  }
  EXPECT_EQ(elastica_under_force({1, 0}, nan).status, Status::left_domain);
  EXPECT_TRUE(std::isnan(elastica(Vec2<double>(0, 1.1e4)).tip[1]));
}

}  // namespace elastica_test
}  // namespace sinew
