/// Following an equilibrium of rods: where it begins, where it goes, where it ends.
#include "kinematics/load_problem.hpp"
#include "kinematics/rods/trace.hpp"

#include <gtest/gtest.h>

#include "rod_robots.hpp"

namespace sinew::test {
namespace rod_path_test {

/// A tripod at rest at home, linearised, and memory.
struct Path {
  explicit Path(const RodRobot& robot) : system(robot), spare(system.state()) {}
  explicit Path(const RodTripod& t) : Path(tripod_robot(t)) { EXPECT_TRUE(system.rest_at(level(t.height))); }

  RodPathEnd to(const RodTarget& target, const RodPathOptions& options = {}) {
    return follow(system, target, options, spare);
  }
  RodPathEnd to(const std::array<double, 3>& lengths, const Wrench6& wrench,
                const RodPathOptions& options = {}) {
    RodTarget target = present(system);
    for (std::size_t k = 0; k < 6; ++k) target.lengths[k] = lengths[k / 2];
    target.wrench = wrench;
    return to(target, options);
  }

  ElasticaSystem system;
  LimbState spare;
};

TEST(RodRest, NothingPushesAlongTheGuides) {
  RodRandom random(1);
  for (const int rods : {3, 8, 9, 12})
    for (int trial = 0; trial < 20; ++trial) {
      const RodRobot robot = random.robot(rods, 0.3);
      ElasticaSystem system(robot);
      ASSERT_TRUE(system.rest_at(random.near(home(robot), 0.05, 0.3)));
      EXPECT_LT(system.evaluate(), 1e-12);
      double worst = 0;
      for (int k = 0; k < rods; ++k) worsen(worst, std::abs(system.rod(k).axial_force));
      EXPECT_EQ(worst, 0);
      if (system.truncation() < 1e-13) {
        EXPECT_LT(off_elastica(robot, system), 1e-11);
      }
    }
}

TEST(RodRest, ReachesTheReferenceHomes) {  // lengths found by another implementation
  for (const RodTripod& t : {g1, g2}) {
    Path path(t);
    EXPECT_LT(path.system.evaluate(), 1e-12);
    path.system.refine();
    EXPECT_TRUE(close_rods(path.system));
    for (int k = 0; k < 6; ++k) EXPECT_NEAR(path.system.length(k), t.length, 1e-9);
    EXPECT_LT(path.system.wrench().norm(), 1e-8);  // they balance among themselves
  }
}

TEST(RodRest, IsHonestWhereARodHasNoPlaneOrNoWayForward) {
  const judge::Tripod t = g2.data();
  const auto rests = [&](const judge::Tripod& robot, const SE3<double>& pose) {
    ElasticaSystem system(tripod_robot(robot, pose));
    return system.rest_at(pose);
  };
  EXPECT_TRUE(rests(t, level(0.4)));
  judge::Tripod above = t;
  above.platform[3] = above.base[3];  // its tip straight above its guide
  EXPECT_FALSE(rests(above, level(0.4)));
  above.platform[3][0] += 1e-11;
  EXPECT_FALSE(rests(above, level(0.4)));
  EXPECT_FALSE(rests(t, level(-0.1)));  // a platform below its base
  EXPECT_FALSE(rests(t, level(0)));
  SE3<double> pose = level(0.4);
  pose.p[0] = std::nan("");
  EXPECT_FALSE(rests(t, pose));
  pose = level(0.4);
  pose.R.w = std::nan("");
  EXPECT_FALSE(rests(t, pose));
}

TEST(RodRest, BendsAsFarAsTheTipLies) {  // from nearly straight to nearly across
  for (const double height : {2.0, 0.5, 0.2, 0.1, 0.05}) {
    const judge::Tripod t = g2.data();
    const RodRobot robot = tripod_robot(t, level(height));
    ElasticaSystem system(robot);
    ASSERT_TRUE(system.rest_at(level(height))) << height;
    EXPECT_LT(system.evaluate(), 1e-12) << height;
    system.refine();
    ASSERT_TRUE(close_rods(system)) << height;
    EXPECT_LT(off_elastica(robot, system), 1e-10) << height;
  }
}

TEST(RodPath, ArrivesOnTheSameBranchByAnyNumberOfPieces) {
  RodRandom random(2);
  for (const RodTripod& t : {g1, g2})
    for (int trial = 0; trial < 25; ++trial) {
      Path path(t);
      RodTarget far = present(path.system);
      for (std::size_t k = 0; k < 6; k += 2)
        far.lengths[k] = far.lengths[k + 1] = t.length + random.uniform(-0.06, 0.06);
      far.wrench = random.wrench(4, 0.3);
      const RodTarget from = present(path.system);
      const RodPathEnd whole = path.to(far);
      ASSERT_TRUE(whole.arrived);
      EXPECT_EQ(whole.progress, 1);
      EXPECT_LE(whole.residual, 1e-12);
      EXPECT_GT(whole.iterations, 0);

      Path pieces(t);
      for (int part = 1; part <= 40; ++part) {
        RodTarget next = from;
        for (std::size_t k = 0; k < 6; ++k)
          next.lengths[k] += part / 40.0 * (far.lengths[k] - from.lengths[k]);
        next.wrench += part / 40.0 * (far.wrench - from.wrench);
        ASSERT_TRUE(pieces.to(next).arrived);
      }
      for (Path* each : {&path, &pieces}) {
        each->system.refine();
        int iterations = 0;
        double residual = 0;
        ASSERT_TRUE(correct(each->system, iterations, residual));
      }
      EXPECT_LT((path.system.platform().p - pieces.system.platform().p).norm(), 1e-13);
      for (int k = 0; k < 6; ++k)
        EXPECT_LT((path.system.rod(k).force - pieces.system.rod(k).force).norm(), 1e-9);
    }
}

TEST(RodPath, EndsAtAnEquilibriumWhereverItEnds) {
  RodRandom random(3);
  int ended = 0;
  for (const RodTripod& t : {g1, g2})
    for (int trial = 0; trial < 60; ++trial) {
      Path path(t);
      std::array<double, 3> lengths;
      for (double& length : lengths) length = std::max(0.03, t.length + random.uniform(-0.25, 0.25));
      const RodTarget from = present(path.system);
      const Wrench6 wrench = random.wrench(60, 4);
      const RodPathEnd end = path.to(lengths, wrench);
      ended += !end.arrived;
      ASSERT_EQ(end.arrived, end.progress == 1);
      EXPECT_LE(path.system.evaluate(), 1e-12);
      for (int k = 0; k < 6; ++k) {  // on the way, where it says
        const double length = from.lengths[std::size_t(k)];
        const double there = length + end.progress * (lengths[std::size_t(k / 2)] - length);
        EXPECT_NEAR(path.system.length(k), there, 1e-14);
      }
      EXPECT_LT((path.system.wrench() - from.wrench - end.progress * (wrench - from.wrench)).norm(), 1e-12);
      // linearised there: a step changes nothing
      EXPECT_LT(path.system.step(false).norm(), 1e-6);
    }
  EXPECT_GT(ended, 20);
}

TEST(RodPath, KeepsToItsBoundOnIterations) {
  for (const int most : {0, 1, 7, 30}) {
    Path path(g1);
    const RodPathEnd end = path.to({0.4, 0.08, 0.3}, Wrench6::Zero(), {.max_iterations = most});
    EXPECT_FALSE(end.arrived);
    EXPECT_LE(end.iterations, most + 25);  // a correction and its refinement are carried through
    EXPECT_LE(path.system.evaluate(), 1e-12);
  }
}

TEST(RodPath,
     FindsWhereTheSymmetricStateBuckles) {  // notes: G2 between -110 and -112 N, G1 between -190 and -200
  for (const auto& [t, low, high] : {std::tuple{g2, 110.0, 112.0}, std::tuple{g1, 190.0, 200.0}}) {
    SCOPED_TRACE(t.name);
    RodWork work = work_of<ElasticaSystem>(tripod_robot(t));
    RodGroup& system = *work.system;
    ASSERT_TRUE(system.rest_at(level(t.height)));
    RodTarget target = present(system);
    for (std::size_t k = 0; k < 6; ++k) target.lengths[k] = t.length;
    target.wrench.setZero();
    ASSERT_TRUE(follow(system, target, {}, work.spare).arrived);
    Wrench6 down = Wrench6::Zero();
    down[2] = -1;
    const GrownLoad grown = grow_load<Spatial>(system, work.places, down, 300, {}, {});
    EXPECT_EQ(grown.end, GrowthEnd::bifurcation);
    EXPECT_GT(grown.load, low);
    EXPECT_LT(grown.load, high);
    EXPECT_EQ(unstable_directions(system), 0);              // the last stable state
    EXPECT_LT(system.platform().p.head<2>().norm(), 1e-7);  // rounding, over what stiffness is left
    EXPECT_LT(system.factors().smallest_pivot(), 1e-3);

    // the state itself goes on beyond: two directions of sway are lost, by symmetry both at once
    Path beyond(t);
    ASSERT_TRUE(beyond.to({t.length, t.length, t.length}, (high + 2) * down).arrived);
    EXPECT_EQ(unstable_directions(beyond.system), 2);
    EXPECT_LT(beyond.system.platform().p.head<2>().norm(), 1e-9);
  }
}

TEST(RodPath,
     PerturbedPathsEndAtAFold) {  // subcritical: a small side force turns the bifurcation into a fold
  Path path(g2);
  const std::array<double, 3> lengths{g2.length, g2.length, g2.length};
  ASSERT_TRUE(path.to(lengths, Wrench6::Zero()).arrived);
  Wrench6 wrench = Wrench6::Zero();
  wrench[2] = -130;
  wrench[1] = 0.5;
  const RodPathEnd end = path.to(lengths, wrench);
  EXPECT_FALSE(end.arrived);
  EXPECT_LT(130 * end.progress, 111);  // before the perfect robot buckles
  EXPECT_GT(130 * end.progress, 80);
  EXPECT_LT(path.system.factors().smallest_pivot(), 1e-4);
}

}  // namespace rod_path_test
}  // namespace sinew::test
