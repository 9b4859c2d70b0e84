#include "sinew/kinematics/trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/serial.hpp"

namespace sinew {
namespace trajectory_test {

using Random = std::mt19937_64;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

std::vector<SerialPosture> walk(const SerialRobot& robot, int count, double bend, Random& random) {
  std::vector<SerialPosture> postures(static_cast<std::size_t>(count));
  double stage = 0;
  for (SerialPosture& posture : postures) {
    posture.stage = stage += uniform(random, 0, 2e-3);
    for (std::size_t m = 0; m < robot.sections.size(); ++m)
      posture.bends.push_back({uniform(random, -bend, bend), uniform(random, -bend, bend)});
  }
  return postures;
}

/// Stage, bends, exact changes of the tendons.
std::vector<double> coordinates(const TrajectoryPoint& point, SerialWorkspace& work) {
  std::vector<double> q{point.posture.stage};
  for (const Bend& bend : point.posture.bends) q.insert(q.end(), {bend[0], bend[1]});
  tendon_changes(point.posture.bends, kernel::Model::exact, work);
  q.insert(q.end(), work.changes.begin(), work.changes.end());
  return q;
}

struct Greatest {
  double speed = 0, acceleration = 0;  ///< as shares of their limits
};

/// By differences of evenly spaced points, which know nothing of how they were made.
Greatest greatest(const SerialRobot& robot, const Trajectory& trajectory, const TrajectoryLimits& limits,
                  double period) {
  SerialWorkspace work(robot);
  Greatest found;
  std::vector<double> before, here, after;
  const std::size_t bends = 2 * robot.sections.size();
  for (std::size_t k = 2; k + 1 < trajectory.points.size(); ++k) {
    before = coordinates(trajectory.points[k - 2], work);
    here = coordinates(trajectory.points[k - 1], work);
    after = coordinates(trajectory.points[k], work);
    for (std::size_t c = 0; c < here.size(); ++c) {
      const double speed = c == 0 ? limits.stage_speed : c <= bends ? limits.bend_speed : limits.tendon_speed;
      const double acceleration = c == 0       ? limits.stage_acceleration
                                  : c <= bends ? limits.bend_acceleration
                                               : limits.tendon_acceleration;
      found.speed = std::max(found.speed, std::abs(after[c] - before[c]) / (2 * period) / speed);
      found.acceleration = std::max(found.acceleration, std::abs(after[c] - 2 * here[c] + before[c]) /
                                                            (period * period) / acceleration);
    }
  }
  return found;
}

TEST(Trajectory, KeepsAllLimitsAndReachesThem) {
  for (const char* name : {"nottingham-tpcj", "nottingham-neutral"}) {
    const auto robot = load_serial(name);
    ASSERT_TRUE(robot) << name;
    Random random(1);
    for (int trial = 0; trial < 6; ++trial) {
      const auto postures = walk(*robot, 2 + 3 * trial, trial % 2 ? 0.2 : 0.02, random);
      TrajectoryLimits limits;
      if (trial % 3 == 1) limits.tendon_speed = limits.tendon_acceleration = 1;
      if (trial % 3 == 2) limits.bend_speed = 1e3, limits.stage_speed = 1;
      const double period = 2e-3;
      const Trajectory made = time_optimal_trajectory(*robot, postures, limits, period);
      ASSERT_TRUE(made.report.ok());
      const Greatest found = greatest(*robot, made, limits, period);
      EXPECT_LT(found.speed, 1.003) << name << trial;
      EXPECT_LT(found.acceleration, 1.02) << name << trial;
      EXPECT_GT(std::max(found.speed, found.acceleration), 0.97) << name << trial;
    }
  }
}

/// Many postures and hard turns, where a piece of the curve is divided least.
TEST(Trajectory, KeepsAllLimitsAlongManyPostures) {
  const SerialRobot robot = load_serial("nottingham-tpcj").value();
  Random random(7);
  for (const double bend : {0.3, 0.05}) {
    const auto postures = walk(robot, 150, bend, random);
    const TrajectoryLimits limits;
    const double period = 2e-3;
    const Trajectory made = time_optimal_trajectory(robot, postures, limits, period);
    ASSERT_TRUE(made.report.ok());
    const Greatest found = greatest(robot, made, limits, period);
    EXPECT_LT(found.speed, 1.01);
    EXPECT_LT(found.acceleration, 1.03);
    EXPECT_GT(std::max(found.speed, found.acceleration), 0.97);
    // what it says it reaches is what it reaches
    EXPECT_LT(made.greatest.tendon_speed, limits.tendon_speed * 1.01);
    EXPECT_GT(made.greatest.tendon_speed, 0.9 * std::min(1.0, found.speed) * limits.tendon_speed);
  }
}

/// Two bends of one size whose directions differ: the way between their coordinates leaves the disc.
TEST(Trajectory, OfNeutralBackbonesStaysWithinTheirDiscs) {
  SerialRobot robot = load_serial("nottingham-neutral").value();
  Random random(9);
  int refused = 0;
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<SerialPosture> postures(5);
    for (std::size_t k = 0; k < postures.size(); ++k) {
      postures[k].stage = 1e-3 * static_cast<double>(k);
      for (const Section& section : robot.sections) {
        const double phi = uniform(random, 0, 1.2), theta = section.limit * (1 - 1e-9);
        postures[k].bends.push_back({theta * std::cos(phi), theta * std::sin(phi)});
      }
    }
    const Trajectory made = time_optimal_trajectory(robot, postures, {}, 5e-3);
    refused += made.report.status == Status::left_domain;
    for (const TrajectoryPoint& point : made.points)
      EXPECT_TRUE(check_limits(robot, point.posture.bends).ok());
  }
  EXPECT_GT(refused, 0);
}

/// One coordinate, one straight move: speeds are a trapezium, whose time is known.
TEST(Trajectory, OfOneMoveTakesTheTimeOfATrapezium) {
  SerialRobot robot = load_serial("nottingham-tpcj").value();
  std::vector<SerialPosture> postures;
  for (int k = 0; k <= 200; ++k) postures.push_back({k * 0.5e-3, std::vector<Bend>(5, Bend(0, 0))});
  TrajectoryLimits limits;
  limits.stage_speed = 20e-3;
  limits.stage_acceleration = 50e-3;
  const Trajectory made = time_optimal_trajectory(robot, postures, limits, 1e-2);
  ASSERT_TRUE(made.report.ok());
  const double trapezium = 0.1 / 20e-3 + 20e-3 / 50e-3;
  EXPECT_NEAR(made.duration, trapezium, 0.02 * trapezium);
  EXPECT_GE(made.duration, trapezium * (1 - 1e-3));  // smooth curves begin more softly
}

TEST(Trajectory, DerivativesAreThoseOfItsPoints) {
  const SerialRobot robot = load_serial("nottingham-tpcj").value();
  Random random(3);
  const auto postures = walk(robot, 9, 0.1, random);
  const double period = 1e-3;
  const Trajectory made = time_optimal_trajectory(robot, postures, {}, period);
  ASSERT_TRUE(made.report.ok());
  int compared = 0;
  for (std::size_t k = 1; k + 2 < made.points.size(); ++k) {
    const TrajectoryPoint &a = made.points[k - 1], &b = made.points[k], &c = made.points[k + 1];
    EXPECT_NEAR((c.posture.stage - a.posture.stage) / (2 * period), b.stage_speed, 2e-5);
    for (std::size_t m = 0; m < 5; ++m) {
      EXPECT_NEAR((c.posture.bends[m] - a.posture.bends[m]).norm() / (2 * period), b.bend_speeds[m].norm(),
                  3e-3);
      // accelerations jump where a limit takes over
      compared +=
          ((c.bend_speeds[m] - a.bend_speeds[m]) / (2 * period) - b.bend_accelerations[m]).norm() < 0.05;
    }
  }
  EXPECT_GT(compared, 0.9 * 5 * static_cast<double>(made.points.size()));
}

/// On the way no coordinate leaves the interval of the postures around; so no limit of a bend is passed that
/// none of them passes.
TEST(Trajectory, PassesThePosturesInOrder) {
  const SerialRobot robot = load_serial("nottingham-tpcj").value();
  Random random(5);
  const auto postures = walk(robot, 12, 0.15, random);
  const Trajectory made = time_optimal_trajectory(robot, postures, {}, 1e-3);
  ASSERT_TRUE(made.report.ok());
  std::size_t piece = 0;
  for (const TrajectoryPoint& point : made.points) {
    while (piece + 2 < postures.size() && point.posture.stage > postures[piece + 1].stage) ++piece;
    for (std::size_t m = 0; m < 5; ++m)
      for (int c = 0; c < 2; ++c) {
        const double a = postures[piece].bends[m][c], b = postures[piece + 1].bends[m][c];
        EXPECT_GE(point.posture.bends[m][c], std::min(a, b) - 1e-9);
        EXPECT_LE(point.posture.bends[m][c], std::max(a, b) + 1e-9);
      }
  }
  EXPECT_EQ(made.points.front().posture.stage, postures.front().stage);
  EXPECT_EQ(made.points.back().posture.stage, postures.back().stage);
  EXPECT_EQ(made.points.back().time, made.duration);
}

TEST(Trajectory, TurnsRoundWherePosturesDo) {
  const SerialRobot robot = load_serial("nottingham-tpcj").value();
  const std::vector<Bend> straight(5, Bend(0, 0)), bent(5, Bend(0.1, 0));
  const std::vector<SerialPosture> there_and_back{{0, straight}, {5e-3, bent}, {0, straight}, {0, straight}};
  const Trajectory made = time_optimal_trajectory(robot, there_and_back, {}, 1e-3);
  ASSERT_TRUE(made.report.ok());
  EXPECT_GT(made.duration, 2.0);
  EXPECT_LT(made.duration, 10.0);
  double furthest = 0;
  for (const TrajectoryPoint& point : made.points) furthest = std::max(furthest, point.posture.stage);
  EXPECT_NEAR(furthest, 5e-3, 1e-6);
}

TEST(Trajectory, OfOnePostureIsARest) {
  const SerialRobot robot = load_serial("nottingham-tpcj").value();
  const std::vector<SerialPosture> one{{1e-3, std::vector<Bend>(5, Bend(0.1, 0))}};
  const Trajectory made = time_optimal_trajectory(robot, one, {}, 1e-3);
  EXPECT_TRUE(made.report.ok());
  EXPECT_EQ(made.points.size(), 1U);
  EXPECT_EQ(made.duration, 0);
}

TEST(Trajectory, RefusesWhatNoRobotDoes) {
  const SerialRobot robot = load_serial("nottingham-tpcj").value();
  const std::vector<Bend> straight(5, Bend(0, 0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto ask = [&](std::vector<SerialPosture> postures, TrajectoryLimits limits = {},
                       double period = 1e-3) {
    return time_optimal_trajectory(robot, postures, limits, period).report.status;
  };
  EXPECT_EQ(ask({}), Status::bad_input);
  EXPECT_EQ(ask({{0, {}}}), Status::bad_input);
  EXPECT_EQ(ask({{nan, straight}}), Status::bad_input);
  EXPECT_EQ(ask({{0, straight}, {1, std::vector<Bend>(5, Bend(nan, 0))}}), Status::bad_input);
  EXPECT_EQ(ask({{0, straight}, {1, std::vector<Bend>(5, Bend(2, 0))}}), Status::left_domain);
  EXPECT_EQ(ask({{0, straight}}, {.stage_speed = 0}), Status::bad_input);
  EXPECT_EQ(ask({{0, straight}}, {.tendon_acceleration = nan}), Status::bad_input);
  EXPECT_EQ(ask({{0, straight}}, {}, -1), Status::bad_input);
  EXPECT_EQ(ask({{0, straight}, {1e9, straight}}, {}, 1e-9), Status::bad_input);  // points without end
}

}  // namespace trajectory_test
}  // namespace sinew
