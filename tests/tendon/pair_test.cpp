#include <gtest/gtest.h>

#include "sinew/link/arc.hpp"
#include "sinew/tendon/pair.hpp"

namespace sinew {
namespace {

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
  EXPECT_EQ(drive.input(arc, 7.0), pair.tendon_1(7.0));
  EXPECT_EQ(drive.coordinate(arc, 0.193), pair.curvature(0.193));
  EXPECT_EQ(drive.rate(arc), -1000.0);
  EXPECT_EQ(drive.lengths(arc, 7.0)[1], pair.tendon_2(7.0));
}

}  // namespace
}  // namespace sinew
