#include "kinematics/serial/three_arcs.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <random>

#include "reference_file.hpp"

namespace sinew::test {
namespace three_arcs_test {

constexpr double pi = std::numbers::pi;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / 4294967295.0;
}
Vec2<double> in_disc(std::mt19937& random, double radius) {
  const double size = radius * std::sqrt(uniform(random, 0, 1)), way = uniform(random, -pi, pi);
  return {size * std::cos(way), size * std::sin(way)};
}
ThreeBends random_bends(std::mt19937& random, double limit) {
  return {in_disc(random, limit), in_disc(random, limit), in_disc(random, limit)};
}
ThreeArcs random_robot(std::mt19937& random, double limit) {
  ThreeArcs robot{.limit = limit};
  for (double& length : robot.lengths) length = uniform(random, 0.3, 1.3);
  return robot;
}
ThreeBends bends(double x1, double y1, double x2, double y2, double x3, double y3) {
  return {Vec2<double>(x1, y1), Vec2<double>(x2, y2), Vec2<double>(x3, y3)};
}

double gap(const ThreeBends& a, const ThreeBends& b) {
  double largest = 0;
  for (std::size_t k = 0; k < 3; ++k) largest = std::max(largest, (a[k] - b[k]).norm());
  return largest;
}
/// How far the nearest solution is.
double gap(const ThreeArcSolutions& found, const ThreeBends& wanted) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const ThreeBends& solution : found.solutions) nearest = std::min(nearest, gap(solution, wanted));
  return nearest;
}

Vec<double, 6> twist(double length, const Vec2<double>& bend) {
  Vec<double, 6> xi;
  xi << 0, 0, length, -bend[1], bend[0], 0;
  return xi;
}
/// The tip as a product of exponentials: nothing of the solver is in it.
SE3<double> tip_by_exponentials(const ThreeArcs& robot, const ThreeBends& b) {
  SE3<double> tip;
  for (std::size_t k = 0; k < 3; ++k) tip = tip.compose(SE3<double>::exp(twist(robot.lengths[k], b[k])));
  return tip;
}
SpatialPose pose_of(const ThreeArcs& robot, const ThreeBends& b) {
  return spatial_pose(tip_by_exponentials(robot, b));
}

double gap(const SE3<double>& a, const SE3<double>& b) {
  return std::max((a.p - b.p).norm(), a.R.compose(b.R.inverse()).log().norm());
}

void expect_all_reach(const ThreeArcs& robot, const ThreeArcSolutions& found, const SpatialPose& pose) {
  ASSERT_EQ(found.residual.size(), found.solutions.size());
  ASSERT_EQ(found.regularity.size(), found.solutions.size());
  for (const ThreeBends& solution : found.solutions) {
    EXPECT_LT(gap(tip_by_exponentials(robot, solution), SE3<double>::from(pose)), 1e-11);
    for (const Vec2<double>& bend : solution) EXPECT_LE(bend.norm(), robot.limit + 1e-8);
  }
}

