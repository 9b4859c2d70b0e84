#include <gtest/gtest.h>

#include "link/swivel.hpp"
#include "tendon/swivel_drive.hpp"
#include "tendon/theta_is.hpp"

namespace sinew {
namespace pair_test {

constexpr kernel::TendonPair<double> pair{0.2, 0.005};

TEST(TendonPair, InnerTendonIsShortAndTheSumIsKept) {  // @verifies TDPCR (10)-(11)
  const double k = 7.5, radius = 1 / k;
  EXPECT_NEAR(pair.tendon_1(k) / (radius - 0.005), 0.2 * k, 1e-15);  // (10): both subtend the angle ℓκ
  EXPECT_NEAR(pair.tendon_2(k) / (radius + 0.005), 0.2 * k, 1e-15);
  EXPECT_EQ(pair.tendon_1(k) + pair.tendon_2(k), 0.4);
  const double l1 = pair.tendon_1(k), l2 = pair.tendon_2(k);
  EXPECT_NEAR((l2 - l1) / (0.005 * (l1 + l2)), k, 1e-13);  // (11) with its sign kept
}

TEST(TendonPair, CurvatureUndoesTendonOneThroughStraight) {
  for (const double k : {-30.0, -1.0, -1e-9, 0.0, 1e-9, 2.5, 31.0})
    EXPECT_NEAR(pair.curvature(pair.tendon_1(k)), k, 1e-13);
  EXPECT_EQ(pair.curvature(0.2), 0.0);
}

TEST(TendonPair, RateIsThePapersOnBothSidesAndAtStraight) {  // @verifies TDPCR (12)-(16)
  const double h = 1e-5;
  for (const double l1 : {0.19, 0.2, 0.21}) {
    EXPECT_NEAR((pair.curvature(l1 + h) - pair.curvature(l1 - h)) / (2 * h), pair.curvature_rate(), 1e-8);
    const double l2 = 0.4 - l1;  // (15) with h/κ the sign of the bend
    EXPECT_NEAR(-2 / (0.005 * (l1 + l2)), pair.curvature_rate(), 1e-10);
  }
}

TEST(TendonPair, DriveUsesTheKernel) {
  const Arc arc{0.2};
  const TendonPair drive{0.005};
  const std::array length{0.193};
  EXPECT_EQ(drive.commands(arc, Vec<double, 1>(7.0))[0], pair.tendon_1(7.0));
  EXPECT_EQ(drive.coordinates(arc, length)[0], pair.curvature(0.193));
  EXPECT_EQ(drive.rate(arc)(0, 0), -1000.0);
  EXPECT_EQ(drive.lengths(0.2, 7.0)[1], pair.tendon_2(7.0));
}

TEST(SwivelDrive, TheChordLiesHalfABendBesideTheTangent) {  // @verifies TDPCR (63), (65)
  const Swivel<Arc> link{{0.2}};
  const SwivelDrive tangent{{0.005}, ThetaIs::tangent}, chord{{0.005}, ThetaIs::chord};
  for (const double k : {-20.0, -1e-9, 0.0, 3.0, 15.0}) {
    const Vec<double, 2> q(0.7, k);
    EXPECT_EQ(tangent.commands(link, q)[0], 0.7);
    EXPECT_EQ(tangent.commands(link, q)[1], chord.commands(link, q)[1]);
    const Vec2<double> tip = link.tip(q).position;
    EXPECT_NEAR(chord.commands(link, q)[0], std::atan2(tip.y(), tip.x()), 1e-15);
    const Vec<double, 2> a = chord.commands(link, q);
    EXPECT_LT((chord.coordinates(link, {a.data(), 2}) - q).norm(), 1e-12);
  }
}

}  // namespace pair_test
}  // namespace sinew
