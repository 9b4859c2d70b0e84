#include "kinematics/modes/spatial_modes.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "reference_file.hpp"

namespace sinew::test {
namespace spatial_modes_test {

using Legs = std::vector<PlatformConstraint<3>>;

double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / 4294967295.0;
}
Vec3<double> point(std::mt19937& random, double flat = 1) {
  const double x = uniform(random, -1, 1), y = uniform(random, -1, 1);
  return {x, y, flat * uniform(random, -1, 1)};
}
SE3<double> pose(std::mt19937& random) {
  const Vec3<double> turn = point(random), place = point(random);
  return {place + Vec3<double>(0, 0, 1.5), SO3<double>::exp(turn)};
}

/// The legs take their distances from the pose.
Legs closed(Legs legs, const SE3<double>& at) {
  for (PlatformConstraint<3>& leg : legs) leg.distance = (at.point(leg.platform_point) - leg.anchor).norm();
  return legs;
}
Legs random_legs(std::mt19937& random, std::size_t count, double flat = 1) {
  Legs legs(count);
  for (PlatformConstraint<3>& leg : legs) leg = {point(random, flat), 1, 0.6 * point(random, flat)};
  return legs;
}

double gap(const SpatialPose& a, const SE3<double>& b) {
  const double turned = (SE3<double>::from(a).R.matrix() - b.R.matrix()).cwiseAbs().maxCoeff();
  return std::max((a.position - b.p).cwiseAbs().maxCoeff(), turned);
}
/// How far the nearest pose found is.
double gap(const SpatialModes& modes, const SE3<double>& wanted) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const SpatialPose& pose : modes.poses) nearest = std::min(nearest, gap(pose, wanted));
  return nearest;
}

struct ReferenceCase {
  Legs legs;
  std::vector<SE3<double>> solutions;
};

std::vector<ReferenceCase> reference() {
  using Json = nlohmann::json;
  const Json& robot = test::reference_file("data/tdpcr/fk.json").at("6-UFS");
  const auto vector = [](const Json& v) {
    return Vec3<double>(v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>());
  };
  std::vector<ReferenceCase> cases;
  for (const Json& found : robot.at("cases")) {
    ReferenceCase& next = cases.emplace_back();
    for (std::size_t i = 0; i < 6; ++i)
      next.legs.push_back(
          {vector(robot.at("a").at(i)), found.at("rho").at(i).get<double>(), vector(robot.at("b").at(i))});
    for (const Json& solution : found.at("solutions")) {
      Mat<double, 3, 3> turn;
      for (int i = 0; i < 3; ++i)
        turn.row(i) = vector(solution.at("R").at(static_cast<std::size_t>(i))).transpose();
      next.solutions.push_back({vector(solution.at("p")), SO3<double>::from(turn)});
    }
  }
  return cases;
}

void expect_complete(const SpatialModes& modes, double size) {
  EXPECT_TRUE(modes.report.ok()) << modes.report.message.view();
  EXPECT_TRUE(modes.is_complete()) << modes.lost_paths << " lost, " << modes.singular_count << " singular";
  EXPECT_EQ(modes.complex_count + modes.infinite_paths, 40);
  ASSERT_EQ(modes.poses.size(), modes.residual.size());
  for (const double residual : modes.residual) EXPECT_LT(residual, 1e-12 * size);
}

TEST(SpatialModes, ReferenceRobotHasExactlyTheModesThatMultiStartFound) {  // 16 and 12
  const auto cases = reference();
  ASSERT_EQ(cases.size(), 2);
  for (const ReferenceCase& robot : cases)
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {  // other ways through the complex numbers end alike
      const SpatialModes modes = spatial_modes(robot.legs, {.seed = seed});
      expect_complete(modes, 0.2);
      EXPECT_EQ(modes.poses.size(), robot.solutions.size());
      for (const SE3<double>& wanted : robot.solutions) EXPECT_LT(gap(modes, wanted), 1e-9);
      EXPECT_EQ(modes.complex_count, 28);  // base and platform points lie on circles: 12 are at infinity
    }
}

TEST(SpatialModes, GeneralLegsHave40SolutionsAndTheTruePoseIsOne) {
  std::mt19937 random{11};
  for (int sample = 0; sample < 20; ++sample) {
    const SE3<double> truth = pose(random);
    const SpatialModes modes = spatial_modes(closed(random_legs(random, 6), truth));
    expect_complete(modes, 3);
    EXPECT_EQ(modes.complex_count, 40) << sample;
    EXPECT_EQ(modes.poses.size() % 2, 0) << sample;  // complex solutions come in pairs
    EXPECT_LT(gap(modes, truth), 1e-9) << sample;
  }
}

