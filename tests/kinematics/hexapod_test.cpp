/// Platforms held at a pose by the lengths of six rods, and let go again.
#include <gtest/gtest.h>

#include <cmath>

#include "kinematics/rods/lengths_for_pose.hpp"
#include "rod_robots.hpp"
#include "sanitizers.hpp"
#include "shooting_hexapod.hpp"
#include "sinew/analysis/shape.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/equilibrium.hpp"

namespace sinew::test {
namespace hexapod_test {

Robot builtin(const char* name) { return load(name).value(); }

SpatialPose pose_at(RodRandom& random, double tilt) {
  const double x = random.uniform(-0.12, 0.12), y = random.uniform(-0.12, 0.12),
               z = random.uniform(0.35, 0.6);
  const Vec3<double> p(x, y, z), turn = random.vector(tilt);
  return pose_of({p, SO3<double>::exp(turn)});
}

double distance(const SpatialPose& a, const SpatialPose& b) {
  const SE3<double> p = SE3<double>::from(a), q = SE3<double>::from(b);
  return (p.p - q.p).norm() + p.R.inverse().compose(q.R).log().norm();
}

TEST(Hexapod, EveryUntiltedPoseIsHeldFromHome) {
  const Robot robot = builtin("hexapod");
  Workspace work(robot);
  RodRandom random(2);
  for (int k = 0; k < 200; ++k) {
    const SpatialPose wanted = pose_at(random, 0);
    const Equilibrium found = inverse_equilibrium(robot, wanted, {}, work);
    ASSERT_TRUE(found.is_solved()) << found.report.message.view() << "\n" << wanted.position.transpose();
    EXPECT_LT(found.report.residual, 1e-12);
    EXPECT_LT(distance(found.pose, wanted), 1e-15);
  }
}

/// A tilted pose is held, or it is said where the way from home folds and that other ways do not lead there.
TEST(Hexapod, EveryTiltedPoseIsHeldOrDiagnosed) {
  const Robot robot = builtin("hexapod");
  Workspace work(robot), other(robot);
  RodRandom random(12);
  int straight = 0, elsewhere = 0, folds = 0;
  for (int k = 0; k < 100; ++k) {
    const SpatialPose wanted = pose_at(random, 0.35);
    const Equilibrium found = inverse_equilibrium(robot, wanted, {}, work);
    const std::string_view message = found.report.message.view();
    if (found.is_solved()) {
      EXPECT_LT(found.report.residual, 1e-12);
      EXPECT_LT(distance(found.pose, wanted), 1e-14);
      ++(message.find("another branch") == std::string_view::npos ? straight : elsewhere);
      continue;
    }
    ++folds;
    EXPECT_EQ(found.report.status, Status::singular) << message;
    EXPECT_NE(message.find("pass a fold at"), std::string_view::npos) << message;
    EXPECT_TRUE(message.ends_with("do not lead to it either")) << message;
    EXPECT_TRUE(inverse_equilibrium(robot, pose_of(level(0.45)), {}, other).is_solved());
  }
  EXPECT_GE(straight, 45);
  EXPECT_GE(elsewhere, 1);
  EXPECT_EQ(straight + elsewhere + folds, 100);
}

TEST(Hexapod, ForwardFindsThePoseThatWasHeld) {
  for (const char* name : {"hexapod", "hexapod-heavy", "6pfs"}) {
    const Robot robot = builtin(name);
    Workspace work(robot);
    RodRandom random(4);
    int solved = 0;
    for (int k = 0; k < 30; ++k) {
      SpatialPose wanted = pose_at(random, 0.1);
      wanted.position = Vec3<double>(0, 0, 0.42) + random.vector(0.03);
      EquilibriumOptions options;
      options.wrench = random.wrench(0.2, 0.01);
      const Equilibrium held = inverse_equilibrium(robot, wanted, options, work);
      if (held.report.status != Status::converged) continue;
      const std::vector<double> inputs(held.inputs.begin(), held.inputs.end());
      options.start = wanted;
      const Equilibrium found = equilibrium(robot, inputs, options, work);
      ASSERT_TRUE(found.is_solved()) << found.report.message.view() << "\n"
                                     << name << " at " << wanted.position.transpose();
      EXPECT_LT(distance(found.pose, wanted), 1e-9) << name;
      ++solved;
    }
    EXPECT_GT(solved, 20) << name;
  }
}

TEST(Hexapod, ResumedStepsAgreeWithTheWayFromHome) {
  const Robot robot = builtin("hexapod");
  Workspace walker(robot), other(robot);
  RodRandom random(6);
  SE3<double> pose = SE3<double>::from(pose_of(level(0.42)));
  ASSERT_TRUE(inverse_equilibrium(robot, pose_of(pose), {}, walker).is_solved());
  for (int k = 0; k < 160; ++k) {
    pose = {pose.p + Vec3<double>(4e-4, -3e-4, 5e-4),
            SO3<double>::exp(Vec3<double>(1e-3, -5e-4, 1e-3)).compose(pose.R)};
    const Equilibrium quick =
        inverse_equilibrium(robot, pose_of(pose), {.warm_start = true, .check_stability = false}, walker);
    ASSERT_TRUE(quick.is_solved()) << quick.report.message.view();
    EXPECT_LE(quick.report.residual, 1e-10);
    EXPECT_LE(quick.report.iterations, 5);
    if (k % 40 != 0) continue;
    const Equilibrium anew = inverse_equilibrium(robot, pose_of(pose), {}, other);
    ASSERT_TRUE(anew.is_solved());
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(quick.inputs[i], anew.inputs[i], 1e-9);
  }
}

TEST(Hexapod, HoldsElasticasAsWell) {
  RodRandom random(8);
  const RodRobot tripod = tripod_robot(g2), robot(tripod.legs, tripod.home, tripod.platform_radius);
  RodWork plane = work_of<ElasticaSystem>(robot);
  RodWork spatial = work_of<TangentSystem>(robot);
  const SE3<double> wanted = random.near(home(robot), 0.01, 0.03);
  RodQuestion question;
  question.wrench = random.wrench(0.5, 0.02);
  const Report a = lengths_for_pose(plane, home(robot), wanted, question);
  const Report b = lengths_for_pose(spatial, home(robot), wanted, question);
  ASSERT_TRUE((a.ok() || a.status == Status::unstable) && a.status == b.status) << a.message.view();
  for (int k = 0; k < 6; ++k) {
    EXPECT_NEAR(plane.system->length(k), spatial.system->length(k), 1e-12);
    EXPECT_LT((plane.system->rod(k).force - spatial.system->rod(k).force).norm(), 1e-10);
  }
}

/// Another formulation: rods with a rotation along them, integrated from the guide by what we say of it.
TEST(Hexapod, RodsIntegratedAnewEndWhereThePlatformHoldsThem) {
  for (const char* name : {"hexapod", "hexapod-heavy", "hexapod-self-weight", "6pfs"}) {
    const Robot robot = builtin(name);
    const auto rods = legs_of<RodLeg>(robot);
    const ShootingHexapod judge(rods, robot.weight().gravity, 600);
    Workspace work(robot);
    RodRandom random(14);
    int solved = 0;
    for (int k = 0; k < 20; ++k) {
      const SpatialPose wanted = pose_of({Vec3<double>(0, 0, 0.42) + random.vector(0.05),
                                          SO3<double>::exp(random.vector(name[0] == 'h' ? 0.3 : 0.1))});
      EquilibriumOptions options;
      options.wrench = random.wrench(0.2, 0.01);
      const Equilibrium held = inverse_equilibrium(robot, wanted, options, work);
      if (!held.is_solved()) continue;
      ++solved;
      const RodAnalysis analysis = analyse_equilibrium(robot, work);
      ShootingHexapod::Unknowns v;
      for (int i = 0; i < 6; ++i) v.segment<6>(6 * i) = judge.unknowns(i, analysis.rods[std::size_t(i)]);
      Vec<double, 6> wrench = options.wrench;
      wrench.head<3>() += robot.weight().platform_mass * robot.weight().gravity;
      const auto gaps = judge.gaps(judge.rods(v), SE3<double>::from(wanted), wrench);
      EXPECT_LT(gaps.lpNorm<Eigen::Infinity>(), 2e-8) << name;
    }
    EXPECT_GE(solved, 8) << name;
  }
}

TEST(Hexapod, SaysWhyAPoseIsNotHeld) {
  const Robot robot = builtin("hexapod"), tripod = builtin("3pfs-g2");
  Workspace work(robot), three(tripod);
  const auto status = [&](const SpatialPose& pose, const EquilibriumOptions& options = {}) {
    const Equilibrium found = inverse_equilibrium(robot, pose, options, work);
    EXPECT_FALSE(found.is_solved());
    EXPECT_FALSE(found.report.message.view().empty());
    return found.report.status;
  };
  EXPECT_EQ(inverse_equilibrium(tripod, pose_of(level(0.4)), {}, three).report.status, Status::unsupported);
  SpatialPose nowhere = pose_of(level(0.4));
  nowhere.position[0] = std::nan("");
  EXPECT_EQ(status(nowhere), Status::left_domain);
  status(pose_of(level(-0.2)));
  status(pose_of({Vec3<double>(0, 0, 0.4), SO3<double>::exp(Vec3<double>(0, 2, 0))}));
  EXPECT_EQ(status(pose_of({Vec3<double>(0.1, 0, 0.5), SO3<double>::identity()}), {.max_iterations = 2}),
            Status::iteration_limit);
  EXPECT_TRUE(inverse_equilibrium(robot, pose_of(level(0.45)), {}, work).is_solved());  // none of it stays
}

/// A pose needs each rod's own length: tied rods are refused, and stay as they are fed.
TEST(Hexapod, TiedRodsHoldNoPose) {
  const RodRobot six = legs_of<RodLeg>(builtin("hexapod"));
  std::vector<RodLeg> legs = six.legs;
  RodLeg more = legs[0];
  more.base.p += Vec3<double>(0, 0.02, 0);
  legs.push_back(more);
  const std::array<int, 7> tied = {-1, -1, -1, -1, -1, -1, 0};
  const Robot robot("seven", RodRobot(legs, six.home, six.platform_radius, tied));
  Workspace work(robot);
  EXPECT_EQ(inverse_equilibrium(robot, pose_of(level(0.41)), {}, work).report.status, Status::unsupported);
  const std::vector<double> inputs(6, 0.41);
  ASSERT_TRUE(equilibrium(robot, inputs, {}, work).is_solved());
  EXPECT_EQ(analyse_equilibrium(robot, work).rods[6].length, 0.41);
}

TEST(Hexapod, SeveralEquilibriaAreOfTheQuestionsGravity) {
  if (test::addresses_are_checked) GTEST_SKIP() << "a hundred and sixty searches take too long here";
  const Robot robot = builtin("hexapod-heavy");
  Workspace work(robot);
  const std::vector<double> inputs(6, 0.45);
  EquilibriumOptions none;
  none.gravity = Vec3<double>::Zero();
  const Equilibrium one = equilibrium(robot, inputs, none, work);
  ASSERT_TRUE(one.is_solved());
  double nearest = 1;
  for (const FoundEquilibrium& found : equilibria(robot, inputs, none, work))
    nearest = std::min(nearest, distance(found.pose, one.pose));
  EXPECT_LT(nearest, 1e-9);
}

/// What the workspace and pictures are given of a solved state is that state.
TEST(Hexapod, CoordinatesHoldWhatWasSolved) {
  const Robot robot = builtin("hexapod-heavy");
  Workspace work(robot), other(robot);
  const Equilibrium held = inverse_equilibrium(robot, pose_of(level(0.43)), {}, work);
  ASSERT_TRUE(held.is_solved());
  const std::vector<double> coordinates(held.coordinates.begin(), held.coordinates.end());
  const RodAnalysis analysis = analyse_equilibrium(robot, work);
  EXPECT_LT(assemble(robot, held.pose, coordinates, other).closure_error, 1e-8);  // of other elements
  const auto shape = std::get<SpatialShape>(any_shape(robot, held.pose, coordinates, 9));
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_LT((shape.backbones[k].back() - analysis.rods[k].tip).norm(), 1e-11);
}

TEST(Hexapod, GravityOfAQuestionIsItsOwn) {
  const Robot heavy = builtin("hexapod-self-weight"), light = builtin("hexapod");
  Workspace work(heavy), other(light);
  const SpatialPose pose =
      pose_of({Vec3<double>(0.02, 0.03, 0.45), SO3<double>::exp(Vec3<double>(0.1, 0, 0))});
  EquilibriumOptions none;
  none.gravity = Vec3<double>::Zero();
  const Equilibrium first = inverse_equilibrium(heavy, pose, {}, work);
  const std::vector<double> loaded(first.inputs.begin(), first.inputs.end());
  const Equilibrium without = inverse_equilibrium(heavy, pose, none, work);
  const Equilibrium same = inverse_equilibrium(light, pose, {}, other);
  ASSERT_TRUE(without.is_solved() && same.is_solved());
  double change = 0;
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(without.inputs[k], same.inputs[k], 1e-12);
    change = std::max(change, std::abs(loaded[k] - same.inputs[k]));
  }
  EXPECT_GT(change, 1e-6);
}

}  // namespace hexapod_test
}  // namespace sinew::test