/// Newton's method on the product of exponentials, damped, from one start; no finite answer where it fails.
ThreeBends newton_from(const ThreeArcs& robot, const SE3<double>& pose, ThreeBends b) {
  double damping = 1e-2;
  const auto error_of = [&](const SE3<double>& tip) {
    Vector6 e;
    e << tip.p - pose.p, tip.R.compose(pose.R.inverse()).log();
    return e;
  };
  Vector6 error = error_of(tip_by_exponentials(robot, b));
  for (int i = 0; i < 30 && error.norm() > 1e-13; ++i) {
    Matrix6 J;
    SE3<double> base;
    const Vec3<double> tip = tip_by_exponentials(robot, b).p;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec<double, 6> xi = twist(robot.lengths[k], b[k]);
      const Mat<double, 6, 6> rate = base.adjoint() * SE3<double>::left_jacobian(xi);
      for (int j = 0; j < 2; ++j) {
        const Vec<double, 6> screw = j == 0 ? rate.col(4) : Vec<double, 6>(-rate.col(3));
        const Vec3<double> turn = screw.tail<3>();
        J.col(2 * static_cast<int>(k) + j) << screw.head<3>() + cross(turn, tip), turn;
      }
      base = base.compose(SE3<double>::exp(xi));
    }
    const Vector6 step = (J.transpose() * J + damping * error.squaredNorm() * Matrix6::Identity())
                             .partialPivLu()
                             .solve(J.transpose() * error);
    ThreeBends next = b;
    for (std::size_t k = 0; k < 3; ++k) next[k] -= step.segment<2>(2 * static_cast<int>(k));
    const Vector6 ahead = error_of(tip_by_exponentials(robot, next));
    if (!(ahead.norm() < error.norm())) {
      damping *= 10;
      continue;
    }
    damping = std::max(damping / 5, 1e-3);
    b = next;
    error = ahead;
  }
  if (!(error.norm() < 1e-11)) b[0][0] = std::numeric_limits<double>::infinity();
  return b;
}
bool is_within(const ThreeBends& b, double limit) {
  return std::ranges::all_of(b, [&](const Vec2<double>& bend) { return bend.norm() < limit; });
}

const nlohmann::json& reference() { return test::reference_file("data/field/cc3_fk_and_all_ik.json"); }
ThreeBends bends_of(const nlohmann::json& xi) {
  ThreeBends b;
  for (std::size_t k = 0; k < 3; ++k) b[k] = {xi.at(2 * k + 1).get<double>(), -xi.at(2 * k).get<double>()};
  return b;
}

TEST(ThreeArcs, TipIsThatOfTheReference) {
  const auto& fk = reference().at("fk");
  const SE3<double> tip = tip_pose({}, bends_of(fk.at("xi")));
  const Mat<double, 3, 3> turn = tip.R.matrix();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j)
      EXPECT_NEAR(j < 3 ? turn(i, j) : tip.p[i],
                  fk.at("T_rowmajor_3x4").at(static_cast<std::size_t>(4 * i + j)).get<double>(), 1e-11);
}

TEST(ThreeArcs, EverySolutionOfTheReferenceIsFoundAndNoOtherExists) {
  const auto& ik = reference().at("ik_all_solutions");
  const double half = 15 * pi / 32;
  const Vec3<double> turn = std::sin(half) * Vec3<double>(0.48, std::sqrt(3.0) / 10, -0.86);
  const SpatialPose pose{Vec3<double>(-0.4, 1.1, 0.8), {std::cos(half), turn[0], turn[1], turn[2]}};
  const ThreeArcSolutions found = all_bends({}, pose);
  EXPECT_TRUE(found.ok());
  EXPECT_TRUE(found.is_complete());
  EXPECT_EQ(found.solutions.size(), ik.at("solutions_xi").size());
  for (const auto& xi : ik.at("solutions_xi")) EXPECT_LT(gap(found, bends_of(xi)), 2e-9);
  EXPECT_LT(found.report.residual, 1e-13);
  expect_all_reach({}, found, pose);
}

RC_GTEST_PROP(ThreeArcs, TipIsTheProductOfExponentials, ()) {
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  const ThreeArcs robot = random_robot(random, 2 * pi);
  const ThreeBends b = random_bends(random, 2 * pi);
  RC_ASSERT(gap(tip_pose(robot, b), tip_by_exponentials(robot, b)) < 1e-13);
}

TEST(ThreeArcs, BendsThatMadeThePoseAreAmongTheAnswers) {
  std::mt19937 random(20240801);
  for (int i = 0; i < 400; ++i) {
    const ThreeArcs robot = random_robot(random, i % 4 == 0 ? 1.5 * pi : pi);
    const ThreeBends b = random_bends(random, robot.limit);
    const ThreeArcSolutions found = all_bends(robot, pose_of(robot, b));
    EXPECT_TRUE(found.ok()) << found.report.message.view();
    EXPECT_TRUE(found.is_complete()) << i << ": " << found.open_boxes;
    EXPECT_LT(gap(found, b), 1e-9) << i;
    expect_all_reach(robot, found, pose_of(robot, b));
  }
}

