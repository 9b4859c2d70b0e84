#include "sinew/analysis/velocity_batch.hpp"

#include <gtest/gtest.h>

#include <hwy/targets.h>

#include "analysis/chord_lanes.hpp"
#include "every_robot.hpp"

namespace sinew::test {
namespace {

constexpr double pi = std::numbers::pi;

/// All that a batch can be asked for, of n poses.
struct Answer {
  std::size_t poses, legs, left = 0;
  std::vector<Status> status;
  std::vector<double> inputs, curvatures, determinant, condition, condition_homogenised, position, rotation;
  std::vector<std::uint8_t> type_1, is_type_2;

  Answer(std::size_t n, std::size_t leg_count)
      : poses(n),
        legs(leg_count),
        status(n),
        inputs(n * legs),
        curvatures(n * legs),
        determinant(n),
        condition(n),
        condition_homogenised(n),
        position(n),
        rotation(n),
        type_1(n),
        is_type_2(n) {}

  VelocityBatch spans() {
    return {.status = status,
            .inputs = inputs,
            .curvatures = curvatures,
            .determinant = determinant,
            .condition = condition,
            .condition_homogenised = condition_homogenised,
            .position = position,
            .rotation = rotation,
            .type_1 = type_1,
            .is_type_2 = is_type_2};
  }

  /// All numbers of pose k; NaN as one certain number, so that equal answers compare equal.
  std::vector<double> numbers(std::size_t k) const {
    std::vector<double> all{
        static_cast<double>(status[k]), type_1[k] * 1.0, is_type_2[k] * 1.0, determinant[k], condition[k],
        condition_homogenised[k],       position[k],     rotation[k]};
    for (std::size_t i = 0; i < legs; ++i) {
      all.push_back(inputs[i * poses + k]);
      all.push_back(curvatures[i * poses + k]);
    }
    for (double& x : all)
      if (std::isnan(x)) x = -1e300;
    return all;
  }
};

/// Poses as a batch has them.
std::vector<double> axes(const std::vector<AnyPose>& poses) {
  const std::size_t n = poses.size();
  if (n == 0) return {};
  const bool planar = std::holds_alternative<PlanarPose>(poses[0]);
  std::vector<double> numbers((planar ? 3 : 7) * n);
  for (std::size_t k = 0; k < n; ++k) {
    std::vector<double> one;
    if (planar) {
      const auto& pose = std::get<PlanarPose>(poses[k]);
      one = {pose.x, pose.y, pose.phi};
    } else {
      const auto& pose = std::get<SpatialPose>(poses[k]);
      one = {pose.position[0], pose.position[1], pose.position[2]};
      one.insert(one.end(), pose.quaternion.begin(), pose.quaternion.end());
    }
    for (std::size_t a = 0; a < one.size(); ++a) numbers[a * n + k] = one[a];
  }
  return numbers;
}

Answer in_batch(const AnyRobot& robot, const std::vector<AnyPose>& poses, std::span<const int> bending = {}) {
  Workspace work(robot);
  Answer answer(poses.size(), static_cast<std::size_t>(leg_count(robot)));
  answer.left = velocity_batch(robot, axes(poses), bending, answer.spans(), work);
  return answer;
}

/// The largest errors beside `inverse` and `velocity`; statuses and what is absent must be the same.
struct Errors {
  double inputs = 0;     ///< [m]
  double curvature = 0;  ///< of the bend angle over what a rounding of the chord does to it
  double determinant = 0, condition = 0, norms = 0;  ///< relative, over max(1, condition/1e5)
  std::size_t statuses = 0, converged = 0, type_1 = 0, type_2 = 0;