TEST(SpatialModes, FlatBaseAndPlatformHaveMirrorPairs) {
  std::mt19937 random{12};
  for (int sample = 0; sample < 20; ++sample) {
    const SE3<double> truth = pose(random);
    const SpatialModes modes = spatial_modes(closed(random_legs(random, 6, 0), truth));
    expect_complete(modes, 3);
    EXPECT_LT(gap(modes, truth), 1e-9) << sample;
    const Mat<double, 3, 3> mirror = Vec3<double>(1, 1, -1).asDiagonal();
    for (const SpatialPose& found : modes.poses) {
      const auto X = SE3<double>::from(found);
      const Mat<double, 3, 3> turn = mirror * X.R.matrix() * mirror;
      EXPECT_LT(gap(modes, {mirror * X.p, SO3<double>::from(turn)}), 1e-8) << sample;
    }
  }
}

TEST(SpatialModes, PairedPointsLeave16) {  // the octahedral manipulator
  std::mt19937 random{13};
  Legs legs = random_legs(random, 6);
  for (std::size_t i = 0; i < 6; i += 2) {
    legs[i + 1].anchor = legs[i].anchor;
    legs[(i + 2) % 6].platform_point = legs[i + 1].platform_point;
  }
  const SE3<double> truth = pose(random);
  const SpatialModes modes = spatial_modes(closed(legs, truth));
  EXPECT_EQ(modes.complex_count, 16);
  EXPECT_LT(gap(modes, truth), 1e-9);
  expect_complete(modes, 3);
}

TEST(SpatialModes, UnitsAndPlaceDoNotMatterAndAnswersRepeat) {
  std::mt19937 random{14};
  const Legs legs = closed(random_legs(random, 6), pose(random));
  Legs moved = legs;
  const Vec3<double> shift(300, -200, 100);
  for (PlatformConstraint<3>& leg : moved)
    leg = {1000 * leg.anchor + shift, 1000 * leg.distance, 1000 * leg.platform_point};
  const SpatialModes here = spatial_modes(legs), again = spatial_modes(legs), there = spatial_modes(moved);
  ASSERT_EQ(here.poses.size(), again.poses.size());
  ASSERT_EQ(here.poses.size(), there.poses.size());
  for (std::size_t i = 0; i < here.poses.size(); ++i) {
    EXPECT_EQ(here.poses[i].position, again.poses[i].position);
    EXPECT_EQ(here.poses[i].quaternion, again.poses[i].quaternion);
    EXPECT_LT((1000 * here.poses[i].position + shift - there.poses[i].position).norm(), 1e-6);
    if (i > 0) {
      EXPECT_GE(here.poses[i - 1].position[2], here.poses[i].position[2] - 1e-8);
    }
  }
}

TEST(SpatialModes, MoreLegsChooseAmongThePosesOfSix) {
  std::mt19937 random{15};
  const SE3<double> truth = pose(random);
  const Legs legs = closed(random_legs(random, 8), truth);
  const SpatialModes modes = spatial_modes(legs);
  ASSERT_TRUE(modes.report.ok());
  EXPECT_EQ(modes.poses.size(), 1);
  EXPECT_LT(gap(modes, truth), 1e-9);
  Legs wrong = legs;
  wrong[7].distance *= 1.01;
  EXPECT_EQ(spatial_modes(wrong).report.status, Status::unreachable);
}

TEST(SpatialModes, ShortLegsAreTorn) {
  std::mt19937 random{16};
  Legs legs = closed(random_legs(random, 6), pose(random));
  for (PlatformConstraint<3>& leg : legs) leg.distance = 1e-3;
  const SpatialModes modes = spatial_modes(legs);
  EXPECT_EQ(modes.report.status, Status::unreachable);
  EXPECT_TRUE(modes.poses.empty());
  EXPECT_NE(modes.report.message.view().find("legs[0]"), std::string_view::npos);
}

TEST(SpatialModes, WhereAllSolutionsAreComplexNewtonFindsNothingEither) {
  std::mt19937 random{21};
  int none = 0;
  for (int sample = 0; sample < 10; ++sample) {
    Legs legs = random_legs(random, 6);
    for (PlatformConstraint<3>& leg : legs) leg.distance = uniform(random, 0.8, 2.2);
    const SpatialModes modes = spatial_modes(legs);
    if (modes.report.ok()) continue;
    EXPECT_EQ(modes.report.status, Status::unreachable);
    const SpatialModes tried = spatial_modes(legs, {.attempts = 0, .newton_starts = 200});
    EXPECT_NE(tried.report.status, Status::converged);
    EXPECT_TRUE(tried.poses.empty());
    ++none;
  }
  EXPECT_GT(none, 0);
}

