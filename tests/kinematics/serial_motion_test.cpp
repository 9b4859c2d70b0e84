/// Poses of serial robots against plain products of matrices, and the tip's Jacobian against differences.
#include <gtest/gtest.h>

#include "check_jacobian.hpp"
#include "link/bent_motion.hpp"
#include "robot/arms/section_motion.hpp"
#include "serial_robots.hpp"

namespace sinew::test {
namespace serial_motion_test {

using Matrix = Eigen::Matrix<long double, 4, 4>;
using kernel::Backbone;

Matrix shifted(int axis, long double by) {
  Matrix m = Matrix::Identity();
  m(axis, 3) = by;
  return m;
}

/// Active, about x (0) or z (2).
Matrix turned(int axis, long double by) {
  Matrix m = Matrix::Identity();
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  m(i, i) = m(j, j) = std::cos(by);
  m(j, i) = std::sin(by);
  m(i, j) = -m(j, i);
  return m;
}

/// One segment as (3) prints it, with the corrections of docs/errata.md: R_x(−β) about an axis at L/β,
/// between turns to the direction of the bend and back.
Matrix segment(const Section& section, long double bend, long double direction) {
  const long double quarter = std::numbers::pi_v<long double> / 2;
  if (bend == 0) return shifted(2, section.joint + section.disc_height);
  const long double radius = section.joint / bend;
  return turned(2, direction - quarter) * shifted(1, radius) * turned(0, -bend) * shifted(1, -radius) *
         turned(2, quarter - direction) * shifted(2, section.disc_height);
}

Matrix as_printed(const Section& section, const Bend& bend) {
  Matrix end = Matrix::Identity();
  for (int i = 0; i < section.segments; ++i)
    if (section.is_twin())
      end *= i % 2 == 0 ? segment(section, bend.y(), std::numbers::pi_v<long double> / 2)
                        : segment(section, bend.x(), 0);
    else
      end *= segment(section, bend.norm() / section.segments, std::atan2(bend.y(), bend.x()));
  return end;
}

SerialRobot arcs(int sections, int segments = 1) {
  SerialRobot robot;
  for (int m = 0; m < sections; ++m) {
    Section section;
    section.backbone = Backbone::neutral;
    section.segments = segments;
    section.joint = 1.0 / segments;
    section.tendon_radius = 0.01;
    robot.sections.push_back(section);
  }
  return robot;
}

SerialRobot with_segments(Backbone backbone, int sections, int segments) {
  SerialRobot robot = nottingham(backbone, sections);
  for (Section& section : robot.sections) section.segments = segments;
  return robot;
}

std::vector<SerialRobot> robots() {
  std::vector<SerialRobot> all = {arcs(3), arcs(1), arcs(2, 3)};
  for (const Backbone backbone : {Backbone::twin_pivot, Backbone::neutral}) {
    for (const int sections : {1, 2, 3, 5, 12}) all.push_back(nottingham(backbone, sections));
    for (const int segments : {2, 6, 10, 28}) all.push_back(with_segments(backbone, 2, segments));
  }
  for (const int segments : {1, 5, 7}) all.push_back(with_segments(Backbone::neutral, 2, segments));
  return all;
}

/// Random bends, these much smaller, some sections straight, and bends far beyond the limits.
std::vector<std::vector<Bend>> shapes(const SerialRobot& robot, std::mt19937& random) {
  std::vector<std::vector<Bend>> all;
  for (const double factor : {1.0, 1.0, 1e-3, 1e-9, 0.0, 2.5}) {
    std::vector<Bend> bends = random_bends(robot, random);
    for (Bend& bend : bends) bend *= factor;
    all.push_back(bends);
  }
  all.push_back(random_bends(robot, random));
  for (std::size_t m = 0; m < robot.sections.size(); m += 2) all.back()[m] = Bend(0, 0);
  return all;
}

TEST(SerialMotion, SectionsArePlainProductsOfMatrices) {  // @verifies LSK (3), (4)
  std::mt19937 random(1);
  for (const SerialRobot& robot : robots()) {
    SerialWorkspace work(robot);
    for (const std::vector<Bend>& bends : shapes(robot, random)) {
      section_ends(bends, work);
      Matrix end = Matrix::Identity();
      double lost = 0;
      for (std::size_t m = 0; m < bends.size(); ++m) {
        end *= as_printed(robot.sections[m], bends[m]);
        const Eigen::Matrix4d expected = end.cast<double>();
        // near straight the printed form loses what the radius is longer than the robot, even in these digits
        const double rounding = 2e-14, smallest = bends[m].cwiseAbs().minCoeff();
        lost += smallest > 0 ? 2e-18 * robot.sections[m].arc_length() / smallest : 0;
        EXPECT_LT((work.ends[m].p - expected.topRightCorner<3, 1>()).norm(),
                  rounding * robot.length() + lost);
        EXPECT_LT((work.ends[m].R.matrix() - expected.topLeftCorner<3, 3>()).norm(), rounding);
      }
    }
  }
}

/// Position and matrix of the tip by all bends, of any scalar.
struct Tip {
  const SerialRobot& robot;
  template <class S>
  Eigen::Matrix<S, Eigen::Dynamic, 1> operator()(const Eigen::Matrix<S, Eigen::Dynamic, 1>& bends) const {
    BentPose<S> end;
    for (std::size_t m = 0; m < robot.sections.size(); ++m) {
      const auto j = static_cast<Eigen::Index>(2 * m);
      end = end.then(section_pose(robot.sections[m], Vec2<S>(bends[j], bends[j + 1])));
    }
    const SE3<S> rigid = end.rigid();
    const Mat<S, 3, 3> R = rigid.R.matrix();
    Eigen::Matrix<S, Eigen::Dynamic, 1> all(12);
    all << rigid.p, R.col(0), R.col(1), R.col(2);
    return all;
  }
};

TEST(SerialMotion, JacobianMatchesComplexStepAndDifferences) {
  std::mt19937 random(2);
  for (const SerialRobot& robot : robots()) {
    SerialWorkspace work(robot);
    for (const std::vector<Bend>& bends : shapes(robot, random)) {
      tip_motion(bends, work);
      const MatrixView J = work.jacobian();
      const Mat<double, 3, 3> R = work.ends.back().R.matrix();
      Eigen::VectorXd all(2 * bends.size());
      Eigen::MatrixXd rates(12, all.size());
      for (Eigen::Index j = 0; j < all.size(); ++j) {
        all[j] = bends[static_cast<std::size_t>(j / 2)][j % 2];
        const Vec3<double> turn = J.col(j).tail<3>();
        rates.col(j) << J.col(j).head<3>(), cross(turn, R.col(0)), cross(turn, R.col(1)),
            cross(turn, R.col(2));
      }
      EXPECT_LT(jacobian_error(rates, complex_step_jacobian(Tip{robot}, all)), 1e-12);
      EXPECT_LT(check_jacobian_real(Tip{robot}, all, rates, {.step = 1e-3}), 1e-7);
    }
  }
}

TEST(SerialMotion, SteeringTurnsTheAxisOfTheTipTheWayThatIsAsked) {
  std::mt19937 random(5);
  for (const SerialRobot& robot : robots()) {
    SerialWorkspace work(robot), moved(robot);
    for (const std::vector<Bend>& bends : shapes(robot, random)) {
      if (bends.back().norm() > 2.5) continue;  // towards half a turn it is lost
      tip_motion(bends, work);
      const auto steering = tip_steering(work);
      ASSERT_TRUE(steering);
      const Mat<double, 3, 3> R = work.ends.back().R.matrix();
      for (int side = 0; side < 2; ++side) {
        const double step = 1e-5;
        std::vector<Bend> ahead = bends, behind = bends;
        ahead.back() += step * steering->col(side);
        behind.back() -= step * steering->col(side);
        section_ends(ahead, moved);
        const Vec3<double> there = moved.ends.back().R.matrix().col(2);
        section_ends(behind, moved);
        const Vec3<double> rate = (there - moved.ends.back().R.matrix().col(2)) / (2 * step);
        EXPECT_LT((rate - R.col(side)).norm(), 1e-7) << bends.back().transpose();
      }
    }
  }
}

TEST(SerialMotion, NoSteeringWhereNoBendTurnsTheAxisToTheSide) {
  const SerialRobot robot = arcs(1);
  SerialWorkspace work(robot);
  tip_motion(std::vector<Bend>{Bend(std::numbers::pi, 0)}, work);
  EXPECT_FALSE(tip_steering(work));
  tip_motion(std::vector<Bend>{Bend(not_a_number, 0)}, work);
  EXPECT_FALSE(tip_steering(work));
}

TEST(SerialMotion, EndsAreTheSameWithAndWithoutDerivatives) {
  std::mt19937 random(3);
  for (const SerialRobot& robot : robots()) {
    SerialWorkspace with(robot), without(robot);
    for (const std::vector<Bend>& bends : shapes(robot, random)) {
      tip_motion(bends, with);
      section_ends(bends, without);
      for (std::size_t m = 0; m < bends.size(); ++m) {
        EXPECT_LT((with.ends[m].p - without.ends[m].p).norm(), 2e-15 * robot.length());
        EXPECT_LT((with.ends[m].R.v - without.ends[m].R.v).norm(), 2e-14);
      }
    }
  }
}

TEST(SerialMotion, RotationsStayUnitQuaternions) {
  const SerialRobot robot = nottingham(Backbone::twin_pivot, 12);
  SerialWorkspace work(robot);
  std::mt19937 random(4);
  for (int i = 0; i < 100; ++i) {
    section_ends(random_bends(robot, random), work);
    for (const SE3<double>& end : work.ends) EXPECT_NEAR(end.R.w * end.R.w + squared_norm(end.R.v), 1, 2e-14);
  }
}

TEST(SerialMotion, StraightRobotHasTheLengthOfItsParts) {
  const SerialRobot robot = nottingham();
  SerialWorkspace work(robot);
  section_ends(work.bends, work);
  EXPECT_NEAR(work.ends.back().p.z(), 0.175, 1e-16);  // 5·8·(2.375 + 2) mm
  EXPECT_EQ(work.ends.back().p.x(), 0);
  EXPECT_NEAR(robot.length(), 0.175, 1e-16);
}

}  // namespace serial_motion_test
}  // namespace sinew::test
