#include "sinew/analysis/velocity.hpp"

#include <gtest/gtest.h>

#include "batch_cases.hpp"
#include "every_robot.hpp"

namespace sinew::test {
namespace velocity_batch_test {

constexpr double pi = std::numbers::pi;

/// Near a border, on it, and beyond it.
constexpr std::array offsets{1e-2,  1e-3,  1e-5,  1e-6,  1e-7,  1e-8,  1e-9,
                             3e-10, 1e-10, 3e-11, 1e-12, 1e-13, 1e-15, 0.0};
constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();

/// Of the built-in 3-RFR.
std::vector<AnyPose> planar_borders() {
  std::vector<AnyPose> poses{PlanarPose{0.03, 0, pi / 3}};  // Fig. 10 of the paper
  // all legs straight: R_b² + R_p² − 2 R_b R_p cos ψ = ℓ² with ψ = φ − 60°
  const double straight = pi / 3 - std::acos((0.19 * 0.19 + 0.05 * 0.05 - 0.04) / (2 * 0.19 * 0.05));
  // the platform point of leg 1 on its base point
  const double y = 0.19 - 0.05 * std::sin(pi / 6), x = -0.05 * std::cos(pi / 6);
  for (const double size : offsets)
    for (const double off : {size, -size}) {
      for (const double beside : {0.0, 0.01, -0.02}) poses.push_back(PlanarPose{beside, 0.005, pi / 3 + off});
      poses.push_back(PlanarPose{0, 0, straight + off});
      poses.push_back(PlanarPose{x + off, y, 0});
    }
  for (const double odd : {nan, inf, -inf, 1e300, 1e5}) {
    poses.push_back(PlanarPose{odd, 0, 0});
    poses.push_back(PlanarPose{0, 0, odd});
    poses.push_back(PlanarPose{1, 0, odd});
    poses.push_back(PlanarPose{odd, 0, nan});
  }
  return poses;
}

/// Of the built-in 6-UFS.
std::vector<AnyPose> spatial_borders(const Robot& robot) {
  std::vector<AnyPose> poses;
  const auto from_home = [&](double up, double turn) {
    SpatialPose pose = std::get<SpatialPose>(home(robot));
    pose.position.z() += up;
    pose.quaternion = {3 * std::cos(turn / 2), 0, 0, 3 * std::sin(turn / 2)};
    return pose;
  };
  const double straight =
      std::sqrt(0.0625 - 0.0144 - 0.0049 + 2 * 0.12 * 0.07 * std::cos(pi / 5)) - from_home(0, 0).position.z();
  for (const double size : offsets)
    for (const double off : {size, -size}) {
      poses.push_back(from_home(straight + off, 0));
      poses.push_back(from_home(0, pi / 2 + off));  // Fichter's singularity
      poses.push_back(from_home(0.02, off - pi / 2));
    }
  for (const double odd : {nan, inf, -inf, 1e300, 0.0}) {
    poses.push_back(SpatialPose{{0, odd, 0.18}, {1, 0, 0, 0}});
    poses.push_back(SpatialPose{{0, 0, 0.18}, {odd, 0, 0, 0}});
    poses.push_back(SpatialPose{{0, 2, 0.18}, {1, odd, 0, 0}});
  }
  poses.push_back(SpatialPose{{0, 0, 0.18}, {1e-200, 0, 0, 0}});
  return poses;
}

/// In and out of reach.
std::vector<AnyPose> poses_around(const Robot& robot, int count) {
  std::mt19937 random{11};
  std::vector<AnyPose> poses;
  for (int k = 0; k < count; ++k) poses.push_back(pose_near_home(robot, random, 0.1, 1.5));
  return poses;
}

std::vector<AnyPose> many_poses(const Robot& robot, int count) {
  std::vector<AnyPose> poses = dof(robot) == 3 ? planar_borders() : spatial_borders(robot);
  const std::vector<AnyPose> around = poses_around(robot, count);
  poses.insert(poses.begin() + 10, around.begin(), around.end());
  return poses;
}

void expect_small(const Errors& found) {
  EXPECT_EQ(found.statuses, 0u);
  EXPECT_LT(found.inputs, 1e-13);
  EXPECT_LT(found.residual, 1e-14);
  EXPECT_LT(found.curvature, 1e-14);
  EXPECT_LT(found.determinant, 1e-13);
  EXPECT_LT(found.condition, 1e-10);
  EXPECT_LT(found.norms, 1e-10);
  EXPECT_GT(found.converged, 100u);
  EXPECT_GT(found.type_1, 0u);
  EXPECT_GT(found.type_2, 0u);
}

TEST(VelocityBatch, ServesRobotsThatCloseInClosedForm) {
  EXPECT_FALSE(has_velocity_batch(rfr_in_code(std::array{-1, -1, 0})));  // two legs, one motor
  EXPECT_TRUE(has_velocity_batch(load("3-rfr").value()));
  EXPECT_TRUE(has_velocity_batch(load("6-ufs").value()));
  EXPECT_TRUE(has_velocity_batch(load("3prs").value()));
  for (const char* other : {"3-frr", "3-rfrr", "3pfs-g1", "2prs-1pfs", "hexapod"})
    EXPECT_FALSE(has_velocity_batch(load(other).value())) << other;
}

TEST(VelocityBatch, SaysWhatInverseAndVelocitySay) {
  const Robot planar = load("3-rfr").value(), spatial = load("6-ufs").value();
  const auto poses = many_poses(planar, 20000), more = many_poses(spatial, 4000);
  with_each_instruction_set([&] {
    expect_small(errors(planar, poses));
    for (const std::array<int, 3>& bending : {std::array{1, 1, 1}, {-1, 1, 0}, {-1, -1, -1}})
      expect_small(errors(planar, poses, bending));
    expect_small(errors(spatial, more));
    expect_small(errors(spatial, more, std::array{1, -1, 1, -1, 0, 1}));
  });
}

TEST(VelocityBatch, ServesLegsOfUnlikeSizeAndRobotsOfAnySize) {
  std::mt19937 random{17};
  for (int robots = 0; robots < 40; ++robots) {
    const double size = std::pow(10.0, robots % 8 - 4);  // legs of 20 µm to 200 m
    const auto any = [&](double low, double high) { return size * uniform(random, low, high); };
    std::vector<RfrLeg> legs = rfr_legs();
    for (RfrLeg& leg : legs) {
      leg.base = SE2<double>::from(any(-0.2, 0.2), any(-0.2, 0.2), 0.0);
      leg.platform_point = Vec2<double>(any(-0.06, 0.06), any(-0.06, 0.06));
      leg.link.length = any(0.1, 0.4);
      leg.drive.offset = any(0.002, 0.06);
    }
    const Robot robot{"any 3-RFR", ParallelRobot<RfrLeg>(legs, {}, any(0.01, 0.1))};
    std::vector<AnyPose> poses;
    for (int k = 0; k < 2000; ++k)
      poses.push_back(PlanarPose{any(-0.2, 0.2), any(-0.2, 0.2), uniform(random, -7, 7)});
    const Errors found = errors(robot, poses);
    EXPECT_EQ(found.statuses, 0u);
    EXPECT_LT(found.inputs, 1e-13 * size);
    EXPECT_LT(found.determinant, 1e-13);
    EXPECT_LT(found.condition, 1e-10);
    EXPECT_LT(found.norms, 1e-10);
  }
}

TEST(VelocityBatch, AnswersAPoseAlikeAmongAnyOthers) {
  for (const char* name : {"3-rfr", "6-ufs"}) {
    const Robot robot = load(name).value();
    const auto poses = many_poses(robot, 40);
    with_each_instruction_set([&] {
      const Answer whole = in_batch(robot, poses);
      for (std::size_t n = 0; n <= 40; ++n)
        for (const std::size_t first : {std::size_t{0}, poses.size() - n}) {
          const Answer some = in_batch(robot, {poses.begin() + static_cast<std::ptrdiff_t>(first),
                                               poses.begin() + static_cast<std::ptrdiff_t>(first + n)});
          for (std::size_t k = 0; k < n; ++k) ASSERT_EQ(some.numbers(k), whole.numbers(first + k)) << name;
        }
    });
  }
}

TEST(VelocityBatch, ComputesOnlyWhatIsAskedFor) {
  const Robot robot = load("3-rfr").value();
  const auto poses = many_poses(robot, 100);
  const Answer whole = in_batch(robot, poses);
  Workspace work(robot);
  const auto same = [](const std::vector<double>& a, const std::vector<double>& b) {
    for (std::size_t k = 0; k < a.size(); ++k)
      if (a[k] != b[k] && !(std::isnan(a[k]) && std::isnan(b[k]))) return false;
    return true;
  };
  Answer one(poses.size(), 3);
  velocity_batch(robot, {axes(poses)}, {.status = one.status}, work);
  velocity_batch(robot, {axes(poses)}, {.determinant = one.determinant}, work);
  velocity_batch(robot, {axes(poses)}, {.residual = one.residual}, work);
  velocity_batch(robot, {axes(poses)}, {.condition = one.condition}, work);
  velocity_batch(robot, {axes(poses)}, {.rotation = one.rotation}, work);
  velocity_batch(robot, {axes(poses)}, {.position = one.position}, work);
  velocity_batch(robot, {axes(poses)}, {.is_type_2 = one.is_type_2}, work);
  EXPECT_EQ(one.status, whole.status);
  EXPECT_EQ(one.is_type_2, whole.is_type_2);
  EXPECT_TRUE(same(one.determinant, whole.determinant));
  for (std::size_t k = 0; k < poses.size(); ++k)  // beside what else is asked for more are done one by one
    EXPECT_TRUE(std::isnan(one.residual[k]) ? std::isnan(whole.residual[k])
                                            : std::abs(one.residual[k] - whole.residual[k]) < 1e-15)
        << k;
  EXPECT_TRUE(same(one.condition, whole.condition));
  EXPECT_TRUE(same(one.rotation, whole.rotation));
  EXPECT_TRUE(same(one.position, whole.position));
  velocity_batch(robot, {axes(poses)}, {}, work);
}

TEST(VelocityBatch, LeavesOnlyPosesNearABorder) {
  const Robot robot = load("3-rfr").value();
  EXPECT_LE(in_batch(robot, poses_around(robot, 100000)).left, 2u);
  const Robot spatial = load("6-ufs").value();
  EXPECT_LE(in_batch(spatial, poses_around(spatial, 20000)).left, 2u);
  EXPECT_EQ(in_batch(robot, {PlanarPose{0, 0, pi / 3}, PlanarPose{0, 0, 0}}).left, 1u);
}

TEST(VelocityBatch, AnswersWithNothingForARobotItDoesNotServe) {
#ifndef NDEBUG
  GTEST_SKIP() << "a broken precondition";
#else
  const Robot robot = load("3-frr").value();
  const Answer answer = in_batch(robot, {PlanarPose{}});
  EXPECT_EQ(answer.status[0], Status::left_domain);
  EXPECT_TRUE(std::isnan(answer.determinant[0]) && std::isnan(answer.inputs[2]));
#endif
}

}  // namespace velocity_batch_test
}  // namespace sinew::test