TEST(ThreeArcs, BendsUpToAFullTurnAreFoundToo) {
  std::mt19937 random(7);
  int complete = 0;
  for (int i = 0; i < 60; ++i) {
    const ThreeArcs robot = random_robot(random, 2 * pi);
    const ThreeBends b = random_bends(random, robot.limit);
    const ThreeArcSolutions found = all_bends(robot, pose_of(robot, b));
    EXPECT_LT(gap(found, b), 1e-7) << i;
    complete += found.is_complete();
  }
  EXPECT_GE(complete, 59);  // near a full turn the Jacobian is nearly singular
}

TEST(ThreeArcs, NewtonFromManyStartsFindsNoOtherSolution) {
  std::mt19937 random(99);
  int reached = 0;
  for (int i = 0; i < 30; ++i) {
    const ThreeArcs robot = random_robot(random, i % 2 == 0 ? pi : 2 * pi);
    const SpatialPose pose = pose_of(robot, random_bends(random, robot.limit));
    const ThreeArcSolutions found = all_bends(robot, pose);
    EXPECT_TRUE(found.is_complete()) << i;
    for (int start = 0; start < 400; ++start) {
      const ThreeBends b = newton_from(robot, SE3<double>::from(pose), random_bends(random, robot.limit));
      if (!is_within(b, robot.limit)) continue;
      ++reached;
      EXPECT_LT(gap(found, b), 1e-7) << i;
    }
  }
  EXPECT_GT(reached, 1000);
}

TEST(ThreeArcs, TheRobotSeenFromItsTipHasTheSameSolutions) {
  std::mt19937 random(5);
  const SO3<double> half_turn{0, Vec3<double>(1, 0, 0)};
  for (int i = 0; i < 40; ++i) {
    const ThreeArcs robot = random_robot(random, 1.4 * pi),
                    back{{robot.lengths[2], robot.lengths[1], robot.lengths[0]}, robot.limit};
    const SE3<double> tip = tip_by_exponentials(robot, random_bends(random, robot.limit)),
                      inverse = tip.inverse();
    const SE3<double> seen{half_turn.rotate(inverse.p), half_turn.compose(inverse.R).compose(half_turn)};
    const ThreeArcSolutions found = all_bends(robot, spatial_pose(tip)),
                            reversed = all_bends(back, spatial_pose(seen));
    ASSERT_EQ(found.solutions.size(), reversed.solutions.size());
    for (const ThreeBends& b : found.solutions)
      EXPECT_LT(gap(reversed, bends(b[2][0], -b[2][1], b[1][0], -b[1][1], b[0][0], -b[0][1])), 1e-8);
  }
}

TEST(ThreeArcs, UnitOfLengthDoesNotMatter) {
  std::mt19937 random(6);
  const ThreeArcs metres = random_robot(random, 1.2 * pi);
  ThreeArcs millimetres = metres;
  for (double& length : millimetres.lengths) length *= 1000;
  SpatialPose pose = pose_of(metres, random_bends(random, metres.limit));
  const ThreeArcSolutions in_metres = all_bends(metres, pose);
  pose.position *= 1000;
  const ThreeArcSolutions in_millimetres = all_bends(millimetres, pose);
  ASSERT_EQ(in_metres.solutions.size(), in_millimetres.solutions.size());
  for (std::size_t i = 0; i < in_metres.solutions.size(); ++i)
    EXPECT_LT(gap(in_metres.solutions[i], in_millimetres.solutions[i]), 1e-10);
}

TEST(ThreeArcs, SectionsOfVeryUnequalLengthAreNoObstacle) {
  for (const std::array<double, 3>& lengths :
       {std::array<double, 3>{0.01, 1, 100}, {1, 1e-6, 1}, {1e-6, 1, 1}}) {
    const ThreeArcs robot{lengths};
    const ThreeBends b = bends(0.5, 0.3, -0.7, 0.2, 2.5, 0.3);
    const ThreeArcSolutions found = all_bends(robot, pose_of(robot, b));
    EXPECT_TRUE(found.ok());
    EXPECT_TRUE(found.is_complete());
    EXPECT_LT(gap(found, b), 1e-8);
  }
}

