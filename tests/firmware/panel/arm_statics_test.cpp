/// The simulated arm's shape against truths that are not its own: closed forms, hole-to-hole distances,
/// differences of its energy.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "cpu_time.hpp"
#include "simulator/arm_statics.hpp"
#include "sinew/io/robot_file.hpp"

namespace sinew::firmware {
namespace arm_statics_test {

SerialRobot prototype() { return *load_serial("nottingham-tpcj"); }
/// Its first section alone, with a tendon along each axis: what one does, another does not.
SerialRobot one_section() {
  SerialRobot robot = prototype();
  robot.sections.resize(1);
  robot.sections[0].tendons = 4;
  robot.sections[0].tendon_angle = 0;
  return robot;
}
ArmMaterial smooth() {
  ArmMaterial material;
  material.friction = 0;
  return material;
}
/// Until friction has followed.
void settle(ArmStatics& arm) {
  for (int i = 0; i < 200 && arm.settle(); ++i) {
  }
}
double largest_bend(const ArmStatics& arm) {
  double largest = 0;
  for (const Bend& bend : arm.bends) largest = std::max(largest, bend.cwiseAbs().maxCoeff());
  return largest;
}

std::vector<Bend> some_bends(std::mt19937& random, double most) {
  std::vector<Bend> bends(5);
  for (Bend& bend : bends)
    for (double& angle : bend) angle = std::uniform_real_distribution<>(-most, most)(random);
  return bends;
}

/// What a tendon's way from hole to hole is longer than straight [m], joint by joint: two holes at r from the
/// ends of an arc of radius L/β, which look at one another under β. No series, nothing of the library but the
/// robot's numbers.
double way_by_holes(const SerialRobot& robot, std::span<const Bend> bends, std::size_t section,
                    double angle) {
  double way = 0;
  for (std::size_t m = 0; m <= section; ++m) {
    const Section& s = robot.sections[m];
    for (int axis = 0; axis < 2; ++axis) {
      const double beta = bends[m][axis],
                   side = s.tendon_radius * (axis == 0 ? std::cos(angle) : std::sin(angle));
      const double span = 2 * std::sin(beta / 2) * (s.joint / beta - side);
      way += s.segments / 2 * (span - s.joint);
    }
  }
  return way;
}

TEST(ArmStatics, StraightAtRest) {
  ArmStatics arm(prototype(), ArmMaterial{});
  for (Tendon& tendon : arm.tendons) tendon.paid_out = 1e-3;
  settle(arm);
  EXPECT_EQ(largest_bend(arm), 0.0);
  EXPECT_EQ(arm.energy(arm.bends), 0.0);
  // Tendons that pull alike keep it straight; bent by hand it comes back.
  for (Tendon& tendon : arm.tendons) tendon.paid_out = -0.05e-3;
  arm.bends[2] = Bend(0.2, -0.1);
  settle(arm);
  EXPECT_LT(largest_bend(arm), 1e-3);  // friction holds what it can
  EXPECT_NEAR(arm.tendons[14].tension, 0.05e-3 * arm.tendons[14].stiffness, 0.1);
  ArmStatics without(prototype(), smooth());
  for (Tendon& tendon : without.tendons) tendon.paid_out = -0.05e-3;
  without.bends[2] = Bend(0.2, -0.1);
  settle(without);
  EXPECT_LT(largest_bend(without), 1e-7);
}

/// One tendon on the x axis, taken in a little: B x = g T, T = k (u − g x).
TEST(ArmStatics, SmallPullIsThatOfTwoSprings) {
  const SerialRobot robot = one_section();
  ArmStatics arm(robot, smooth());
  for (Tendon& tendon : arm.tendons) tendon.paid_out = 1e-3;
  const double u = 1e-5, g = robot.sections[0].map().gain, b = arm.bending_stiffness(0);
  arm.tendons[0].paid_out = -u;
  settle(arm);
  const double k = arm.tendons[0].stiffness, x = k * g * u / (b + k * g * g);
  EXPECT_NEAR(arm.bends[0].x(), x, 1e-3 * x);
  EXPECT_NEAR(arm.bends[0].y(), 0, 1e-12);
  EXPECT_NEAR(arm.tendons[0].tension, b * x / g, 1e-3 * b * x / g);
}

/// A joint held by one tendon bends to its limit by the tension that the material names.
TEST(ArmStatics, LimitIsReachedByTheTensionOfTheMaterial) {
  const SerialRobot robot = one_section();
  ArmStatics arm(robot, smooth());
  for (Tendon& tendon : arm.tendons) tendon.paid_out = 20e-3;
  for (double u = 0; arm.bends[0].x() < robot.sections[0].limit; u += 2e-6) {
    arm.tendons[0].paid_out = -u;
    settle(arm);
  }
  EXPECT_NEAR(arm.tendons[0].tension, ArmMaterial{}.tension_at_limit, 0.1);
}

TEST(ArmStatics, WaysAreThoseFromHoleToHole) {
  const SerialRobot robot = prototype();
  ArmStatics arm(robot, smooth());
  std::mt19937 random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const std::vector<Bend> bends = some_bends(random, 0.42);
    const auto ways = arm.ways(bends);
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const double angle = robot.sections[i / 3].angle_of(static_cast<int>(i % 3));
      ASSERT_NEAR(ways[i], way_by_holes(robot, bends, i / 3, angle), 1e-14);
    }
  }
}

