#include "kinematics/modes/hinged_modes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "analysis/tripod_loci.hpp"
#include "check_jacobian.hpp"
#include "kinematics/closing.hpp"
#include "kinematics/modes/three_circles.hpp"
#include "thorough.hpp"
#include "uniform.hpp"

namespace sinew::test {
namespace hinged_modes_test {

using Legs = std::array<PlatformConstraint<3>, 3>;

Vec3<double> point(std::mt19937& random, double size = 1) {
  return {uniform(random, -size, size), uniform(random, -size, size), uniform(random, -size, size)};
}
SE3<double> random_pose(std::mt19937& random, double reach = 1) {
  const SO3<double> turn{uniform(random, -1, 1), point(random)};
  return {point(random, reach), turn.normalised()};
}

/// Legs anywhere that close at a pose.
Legs random_legs(std::mt19937& random, const SE3<double>& pose) {
  Legs legs;
  for (auto& leg : legs) {
    const Vec3<double> u = point(random).normalized(), b = point(random, 0.7);
    const Vec3<double> to = cross(u, point(random)) * uniform(random, 0.5, 1.5);
    leg = {pose.point(b) - to, to.norm(), b, u};
  }
  return legs;
}

/// A symmetric tripod with its hinges at these heights.
Legs tripod(std::array<double, 3> heights, double base = 0.25, double platform = 0.125, double strut = 0.35) {
  Legs legs;
  for (std::size_t i = 0; i < 3; ++i) {
    const double azimuth = (90 + 120 * static_cast<double>(i)) * std::numbers::pi / 180;
    const Vec3<double> outwards(std::cos(azimuth), std::sin(azimuth), 0);
    legs[i] = {Vec3<double>(base * outwards + Vec3<double>(0, 0, heights[i])), strut,
               Vec3<double>(platform * outwards), Vec3<double>(std::sin(azimuth), -std::cos(azimuth), 0)};
  }
  return legs;
}

double gap(const SE3<double>& a, const SE3<double>& b) {
  return (a.p - b.p).norm() + 2 * a.R.compose(b.R.inverse()).v.norm();
}
double miss(const HingedModes& modes, const SE3<double>& pose) {
  double nearest = 1e9;
  for (std::size_t k = 0; k < static_cast<std::size_t>(modes.count); ++k)
    nearest = std::min(nearest, gap(SE3<double>::from(modes.poses[k]), pose));
  return nearest;
}

/// Newton in the pose from many starts: an independent way to the modes. Returns how many it found that the
/// polynomial did not.
int missing(const Legs& legs, const HingedModes& modes, std::mt19937& random, int starts) {
  const Closing<Spatial> closing(legs);
  int count = 0;
  for (int i = 0; i < starts; ++i) {
    SE3<double> pose = random_pose(random);
    pose.p *= closing.size();
    if (!newton(closing, pose, {.tolerance = 1e-14 * closing.size()}).ok()) continue;
    if (miss(modes, pose) > 1e-5 * (1 + closing.size())) ++count;
  }
  return count;
}

TEST(ThreeCircles, TheirRatesAreDerivatives) {
  std::mt19937 random{4};
  for (int sample = 0; sample < 300; ++sample) {
    const SE3<double> pose = random_pose(random);
    const Legs legs = random_legs(random, pose);
    const ThreeCircles circles(legs, 1, random_pose(random));
    CircleAngles at;
    for (auto& angle : at) {
      const double t = uniform(random, -3, 3);
      angle = {std::cos(t), std::sin(t)};
    }
    Linearised<3> here;
    circles.linearise(at, here);
    const auto residual = [&](const Eigen::Vector3d& step) {
      Linearised<3> there;
      circles.linearise(circles.moved(at, Vec3<double>(step)), there);
      return Eigen::Vector3d(there.residual);
    };
    EXPECT_LT(
        jacobian_error(Eigen::MatrixXd(here.jacobian), central_jacobian(residual, Eigen::Vector3d::Zero())),
        1e-8);
    // the angles of the pose that closes the legs close the sides, and give it back
    const ThreeCircles closed(legs, 1, pose);
    closed.linearise(ThreeCircles::start(), here);
    EXPECT_LT(here.error, 1e-14);
    EXPECT_LT(gap(closed.platform(ThreeCircles::start()), pose), 1e-13);
  }
}

/// Two modes so near that between two samples the polynomial's argument turned by 2π, which looked like none:
/// one of them was missed and all said to be there.
TEST(HingedModes, OfANearPairAreBothThere) {
  const Legs legs{
      PlatformConstraint<3>{{1.0819370595627098, 1.560508814804345, 1.3133263426628612},
                            1.1638323963856112,
                            {-0.2293003861151714, 0.3539093859284965, 0.1072918750912627},
                            {0.6580260301998307, -0.35940333362965526, -0.6616879833844213}},
      PlatformConstraint<3>{{-0.1533603124465933, -0.15532557076944004, 1.7510818150856649},
                            0.5166379605843278,
                            {-0.3610868242033988, 0.5526192114812027, -0.46188485176804017},
                            {-0.27162047272552126, -0.5899399064703084, -0.7603901798091346}},
      PlatformConstraint<3>{{0.9944487917660013, 1.2940117138550047, 0.5319414414147272},
                            0.13371543047348325,
                            {0.20687593009258987, -0.44423542451216136, 0.6542933855928301},
                            {0.6384549424628723, 0.6246350995121069, 0.44967352479574635}},
  };
  const HingedModes modes = hinged_modes(legs);
  ASSERT_TRUE(modes.ok());
  EXPECT_TRUE(modes.is_complete);
  ASSERT_EQ(modes.count, 2);
  EXPECT_NEAR(gap(SE3<double>::from(modes.poses[0]), SE3<double>::from(modes.poses[1])), 0.01123, 1e-5);
}

TEST(HingedModes, HoldThePoseTheLegsCloseAtAndAllThatOtherwaysAreFound) {
  std::mt19937 random{1};
  std::array<int, 17> histogram{};
  for (int sample = 0; sample < 300; ++sample) {
    const SE3<double> pose = random_pose(random);
    const Legs legs = random_legs(random, pose);
    const HingedModes modes = hinged_modes(legs);
    ASSERT_TRUE(modes.ok()) << sample << ' ' << to_string(modes.report);
    EXPECT_TRUE(modes.is_complete) << sample;
    EXPECT_LT(miss(modes, pose), 1e-7) << sample;
    EXPECT_LT(modes.report.residual, 1e-12);
    EXPECT_EQ(modes.count % 2, 0) << sample;  // real roots of a real polynomial of even degree
    ++histogram[static_cast<std::size_t>(modes.count)];
    if (sample < 60) {
      EXPECT_EQ(missing(legs, modes, random, 60), 0) << sample;
    }
  }
  EXPECT_GT(histogram[4] + histogram[6] + histogram[8], 100);
}

/// Thoroughly 60 000 tripods: an earlier count of the roots called some of them complete that lacked a pair.
TEST(HingedModes, AreNotCalledCompleteWhereOneIsMissing) {
  std::mt19937 random{11};
  const int samples = count_of(1000, 60000);
  int not_complete = 0;
  for (int sample = 0; sample < samples; ++sample) {
    const SE3<double> pose = random_pose(random);
    const HingedModes modes = hinged_modes(random_legs(random, pose));
    ASSERT_TRUE(modes.ok()) << sample << ' ' << to_string(modes.report);
    if (!modes.is_complete) {
      ++not_complete;
      continue;
    }
    const auto doubles = std::count(modes.is_double.begin(), modes.is_double.begin() + modes.count, true);
    EXPECT_LT(miss(modes, pose), 1e-5) << sample;
    EXPECT_TRUE(modes.count % 2 == 0 || doubles > 0) << sample;
  }
  EXPECT_LE(not_complete, samples / 1000);
}

TEST(HingedModes, OfASymmetricTripodHoldMirrorImages) {  // double roots of the polynomial
  std::mt19937 random{2};
  const HingedModes level = hinged_modes(tripod({0.174, 0.174, 0.174}));
  ASSERT_TRUE(level.ok());
  EXPECT_TRUE(level.is_complete);
  EXPECT_EQ(level.count, 8);
  EXPECT_EQ(missing(tripod({0.174, 0.174, 0.174}), level, random, 500), 0);
  for (int sample = 0; sample < 40; ++sample) {
    const double a = uniform(random, 0, 0.2), b = uniform(random, 0, 0.2);
    const Legs legs = tripod({a, b, b}, 0.25, 0.125, uniform(random, 0.3, 0.6));
    const HingedModes modes = hinged_modes(legs);
    EXPECT_TRUE(modes.is_complete) << sample;
    EXPECT_EQ(missing(legs, modes, random, 60), 0) << sample;
    for (std::size_t k = 0; k < static_cast<std::size_t>(modes.count); ++k) {  // x → −x
      SE3<double> mirror = SE3<double>::from(modes.poses[k]);
      mirror.p[0] = -mirror.p[0];
      mirror.R = {mirror.R.w, Vec3<double>(mirror.R.v[0], -mirror.R.v[1], -mirror.R.v[2])};
      EXPECT_LT(miss(modes, mirror), 1e-6) << sample;
    }
  }
}

TEST(HingedModes, HoldBothOperationModes) {  // struts long enough to turn the platform over
  const HingedModes modes = hinged_modes(tripod({0.1, 0.12, 0.11}, 0.25, 0.125, 0.5));
  EXPECT_TRUE(modes.is_complete);
  int tilted = 0, turned = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(modes.count); ++k) {
    const auto& e = modes.poses[k].quaternion;
    tilted += std::abs(e[3]) < 1e-9;
    turned += std::abs(e[0]) < 1e-9;
  }
  EXPECT_EQ(tilted + turned, modes.count);  // (9): nothing else
  EXPECT_GT(tilted, 0);
  EXPECT_GT(turned, 0);
}

TEST(HingedModes, WhereTwoMergeOneIsTold) {  // at a type II singularity of the 3PRS
  const Legs legs = [] {
    const double e = -forward_locus({0.25, 0.125, 0.35}, std::numbers::pi).value(), r = 0.125,
                 w = std::sqrt(1 - e * e);
    const SE3<double> pose{Vec3<double>(0, -r * e * e, 0.5), {w, Vec3<double>(e, 0, 0)}};
    Legs at = tripod({0, 0, 0});
    for (auto& leg : at) {
      const Vec3<double> b = pose.point(leg.platform_point), off = b - leg.anchor;
      leg.anchor[2] = b[2] - std::sqrt(0.35 * 0.35 - off[0] * off[0] - off[1] * off[1]);
    }
    return at;
  }();
  const HingedModes modes = hinged_modes(legs);
  ASSERT_TRUE(modes.ok());
  EXPECT_TRUE(modes.is_complete);
  EXPECT_EQ(std::ranges::count(modes.is_double, true), 1);
}

TEST(HingedModes, ThatDoNotExistAreProvenSo) {
  EXPECT_EQ(hinged_modes(tripod({0, 5, 0})).report.status, Status::unreachable);  // torn apart
  std::mt19937 random{3};
  int none = 0;
  for (int sample = 0; sample < 200; ++sample) {
    Legs legs = random_legs(random, random_pose(random));
    for (auto& leg : legs) leg.distance *= uniform(random, 0.3, 1);
    const HingedModes modes = hinged_modes(legs);
    if (modes.count > 0) continue;
    ++none;
    EXPECT_EQ(modes.report.status, Status::unreachable) << sample;
    EXPECT_EQ(missing(legs, modes, random, 20), 0) << sample;
  }
  EXPECT_GT(none, 10);
}

TEST(HingedModes, OfLegsThatAreNoneAreRefused) {
  Legs legs = tripod({0, 0, 0});
  EXPECT_TRUE(are_hinged(legs));
  legs[1].normal = Vec3<double>::Zero();
  EXPECT_FALSE(are_hinged(legs));
  EXPECT_EQ(hinged_modes(legs).report.status, Status::left_domain);
  legs = tripod({0, std::nan(""), 0});
  EXPECT_EQ(hinged_modes(legs).report.status, Status::left_domain);
  EXPECT_FALSE(are_hinged(std::span<const PlatformConstraint<3>>(legs).first(2)));
}

}  // namespace hinged_modes_test
}  // namespace sinew::test