TEST(ThreeArcs, PlanarPosesAreOrdinary) {  // the twist equation then says nothing on either curve
  for (const double way : {0.0, 0.3, pi / 2}) {
    const double c = std::cos(way), s = std::sin(way);
    const ThreeBends b = bends(0.5 * c, 0.5 * s, -0.8 * c, -0.8 * s, 1.2 * c, 1.2 * s);
    const ThreeArcSolutions found = all_bends({}, pose_of({}, b));
    EXPECT_TRUE(found.ok());
    EXPECT_TRUE(found.is_complete());
    EXPECT_LT(gap(found, b), 1e-9);
    EXPECT_EQ(found.solutions.size(), 2u);
  }
}

TEST(ThreeArcs, TheStraightRobotHasOneSolution) {
  const ThreeArcSolutions found = all_bends({{0.1, 0.2, 0.3}}, {Vec3<double>(0, 0, 0.6), {1, 0, 0, 0}});
  EXPECT_TRUE(found.ok());
  EXPECT_TRUE(found.is_complete());
  ASSERT_EQ(found.solutions.size(), 1u);
  EXPECT_EQ(gap(found.solutions[0], bends(0, 0, 0, 0, 0, 0)), 0);
}

TEST(ThreeArcs, NearStraightTheTwoSolutionsStayApart) {
  for (const double size : {1e-4, 1e-3, 1e-2, 0.1}) {
    const ThreeBends b = bends(size, 0.5 * size, -0.3 * size, 0.7 * size, 0.2 * size, -0.9 * size);
    const ThreeArcSolutions found = all_bends({}, pose_of({}, b));
    EXPECT_TRUE(found.is_complete());
    EXPECT_EQ(found.solutions.size(), 2u);
    EXPECT_LT(gap(found, b), 1e-12 / size);
  }
}

TEST(ThreeArcs, NearerToStraightTheAnswerSaysThatSomeMayBeMissing) {
  for (const double size : {1e-7, 1e-6}) {
    const ThreeBends b = bends(size, 0.5 * size, -0.3 * size, 0.7 * size, 0.2 * size, -0.9 * size);
    const ThreeArcSolutions found = all_bends({}, pose_of({}, b));
    EXPECT_FALSE(found.is_complete());
    EXPECT_LT(gap(found, b), 1e-5);
  }
}

TEST(ThreeArcs, StraightSectionsBetweenBentOnesAreRegular) {
  const ThreeBends b = bends(0.5, 1, 0, 0, 1.2, -0.3);
  const ThreeArcSolutions found = all_bends({}, pose_of({}, b));
  EXPECT_TRUE(found.is_complete());
  EXPECT_LT(gap(found, b), 1e-9);
}

TEST(ThreeArcs, PoseOfASingleArcIsReachedByAContinuum) {
  const ThreeArcs robot{{1, 1, 1}, 1.2 * pi};
  for (const ThreeBends& b :
       {bends(0.5, 0.3, 0.5, 0.3, 0.5, 0.3), bends(0, 0, 2, 1, 0, 0), bends(1, 0, 2, 0, 1, 0)}) {
    const SpatialPose pose = pose_of(robot, b);
    const ThreeArcSolutions found = all_bends(robot, pose);
    EXPECT_EQ(found.report.status, Status::singular);
    EXPECT_FALSE(found.is_complete());
    EXPECT_GT(found.solutions.size(), 3u);
    EXPECT_LE(found.solutions.size(), 32u);
    EXPECT_LT(found.boxes, 50000);
    expect_all_reach(robot, found, pose);
    for (std::size_t i = 0; i < found.solutions.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) EXPECT_GT(gap(found.solutions[i], found.solutions[j]), 0.1);
  }
}

TEST(ThreeArcs, TooFarIsSaidWithTheLengths) {
  const ThreeArcSolutions found = all_bends({}, {Vec3<double>(1, 0, 3), {1, 0, 0, 0}});
  EXPECT_EQ(found.report.status, Status::unreachable);
  EXPECT_TRUE(found.is_complete());
  EXPECT_NE(found.report.message.view().find("3162.28 mm from the base, the robot 3000 mm"),
            std::string_view::npos);
}

