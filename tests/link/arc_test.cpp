#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "check_jacobian.hpp"
#include "link/arc.hpp"

namespace sinew {
namespace arc_test {

const Arc link{0.2};

/// Bend angles from a hair to a full turn, both signs, straight included.
double any_curvature() {
  const int exponent = *rc::gen::inRange(-12, 1);
  return *rc::gen::inRange(-6283, 6284) * 1e-3 * std::pow(10.0, exponent) / link.length;
}

TEST(Arc, StraightLinkIsARegularPoint) {  // @verifies TDPCR (25)-(27)
  const auto tip = link.tip(0.0);
  EXPECT_EQ(tip.position.x(), 0.0);
  EXPECT_EQ(tip.position.y(), link.length);
  EXPECT_EQ(tip.rate.x(), link.length * link.length / 2);
  EXPECT_EQ(tip.rate.y(), 0.0);
}

TEST(Arc, QuarterTurnEndsBesideItsCentre) {
  const double radius = link.length / (std::numbers::pi / 2);
  const auto tip = link.tip(1 / radius).position;  // bends towards +x
  EXPECT_NEAR(tip.x(), radius, 1e-16);
  EXPECT_NEAR(tip.y(), radius, 1e-16);
}

RC_GTEST_PROP(Arc, TipIsThePapersFormAwayFromStraight, ()) {  // @verifies TDPCR (25)-(27)
  const double t = *rc::gen::inRange(100, 6284) * 1e-3 * *rc::gen::element(-1, 1), k = t / link.length;
  const auto tip = link.tip(k);
  RC_ASSERT(std::abs(tip.position.x() - (1 - std::cos(t)) / k) < 1e-15);
  RC_ASSERT(std::abs(tip.position.y() - std::sin(t) / k) < 1e-15);
  Mat<double, 2, 2> E;  // as printed in (27)
  E << -1 / k, link.length, link.length * std::cos(t) / (1 - std::cos(t)), -1 / k;
  RC_PRE(std::abs(1 - std::cos(t)) > 1e-3);
  RC_ASSERT((E * tip.position - tip.rate).norm() < 1e-13 / std::abs(1 - std::cos(t)));
}

RC_GTEST_PROP(Arc, RateIsTheDerivative, ()) {
  const Vec<double, 1> k(any_curvature());
  const auto tip = [](const auto& q) { return link.tip(q[0]).position; };
  RC_ASSERT(test::jacobian_error(link.tip(k[0]).rate, test::complex_step_jacobian(tip, k)) < 1e-14);
  RC_ASSERT(test::jacobian_error(link.tip(k[0]).rate, test::central_jacobian(tip, k)) < 1e-9);
}

RC_GTEST_PROP(Arc, ChordIsTheDistanceOfTheTip, ()) {  // @verifies TDPCR (7)-(9)
  const double k = any_curvature();
  RC_ASSERT(std::abs(link.chord(k) - link.tip(k).position.norm() *
                                         (std::abs(k * link.length) <= 2 * std::numbers::pi ? 1 : -1)) <
            1e-15);
  const auto chord = [](const auto& q) { return Vec<std::decay_t<decltype(q[0])>, 1>(link.chord(q[0])); };
  const Mat<double, 1, 1> rate(link.chord_rate(k));
  RC_ASSERT(test::jacobian_error(rate, test::complex_step_jacobian(chord, Vec<double, 1>(k)), 1e-12) < 1e-13);
}

TEST(Arc, ChordRateStaysExactWhereThePaperFormCancels) {  // TDPCR (9) as printed is 8 % off at κ = 1e-6
  const double printed = link.length / 1e-6 * std::cos(link.length * 1e-6 / 2) - link.chord(1e-6) / 1e-6;
  EXPECT_GT(std::abs(printed / (-0.008e-6 / 12) - 1), 0.01);
  EXPECT_NEAR(link.chord_rate(1e-6) / (-0.008e-6 / 12), 1.0, 1e-13);
}

RC_GTEST_PROP(Arc, CurvatureIsFoundFromTheChord, ()) {
  const double k = std::abs(any_curvature());
  RC_PRE(k * link.length < 2 * std::numbers::pi);
  const double found = link.curvature_from_chord(link.chord(k));
  RC_ASSERT(std::abs(link.chord(found) - link.chord(k)) <= 4e-16 * link.length);  // backward
  if (k * link.length > 1e-3) RC_ASSERT(std::abs(found - k) < 1e-8 * k);          // forward: a square root
}

TEST(Arc, NoCurvatureHasAChordBeyondTheLength) { EXPECT_TRUE(std::isnan(link.curvature_from_chord(0.2001))); }

RC_GTEST_PROP(Arc, BoundsHold, ()) {
  const double k = any_curvature(), h = 1e-4;
  const TipBounds bounds = link.bounds();
  const auto tip = link.tip(k), ahead = link.tip(k + h), behind = link.tip(k - h);
  RC_ASSERT(tip.position.norm() <= bounds.reach * (1 + 1e-15));
  RC_ASSERT(tip.rate.norm() <= bounds.rate * (1 + 1e-15));
  RC_ASSERT((ahead.rate - behind.rate).norm() / (2 * h) <= bounds.rate_rate * (1 + 1e-6));
}

TEST(Arc, PointsOfTheBackboneEndAtTheTipAndStartAtTheBase) {
  EXPECT_EQ(link.point(3.0, 0).norm(), 0);
  EXPECT_EQ(link.point(3.0, link.length), link.tip(3.0).position);
  const double s = 0.13, h = 1e-6;  // side ⟂ tangent, on the side the bend goes to
  const Vec2<double> tangent = (link.point(3.0, s + h) - link.point(3.0, s - h)) / (2 * h);
  EXPECT_NEAR(tangent.norm(), 1, 1e-9);
  EXPECT_NEAR(dot(tangent, link.side(3.0, s)), 0, 1e-9);
  EXPECT_GT(cross(link.side(3.0, s), tangent), 0.99);
}

}  // namespace arc_test
}  // namespace sinew
