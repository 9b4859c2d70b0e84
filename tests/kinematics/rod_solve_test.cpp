/// Forward and inverse equilibria of whole robots of rods: against tests/data/tripod/, against their own rods
/// integrated anew, and against themselves.
#include "kinematics/rods/inverse.hpp"
#include "kinematics/rods/start.hpp"

#include <gtest/gtest.h>

#include "rod_robots.hpp"

namespace sinew::test {
namespace rod_solve_test {

/// A robot with the memory of its solver.
struct Solver {
  explicit Solver(const RodTripod& t) : Solver(tripod_robot(t)) {}
  explicit Solver(const RodRobot& r) : robot(r), work(work_of<ElasticaSystem>(robot)) {}

  Report ask(Numbers inputs, const RodQuestion& question = {}) {
    return solve_rods(work, home(robot), inputs, question);
  }
  Report solve(const Vec3<double>& inputs, const RodQuestion& question = {}) {
    return ask(std::span<const double>(inputs.data(), 3), question);
  }
  Report solve_at(const IndependentPose& wanted, const RodQuestion& question = {}) {
    return solve_rods_at(work, home(robot), wanted, question);
  }
  const SE3<double>& pose() const { return work.system->platform(); }
  Vec3<double> lengths() const {
    return {work.system->length(0), work.system->length(2), work.system->length(4)};
  }

