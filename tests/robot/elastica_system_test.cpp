/// Rods between a base and a platform as one system: each rod against the exact elastica, forces against
/// their slopes, lanes against each other. Whole robots: tests/kinematics/rod_*_test.cpp.
#include "robot/rods/elastica_system.hpp"

#include <gtest/gtest.h>

#include "check_jacobian.hpp"
#include "rod_robots.hpp"

namespace sinew::test {
namespace elastica_system_test {

/// Calls `use(robot, system)` with random robots of these numbers of rods, laid at random poses.
template <class Use>
void each_robot(std::initializer_list<int> sizes, unsigned seed, Use&& use) {
  RodRandom random(seed);
  for (const int rods : sizes)
    for (int trial = 0; trial < 4; ++trial) {
      SCOPED_TRACE(testing::Message() << rods << " rods, trial " << trial);
      const RodRobot robot = random.robot(rods, trial % 2 == 0 ? 0 : 0.25);
      ElasticaSystem system(robot);
      ASSERT_TRUE(lay(system, random.near(home(robot), 0.02, 0.12), random));
      use(robot, system);
    }
}

TEST(ElasticaSystem, EachRodIsAnElastica) {  // @verifies 3PFS (24)
  each_robot({3, 6, 8, 9, 12}, 1, [](const RodRobot& robot, ElasticaSystem& system) {
    system.refine();
    ASSERT_TRUE(close_rods(system));
    ASSERT_TRUE(balance(system));
    EXPECT_LT(system.evaluate(), 1e-12);
    EXPECT_LT(off_elastica(robot, system), 2e-12);
    for (int k = 0; k < system.limbs(); ++k) {
      const RodLeg& leg = robot.legs[std::size_t(k)];
      const RodResult rod = system.rod(k);
      EXPECT_LT((rod.tip - system.platform().point(leg.platform_point)).norm(), 1e-15);
      EXPECT_NEAR(rod.chord, (rod.tip - leg.base.p).norm(), 1e-15);
      EXPECT_LT((rod.moment_0 - cross(rod.tip - leg.base.p, rod.force)).norm(), 1e-14);
      EXPECT_LT((rod.moment_0 - leg.link.bending_stiffness() * rod.curvature_0).norm(), 1e-15);
    }
  });
}

TEST(ElasticaSystem, LargestCurvatureIsThatOfTheExactShape) {
  std::vector<double> s(401);
  for (std::size_t i = 0; i < s.size(); ++i) s[i] = double(i) / double(s.size() - 1);
  std::vector<ElasticaSection> sections(s.size());
  each_robot({6}, 2, [&](const RodRobot& robot, ElasticaSystem& system) {
    for (int k = 0; k < system.limbs(); ++k) {
      const RodResult rod = system.rod(k);
      elastica_sections(local_force(planar_state(rod, robot.legs[std::size_t(k)])), s, sections);
      std::size_t best = 0;
      for (std::size_t i = 0; i < s.size(); ++i)
        if (std::abs(sections[i].curvature) > std::abs(sections[best].curvature)) best = i;
      double largest = std::abs(sections[best].curvature);
      if (best > 0) {  // the top of the parabola through it and its neighbours
        const double left = std::abs(sections[best - 1].curvature),
                     right = std::abs(sections[best + 1].curvature);
        largest += (right - left) * (right - left) / (8 * (2 * largest - left - right));
      }
      largest /= rod.length;
      EXPECT_NEAR(rod.largest_curvature, largest, 1e-9 * largest);
    }
  });
}

TEST(ElasticaSystem, CentrelineRunsAlongTheElastica) {
  constexpr int samples = 41;
  std::vector<double> s(samples);
  for (std::size_t i = 0; i < s.size(); ++i) s[i] = double(i) / (samples - 1);
  std::vector<ElasticaSection> sections(samples);
  each_robot({3}, 3, [&](const RodRobot& robot, ElasticaSystem& system) {
    system.refine();
    ASSERT_TRUE(close_rods(system));
    for (int k = 0; k < system.limbs(); ++k) {
      const RodLeg& leg = robot.legs[std::size_t(k)];
      const RodResult rod = system.rod(k);
      elastica_sections(local_force(planar_state(rod, leg)), s, sections);
      const Vec3<double> aside =
          rod.tip - leg.base.p - leg.tangent() * dot(leg.tangent(), rod.tip - leg.base.p);
      const std::vector<Vec3<double>> line = system.centreline(k, samples);
      ASSERT_EQ(line.size(), s.size());
      for (std::size_t i = 0; i < line.size(); ++i) {
        const Vec3<double> exact = leg.base.p + rod.length * (aside / aside.norm() * sections[i].position[0] +
                                                              leg.tangent() * sections[i].position[1]);
        EXPECT_LT((line[i] - exact).norm(), 1e-10);
      }
      EXPECT_LT((line.back() - rod.tip).norm(), 1e-10);
    }
  });
}

TEST(ElasticaSystem, StiffnessIsTheSlopeOfTheForces) {  // rods found anew at every displaced pose
  each_robot({3, 6, 9}, 4, [](const RodRobot&, ElasticaSystem& system) {
    const LimbState at = system.state();
    const Eigen::MatrixXd stiffness = system.stiffness();
    const auto forces = [&](const Vec<double, 6>& x) {
      return Eigen::VectorXd(wrench_beside(system, at, x));
    };
    const Vec<double, 6> zero = Vec<double, 6>::Zero();
    EXPECT_LT(check_jacobian_real(forces, zero, stiffness, {.step = 1e-5}), 1e-7);
  });
}

TEST(ElasticaSystem, FeedWrenchIsTheSlopeByAnInput) {
  RodRandom random(5);
  const auto check = [](ElasticaSystem& system) {
    const LimbState at = system.state();
    Eigen::MatrixXd feed(6, system.inputs());
    for (int input = 0; input < system.inputs(); ++input)
      feed.col(input) = system.input_wrench_jacobian(input);
    const auto forces = [&](const Eigen::VectorXd& x) {
      return Eigen::VectorXd(
          wrench_beside(system, at, Vec<double, 6>::Zero(), {x.data(), std::size_t(x.size())}));
    };
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(system.inputs());
    EXPECT_LT(check_jacobian_real(forces, zero, feed, {.step = 1e-5}), 1e-7);
  };
  each_robot({3, 9}, 5, [&](const RodRobot&, ElasticaSystem& system) { check(system); });
  const RodRobot tied = tripod_robot(g2);
  ElasticaSystem system(tied);
  ASSERT_EQ(system.inputs(), 3);
  ASSERT_TRUE(lay(system, random.near(home(tied), 0.01, 0.1), random));
  check(system);
}

TEST(ElasticaSystem, EnergyFallsByWhatTheForcesDo) {
  each_robot({6, 12}, 6, [](const RodRobot& robot, ElasticaSystem& system) {
    system.refine();
    ASSERT_TRUE(close_rods(system) && balance(system));
    const LimbState at = system.state();
    const Wrench6 wrench = system.wrench();
    Eigen::RowVectorXd by_length(system.limbs());
    for (int k = 0; k < system.limbs(); ++k) {
      const RodResult rod = system.rod(k);
      // −½EIκ² − n·t, the same all along the rod
      by_length[k] = -(rod.energy + dot(rod.force, rod.tip - robot.legs[std::size_t(k)].base.p)) / rod.length;
    }
    const auto energy = [&](const Vec<double, 6>& x, std::span<const double> fed) {
      wrench_beside(system, at, x, fed);
      Eigen::VectorXd sum = Eigen::VectorXd::Zero(1);
      for (int k = 0; k < system.limbs(); ++k) sum[0] += system.rod(k).energy;
      return sum;
    };
    const Vec<double, 6> still = Vec<double, 6>::Zero();
    const auto by_pose = [&](const Vec<double, 6>& x) { return energy(x, {}); };
    EXPECT_LT(check_jacobian_real(by_pose, still, wrench.transpose(), {.step = 1e-5}), 1e-8);
    const auto by_feed = [&](const Eigen::VectorXd& x) {
      return energy(still, {x.data(), std::size_t(x.size())});
    };
    const Eigen::VectorXd unfed = Eigen::VectorXd::Zero(system.inputs());
    EXPECT_LT(check_jacobian_real(by_feed, unfed, by_length, {.step = 1e-5}), 1e-8);
  });
}

TEST(ElasticaSystem, NewtonsStepIsQuadratic) {  // pose, forces and shapes in one step
  RodRandom random(7);
  each_robot({6, 9}, 7, [&](const RodRobot&, ElasticaSystem& system) {
    const SE3<double> found = system.platform();
    system.set_platform(random.near(found, 3e-4, 2e-3));
    double before = system.evaluate();
    for (int k = 0; k < 6 && before > 1e-6; ++k) {
      ASSERT_TRUE(system.linearise());
      system.move(system.step(true));
      before = system.evaluate();
    }
    ASSERT_TRUE(system.linearise());
    system.move(system.step(true));
    EXPECT_LT(system.evaluate(), 1e-12 + 1e4 * before * before);
    EXPECT_LT((system.platform().p - found.p).norm(), 1e-11);
  });
}

TEST(ElasticaSystem, EvaluatesTheSameFromWhatAStepLeft) {
  RodRandom random(8);
  each_robot({3, 9}, 8, [&](const RodRobot&, ElasticaSystem& system) {
    for (const bool is_fine : {false, true}) {
      if (is_fine) system.refine();
      system.set_platform(random.near(system.platform(), 2e-4, 1e-3));
      system.evaluate();
      ASSERT_TRUE(system.linearise());
      for (int k = 0; k < 4; ++k) {
        system.move(system.step(k == 0));
        const double carried = system.evaluate(false);
        const Wrench6 missing = system.wrench_residual();
        const double anew = system.evaluate(true);
        EXPECT_NEAR(carried, anew, 2e-12);
        EXPECT_LT((system.wrench_residual() - missing).norm(), 1e-12);
        system.evaluate(false);  // what the next step begins from
      }
    }
  });
}

/// Steps beyond the 0.07 rad up to which sines are turned, more of them than are carried on, and lengths and
/// load that change between.
TEST(ElasticaSystem, CarriesOnWhatLengthsLoadAndManyStepsChange) {
  RodRandom random(12);
  each_robot({3, 9}, 12, [&](const RodRobot& robot, ElasticaSystem& system) {
    for (const bool is_fine : {false, true}) {
      if (is_fine) system.refine();
      system.evaluate();
      ASSERT_TRUE(system.linearise());
      const LimbState start = system.state();
      for (int k = 0; k < 150; ++k) {
        const double size = k % 7 == 0 ? 0.1 : 1e-3;
        if (k % 2 == 0) {
          system.set_wrench(random.wrench(1, 0.1));
          for (int rod = 0; rod < system.limbs(); ++rod)
            system.set_feed(rod, system.length(rod) * (1 + 1e-4 * (rod % 3 - 1)));
        }
        ElasticaSystem::Twist twist = random.wrench(size * system.length(0), size);
        system.evaluate(false);
        system.step(false);
        system.move(twist);
        ElasticaSystem other(robot);
        other.restore(system.state());
        const double carried = system.evaluate(false), anew = other.evaluate(true);
        EXPECT_NEAR(carried, anew, 1e-11 * (1 + anew)) << k;
        EXPECT_LT((system.wrench_residual() - other.wrench_residual()).norm(),
                  1e-10 * (1 + other.wrench_residual().norm()))
            << k;
        if (k % 10 == 9) {  // back to where rods are not far from their equilibrium
          system.restore(start);
          system.evaluate();
          ASSERT_TRUE(system.linearise());
        }
      }
    }
  });
}

TEST(ElasticaSystem, NoNumberThatIsNotOneIsEverSmall) {
  const double nan = std::nan("");
  each_robot({3, 9}, 9, [&](const RodRobot&, ElasticaSystem& system) {
    for (const bool is_fine : {false, true}) {
      if (is_fine) system.refine();
      ASSERT_TRUE(close_rods(system));
      ASSERT_TRUE(balance(system));
      const LimbState good = system.state();
      const Wrench6 load = system.wrench();
      const auto spoilt = [&](auto&& spoil) {
        system.restore(good);
        spoil();
        return std::isnan(system.evaluate());
      };
      for (int k = 0; k < system.limbs(); ++k) {
        EXPECT_TRUE(spoilt([&] { system.set_feed(k, nan); })) << k;
        for (const std::size_t part : {0u, 4u, 10u, 11u, 12u}) {
          const auto spoil = [&] {
            CoarseRods lanes;
            system.copy_rod(k, lanes, 0);
            RodLane* parts[] = {&lanes.theta[part % 10], &lanes.force_d, &lanes.force_w};
            (*parts[part < 10 ? 0 : (part == 10 ? 1 : 2)])[0] = nan;
            system.take_rod(k, lanes, 0);
          };
          const auto spoil_fine = [&] {
            std::array<double, RodLeg::coordinates> x;
            system.get_rod(k, x);
            x[part < 10 ? part : fine_nodes + (part == 10 ? 0 : 1)] = nan;
            system.set_rod(k, x, system.aim(k).lateral);
          };
          EXPECT_TRUE(is_fine ? spoilt(spoil_fine) : spoilt(spoil)) << k << " part " << part;
        }
      }
      const SE3<double> there = system.platform();
      SE3<double> pose = there;
      pose.p[1] = nan;
      EXPECT_TRUE(spoilt([&] { system.set_platform(pose); }));
      pose = there;
      pose.R.v[2] = nan;
      EXPECT_TRUE(spoilt([&] { system.set_platform(pose); }));
      for (int c = 0; c < 6; ++c) {
        Wrench6 wrench = load;
        wrench[c] = nan;
        EXPECT_TRUE(spoilt([&] { system.set_wrench(wrench); }));
      }
      EXPECT_FALSE(spoilt([] {}));
      EXPECT_LT(system.evaluate(), 1e-12);
    }
  });
}

TEST(ElasticaSystem, SavesAndRestoresExactly) {
  RodRandom random(10);
  each_robot({9}, 10, [&](const RodRobot&, ElasticaSystem& system) {
    for (const bool is_fine : {false, true}) {
      if (is_fine) system.refine();
      const LimbState saved = system.state();
      const double error = system.evaluate();
      const RodResult rod = system.rod(4);
      system.linearise();
      const Eigen::MatrixXd stiffness = system.stiffness();
      system.set_platform(random.near(system.platform(), 1e-3, 1e-2));
      system.set_wrench(random.wrench(3, 1));
      close_rods(system);
      if (!is_fine) system.refine();
      system.restore(saved);
      EXPECT_EQ(system.is_fine(), is_fine);
      EXPECT_EQ(system.evaluate(), error);
      EXPECT_EQ(system.rod(4).force, rod.force);
      EXPECT_EQ(system.rod(4).energy, rod.energy);
      system.linearise();
      EXPECT_EQ(Eigen::MatrixXd(system.stiffness()), stiffness);
    }
  });
}

TEST(ElasticaSystem, RefinesAndCoarsensTheSameShapes) {
  each_robot({6, 9}, 11, [](const RodRobot&, ElasticaSystem& system) {
    const auto points = [&] { return system.centreline(system.limbs() - 1, 21); };
    const auto before = points();
    const RodResult rod = system.rod(0);
    system.refine();
    ASSERT_TRUE(system.is_fine());
    EXPECT_GT(system.evaluate(),
              1e-12);  // the same polynomial, whose equation is met in the coarse sense only
    const auto refined = points();
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LT((refined[i] - before[i]).norm(), 1e-14);
    EXPECT_NEAR(system.rod(0).tip_angle, rod.tip_angle, 1e-13);
    system.coarsen();
    EXPECT_LT(system.evaluate(), 1e-12);  // and back exactly, as the coarse polynomials are among the fine
    const auto coarsened = points();
    for (std::size_t i = 0; i < before.size(); ++i) EXPECT_LT((coarsened[i] - before[i]).norm(), 1e-14);
  });
}

TEST(ElasticaSystem, HandsOutRodsAsCoordinatesAndTakesThemBack) {
  each_robot({9}, 12, [](const RodRobot& robot, ElasticaSystem& system) {
    const LimbState at = system.state();
    for (const bool is_fine : {false, true}) {
      system.restore(at);
      if (is_fine) system.refine();
      ASSERT_TRUE(close_rods(system));
      ASSERT_TRUE(balance(system));
      ElasticaSystem other(robot);
      other.set_platform(system.platform());
      other.set_wrench(system.wrench());
      for (int k = 0; k < system.limbs(); ++k) {
        std::array<double, RodLeg::coordinates> x;
        system.get_rod(k, x);
        EXPECT_EQ(x[rod_nodes + 2], system.length(k));
        other.set_rod(k, x, system.aim(k).lateral);
      }
      EXPECT_LT(other.evaluate(), is_fine ? 1e-12 : 1e-4);
      for (int k = 0; k < system.limbs(); ++k)
        EXPECT_LT((other.rod(k).force - system.rod(k).force).norm(), 1e-13);
    }
  });
}

TEST(ElasticaSystem, RodsDoNotMindTheirLanes) {  // idle lanes, several groups: the same rods in another order
  RodRandom random(13);
  for (const int rods : {1, 3, 6, 8, 9, 12, 17, 24}) {
    SCOPED_TRACE(rods);
    const RodRobot robot = random.robot(rods, 0.2);
    RodRobot turned = robot;
    std::reverse(turned.legs.begin(), turned.legs.end());
    ElasticaSystem a(robot), b(turned);
    const SE3<double> pose = random.near(home(robot), 0.02, 0.1);
    if (rods > 1) {
      ASSERT_TRUE(a.rest_at(pose) && b.rest_at(pose));
    } else {
      a.rest_at(pose);  // one rod does not hold a platform
      b.rest_at(pose);
    }
    for (int k = 0; k < rods; ++k) {
      const double fed = random.uniform(0, 1e-3);
      a.set_feed(k, a.length(k) + fed);
      b.set_feed(rods - 1 - k, b.length(rods - 1 - k) + fed);
    }
    ASSERT_TRUE(close_rods(a) && close_rods(b));
    balance(a);
    balance(b);
    for (int k = 0; k < rods; ++k) {
      const RodResult one = a.rod(k), same = b.rod(rods - 1 - k);
      EXPECT_LT((one.force - same.force).norm(), 1e-12 * (1 + one.force.norm()));
      EXPECT_NEAR(one.energy, same.energy, 1e-13);
      EXPECT_LT((a.input_wrench_jacobian(k) - b.input_wrench_jacobian(rods - 1 - k)).norm(),
                1e-10 * a.input_wrench_jacobian(k).norm());
    }
    EXPECT_LT((a.wrench() - b.wrench()).norm(), 1e-12 * (1 + a.wrench().norm()));
    EXPECT_LT((a.stiffness() - b.stiffness()).norm(), 1e-11 * a.stiffness().norm());
  }
}

TEST(ElasticaSystem, PutsTheSumOfItsRodsOnThePlatform) {
  each_robot({3, 8, 9, 24}, 14, [](const RodRobot& robot, ElasticaSystem& system) {
    Wrench6 sum = Wrench6::Zero();
    for (int k = 0; k < system.limbs(); ++k) {
      const Vec3<double> force = system.rod(k).force;
      const Vec3<double> arm = system.platform().rotate(robot.legs[std::size_t(k)].platform_point);
      sum.head<3>() += force;
      sum.tail<3>() += cross(arm, force);
    }
    EXPECT_LT((system.wrench() - sum).norm(), 1e-13 * (1 + sum.norm()));
  });
}

}  // namespace elastica_system_test
}  // namespace sinew::test