/// The stiffer the tendons, the nearer the bends of exact PCC; ten times as stiff, ten times as near.
TEST(ArmStatics, StiffTendonsMakeExactBends) {
  const SerialRobot robot = prototype();
  std::mt19937 random(2);
  const std::vector<Bend> wanted = some_bends(random, 0.35);
  double before = 0;
  for (const double stiffness : {3e4, 3e5, 3e6, 3e7}) {
    ArmMaterial material = smooth();
    material.stiffness = stiffness;
    ArmStatics arm(robot, material);
    for (const int part : {1, 2, 3, 4}) {
      std::vector<Bend> on_the_way = wanted;
      for (Bend& bend : on_the_way) bend *= part / 4.0;
      for (std::size_t i = 0; i < arm.tendons.size(); ++i)
        arm.tendons[i].paid_out =
            way_by_holes(robot, on_the_way, i / 3, robot.sections[i / 3].angle_of(static_cast<int>(i % 3)));
      settle(arm);
    }
    double error = 0;
    for (std::size_t m = 0; m < 5; ++m)
      error = std::max(error, (arm.bends[m] - wanted[m]).cwiseAbs().maxCoeff());
    std::printf("EA %.0e N: bends off by %.2e rad\n", stiffness, error);
    if (before > 0) {
      EXPECT_NEAR(before / error, 10, 2);
    }
    before = error;
  }
  EXPECT_LT(before, 5e-5);
}

TEST(ArmStatics, GradientIsThatOfTheEnergy) {
  ArmStatics arm(prototype(), ArmMaterial{});
  std::mt19937 random(3);
  const auto any = [&random](double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random);
  };
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Bend> bends = some_bends(random, trial < 40 ? 0.4 : 0.8);  // beyond: discs touch
    if (trial == 0) bends.assign(5, Bend::Zero());
    const std::vector<double> ways(arm.ways(bends).begin(), arm.ways(bends).end());
    for (std::size_t i = 0; i < arm.tendons.size(); ++i) {
      Tendon& tendon = arm.tendons[i];
      tendon.is_cut = any(0, 1) < 0.1;
      tendon.paid_out = ways[i] + any(-2e-4, 1e-4);
      tendon.rubs_from = ways[i] + any(-1e-4, 1e-4);
      tendon.friction = any(0, 1);
    }
    std::vector<double> gradient(10), none;
    arm.energy(bends, gradient);
    for (std::size_t k = 0; k < gradient.size(); ++k) {
      const double h = 1e-7;
      double& angle = bends[k / 2][static_cast<Eigen::Index>(k % 2)];
      const double at = angle;
      angle = at + h;
      const double ahead = arm.energy(bends);
      angle = at - h;
      const double behind = arm.energy(bends);
      angle = at;
      // Tendons that become taut or slide within the step: k (rate h)² / h at most.
      ASSERT_NEAR(gradient[k], (ahead - behind) / (2 * h), 2e-5) << trial << ' ' << k;
    }
  }
}

TEST(ArmStatics, RestIsAMinimum) {
  ArmStatics arm(prototype(), ArmMaterial{});
  std::mt19937 random(4);
  for (int trial = 0; trial < 20; ++trial) {
    for (Tendon& tendon : arm.tendons)
      tendon.paid_out = std::uniform_real_distribution<>(-4e-3, 4e-3)(random);
    settle(arm);
    const double least = arm.energy(arm.bends);
    std::vector<double> gradient(10);
    arm.energy(arm.bends, gradient);
    for (const double slope : gradient) ASSERT_LT(std::abs(slope), 1e-5) << trial;  // of up to 0.1 N m
    for (int i = 0; i < 50; ++i) {
      std::vector<Bend> near = some_bends(random, 1e-3);
      for (std::size_t m = 0; m < 5; ++m) near[m] += arm.bends[m];
      ASSERT_GE(arm.energy(near), least);
    }
  }
}

