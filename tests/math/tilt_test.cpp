/// Tilt, azimuth and torsion of rotations.
#include "math/tilt.hpp"

#include <gtest/gtest.h>

#include <random>

namespace sinew {
namespace tilt_test {

constexpr double pi = std::numbers::pi;

SO3<double> turn(int axis, double angle) {
  Vec3<double> vector = Vec3<double>::Zero();
  vector[axis] = angle;
  return SO3<double>::exp(vector);
}

double distance(const SO3<double>& a, const SO3<double>& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

/// Unit quaternions: evenly, and with one of the two pairs (w, z), (x, y) nearly, or quite, 0.
std::vector<SO3<double>> rotations(int count) {
  std::mt19937 engine(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> digits(0, 20);
  std::vector<SO3<double>> all;
  for (int k = 0; k < count; ++k) {
    SO3<double> q{normal(engine), Vec3<double>(normal(engine), normal(engine), normal(engine))};
    const double small = k % 10 == 0 ? 0 : std::pow(10, -digits(engine));
    if (k % 3 == 1) q.w *= small, q.v.z() *= small;
    if (k % 3 == 2) q.v.x() *= small, q.v.y() *= small;
    all.push_back(q.normalised());
  }
  return all;
}

TEST(TiltTorsion, IsTheProductOfThreeTurns) {
  for (const double tilt : {-0.4, 0.0, 1e-9, 0.3, 2.9, pi})
    for (const double azimuth : {-3.0, 0.0, 1.2})
      for (const double torsion : {-2.0, 0.0, 0.7}) {
        const SO3<double> product =
            turn(2, azimuth).compose(turn(1, tilt)).compose(turn(2, torsion - azimuth));
        EXPECT_LT(distance(rotation_of({tilt, azimuth, torsion}), product), 2e-15);
      }
}

TEST(TiltTorsion, LeansTheAxisTowardsTheAzimuth) {
  for (const SO3<double>& q : rotations(1000)) {
    const TiltTorsion angles = tilt_torsion(q);
    const Vec3<double> axis = q.rotate(Vec3<double>(0, 0, 1));
    EXPECT_NEAR(axis.z(), std::cos(angles.tilt), 1e-15);
    EXPECT_NEAR(axis.x(), std::sin(angles.tilt) * std::cos(angles.azimuth), 1e-15);
    EXPECT_NEAR(axis.y(), std::sin(angles.tilt) * std::sin(angles.azimuth), 1e-15);
  }
}

TEST(TiltTorsion, ABendWithoutTwistHasNoTorsion) {  // about an axis in the plane
  for (const double angle : {1e-12, 0.5, 3.0})
    for (const double direction : {-2.5, 0.0, 0.4}) {
      const Vec3<double> axis(-std::sin(direction), std::cos(direction), 0);
      const TiltTorsion angles = tilt_torsion(SO3<double>::exp(axis * angle));
      EXPECT_NEAR(angles.tilt / angle, 1, 1e-15);
      EXPECT_NEAR(angles.azimuth, direction, 1e-15);
      EXPECT_EQ(angles.torsion, 0);
    }
}

TEST(TiltTorsion, AnglesAreTheRotation) {
  double worst = 0;
  for (const SO3<double>& q : rotations(100000)) {
    const TiltTorsion angles = tilt_torsion(q);
    ASSERT_TRUE(angles.tilt >= 0 && angles.tilt <= pi);
    ASSERT_TRUE(angles.azimuth > -pi && angles.azimuth <= pi);
    ASSERT_TRUE(angles.torsion > -pi && angles.torsion <= pi);
    worst = std::max(worst, distance(rotation_of(angles), q));
  }
  EXPECT_LT(worst, 4e-15);
}

TEST(TiltTorsion, DoesNotSeeTheQuaternionsSignOrLength) {
  for (const SO3<double>& q : rotations(1000)) {
    const TiltTorsion one = tilt_torsion(q), other = tilt_torsion({-3 * q.w, -3 * q.v});
    EXPECT_NEAR(one.tilt, other.tilt, 1e-15);
    EXPECT_NEAR(std::remainder(one.azimuth - other.azimuth, 2 * pi), 0, 2e-15);
    EXPECT_NEAR(std::remainder(one.torsion - other.torsion, 2 * pi), 0, 2e-15);
  }
}

TEST(TiltTorsion, TinyTiltsKeepAllDigits) {
  for (const double tilt : {1e-300, 1e-100, 1e-16, 1e-12, 1e-8, 1e-3})
    for (const double azimuth : {-3.1, -0.2, 0.0, 1.7})
      for (const double torsion : {-3.0, 0.0, 1e-9, 2.0}) {
        const TiltTorsion angles = tilt_torsion(rotation_of({tilt, azimuth, torsion}));
        EXPECT_NEAR(angles.tilt / tilt, 1, 1e-15);
        EXPECT_NEAR(angles.azimuth, azimuth, 1e-15);
        EXPECT_NEAR(angles.torsion, torsion, 1e-15);
      }
}

TEST(TiltTorsion, WhatIsNotSeenIsZero) {
  for (const double torsion : {-3.0, 0.0, 0.4, pi}) {
    const TiltTorsion level = tilt_torsion(rotation_of({0, 1.3, torsion}));
    EXPECT_EQ(level.tilt, 0);
    EXPECT_EQ(level.azimuth, 0);
    EXPECT_NEAR(level.torsion, torsion, 1e-15);
    const TiltTorsion down = tilt_torsion(rotation_of({pi, 1.3, torsion}));
    EXPECT_EQ(down.tilt, pi);
    EXPECT_EQ(down.torsion, 0);
    EXPECT_NEAR(std::remainder(down.azimuth - (1.3 - torsion / 2), pi), 0, 1e-15);
    EXPECT_TRUE(down.azimuth > -pi / 2 && down.azimuth <= pi / 2);
  }
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_EQ(tilt_torsion({0, Vec3<double>(sign, 0, 0)}).azimuth, pi / 2);
    EXPECT_FALSE(std::signbit(tilt_torsion({sign, Vec3<double>(0, 0, -0.0)}).torsion));
    EXPECT_EQ(tilt_torsion({0, Vec3<double>(0, 0, sign)}).torsion, pi);
  }
}

}  // namespace tilt_test
}  // namespace sinew