  void of_pose(const AnyRobot& robot, const Answer& batch, std::size_t k, const AnyPose& pose,
               std::span<const int> bending, Workspace& work) {
    const Inverse solved = inverse(robot, pose, {.bending = bending}, work);
    if (!solved.ok()) {
      statuses += batch.status[k] != solved.report.status;
      for (const double number : batch.numbers(k)) statuses += number != -1e300 && number < 0;
      statuses +=
          !std::isnan(batch.determinant[k]) || !std::isnan(batch.inputs[k]) || !std::isnan(batch.rotation[k]);
      return;
    }
    for (std::size_t i = 0; i < batch.legs; ++i) {
      worsen(inputs, std::abs(batch.inputs[i * batch.poses + k] - solved.inputs[i]));
      const double turn = solved.coordinates[i] * 0.1;
      worsen(curvature, std::abs(batch.curvatures[i * batch.poses + k] - solved.coordinates[i]) * 0.1 *
                            std::min(1.0, std::abs(turn)));
    }
    const Velocity at = velocity(robot, pose, solved.coordinates, work);
    statuses += batch.status[k] != at.report.status || batch.type_1[k] != at.type_1.size() ||
                batch.is_type_2[k] != at.type_2.singular;
    converged += at.report.ok();
    type_1 += !at.type_1.empty();
    type_2 += at.type_2.singular;
    const double loss = std::max(1.0, at.indices.condition_homogenised / 1e5);
    const auto compare = [&](double& worst, double found, double expected) {
      if (std::isnan(expected) || std::isnan(found))
        statuses += std::isnan(expected) != std::isnan(found);
      else
        worsen(worst, std::abs(found / expected - 1) / loss);
    };
    double scale = 1;
    for (Eigen::Index i = 0; i < at.J.rows(); ++i) scale *= at.J.row(i).norm();
    worsen(determinant, std::abs(batch.determinant[k] - at.determinant) / scale);
    compare(condition, batch.condition[k], at.indices.condition);
    compare(condition, batch.condition_homogenised[k], at.indices.condition_homogenised);
    compare(norms, batch.position[k], at.indices.position);
    compare(norms, batch.rotation[k], at.indices.rotation);
  }