TEST(SpatialModes, ADoubleModeIsFoundAndNotCalledComplete) {  // legs through one line: J is singular
  std::mt19937 random{17};
  const SE3<double> truth = pose(random);
  Legs legs = random_legs(random, 6);
  for (PlatformConstraint<3>& leg : legs) {  // every leg's line meets the vertical through the middle
    const Vec3<double> end = truth.point(leg.platform_point);
    leg.anchor = Vec3<double>(truth.p[0], truth.p[1], uniform(random, -2, 0)) * 2 - end;
  }
  const SpatialModes modes = spatial_modes(closed(legs, truth));
  EXPECT_TRUE(modes.report.ok()) << modes.report.message.view();
  EXPECT_LT(gap(modes, truth), 1e-6);
  EXPECT_GE(modes.singular_count, 1);
  EXPECT_FALSE(modes.is_complete());
}

TEST(SpatialModes, ASelfMotionIsCalledSingular) {  // equal base and platform, equal legs: a parallelogram
  std::mt19937 random{18};
  Legs legs = random_legs(random, 6);
  for (PlatformConstraint<3>& leg : legs) leg.anchor = leg.platform_point, leg.distance = 1;
  const SpatialModes modes = spatial_modes(legs);
  EXPECT_EQ(modes.report.status, Status::singular);
  EXPECT_FALSE(modes.is_complete());
}

void expect_refused(const Legs& legs, Status status, std::string_view why) {
  const SpatialModes modes = spatial_modes(legs);
  EXPECT_EQ(modes.report.status, status) << modes.report.message.view();
  EXPECT_NE(modes.report.message.view().find(why), std::string_view::npos) << modes.report.message.view();
  EXPECT_FALSE(modes.is_complete());
  EXPECT_TRUE(modes.poses.empty());
}

TEST(SpatialModes, TooFewConstraintsAreSingular) {
  std::mt19937 random{19};
  const Legs legs = closed(random_legs(random, 6), pose(random));
  expect_refused({}, Status::singular, "fewer than six");
  expect_refused({legs.begin(), legs.end() - 1}, Status::singular, "fewer than six");
  Legs same = legs, collapsed = legs, line = legs, stacked = legs;
  same[5] = same[4];
  expect_refused(same, Status::singular, "only 5");
  for (PlatformConstraint<3>& leg : collapsed) leg.platform_point = Vec3<double>(1, 2, 3);
  expect_refused(collapsed, Status::singular, "line");
  for (PlatformConstraint<3>& leg : line) leg.platform_point = leg.platform_point[0] * Vec3<double>(1, 2, 3);
  expect_refused(line, Status::singular, "line");
  for (PlatformConstraint<3>& leg : stacked) leg.anchor.setZero();
  expect_refused(stacked, Status::singular, "line");
}

TEST(SpatialModes, NumbersThatAreNoRobotAreRefusedByName) {
  std::mt19937 random{20};
  const Legs legs = closed(random_legs(random, 6), pose(random));
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e200}) {
    Legs distance = legs, anchor = legs, end = legs;
    distance[3].distance = bad;
    anchor[3].anchor[1] = bad;
    end[3].platform_point[2] = -bad;
    for (const Legs& each : {distance, anchor, end}) expect_refused(each, Status::left_domain, "legs[3]");
  }
  for (const double bad : {0.0, -1.0}) {
    Legs distance = legs;
    distance[2].distance = bad;
    expect_refused(distance, Status::left_domain, "legs[2] has no length");
  }
  expect_refused(Legs(25, legs[0]), Status::left_domain, "24");
}

TEST(SpatialModes, WorkIsBoundedAsAsked) {
  const Legs legs = reference()[1].legs;
  const SpatialModes none = spatial_modes(legs, {.attempts = 0, .newton_starts = 0});
  EXPECT_TRUE(none.poses.empty());
  EXPECT_EQ(none.lost_paths, 40);
  const SpatialModes cut = spatial_modes(legs, {.attempts = 1, .max_steps = 20, .newton_starts = 500});
  EXPECT_FALSE(cut.is_complete());
  EXPECT_EQ(cut.poses.size(), 12);  // by Newton alone
}

}  // namespace spatial_modes_test
}  // namespace sinew::test