TEST(ThreeArcs,
     PoseWithinReachMayStillHaveNoSolution) {  // half a turn about the axis of a nearly straight robot
  for (const double height : {1.0, 2.9, 3.0}) {
    const ThreeArcSolutions found = all_bends({}, {Vec3<double>(0, 0, height), {0, 0, 0, 1}});
    EXPECT_EQ(found.report.status, Status::unreachable);
    EXPECT_TRUE(found.is_complete());
    EXPECT_TRUE(found.solutions.empty());
  }
}

TEST(ThreeArcs, TheLimitTakesSolutionsAwayAndAddsNone) {
  std::mt19937 random(12);
  for (int i = 0; i < 20; ++i) {
    ThreeArcs robot = random_robot(random, 1.6 * pi);
    const SpatialPose pose = pose_of(robot, random_bends(random, pi));
    const ThreeArcSolutions all = all_bends(robot, pose);
    robot.limit = pi;
    const ThreeArcSolutions some = all_bends(robot, pose);
    const auto within =
        std::ranges::count_if(all.solutions, [](const ThreeBends& b) { return is_within(b, pi); });
    EXPECT_EQ(static_cast<std::size_t>(within), some.solutions.size());
    for (const ThreeBends& b : some.solutions) EXPECT_LT(gap(all, b), 1e-8);
  }
}

TEST(ThreeArcs, ABendAtTheLimitCounts) {
  const ThreeArcs robot{{1, 1, 1}, 2};
  const ThreeBends b = bends(2, 0, 0, -2, 0.3, 0.4);
  EXPECT_LT(gap(all_bends(robot, pose_of(robot, b)), b), 1e-9);
}

TEST(ThreeArcs, TheSameQuestionHasTheSameAnswerAndBothQuaternionsAreOnePose) {
  std::mt19937 random(3);
  const SpatialPose pose = pose_of({}, random_bends(random, 4));
  SpatialPose other = pose;
  for (double& q : other.quaternion) q *= -2;
  const ThreeArcSolutions a = all_bends({}, pose), b = all_bends({}, pose), c = all_bends({}, other);
  ASSERT_EQ(a.solutions.size(), c.solutions.size());
  for (std::size_t i = 0; i < a.solutions.size(); ++i) {
    EXPECT_EQ(a.solutions[i], b.solutions[i]);
    EXPECT_LT(gap(a.solutions[i], c.solutions[i]), 1e-10);
  }
}

TEST(ThreeArcs, NumbersOutsideTheDomainAreRefused) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                   infinite = std::numeric_limits<double>::infinity();
  const SpatialPose pose{Vec3<double>(0.5, 0, 2), {1, 0, 0, 0}};
  const auto status = [](const ThreeArcs& robot, const SpatialPose& tip) {
    return all_bends(robot, tip).report.status;
  };
  EXPECT_EQ(status({{1, 0, 1}}, pose), Status::left_domain);
  EXPECT_EQ(status({{1, -1, 1}}, pose), Status::left_domain);
  EXPECT_EQ(status({{1, infinite, 1}}, pose), Status::left_domain);
  EXPECT_EQ(status({{1, nan, 1}}, pose), Status::left_domain);
  EXPECT_EQ(status({{1, 1, 1}, 0}, pose), Status::left_domain);
  EXPECT_EQ(status({{1, 1, 1}, 7}, pose), Status::left_domain);
  EXPECT_EQ(status({}, {Vec3<double>(nan, 0, 1), {1, 0, 0, 0}}), Status::left_domain);
  EXPECT_EQ(status({}, {Vec3<double>(0, 0, 1), {0, 0, 0, 0}}), Status::left_domain);
  EXPECT_EQ(status({}, {Vec3<double>(0, 0, 1), {nan, 0, 0, 0}}), Status::left_domain);
}

}  // namespace three_arcs_test
}  // namespace sinew::test