  static void worsen(double& worst, double found) {
    if (!(found <= worst)) worst = found;
  }
};

Errors errors(const AnyRobot& robot, const std::vector<AnyPose>& poses, std::span<const int> bending = {}) {
  Workspace work(robot);
  const Answer batch = in_batch(robot, poses, bending);
  Errors found;
  for (std::size_t k = 0; k < poses.size(); ++k) found.of_pose(robot, batch, k, poses[k], bending, work);
  return found;
}

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
std::vector<AnyPose> spatial_borders(const AnyRobot& robot) {
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
std::vector<AnyPose> poses_around(const AnyRobot& robot, int count) {
  std::mt19937 random{11};
  std::vector<AnyPose> poses;
  for (int k = 0; k < count; ++k) poses.push_back(pose_near_home(robot, random, 0.1, 1.5));
  return poses;
}

std::vector<AnyPose> many_poses(const AnyRobot& robot, int count) {
  std::vector<AnyPose> poses = dof(robot) == 3 ? planar_borders() : spatial_borders(robot);
  const std::vector<AnyPose> around = poses_around(robot, count);
  poses.insert(poses.begin() + 10, around.begin(), around.end());
  return poses;
}

void expect_small(const Errors& found) {
  EXPECT_EQ(found.statuses, 0u);
  EXPECT_LT(found.inputs, 1e-13);
  EXPECT_LT(found.curvature, 1e-14);
  EXPECT_LT(found.determinant, 1e-13);
  EXPECT_LT(found.condition, 1e-10);
  EXPECT_LT(found.norms, 1e-10);
  EXPECT_GT(found.converged, 100u);
  EXPECT_GT(found.type_1, 0u);
  EXPECT_GT(found.type_2, 0u);
}

TEST(VelocityBatch, ServesRobotsOfChordLegsOnly) {
  EXPECT_FALSE(has_velocity_batch(rfr_in_code(std::array{-1, -1, 0})));  // two legs, one motor
  EXPECT_TRUE(has_velocity_batch(load("3-rfr").value()));
  EXPECT_TRUE(has_velocity_batch(load("6-ufs").value()));
  for (const char* other : {"3-frr", "3-rfrr", "3prs", "3pfs-g1", "2prs-1pfs", "hexapod"})
    EXPECT_FALSE(has_velocity_batch(load(other).value())) << other;
}

/// Runs a test's body with each instruction set of this machine.
template <class Body>
void with_each_instruction_set(const Body& body) {
  for (const std::int64_t set : {std::int64_t{HWY_AVX3}, std::int64_t{HWY_AVX2}, std::int64_t{HWY_SSSE3},
                                 std::int64_t{HWY_EMU128}, std::int64_t{HWY_SCALAR}}) {
    if ((hwy::SupportedTargets() & set) == 0) continue;
    hwy::SetSupportedTargetsForTest(set);
    hwy::GetChosenTarget().Update(set);
    SCOPED_TRACE(chord_lanes::instruction_set());
    body();
    hwy::SetSupportedTargetsForTest(0);
  }
  hwy::GetChosenTarget().DeInit();
}

TEST(VelocityBatch, SaysWhatInverseAndVelocitySay) {
  const AnyRobot planar = load("3-rfr").value(), spatial = load("6-ufs").value();
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
    const AnyRobot robot{"any 3-RFR", ParallelRobot<RfrLeg>(legs, {}, any(0.01, 0.1))};
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
    const AnyRobot robot = load(name).value();
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
  const AnyRobot robot = load("3-rfr").value();
  const auto poses = many_poses(robot, 100);
  const Answer whole = in_batch(robot, poses);
  Workspace work(robot);
  const auto same = [](const std::vector<double>& a, const std::vector<double>& b) {
    for (std::size_t k = 0; k < a.size(); ++k)
      if (a[k] != b[k] && !(std::isnan(a[k]) && std::isnan(b[k]))) return false;
    return true;
  };
  Answer one(poses.size(), 3);
  velocity_batch(robot, axes(poses), {}, {.status = one.status}, work);
  velocity_batch(robot, axes(poses), {}, {.determinant = one.determinant}, work);
  velocity_batch(robot, axes(poses), {}, {.condition = one.condition}, work);
  velocity_batch(robot, axes(poses), {}, {.rotation = one.rotation}, work);
  velocity_batch(robot, axes(poses), {}, {.position = one.position}, work);
  velocity_batch(robot, axes(poses), {}, {.is_type_2 = one.is_type_2}, work);
  EXPECT_EQ(one.status, whole.status);
  EXPECT_EQ(one.is_type_2, whole.is_type_2);
  EXPECT_TRUE(same(one.determinant, whole.determinant));
  EXPECT_TRUE(same(one.condition, whole.condition));
  EXPECT_TRUE(same(one.rotation, whole.rotation));
  EXPECT_TRUE(same(one.position, whole.position));
  velocity_batch(robot, axes(poses), {}, {}, work);
}

TEST(VelocityBatch, LeavesOnlyPosesNearABorder) {
  const AnyRobot robot = load("3-rfr").value();
  EXPECT_LE(in_batch(robot, poses_around(robot, 100000)).left, 2u);
  const AnyRobot spatial = load("6-ufs").value();
  EXPECT_LE(in_batch(spatial, poses_around(spatial, 20000)).left, 2u);
  EXPECT_EQ(in_batch(robot, {PlanarPose{0, 0, pi / 3}, PlanarPose{0, 0, 0}}).left, 1u);
}

TEST(VelocityBatch, AnswersWithNothingForARobotItDoesNotServe) {
#ifndef NDEBUG
  GTEST_SKIP() << "a broken precondition";
#else
  const AnyRobot robot = load("3-frr").value();
  const Answer answer = in_batch(robot, {PlanarPose{}});
  EXPECT_EQ(answer.status[0], Status::left_domain);
  EXPECT_TRUE(std::isnan(answer.determinant[0]) && std::isnan(answer.inputs[2]));
#endif
}

}  // namespace
}  // namespace sinew::test
