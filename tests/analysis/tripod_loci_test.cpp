#include "analysis/tripod_loci.hpp"

#include <gtest/gtest.h>

#include "every_robot.hpp"
#include "sinew/analysis/velocity.hpp"

namespace sinew::test {
namespace tripod_loci_test {

constexpr TripodSize size{0.25, 0.125, 0.35};
constexpr double degree = std::numbers::pi / 180;

struct Tripod {
  Robot robot = load("3prs").value();
  Workspace work{robot};

  SpatialPose pose(double e1, double e2) { return constrained_pose(robot, {0.5, e1, e2}).pose; }
  Velocity velocity_at(double e1, double e2) {
    const SpatialPose at = pose(e1, e2);
    EXPECT_TRUE(inverse(robot, at, {}, work).ok()) << e1 << ' ' << e2;
    return velocity(robot, at, values(work.coordinates), work);
  }
};

TEST(TripodLoci, LeftSidesAreWhereThePlatformPointsAre) {  // @verifies 3PFS (19)
  Tripod tripod;
  const auto& legs = legs_of<Leg<Spatial, Rail, SlideDrive, HingedStrut>>(tripod.robot).legs;
  std::mt19937 random{1};
  for (int sample = 0; sample < 200; ++sample) {
    const double e1 = uniform(random, -0.7, 0.7), e2 = uniform(random, -0.7, 0.7);
    const SE3<double> platform = SE3<double>::from(tripod.pose(e1, e2));
    const auto found = radial_positions(e1, e2);
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3<double> outwards = legs[i].base.p / 0.25, b = platform.point(legs[i].platform_point);
      EXPECT_NEAR(found[i], dot(b, outwards) / 0.125, 1e-14);
    }
  }
}

TEST(TripodLoci, KLosesARowWhereALeftSideReachesARightSide) {  // @verifies 3PFS (18)-(19)
  Tripod tripod;
  EXPECT_NEAR(radial_limits(size)[0], -0.8, 1e-15);
  for (const double direction : {0.0, 20.0, 120.0, 240.0, 250.0}) {
    const double radius = inverse_locus(size, direction * degree).value();
    const double c = std::cos(direction * degree), s = std::sin(direction * degree);
    const auto at = radial_positions(radius * c, radius * s);
    EXPECT_NEAR(*std::ranges::min_element(at), -0.8, 1e-14);
    const Velocity near = tripod.velocity_at((radius - 1e-9) * c, (radius - 1e-9) * s);
    EXPECT_LT(near.K.topRows(3).diagonal().minCoeff(), 1e-4);  // the root of how near it is
    EXPECT_FALSE(
        inverse(tripod.robot, tripod.pose((radius + 1e-9) * c, (radius + 1e-9) * s), {}, tripod.work).ok());
  }
  EXPECT_NEAR(inverse_locus(size, 0).value(), std::sqrt(0.6), 1e-12);
  EXPECT_NEAR(inverse_locus(size, 30 * degree).value(), std::sqrt(0.9), 1e-12);
}

TEST(TripodLoci, TypeTwoComesFirstButInThreeDirections) {  // an independent computation, to its digits
  for (const int direction : {60, 180, 300})
    EXPECT_NEAR(forward_locus(size, direction * degree).value(), 0.4575, 1e-4);
  for (int direction = 30; direction < 360; direction += 60)
    EXPECT_NEAR(forward_locus(size, direction * degree).value(), 0.5365, 1e-4);
  for (const int direction : {0, 120, 240}) EXPECT_FALSE(forward_locus(size, direction * degree));
  // on e₂ = 0 by hand: (1 − 2e₁²)/e₀ = 2 e₁ f/√(L² − f²) with f = r(1 − 3e₁²) − r_A
  const double e = -forward_locus(size, 180 * degree).value(), f = 0.125 * (1 - 3 * e * e) - 0.25;
  EXPECT_NEAR((1 - 2 * e * e) / std::sqrt(1 - e * e), 2 * e * f / std::sqrt(0.35 * 0.35 - f * f), 1e-12);
}

TEST(TripodLoci, TheDeterminantIsThatOfTheVelocityEquations) {  // and the same at every height
  Tripod tripod;
  std::mt19937 random{2};
  for (int sample = 0; sample < 100; ++sample) {
    const double e1 = uniform(random, -0.4, 0.4), e2 = uniform(random, -0.4, 0.4);
    EXPECT_NEAR(tripod.velocity_at(e1, e2).determinant, tripod_determinant(size, e1, e2), 1e-17);
  }
  EXPECT_TRUE(std::isnan(tripod_determinant(size, 0.9, 0.9)));
  EXPECT_TRUE(std::isnan(tripod_determinant(size, std::nan(""), 0)));
  EXPECT_FALSE(forward_locus(size, std::nan("")));
}

}  // namespace tripod_loci_test
}  // namespace sinew::test
