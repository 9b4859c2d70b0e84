#include "sinew/analysis/singularity.hpp"

#include <gtest/gtest.h>

#include "planar_robots.hpp"
#include "reference_file.hpp"
#include "sinew/analysis/velocity.hpp"

namespace sinew::test {
namespace singularity_map_test {

/// Numbers of an independent implementation.
const nlohmann::json& reference() { return test::reference_file("data/tdpcr/singular.json"); }

/// The axis of a list of values a regular distance apart.
MapAxis axis(const nlohmann::json& values) {
  return {.from = values.front(), .to = values.back(), .count = static_cast<int>(values.size())};
}

TEST(SingularityMap, Of3RfrIsTheReference) {  // all 13 × 13 × 9 poses
  const nlohmann::json& map = reference()["3-RFR_map"];
  const Robot robot = load("3-rfr").value();
  Workspace work(robot);
  std::size_t k = 0, reachable = 0;
  for (const double phi : map["phi"]) {
    const PoseGrid grid{.axes = {axis(map["x"]), axis(map["y"]), MapAxis{.from = phi}}};
    const SingularityMap found = singularity_map(robot, grid, {}, work);
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const nlohmann::json& expected = map["data"][k++];
      MapSample sample = found.samples[i];
      ASSERT_EQ(sample.is_reachable, expected[3].get<bool>()) << k;
      reachable += sample.is_reachable;
      if (!sample.is_reachable) {  // J asks only where the points are, not how the legs get there
        const Velocity at = velocity(robot, grid.pose(i), {1, 1, 1}, work);
        sample.determinant = at.determinant;
        sample.inverse_condition = 1 / at.indices.condition;
        sample.inverse_condition_homogenised = 1 / at.indices.condition_homogenised;
      }
      EXPECT_NEAR(sample.determinant, expected[0].get<double>(), 1e-16);
      EXPECT_NEAR(sample.inverse_condition, expected[1].get<double>(), 1e-13);
      EXPECT_NEAR(sample.inverse_condition_homogenised, expected[2].get<double>(), 1e-13);
      EXPECT_FALSE(sample.is_type_2);  // slices one degree beside 60°
    }
  }
  EXPECT_EQ(k, 1521U);
  EXPECT_EQ(reachable, 145U);
}

TEST(SingularityMap, Of3FrrOnTheReferencesBranchIsTheReference) {
  const nlohmann::json& map = reference()["3-FRR_map"];
  const Robot robot = load("3-frr").value();
  Workspace work(robot);
  std::size_t k = 0, reachable = 0;
  for (const double phi : map["phi"])
    for (const double y : map["y"])
      for (const double x : map["x"]) {
        const nlohmann::json& expected = map["data"][k++];
        const PlanarPose pose{x, y, phi};
        if (expected.is_null()) {
          EXPECT_FALSE(map_sample(robot, pose, {}, work).is_reachable);
          continue;
        }
        ++reachable;
        const std::vector<double> curvature = expected[0];
        const MapSample sample = map_sample(robot, pose, {.curvature = curvature}, work);
        EXPECT_NEAR(sample.determinant, expected[1].get<double>(), 1e-14);
        EXPECT_NEAR(sample.inverse_condition, expected[2].get<double>(), 1e-12);
      }
  EXPECT_GT(reachable, 50U);
}

TEST(SingularityMap, OfUfsTurningAboutZHasTheReferencesDeterminant) {
  const nlohmann::json& line = reference()["6-UFS_det_rotz"];
  const Robot robot = load("6-ufs").value();
  Workspace work(robot);
  PoseGrid grid = PoseGrid::at(home(robot));
  EXPECT_EQ(grid.axes[2].from, line["p"][2].get<double>());
  std::size_t reachable = 0;
  for (std::size_t k = 0; k < line["rot"].size(); ++k) {
    grid.axes[5] = {.from = line["rot"][k]};
    const MapSample sample = singularity_map(robot, grid, {}, work).samples.front();
    if (!sample.is_reachable) continue;
    ++reachable;
    EXPECT_NEAR(sample.determinant, line["det"][k].get<double>(), 1e-19) << line["rot"][k];
    EXPECT_EQ(sample.is_type_2,
              std::abs(std::abs(line["rot"][k].get<double>()) - std::numbers::pi / 2) < 1e-9);
  }
  EXPECT_GE(reachable, 7U);
}

TEST(SingularityMap, RunsThroughTheFirstAxisFastest) {
  const PoseGrid grid{.axes = {MapAxis{-1, 1, 3}, MapAxis{5, 6, 2}, MapAxis{0.5, 0.5, 1}}};
  ASSERT_EQ(grid.size(), 6U);
  EXPECT_EQ(grid.coordinates(0), (std::array<double, 6>{-1, 5, 0.5}));
  EXPECT_EQ(grid.coordinates(1), (std::array<double, 6>{0, 5, 0.5}));
  EXPECT_EQ(grid.coordinates(5), (std::array<double, 6>{1, 6, 0.5}));
}

TEST(SingularityMap, ASpatialGridOfOnePoseIsThatPose) {
  const SpatialPose pose{Vec3<double>(0.01, 0.02, 0.2), {0.8, 0, 0.6, 0}};
  const auto again = std::get<SpatialPose>(PoseGrid::at(pose).pose(0));
  EXPECT_EQ(again.position, pose.position);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(again.quaternion[i], pose.quaternion[i], 1e-15);
}

TEST(SingularityMap, TellsBothTypesWithTheirLegsAndClass) {
  const Robot robot = rfr_in_code();
  Workspace work(robot);
  const MapSample centre = map_sample(robot, PlanarPose{0, 0, std::numbers::pi / 3}, {}, work);
  EXPECT_TRUE(centre.is_type_2);
  EXPECT_EQ(centre.kind, LineClass::concurrent);
  EXPECT_LT(centre.inverse_condition_homogenised, 1e-10);
  const Forward straight = forward(robot, {0.19, 0.2, 0.19}, {}, work);
  ASSERT_TRUE(straight.ok());
  EXPECT_EQ(map_sample(robot, straight.pose, {}, work).type_1, 0b010U);
  const MapSample outside = map_sample(robot, PlanarPose{1, 0, 0}, {}, work);
  EXPECT_FALSE(outside.is_reachable);
  EXPECT_TRUE(std::isnan(outside.determinant));
}

TEST(SingularityMap, StopsWhenItsCallerHasEnough) {
  const Robot robot = rfr_in_code();
  Workspace work(robot);
  const PoseGrid grid{.axes = {MapAxis{-0.02, 0.02, 40}, MapAxis{-0.02, 0.02, 40}, MapAxis{}}};
  std::vector<std::size_t> told;
  const SingularityMap whole =
      singularity_map(robot, grid, {}, work, [&](std::size_t done, std::size_t total) {
        EXPECT_EQ(total, 1600U);
        told.push_back(done);
        return true;
      });
  EXPECT_TRUE(whole.is_complete());
  EXPECT_EQ(told.front(), 0U);
  EXPECT_EQ(told.back(), 1600U);
  const SingularityMap part =
      singularity_map(robot, grid, {}, work, [](std::size_t done, std::size_t) { return done < 500; });
  EXPECT_FALSE(part.is_complete());
  EXPECT_EQ(part.samples.size(), 512U);
  EXPECT_EQ(part.samples[100].determinant, whole.samples[100].determinant);
}

TEST(SingularityMap, HandsItsSamplesOverInTheOrderOfTheGrid) {
  const Robot robot = rfr_in_code();
  Workspace work(robot);
  const PoseGrid grid{.axes = {MapAxis{-0.02, 0.02, 4}, MapAxis{-0.02, 0.02, 3}, MapAxis{}}};
  const SingularityMap kept = singularity_map(robot, grid, {}, work);
  std::size_t next = 0;
  EXPECT_EQ(visit_map(robot, grid, {}, work,
                      [&](std::size_t k, const MapSample& sample) {
                        EXPECT_EQ(k, next++);
                        EXPECT_EQ(sample.determinant, kept.samples.at(k).determinant);
                        return true;
                      }),
            12U);
  EXPECT_EQ(next, 12U);
  EXPECT_EQ(visit_map(robot, grid, {}, work, [](std::size_t k, const MapSample&) { return k < 4; }), 5U);
}

}  // namespace singularity_map_test
}  // namespace sinew::test