  RodRobot robot;
  RodWork work;
};

bool is_solved(const Report& report) { return report.ok() || report.status == Status::unstable; }

double distance(const SE3<double>& a, const SE3<double>& b) {
  return std::hypot((a.p - b.p).norm(), a.R.inverse().compose(b.R).log().norm());
}

Vec3<double> inputs_around(const RodTripod& t, RodRandom& random, double range) {
  return Vec3<double>::Constant(t.length) + random.vector(range);
}

TEST(RodSolve, NoInputWithinTheWorkingRangeIsLostOrWrong) {
  for (const RodTripod& t : {g1, g2}) {
    SCOPED_TRACE(t.name);
    const judge::Tripod data = t.data();
    Solver solver(t);
    RodRandom random(1);
    for (int trial = 0; trial < 1500; ++trial) {
      const Report report = solver.solve(inputs_around(t, random, 0.06),
                                         {.wrench = random.wrench(trial % 3 * 3, trial % 3 * 0.15)});
      ASSERT_TRUE(report.ok()) << trial << ' ' << to_string(report);
      EXPECT_LE(report.residual, 1e-12);
      EXPECT_LE(report.iterations, 80);
      if (trial % 10 != 0) continue;  // integrating takes a hundred times as long as solving
      const judge::Mismatch off = reintegrated(data, *solver.work.system);
      EXPECT_LT(off.closure, 1e-12);
      EXPECT_LT(off.tip_curvature, 1e-10);
      EXPECT_LT(off.torsion, 1e-13);
      EXPECT_LT(off.force, 1e-11);
      EXPECT_LT(off.moment, 1e-12);
      EXPECT_LT(off_elastica(solver.robot, *solver.work.system), 1e-12);
    }
  }
}

TEST(RodSolve, BeyondItAnswersOrSaysWhyNot) {
  std::array<int, 8> by_status{};
  for (const RodTripod& t : {g1, g2}) {
    SCOPED_TRACE(t.name);
    Solver solver(t);
    RodRandom random(2);
    for (int trial = 0; trial < 400; ++trial) {
      Vec3<double> inputs = inputs_around(t, random, trial % 2 == 0 ? 0.15 : 0.3);
      inputs = inputs.cwiseMax(0.02);
      const double force = trial % 4 == 0 ? 500 : (trial % 4 == 1 ? 50 : 0);
      const Report report = solver.solve(inputs, {.wrench = random.wrench(force, force / 20)});
      SCOPED_TRACE(testing::Message() << trial << ' ' << to_string(report));
      ++by_status[std::size_t(report.status)];
      EXPECT_TRUE(solver.pose().p.allFinite());
      EXPECT_LT(report.iterations, 2000);
      if (is_solved(report)) {
        EXPECT_LE(report.residual, 1e-12);
        EXPECT_LT(off_elastica(solver.robot, *solver.work.system), 1e-11);
        Wrench6 sum = Wrench6::Zero();
        for (int k = 0; k < 6; ++k) {
          const RodResult rod = solver.work.system->rod(k);
          sum.head<3>() += rod.force;
          sum.tail<3>() += cross(rod.tip - solver.pose().p, rod.force);
          EXPECT_EQ(rod.length, inputs[k / 2]);
        }
        EXPECT_LT((sum - solver.work.system->wrench()).norm(), 1e-10);
        EXPECT_EQ(report.ok(), report.message.empty());
        continue;
      }
      EXPECT_FALSE(report.message.empty());
      const RodGroup& system = *solver.work.system;
      const std::string_view said = report.message.view();
      if (report.status == Status::singular) {
        EXPECT_NE(said.find("fold"), said.npos);
        EXPECT_LT(system.factors().smallest_pivot(), 1e-2);  // what a fold is
      }
      if (report.status == Status::left_domain) {
        EXPECT_NE(said.find("sharply"), said.npos);
      }
      if (report.status == Status::unreachable && said.find("pulled straight") == said.npos) {
        EXPECT_NE(said.find("too short"), said.npos);
      }
    }
  }
  const auto seen = [&](Status status) { return by_status[std::size_t(status)]; };
  EXPECT_GT(seen(Status::converged), 300);
  EXPECT_GT(seen(Status::singular), 50);
  EXPECT_GT(seen(Status::unreachable), 20);
  EXPECT_GT(seen(Status::left_domain), 5);
  EXPECT_LT(seen(Status::stalled), 8);  // the one that explains nothing
}

/// A path that ends for another reason, rounding for one, would go on with a coarser tolerance.
TEST(RodSolve, TheFoldsItNamesAreThere) {
  int named = 0, false_ones = 0;
  for (const RodTripod& t : {g1, g2})
    for (const double force : {0.0, 30.0}) {
      Solver solver(t);
      RodGroup& system = *solver.work.system;
      LimbState spare = system.state();
      RodRandom random(15);
      for (int trial = 0; trial < 120; ++trial) {
        const Vec3<double> inputs =
            inputs_around(t, random, 0.3).cwiseMax(0.02);  // rods of very unequal length too
        const Wrench6 wrench = random.wrench(force, force / 20);
        const Report report = solver.solve(inputs, {.wrench = wrench});
        if (report.status != Status::singular && report.status != Status::stalled) continue;
        RodTarget target = present(system);
        for (std::size_t k = 0; k < 6; ++k) target.lengths[k] = inputs[Eigen::Index(k / 2)];
        target.wrench = wrench;
        ++named;
        false_ones += follow(system, target, {.tolerance = 1e-10}, spare).progress > 1e-3;
      }
    }
  EXPECT_GT(named, 30);
  EXPECT_LE(false_ones, 1);
}

TEST(RodSolve, SaysWhenTheRobotDoesNotHoldByItself) {  // symmetric, pressed beyond its buckling load
  for (const auto& [t, load] : {std::pair{g2, 115.0}, std::pair{g1, 205.0}}) {
    Solver solver(t);
    Wrench6 wrench = Wrench6::Zero();
    wrench[2] = -load;
    const Report report = solver.solve(Vec3<double>::Constant(t.length), {.wrench = wrench});
    EXPECT_EQ(report.status, Status::unstable);
    EXPECT_LE(report.residual, 1e-12);
    EXPECT_EQ(report.message.view().substr(0, 12), "2 directions");
    EXPECT_LT(off_elastica(solver.robot, *solver.work.system), 1e-12);
    wrench[2] = -load + 20;
    EXPECT_TRUE(solver.solve(Vec3<double>::Constant(t.length), {.wrench = wrench, .warm_start = true}).ok());
  }
}

TEST(RodSolve, NamesTheLoadWhereTheLoadAloneWasChanged) {
  int buckled = 0;
  for (const RodTripod& t : {g2, g1}) {
    SCOPED_TRACE(t.name);
    Solver solver(t);
    RodRandom random(21);
    const Vec3<double> inputs = Vec3<double>::Constant(t.length);
    for (int trial = 0; trial < 60; ++trial) {
      ASSERT_TRUE(solver.solve(inputs, {.wrench = random.wrench(1, 0.1)}).ok());
      const Report report = solver.solve(inputs, {.wrench = random.wrench(400, 20), .warm_start = true});
      if (report.status != Status::singular) continue;
      ++buckled;
      EXPECT_EQ(report.message.view().substr(0, 17), "the robot buckles") << report.message.view();
    }
  }
  EXPECT_GT(buckled, 0);
}

TEST(RodSolve, ResumingNothingIsBeginningAtHome) {
  RodRandom random(14);
  for (int trial = 0; trial < 30; ++trial) {
    Solver fresh(g2), cold(g2);
    const Vec3<double> inputs = inputs_around(g2, random, 0.1);
    const Wrench6 wrench = random.wrench(50, 3);
    const Report one = fresh.solve(inputs, {.wrench = wrench, .warm_start = true});
    const Report other = cold.solve(inputs, {.wrench = wrench});
    EXPECT_EQ(one.status, other.status);
    EXPECT_EQ(distance(fresh.pose(), cold.pose()), 0);
  }
}

TEST(RodSolve, ResumedIsWhatIsFoundFromHome) {
  for (const RodTripod& t : {g1, g2}) {
    SCOPED_TRACE(t.name);
    Solver cold(t), warm(t), quick(t);
    RodRandom random(3);
    Vec3<double> inputs = Vec3<double>::Constant(t.length);
    Wrench6 wrench = Wrench6::Zero();
    int iterations = 0, steps = 0;
    for (int trial = 0; trial < 1500; ++trial) {
      const double stride = std::pow(10, random.uniform(-3.3, -2.3));  // 0.5 to 5 mm
      inputs += random.vector(stride);
      inputs = inputs.cwiseMin(t.length + 0.05).cwiseMax(t.length - 0.05);
      wrench = 0.98 * wrench + random.wrench(0.4, 0.02);
      ASSERT_TRUE(cold.solve(inputs, {.wrench = wrench}).ok());
      const Report report = warm.solve(inputs, {.wrench = wrench, .warm_start = true});
      ASSERT_TRUE(report.ok()) << to_string(report);
      EXPECT_LT(distance(warm.pose(), cold.pose()), 1e-11);
      for (int k = 0; k < 6; ++k)
        EXPECT_LT((warm.work.system->rod(k).force - cold.work.system->rod(k).force).norm(), 1e-8);
      if (trial > 0) iterations += report.iterations, ++steps;
      ASSERT_TRUE(quick.solve(inputs, {.wrench = wrench, .warm_start = true, .check_stability = false}).ok());
      EXPECT_LT(distance(quick.pose(), cold.pose()), 1e-11);
    }
    EXPECT_LT(iterations, 6 * steps);
  }
}

TEST(RodSolve, QuickAnswersStayResolved) {  // ten nodes do not: they were 1e-7 m off here
  for (const RodTripod& t : {g1, g2}) {
    Solver quick(t), cold(t);
    RodRandom random(13);
    Vec3<double> inputs = Vec3<double>::Constant(t.length);
    int fine = 0;
    for (int way = 0; way < 12; ++way) {
      const Vec3<double> from = inputs, to = inputs_around(t, random, 0.15);
      for (int part = 1; part <= 50; ++part) {
        inputs = from + part / 50.0 * (to - from);
        ASSERT_TRUE(quick.solve(inputs, {.warm_start = true, .check_stability = false}).ok());
        fine += quick.work.system->is_fine();
      }
      ASSERT_TRUE(cold.solve(inputs).ok());
      EXPECT_LT(distance(quick.pose(), cold.pose()), 2e-12);
    }
    EXPECT_GT(fine, 0);
  }
}

TEST(RodSolve, NeverLeavesItsBranchInLargeResumedSteps) {  // beside a path in small ones
  int jumped = 0, tried = 0;
  for (const RodTripod& t : {g1, g2}) {
    Solver large(t), small(t);
    RodRandom random(4);
    for (int trial = 0; trial < 80; ++trial) {
      const Vec3<double> from = inputs_around(t, random, 0.06), to = inputs_around(t, random, 0.12);
      const Wrench6 before = random.wrench(5, 0.3), after = random.wrench(30, 2);
      if (!large.solve(from, {.wrench = before}).ok()) continue;
      ASSERT_TRUE(small.solve(from, {.wrench = before}).ok());
      if (!is_solved(large.solve(to, {.wrench = after, .warm_start = true}))) continue;
      bool is_there = true;
      for (int part = 1; part <= 60 && is_there; ++part) {
        const double f = part / 60.0;
        const Vec3<double> inputs = (1 - f) * from + f * to;
        is_there =
            is_solved(small.solve(inputs, {.wrench = (1 - f) * before + f * after, .warm_start = true}));
      }
      if (!is_there) continue;
      ++tried;
      jumped += distance(large.pose(), small.pose()) > 1e-9;
    }
  }
  EXPECT_GT(tried, 100);
  EXPECT_EQ(jumped, 0);
}

TEST(RodSolve, AnswersDoNotDependOnWhatWasSolvedBefore) {
  Solver used(g1);
  RodRandom random(5);
  for (int trial = 0; trial < 60; ++trial) {
    const Vec3<double> inputs = inputs_around(g1, random, 0.06);
    const Wrench6 wrench = random.wrench(5, 0.3);
    used.solve(inputs_around(g1, random, 0.3).cwiseMax(0.02), {.wrench = random.wrench(300, 10)});
    used.solve_at({0.2, random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)});
    Solver fresh(g1);
    ASSERT_TRUE(used.solve(inputs, {.wrench = wrench}).ok());
    ASSERT_TRUE(fresh.solve(inputs, {.wrench = wrench}).ok());
    EXPECT_EQ(distance(used.pose(), fresh.pose()), 0);
    used.solve({-1, 0.2, 0.2});  // a bad question leaves no trace either
  }
}

/// Turned by 120° about z: pair j's length goes to pair j + 1.
TEST(RodSolve, TurnedQuestionsHaveTurnedAnswers) {
  const SO3<double> third = SO3<double>::exp(Vec3<double>(0, 0, 2 * 3.14159265358979323846 / 3));
  for (const RodTripod& t : {g1, g2}) {
    Solver solver(t), other(t);
    RodRandom random(6);
    for (int trial = 0; trial < 60; ++trial) {
      const Vec3<double> L = inputs_around(t, random, 0.06);
      const Wrench6 w = random.wrench(6, 0.4);
      Wrench6 turned;
      turned << third.rotate(w.head<3>()), third.rotate(w.tail<3>());
      ASSERT_TRUE(solver.solve(L, {.wrench = w}).ok());
      ASSERT_TRUE(other.solve({L[2], L[0], L[1]}, {.wrench = turned}).ok());
      const SE3<double> expected{third.rotate(solver.pose().p),
                                 third.compose(solver.pose().R).compose(third.inverse())};
      EXPECT_LT(distance(expected, other.pose()), 1e-12);
    }
  }
}

/// Mirrored at x = 0: pair 0 stays, pairs 1 and 2 change places.
TEST(RodSolve, MirroredQuestionsHaveMirroredAnswers) {
  for (const RodTripod& t : {g1, g2}) {
    Solver solver(t), other(t);
    RodRandom random(7);
    for (int trial = 0; trial < 60; ++trial) {
      const Vec3<double> L = inputs_around(t, random, 0.06);
      const Wrench6 w = random.wrench(6, 0.4);
      Wrench6 mirrored;
      mirrored << -w[0], w[1], w[2], w[3], -w[4], -w[5];
      ASSERT_TRUE(solver.solve(L, {.wrench = w}).ok());
      ASSERT_TRUE(other.solve({L[0], L[2], L[1]}, {.wrench = mirrored}).ok());
      const SE3<double> at = solver.pose();
      const SE3<double> expected{Vec3<double>(-at.p[0], at.p[1], at.p[2]),
                                 SO3<double>{at.R.w, Vec3<double>(at.R.v[0], -at.R.v[1], -at.R.v[2])}};
      EXPECT_LT(distance(expected, other.pose()), 1e-12);
    }
  }
}

TEST(RodSolve, WithoutLoadStiffnessDoesNotMatter) {  // equilibrium is homogeneous in EI
  judge::Tripod stiff = g1.data();
  stiff.bending_stiffness *= 16;
  Solver soft(g1), other(tripod_robot(stiff, level(g1.height)));
  const Vec3<double> inputs(0.22, 0.18, 0.24);
  ASSERT_TRUE(soft.solve(inputs).ok() && other.solve(inputs).ok());
  EXPECT_LT(distance(soft.pose(), other.pose()), 1e-14);
  const Vec3<double> force = soft.work.system->rod(2).force;
  EXPECT_LT((16 * force - other.work.system->rod(2).force).norm(), 1e-12 * force.norm());
}

TEST(RodSolve, RobotsOfManyRodsEachWithItsInput) {
  RodRandom random(8);
  for (const int rods : {3, 6, 8, 9, 12}) {
    SCOPED_TRACE(rods);
    for (int trial = 0; trial < 3; ++trial) {
      Solver solver(random.robot(rods, 0.2));
      ASSERT_TRUE(solver.work.system->rest_at(random.near(home(solver.robot), 0.01, 0.1)));
      std::vector<double> inputs;
      for (int k = 0; k < rods; ++k) inputs.push_back(solver.work.system->length(k) + 0.003);
      const Report report = solver.ask(inputs, {.wrench = random.wrench(1, 0.05)});
      ASSERT_TRUE(is_solved(report)) << to_string(report);
      EXPECT_LE(solver.work.system->evaluate(), 1e-12);
      EXPECT_LT(off_elastica(solver.robot, *solver.work.system), 1e-11);
    }
  }
}

TEST(RodSolve, SaysWhatIsWrongWithAQuestion) {
  Solver solver(g2);
  const double nan = std::nan(""), L = g2.length;
  const auto is_refused = [&](Numbers inputs, const RodQuestion& question, std::string_view because,
                              Status status = Status::left_domain) {
    const Report report = solver.ask(inputs, question);
    EXPECT_EQ(report.status, status);
    EXPECT_NE(report.message.view().find(because), std::string_view::npos) << report.message.view();
  };
  is_refused({L, L}, {}, "3 inputs, 2 were given", Status::bad_input);
  is_refused({L, nan, L}, {}, "inputs[1]");
  is_refused({L, L, -L}, {}, "inputs[2]");
  is_refused({0, L, L}, {}, "inputs[0]");
  is_refused({L, L, HUGE_VAL}, {}, "inputs[2]");
  is_refused({L, L, L}, {.wrench = Wrench6::Constant(nan)}, "wrench");
  SE3<double> start = level(0.4);
  start.p[2] = nan;
  is_refused({L, L, L}, {.start = start}, "start");
  start = level(-0.3);
  is_refused({L, L, L}, {.start = start}, "start");
  const Report report = solver.solve({0.1, 0.1, 0.1});
  EXPECT_EQ(report.status, Status::unreachable);
  EXPECT_TRUE(solver.solve({L, L, L}).ok());  // none of it does harm
}

TEST(RodSolve, SaysWhenHomeCannotBeLaid) {
  judge::Tripod above = g2.data();
  above.platform[3] = above.base[3];
  for (const RodRobot& robot : {tripod_robot(above, level(0.4)), tripod_robot(g2.data(), level(-0.1))}) {
    Solver solver(robot);
    for (int again = 0; again < 2; ++again) {
      const double L = g2.length;
      for (const Report& report : {solver.solve({L, L, L}), solver.solve_at({0.4, 0, 0})}) {
        EXPECT_EQ(report.status, Status::singular);
        EXPECT_NE(report.message.view().find("home"), std::string_view::npos);
      }
    }
  }
  // a start is a way out, and what is resumed after it
  Solver solver(tripod_robot(g2.data(), level(-0.1)));
  EXPECT_TRUE(solver.solve({0.44, 0.43, 0.43}, {.start = level(0.4)}).ok());
  EXPECT_TRUE(solver.solve({0.44, 0.43, 0.44}, {.warm_start = true}).ok());
}

TEST(RodInverse, RoundTrips) {
  for (const RodTripod& t : {g1, g2}) {
    SCOPED_TRACE(t.name);
    Solver there(t), back(t);
    RodRandom random(9);
    int solved = 0;
    for (int trial = 0; trial < 300; ++trial) {
      const IndependentPose wanted{t.height + random.uniform(-0.03, 0.03), random.uniform(-0.12, 0.12),
                                   random.uniform(-0.12, 0.12)};
      const Wrench6 wrench = random.wrench(trial % 2 * 5, trial % 2 * 0.3);
      const bool resume = trial % 5 == 4;
      const Report report = there.solve_at(wanted, {.wrench = wrench, .warm_start = resume});
      if (!report.ok()) continue;
      ++solved;
      EXPECT_LE(report.residual, 1e-12);
      const SO3<double> q = there.pose().R.canonical();
      EXPECT_NEAR(there.pose().p[2], wanted.z, 1e-15);
      EXPECT_NEAR(q.v[0], wanted.e1, 1e-15);
      EXPECT_NEAR(q.v[1], wanted.e2, 1e-15);
      for (int k = 0; k < 6; k += 2)
        EXPECT_NEAR(there.work.system->length(k), there.work.system->length(k + 1), 1e-15);
      EXPECT_LT(off_elastica(there.robot, *there.work.system), 1e-12);
      const Report forward = back.solve(there.lengths(), {.wrench = wrench, .start = there.pose()});
      ASSERT_TRUE(forward.ok()) << to_string(forward);
      EXPECT_LT(distance(there.pose(), back.pose()), 1e-12);
      if (!is_solved(back.solve(there.lengths(), {.wrench = wrench})))
        continue;  // from home: a path of its own
      EXPECT_LT(distance(there.pose(), back.pose()), 1e-11);
    }
    EXPECT_GE(solved, 295);
  }
}

TEST(RodInverse, RodsOfOneInputHaveOneLengthWhateverTheHome) {
  RodRandom random(10);
  for (int trial = 0; trial < 20; ++trial) {
    const SE3<double> tilted = random.near(level(g2.height), 0.02, 0.15);
    Solver solver(tripod_robot(g2.data(), tilted)), plain(g2);
    const IndependentPose wanted{0.4, 0.05, 0.02};
    ASSERT_TRUE(solver.solve_at(wanted).ok() && plain.solve_at(wanted).ok());
    for (int k = 0; k < 6; k += 2)
      EXPECT_NEAR(solver.work.system->length(k), solver.work.system->length(k + 1), 1e-15);
    EXPECT_LT(distance(solver.pose(), plain.pose()), 1e-12);
    EXPECT_LT((solver.lengths() - plain.lengths()).norm(), 1e-12);
  }
}

TEST(RodInverse, SaysWhatIsWrongOrOutOfReach) {
  Solver solver(g2);
  const double nan = std::nan("");
  for (const IndependentPose& wanted :
       {IndependentPose{nan, 0, 0}, {0.4, nan, 0}, {0.4, 0, nan}, {0.4, 0.8, 0.7}})
    EXPECT_EQ(solver.solve_at(wanted).status, Status::left_domain);
  EXPECT_EQ(solver.solve_at({0.4, 0, 0}, {.wrench = Wrench6::Constant(nan)}).status, Status::left_domain);
  for (const IndependentPose& wanted :
       {IndependentPose{-5, 0, 0}, {0.4, 0.95, 0}, {0.4, 0, -0.99}, {0.001, 0, 0}}) {
    const Report report = solver.solve_at(wanted);
    SCOPED_TRACE(to_string(report));
    if (!is_solved(report)) {
      EXPECT_FALSE(report.message.empty());
    } else {
      EXPECT_LE(solver.work.system->evaluate(), 1e-12);
    }
    EXPECT_TRUE(solver.pose().p.allFinite());
  }
  RodRandom random(11);
  Solver many(random.robot(4, 0));
  EXPECT_EQ(many.solve_at({0.4, 0, 0}).status, Status::unsupported);
  EXPECT_TRUE(solver.solve_at({0.4, 0, 0}).ok());
}

TEST(RodLay, HoldsAPoseAtGivenLengths) {
  RodRandom random(12);
  for (int trial = 0; trial < 40; ++trial) {
    Solver solver(g2);
    const SE3<double> pose = random.near(level(g2.height), 0.01, 0.08);
    ASSERT_TRUE(lay_rods(solver.work, pose, {0.45, 0.45, 0.45}));
    RodGroup& system = *solver.work.system;
    EXPECT_LT(distance(system.platform(), pose), 1e-15);
    EXPECT_LE(system.evaluate(), 1e-10);
    for (int k = 0; k < 6; ++k) EXPECT_EQ(system.length(k), 0.45);
  }
  Solver solver(g2);
  EXPECT_FALSE(lay_rods(solver.work, level(0.4), {0.41, 0.41, 0.41}));  // shorter than the way
  EXPECT_LE(solver.work.system->evaluate(), 1e-10);                     // at rest all the same
}

}  // namespace rod_solve_test
}  // namespace sinew::test