TEST(ArmStatics, CutTendonsLetTheirSectionGo) {
  ArmStatics one(one_section(), ArmMaterial{});
  for (Tendon& tendon : one.tendons) tendon.paid_out = 1e-2;
  one.tendons[1].paid_out = -2e-3;
  settle(one);
  EXPECT_GT(one.bends[0].y(), 0.15);
  one.tendons[1].is_cut = true;
  settle(one);
  EXPECT_LT(largest_bend(one), 1e-9);
  EXPECT_EQ(one.tendons[1].tension, 0);
  // Of five sections the last, which no other tendons pass; the others keep much of their shape.
  const SerialRobot robot = prototype();
  ArmStatics arm(robot, ArmMaterial{});
  const std::vector<Bend> bends(5, Bend(0.3, -0.2));
  for (std::size_t i = 0; i < 15; ++i)
    arm.tendons[i].paid_out =
        way_by_holes(robot, bends, i / 3, robot.sections[i / 3].angle_of(static_cast<int>(i % 3)));
  settle(arm);
  EXPECT_GT(arm.bends[4].norm(), 0.25);
  for (std::size_t i = 12; i < 15; ++i) arm.tendons[i].is_cut = true;
  settle(arm);
  EXPECT_LT(arm.bends[4].norm(), 1e-9);
  EXPECT_GT(arm.bends[0].norm(), 0.25);
}

/// Taken in, a tendon bears what the bend asks for over 1 − μ; paid out, over 1 + μ.
TEST(ArmStatics, FrictionMakesHysteresisOfItsSize) {
  for (const double friction : {0.0, 0.05, 0.2}) {
    const SerialRobot robot = one_section();
    ArmMaterial material;
    material.friction = friction;
    ArmStatics arm(robot, material);
    for (Tendon& tendon : arm.tendons) tendon.paid_out = 2e-2;
    const double g = robot.sections[0].map().gain, joint = robot.sections[0].joint;
    // Moment of a tendon on the axis by its way: its rate by the angle, from the holes.
    const auto load = [&](double x) {
      const double rate = robot.sections[0].segments / 2.0 *
                          (std::cos(x / 2) * (joint / x - robot.sections[0].tendon_radius) -
                           2 * std::sin(x / 2) * joint / (x * x));
      return -arm.bending_stiffness(0) * x / rate;
    };
    for (double u = 0; u <= 3e-3; u += 5e-6) {
      arm.tendons[0].paid_out = -u;
      settle(arm);
    }
    EXPECT_NEAR(arm.tendons[0].tension, load(arm.bends[0].x()) / (1 - friction), 1e-4);
    EXPECT_GT(arm.tendons[0].tension, 0.9 * arm.bending_stiffness(0) * arm.bends[0].x() / g);
    const double held = arm.bends[0].x();
    for (double u = 3e-3; u >= 2e-3; u -= 5e-6) {
      arm.tendons[0].paid_out = -u;
      settle(arm);
      if (friction > 0.1 && u > 2.99e-3) {
        EXPECT_NEAR(arm.bends[0].x(), held, 2e-3);  // it sticks at first
      }
    }
    EXPECT_NEAR(arm.tendons[0].tension, load(arm.bends[0].x()) / (1 + friction), 1e-4);
  }
}

TEST(ArmStatics, IsQuickerThanRealTime) {
  const SerialRobot robot = prototype();
  ArmStatics arm(robot, ArmMaterial{});
  const int steps = 2000;
  int iterations = 0, most = 0;
  const double start = test::cpu_seconds();
  for (int step = 0; step < steps; ++step) {
    std::vector<Bend> bends(5);
    for (std::size_t m = 0; m < 5; ++m) {
      const double phase = 0.003 * step * (1 + 0.3 * static_cast<double>(m));
      bends[m] = Bend(0.3 * std::sin(phase), 0.3 * std::sin(1.3 * phase));
    }
    const auto ways = arm.ways(bends);
    for (std::size_t i = 0; i < 15; ++i) arm.tendons[i].paid_out = ways[i] - 2e-5;
    arm.settle();
    iterations += arm.iterations();
    most = std::max(most, arm.iterations());
  }
  const double each = (test::cpu_seconds() - start) / steps;
  std::printf("a millisecond of moving takes %.1f us, %.1f iterations, %d at most\n", 1e6 * each,
              static_cast<double>(iterations) / steps, most);
  EXPECT_LT(each, 500e-6);
}

}  // namespace arm_statics_test
}  // namespace sinew::firmware
