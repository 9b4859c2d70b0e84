// Batches of poses of tripods on rails: what constrained_pose, inverse and velocity say, one by one.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "batch_cases.hpp"
#include "every_robot.hpp"

namespace sinew::test {
namespace hinged_batch_test {

using PrsLeg = Leg<Spatial, Rail, SlideDrive, HingedStrut>;

/// z, e₁, e₂ of each of n.
using Places = std::vector<double>;

Places places(std::size_t n, double far, std::uint32_t seed) {
  std::mt19937 random{seed};
  Places all(3 * n);
  for (std::size_t k = 0; k < n; ++k) {
    all[k] = uniform(random, -1, 1);
    all[n + k] = uniform(random, -far, far);
    all[2 * n + k] = uniform(random, -far, far);
  }
  return all;
}

/// On the loci of the built-in 3PRS, near them and beyond; odd ones.
Places borders() {
  std::vector<std::array<double, 3>> each;
  for (const double size : {1e-3, 1e-6, 1e-8, 1e-10, 1e-12, 1e-15, 0.0})
    for (const double off : {size, -size}) {
      each.push_back({0.5, 0, std::sqrt(0.6) + off});                       // a strut square to its rail
      each.push_back({0.5, std::sqrt(0.9) * 0.5, std::sqrt(0.675) + off});  // another, obliquely
      each.push_back({0.5, 0.45749571099781405 * 0.5, 0.3962 + off});       // forward locus
      each.push_back({0.5, 1 + off, 0});                                    // no quaternion beyond
      each.push_back({0.5, off, -0.53});
    }
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                   inf = std::numeric_limits<double>::infinity();
  for (const double odd : {nan, inf, -inf, 1e300, 1e9, 1e7}) {
    each.push_back({odd, 0.1, 0});
    each.push_back({0.5, odd, 0});
    each.push_back({0.5, 0, odd});
  }
  Places all(3 * each.size());
  for (std::size_t k = 0; k < each.size(); ++k)
    for (std::size_t c = 0; c < 3; ++c) all[c * each.size() + k] = each[k][c];
  return all;
}

struct Compared {
  Errors errors;
  double pose = 0;  ///< [m, and of the quaternion]
  std::size_t left = 0, poses = 0;
};

Compared compare(const Robot& robot, const PoseBatch& batch) {
  Workspace work(robot);
  const std::size_t n = batch.coordinates.size() / 3;
  const Answer answer = in_batch(robot, batch, n);
  Compared found{.errors = {}, .left = answer.left, .poses = n};
  for (std::size_t k = 0; k < n; ++k) {
    const auto c = [&](std::size_t axis) { return batch.coordinates[axis * n + k]; };
    const ConstrainedPose place = constrained_pose(robot, {c(0), c(1), c(2)}, *batch.independent);
    if (!place.ok()) {
      found.errors.statuses += answer.status[k] != place.report.status;
      continue;
    }
    found.errors.of_pose(robot, answer, k, place.pose, batch, work);
    for (std::size_t i = 0; i < 7; ++i) {
      const double expected = i < 3 ? place.pose.position[static_cast<int>(i)] : place.pose.quaternion[i - 3];
      Errors::worsen(found.pose, std::abs(answer.place[i * n + k] - expected));
    }
  }
  return found;
}

void expect_small(const Compared& found, double size = 1) {
  EXPECT_EQ(found.errors.statuses, 0u);
  EXPECT_LT(found.errors.inputs, 1e-12 * size);
  EXPECT_LT(found.errors.residual, 1e-12 * size);
  EXPECT_LT(found.errors.determinant, 1e-13);
  EXPECT_LT(found.errors.condition, 1e-9);
  EXPECT_LT(found.errors.norms, 1e-9);
  EXPECT_LT(found.pose, 1e-12 * std::max(1.0, size));
}

TEST(HingedBatch, SaysWhatConstrainedPoseInverseAndVelocitySay) {
  const Robot robot = load("3prs").value();
  const Places many = places(4000, 1.05, 3), few = borders();
  with_each_instruction_set([&] {
    const Compared found = compare(robot, {.coordinates = many, .independent = OperationMode::tilt});
    expect_small(found);
    EXPECT_GT(found.errors.converged, 1000u);
    EXPECT_LT(found.left, found.poses / 2);  // those outside the disc
    const std::array<int, 3> elbow{1, -1, -1};
    expect_small(compare(robot, {.coordinates = many, .elbow = elbow, .independent = OperationMode::tilt}));
    expect_small(compare(robot, {.coordinates = few, .independent = OperationMode::tilt}));
    expect_small(compare(robot, {.coordinates = few, .independent = OperationMode::half_turn}));
  });
}

TEST(HingedBatch, TurnsOver) {
  auto legs = legs_of<PrsLeg>(load("3prs").value());
  for (PrsLeg& leg : legs.legs) leg.closure.length = 0.6;
  const Robot robot("long struts", legs);
  const Compared found =
      compare(robot, {.coordinates = places(2000, 0.7, 5), .independent = OperationMode::half_turn});
  expect_small(found);
  EXPECT_GT(found.errors.converged, 100u);
}

TEST(HingedBatch, ServesTripodsOfAnyShapeAndSize) {  // planes that do not meet in a line, rails that lean
  std::mt19937 random{23};
  std::size_t converged = 0, left = 0, poses = 0;
  for (int robots = 0; robots < 60; ++robots) {
    const double size = std::pow(10.0, robots % 7 - 3);
    auto model = legs_of<PrsLeg>(load("3prs").value());
    for (PrsLeg& leg : model.legs) {
      for (int i = 0; i < 3; ++i) leg.base.p[i] += uniform(random, -0.05, 0.05);
      for (int i = 0; i < 3; ++i) leg.platform_point[i] += uniform(random, -0.03, 0.03);
      leg.base = leg.base.displaced(Vec<double, 6>(0.0, 0.0, 0.0, uniform(random, -0.3, 0.3),
                                                   uniform(random, -0.3, 0.3), uniform(random, -0.3, 0.3)));
      leg.closure.length = uniform(random, 0.3, 0.5) * size;
      leg.base.p *= size;
      leg.platform_point *= size;
    }
    model.platform_radius *= size;
    const Robot robot("another", model);
    Places all = places(500, 0.4, static_cast<std::uint32_t>(robots));
    for (std::size_t k = 0; k < 500; ++k) all[k] *= size;
    const Compared found = compare(robot, {.coordinates = all, .independent = OperationMode::tilt});
    expect_small(found, size);
    converged += found.errors.converged, left += found.left, poses += found.poses;
  }
  EXPECT_GT(converged, poses / 4);
  EXPECT_LT(left, poses / 4);
}

TEST(HingedBatch, TakesWholePosesInTheirPlanesAndOutside) {
  const Robot robot = load("3prs").value();
  std::mt19937 random{31};
  std::vector<AnyPose> poses;
  const Places at = places(500, 0.8, 9);
  for (std::size_t k = 0; k < 500; ++k) {
    SpatialPose pose = constrained_pose(robot, {at[k], at[500 + k], at[1000 + k]}).pose;
    if (k % 2 == 1) pose.position[static_cast<int>(k % 3)] += std::pow(10.0, uniform(random, -13, -2));
    poses.push_back(pose);
  }
  with_each_instruction_set([&] {
    const Errors found = errors(robot, poses);
    EXPECT_EQ(found.statuses, 0u);
    EXPECT_LT(found.inputs, 1e-12);
    EXPECT_LT(found.norms, 1e-9);
    EXPECT_GT(found.converged, 100u);
  });
}

TEST(HingedBatch, AnswersAPoseAlikeAmongAnyOthers) {
  const Robot robot = load("3prs").value();
  const Places all = places(40, 1, 2);
  with_each_instruction_set([&] {
    const Answer whole = in_batch(robot, {.coordinates = all, .independent = OperationMode::tilt}, 40);
    for (std::size_t k = 0; k < 40; ++k) {
      const Places one{all[k], all[40 + k], all[80 + k]};
      const Answer alone = in_batch(robot, {.coordinates = one, .independent = OperationMode::tilt}, 1);
      EXPECT_EQ(alone.numbers(0), whole.numbers(k)) << k;
    }
  });
}

}  // namespace hinged_batch_test
}  // namespace sinew::test
