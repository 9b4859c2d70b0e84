#include <gtest/gtest.h>

#include <array>

#include "planar_modes_cases.hpp"

namespace sinew::test {
namespace planar_modes_limits_test {

/// Points on a coarse grid: equal points, parallel legs, merging modes of any multiplicity, continua.
TEST(PlanarModes, OfDegenerateRobotsHoldTheTruePoseOrSaySingular) {
  std::mt19937 random{5};
  const auto grid = [&] { return static_cast<double>(random() % 5) - 2; };
  int singular = 0, doubles = 0;
  for (int sample = 0; sample < 30000; ++sample) {
    Legs legs(3);
    for (auto& leg : legs) leg = {{grid(), grid()}, 0, {grid(), grid()}};
    const PlanarPose truth{grid() / 2, grid() / 2, static_cast<double>(random() % 8) * pi / 4};
    set_distances(legs, truth);
    const PlanarModes modes = planar_modes(legs);
    singular += modes.report.status == Status::singular;
    if (modes.report.status == Status::singular) continue;
    ASSERT_TRUE(modes.ok()) << sample;
    bool any_double = false;
    for (int i = 0; i < modes.count; ++i) any_double |= modes.is_double[static_cast<std::size_t>(i)];
    doubles += any_double;
    EXPECT_LT(miss(modes, truth), any_double ? 1e-3 : 1e-9) << sample;
  }
  EXPECT_LT(singular, 600);
  EXPECT_GT(doubles, 300);
}

TEST(PlanarModes, OfAShortLegAreTwoNearEachOther) {
  std::mt19937 random{7};
  for (int sample = 0; sample < 3000; ++sample) {
    const double size = std::pow(10.0, uniform(random, -6, -2));
    Legs legs = random_legs(random, 3);
    const PlanarPose truth = any_pose(random);
    legs[2].anchor = SE2<double>::from(truth).point(legs[2].platform_point) + size * point(random);
    set_distances(legs, truth);
    const PlanarModes modes = planar_modes(legs);
    EXPECT_LT(miss(modes, truth), 1e-7) << size;
    EXPECT_GE(modes.count, 2) << size;
  }
}

TEST(PlanarModes, ArePinnedInClosedForm) {
  std::mt19937 random{8};
  for (int sample = 0; sample < 3000; ++sample) {
    const std::size_t count = 2 + static_cast<std::size_t>(sample) % 3;
    Legs legs = random_legs(random, count);
    const PlanarPose truth = any_pose(random);
    const std::size_t pin = random() % count;
    const std::size_t pins = 1 + random() % 2;
    for (std::size_t i = pin; i < std::min(count, pin + pins); ++i)
      legs[i].anchor = SE2<double>::from(truth).point(legs[i].platform_point);
    set_distances(legs, truth);
    for (auto& leg : legs)
      if (leg.distance < 1e-14) leg.distance = 0;
    const PlanarModes modes = planar_modes(legs);
    ASSERT_TRUE(modes.ok()) << sample << modes.report.message.view();
    EXPECT_LT(miss(modes, truth), 1e-7) << sample;
    EXPECT_LE(modes.count, count == 2 ? 2 : 1) << sample;
  }
}

TEST(PlanarModes, OfMoreLegsThanThreeAreThoseThatCloseAll) {
  std::mt19937 random{9};
  for (int sample = 0; sample < 3000; ++sample) {
    Legs legs = random_legs(random, 4 + static_cast<std::size_t>(sample) % 5);
    const PlanarPose truth = any_pose(random);
    set_distances(legs, truth);
    const PlanarModes modes = planar_modes(legs);
    ASSERT_TRUE(modes.ok()) << sample;
    EXPECT_EQ(modes.count, 1);
    EXPECT_LT(miss(modes, truth), 1e-11);
    legs.back().distance += 1e-3;
    EXPECT_EQ(planar_modes(legs).report.status, Status::unreachable);
  }
  Legs four = example({0, 0, 0});  // the fourth leg tells apart what the three leave merged
  four.push_back({{0.1, 0.1}, 0, {0.02, 0.01}});
  set_distances(four, {0.03, 0, pi / 3});
  const PlanarModes modes = planar_modes(four);
  ASSERT_EQ(modes.count, 1);
  EXPECT_LT(miss(modes, {0.03, 0, pi / 3}), 1e-12);
  EXPECT_FALSE(modes.is_double[0]);
}

TEST(PlanarModes, ThatAreAContinuumAreCalledSingular) {
  const auto status = [](const Legs& legs) { return planar_modes(legs).report.status; };
  EXPECT_EQ(status({}), Status::singular);
  EXPECT_EQ(status({{{0, 0}, 0, {1, 0}}}), Status::singular);
  EXPECT_EQ(status({{{0, 0}, 1, {1, 0}}, {{1, 0}, 1, {2, 0}}}), Status::singular);
  EXPECT_EQ(status({{{0, 0}, 1, {1, 0}}, {{0, 0}, 1, {1, 0}}, {{1, 0}, 1, {2, 0}}}), Status::singular);
  EXPECT_EQ(status({{{0, 0}, 0, {1, 0}}, {{0, 0}, 0, {1, 0}}}), Status::singular);
  EXPECT_EQ(status({{{0, 0}, 0, {1, 0}}, {{1, 0}, 1, {1, 0}}}), Status::singular);
  std::mt19937 random{1};
  Legs congruent = random_legs(random, 3);
  for (auto& leg : congruent) leg = {leg.anchor, 0.7, leg.anchor};
  EXPECT_EQ(status(congruent), Status::singular);
  EXPECT_EQ(planar_modes(congruent).report.message.view(),
            "the legs do not bind each other: a continuum of poses closes them");
}

TEST(PlanarModes, ThatDoNotExistAreUnreachable) {
  const PlanarModes torn = planar_modes(example({0.01, 0.01, 0.01}));
  EXPECT_EQ(torn.report.status, Status::unreachable);
  EXPECT_EQ(torn.count, 0);
  EXPECT_NE(torn.report.message.view().find("no pose closes legs[0] and legs[1] together"),
            std::string_view::npos);
  const PlanarModes any_two = planar_modes(example({0.13, 0.13, 0.13}));
  EXPECT_EQ(any_two.report.status, Status::unreachable);
  EXPECT_NE(any_two.report.message.view().find("any two"), std::string_view::npos);
  EXPECT_EQ(planar_modes(Legs{{{0, 0}, 0, {0, 0}}, {{1, 0}, 0, {2, 0}}}).report.status, Status::unreachable);
}

TEST(PlanarModes, OfNastyNumbersEndHonestly) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  const std::array nasty{0.0,   -0.0,   1.0,     1.0,   2.0, 0.5,          1e-300, 5e-324,
                         1e300, -1e300, 1.7e308, 1e-12, inf, std::nan(""), -1.0,   1e9};
  std::mt19937 random{10};
  const auto any = [&](std::size_t kinds) { return nasty[random() % kinds]; };
  for (int sample = 0; sample < 30000; ++sample) {
    const std::size_t kinds = sample % 3 == 0 ? nasty.size() : sample % 3 == 1 ? 12 : 8;
    Legs legs(random() % 6);
    for (auto& leg : legs) leg = {{any(kinds), any(kinds)}, any(kinds), {any(kinds), any(kinds)}};
    const PlanarModes modes = planar_modes(legs);
    ASSERT_LE(modes.count, PlanarModes::most);
    EXPECT_EQ(modes.ok(), modes.report.message.empty());
    if (modes.ok()) {
      ASSERT_GE(modes.count, 1);
    }
    double size = 0;
    for (const auto& leg : legs)
      size = std::max(
          {size, leg.distance, leg.anchor.cwiseAbs().maxCoeff(), leg.platform_point.cwiseAbs().maxCoeff()});
    for (int i = 0; i < modes.count; ++i) {
      const PlanarPose& pose = modes.poses[static_cast<std::size_t>(i)];
      EXPECT_TRUE(std::isfinite(pose.x + pose.y + pose.phi)) << sample;
      EXPECT_TRUE(!(size < 1e150) || error(legs, pose) <= 3e-9 * size) << sample;
    }
  }
  EXPECT_EQ(planar_modes(Legs{{{0, 0}, -1, {0, 0}}}).report.status, Status::left_domain);
  EXPECT_EQ(planar_modes(Legs{{{0, inf}, 1, {0, 0}}}).report.status, Status::left_domain);
}

}  // namespace planar_modes_limits_test
}  // namespace sinew::test
