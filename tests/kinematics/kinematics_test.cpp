#include <gtest/gtest.h>

#include "every_robot.hpp"
#include "paths.hpp"
#include "sinew/kinematics/forward.hpp"

namespace sinew::test {
namespace kinematics_test {

const PlanarPose& planar(const AnyPose& pose) { return std::get<PlanarPose>(pose); }

/// Every robot that comes with the library.
class EveryRobot : public testing::TestWithParam<std::string> {
 protected:
  Robot robot = load(GetParam()).value();
  Workspace work{robot};
  std::mt19937 random{20261121};
  std::size_t legs = static_cast<std::size_t>(leg_count(robot));

  AnyPose reachable() { return reachable_pose(robot, random, work); }
};

TEST_P(EveryRobot, ForwardUndoesInverseOnEveryWorkingMode) {  // @verifies TDPCR (1), (4), (42), (57)
  for (int sample = 0; sample < 100; ++sample) {
    const AnyPose pose = reachable();
    const WorkingModes modes = working_modes(robot, pose, {}, work);
    ASSERT_TRUE(modes.report.ok());
    std::vector<double> inputs(work.inputs.size());
    for (std::size_t k = 0; static_cast<double>(k) < std::min(modes.count, 30.0); ++k) {
      modes.mode(robot, k, inputs);
      const Forward there = forward(robot, inputs, {.start = pose}, work);
      ASSERT_TRUE(there.ok()) << to_string(there.report);
      EXPECT_LE(there.report.residual, 1e-14);
      EXPECT_LT(motion(pose, there.pose).norm(), 1e-11);
      working_modes(robot, pose, {}, work);  // the views of `modes` are of this workspace
    }
  }
}

TEST_P(EveryRobot, ForwardFromAFarStartConvergesOrSaysWhyNot) {
  int converged = 0;
  constexpr int samples = 500;
  for (int sample = 0; sample < samples; ++sample) {
    inverse(robot, reachable(), {}, work);
    const std::vector<double> inputs = values(work.inputs);
    const AnyPose start = pose_near_home(robot, random, 0.3, dof(robot) == 3 ? 3 : 1);
    const Forward answer = forward(robot, inputs, {.start = start}, work);
    converged += answer.ok();
    const Reduced at = assemble(robot, answer.pose, values(answer.coordinates), work);
    EXPECT_NEAR(at.closure_error, answer.report.residual, 2e-15);
    EXPECT_EQ(answer.ok(), at.closure_error < 1e-12) << to_string(answer.report);
    EXPECT_EQ(answer.ok(), answer.report.message.empty());
  }
  if (dof(robot) == 3)
    EXPECT_EQ(converged, samples);  // where Newton's method stalls the sextic answers
  else
    EXPECT_GT(converged, samples * 8 / 10);
}

TEST_P(EveryRobot, BranchIsChosenAsAsked) {
  for (int sample = 0; sample < 200; ++sample) {
    const AnyPose pose = reachable();
    const WorkingModes modes = working_modes(robot, pose, {}, work);
    std::vector<double> inputs(work.inputs.size());
    modes.mode(robot, static_cast<std::size_t>(modes.count) / 2, inputs);
    ASSERT_TRUE(coordinates_from_inputs(robot, inputs, work).ok());
    const std::vector<double> coordinates = work.coordinates;
    // inputs as a start lead back to themselves
    const Inverse again = inverse(robot, pose, {.start = inputs}, work);
    ASSERT_TRUE(again.ok());
    for (std::size_t k = 0; k < inputs.size(); ++k) EXPECT_NEAR(again.inputs[k], inputs[k], 1e-12);
    if (!has_arc(robot)) continue;
    std::vector<double> wanted;
    std::vector<int> signs;
    for (const LegState& leg : leg_states(robot, pose, coordinates, work)) {
      wanted.push_back(leg.curvature);
      signs.push_back(leg.curvature < 0 ? -1 : 1);
    }
    ASSERT_TRUE(inverse(robot, pose, {.curvature = wanted}, work).ok());
    const std::vector<double> nearest = work.coordinates;
    const auto states = leg_states(robot, pose, nearest, work);
    for (std::size_t i = 0; i < legs; ++i) EXPECT_NEAR(states[i].curvature, wanted[i], 1e-12);
    ASSERT_TRUE(inverse(robot, pose, {.bending = signs}, work).ok());
    const std::vector<double> bent = work.coordinates;
    const auto bent_states = leg_states(robot, pose, bent, work);
    for (std::size_t i = 0; i < legs; ++i) {
      EXPECT_GE(bent_states[i].curvature * signs[i], 0);
      EXPECT_LE(std::abs(bent_states[i].curvature), std::abs(wanted[i]) + 1e-12);
    }
  }
}

TEST_P(EveryRobot, ElbowIsChosenAsAsked) {
  if (!has_elbow(robot)) GTEST_SKIP() << "none of its legs has one";
  for (int sample = 0; sample < 100; ++sample) {
    const AnyPose pose = reachable();
    std::vector<int> elbow(legs);
    for (std::size_t i = 0; i < legs; ++i) elbow[i] = random() % 2 ? 1 : -1;
    const Inverse answer = inverse(robot, pose, {.elbow = elbow}, work);
    ASSERT_TRUE(answer.ok());
    const auto states = leg_states(robot, pose, values(answer.coordinates), work);
    for (std::size_t i = 0; i < legs; ++i) EXPECT_EQ(states[i].elbow, elbow[i]);
    ASSERT_TRUE(inverse(robot, pose, {}, work).ok());
    for (const LegState& leg : leg_states(robot, pose, values(work.coordinates), work))
      EXPECT_EQ(leg.elbow, 1);
  }
}

TEST_P(EveryRobot, AllAssemblyModesCloseAndHoldTheOneKnown) {
  for (int sample = 0; sample < (dof(robot) == 3 ? 300 : 3); ++sample) {
    const AnyPose pose = reachable();
    ASSERT_TRUE(inverse(robot, pose, {}, work).ok());
    const std::vector<double> inputs = values(work.inputs);
    const AssemblyModes modes = assembly_modes(robot, inputs, work);
    ASSERT_TRUE(modes.report.ok()) << to_string(modes.report);
    EXPECT_LT(motion(modes.poses[nearest_pose(robot, modes.poses, pose)], pose).norm(), 1e-8);
    for (const AnyPose& mode : modes.poses)
      EXPECT_LT(assemble(robot, mode, work.coordinates, work).closure_error, 1e-12);
  }
}

TEST_P(EveryRobot, UnreachablePosesNameTheLegAndInputsOutsideTheDomainTheInput) {
  const Eigen::VectorXd away = Eigen::VectorXd::Unit(dof(robot), 0);
  const Inverse far = inverse(robot, moved(home(robot), away), {}, work);
  EXPECT_EQ(far.report.status, Status::unreachable);
  EXPECT_NE(far.report.message.view().find("legs[0]"), std::string_view::npos);
  ASSERT_TRUE(inverse(robot, reachable(), {}, work).ok());
  const std::vector<double> good = values(work.inputs);
  std::vector<double> bad = good;
  bad.back() = 1e10;
  const Forward folded = forward(robot, bad, {}, work);
  EXPECT_EQ(folded.report.status, Status::left_domain);
  EXPECT_NE(folded.report.message.view().find("inputs[" + std::to_string(bad.size() - 1) + "]"),
            std::string_view::npos);
  for (double& value : bad) {
    bad = good;
    value = std::nan("");
    EXPECT_EQ(forward(robot, bad, {}, work).report.status, Status::left_domain);
  }
  EXPECT_EQ(forward(robot, {0.19}, {}, work).report.status, Status::bad_input);
  const AnyPose nowhere = moved(home(robot), std::nan("") * away);
  EXPECT_EQ(inverse(robot, nowhere, {}, work).report.status, Status::left_domain);
  EXPECT_EQ(forward(robot, good, {.start = nowhere}, work).report.status, Status::left_domain);
}

INSTANTIATE_TEST_SUITE_P(Builtin, EveryRobot, testing::ValuesIn(builtin_robots(false)),
                         [](const auto& robot) { return "robot_" + std::to_string(robot.index); });

/// Legs 0 and 1 on one motor: a random robot, its pose for a known common curvature.
TEST(Inverse, TiedLegsAreSolvedTogether) {  // by whichever value closes them all, not leg by leg
  std::mt19937 random{5};
  for (int sample = 0; sample < 300; ++sample) {
    std::vector<FrrLeg> legs;
    const PlanarPose pose = random_pose(random);
    const auto platform = Planar::frame(pose);
    const double common = uniform(random, -20, 20), third = uniform(random, -20, 20);
    for (int i = 0; i < 3; ++i) {  // whatever the leg, its strut is made to fit
      FrrLeg leg = random_leg<FrrLeg>(random);
      leg.link.length = 0.2;
      leg.drive.offset = 0.005;
      const Vec2<double> tip = leg.base.point(leg.link.tip(i < 2 ? common : third).position);
      leg.closure.length = (platform.point(leg.platform_point) - tip).norm();
      legs.push_back(leg);
    }
    const Robot robot("tied", ParallelRobot<FrrLeg>(legs, {}, 0.05, std::array{-1, 0, -1}));
    Workspace work(robot);
    const Inverse answer = inverse(robot, pose, {}, work);
    ASSERT_TRUE(answer.ok()) << sample << " " << to_string(answer.report);
    EXPECT_LT(answer.report.residual, 1e-12);
    const std::array near{common, common, third};
    const Inverse known = inverse(robot, pose, {.curvature = near}, work);
    ASSERT_TRUE(known.ok());
    EXPECT_NEAR(known.coordinates[0], common, 1e-6);
    EXPECT_EQ(known.coordinates[0], known.coordinates[1]);
    const WorkingModes modes = working_modes(robot, pose, {}, work);
    EXPECT_GE(modes.count, 1);
  }
}

TEST(Inverse, TiedLegsNearStraightAgree) {  // κ is a square root there
  std::mt19937 random{6};
  for (int sample = 0; sample < 200; ++sample) {
    ParallelRobot<RfrLeg> model(rfr_legs(), {}, 0.05, std::array{-1, 0, -1});
    const double curvature = std::pow(10.0, uniform(random, -8, -2)),
                 chord = model.legs[0].link.chord(curvature);
    const PlanarPose pose{uniform(random, -0.01, 0.01), 0, uniform(random, -0.3, 0.3)};
    for (std::size_t i = 0; i < 2; ++i) {  // move the base points so that both legs have this chord
      auto& leg = model.legs[i];
      const Vec2<double> head = Planar::frame(pose).point(leg.platform_point);
      leg.base.p = head + chord * (leg.base.p - head).normalized();
    }
    const Robot robot("tied", model);
    Workspace work(robot);
    const Inverse answer = inverse(robot, pose, {}, work);
    ASSERT_TRUE(answer.ok()) << curvature << " " << to_string(answer.report);
    EXPECT_LT(answer.report.residual, 1e-12);
  }
}

TEST(Inverse, OptionsOfTheWrongSizeAreNamed) {
  const Robot robot = rfr_in_code();
  Workspace work(robot);
  const std::array<int, 2> two{1, 1};
  EXPECT_EQ(inverse(robot, PlanarPose{}, {.bending = two}, work).report.status, Status::bad_input);
  EXPECT_EQ(inverse(robot, PlanarPose{}, {.curvature = {1, 2, 3, 4}}, work).report.status, Status::bad_input);
}

TEST(Inverse, AFoldedLegAndATendonBeyondTheCentreAreNoSolutions) {
  Leg<Planar, Arc, TendonPair, Chord> leg{};
  leg.drive.offset = 0.005;
  std::array<Vec<double, 1>, 8> roots;
  for (const double length : {0.13, 0.2, 0.3, 0.41}) {
    leg.link.length = length;
    EXPECT_EQ(leg.solutions_at(Planar::frame({0, 0, 0}), {}, roots), 0) << length;
  }
  leg.link.length = 0.2;
  leg.drive.offset = 0.1;  // 1/d = 10 1/m
  EXPECT_EQ(leg.solutions_at(Planar::frame({0, leg.link.chord(9.9), 0}), {}, roots), 2);
  EXPECT_EQ(leg.solutions_at(Planar::frame({0, leg.link.chord(10.1), 0}), {}, roots), 0);
}

TEST(Inverse, DefaultIsTheSmallestCurvatureAndPositiveOfTwo) {
  const Robot robot = rfr_in_code();
  Workspace work(robot);
  const Inverse answer = inverse(robot, PlanarPose{0.01, 0, 0.1}, {}, work);
  ASSERT_TRUE(answer.ok());
  for (const double curvature : answer.coordinates) EXPECT_GT(curvature, 0);
}

TEST(Inverse, AStraightLegIsOneSolutionAtTheEdgeOfTheWorkspace) {
  Leg<Planar, Arc, TendonPair, Chord> leg{};
  leg.link.length = 0.2;
  leg.drive.offset = 0.005;
  std::array<Vec<double, 1>, 8> roots;
  ASSERT_EQ(leg.solutions_at(Planar::frame({0, 0.2, 1}), {}, roots), 1);
  EXPECT_EQ(roots[0][0], 0);
  EXPECT_EQ(leg.solutions_at(Planar::frame({0, 0.2 + 1e-15, 1}), {}, roots), 0);
  EXPECT_EQ(leg.solutions_at(Planar::frame({0, 0.2 - 1e-15, 1}), {}, roots), 2);
}

TEST(Forward,
     InputsThatNoPoseClosesAreUnreachable) {  // proven by the four bars of two legs, whatever the start
  std::mt19937 random{3};
  for (const char* name : {"3-rfr", "3-frr"}) {
    const Robot robot = load(name).value();
    Workspace work(robot);
    int proven = 0, stalled = 0;
    for (int sample = 0; sample < 500; ++sample) {
      const std::array inputs{uniform(random, 0.17, 0.23), uniform(random, 0.17, 0.23),
                              uniform(random, 0.17, 0.23)};
      const Forward answer = forward(robot, inputs, {}, work);
      proven += answer.report.status == Status::unreachable;
      stalled += answer.report.status == Status::stalled || answer.report.status == Status::iteration_limit;
      if (answer.report.status != Status::unreachable) continue;
      EXPECT_GT(answer.report.residual, 0);
      for (int start = 0; start < 10; ++start)  // no other start may contradict the proof
        EXPECT_FALSE(forward(robot, inputs, {.start = random_pose(random)}, work).ok());
    }
    EXPECT_GT(proven, 0) << name << " stalled " << stalled;
  }
}

TEST(Inverse, ACurvatureBeyondTheDomainIsAnsweredByTheNearestWithin) {
  auto legs = legs_of<RfrrLeg>(load("3-rfrr").value());
  for (RfrrLeg& leg : legs.legs) leg.drive.tendons.offset = 0.05;  // 1/d = 20 1/m
  const Robot robot("bent", legs);
  Workspace work(robot);
  const std::array<double, 3> wild{1000, -1000, 1000};
  const Inverse answer = inverse(robot, PlanarPose{}, {.curvature = wild}, work);
  ASSERT_TRUE(answer.ok()) << to_string(answer.report);
  EXPECT_NEAR(answer.coordinates[1], 20, 1e-9);
  EXPECT_NEAR(answer.coordinates[3], -20, 1e-9);
}

TEST(Forward, DoesNotDependOnTheUnitOfLength) {  // also where the legs leave a freedom
  std::mt19937 random{8};
  for (int sample = 0; sample < 300; ++sample) {
    std::vector<RfrLeg> legs = rfr_legs();
    legs.pop_back();
    const PlanarPose start = random_pose(random);
    std::vector<Status> statuses;
    for (const double unit : {1.0, 1e3}) {
      std::vector<RfrLeg> scaled = legs;
      for (RfrLeg& leg : scaled) {
        leg.base.p *= unit;
        leg.link.length *= unit;
        leg.drive.offset *= unit;
        leg.platform_point *= unit;
      }
      const Robot robot("2-RFR", ParallelRobot<RfrLeg>(scaled, {}, 0.05 * unit));
      Workspace work(robot);
      const Forward there = forward(robot, {0.19 * unit, 0.188 * unit},
                                    {.start = PlanarPose{start.x * unit, start.y * unit, start.phi}}, work);
      statuses.push_back(there.report.status);
    }
    EXPECT_EQ(statuses[0], statuses[1]) << sample;
  }
}

TEST(Forward, ConstraintsBeyondTheFreedomsNeedNotFitToRounding) {
  const Robot robot = load(std::string(source_folder) + "/examples/robots/four-legged.yaml").value();
  Workspace work(robot);
  ASSERT_TRUE(inverse(robot, PlanarPose{0.003, 0.001, 0.02}, {}, work).ok());
  std::vector<double> inputs = values(work.inputs);
  inputs[3] += 1e-11;
  const Forward near = forward(robot, inputs, {.max_iterations = 50}, work);
  EXPECT_TRUE(near.ok());
  EXPECT_GT(near.report.residual, 1e-13);
  inputs[3] += 1e-4;
  EXPECT_FALSE(forward(robot, inputs, {}, work).ok());
}

TEST(Forward, TraceTellsEveryIterate) {
  const Robot robot = rfr_in_code();
  Workspace work(robot);
  std::array<TraceStep, 50> trace{};
  const Forward answer = forward(robot, {0.193, 0.189, 0.187}, {.trace = trace}, work);
  ASSERT_TRUE(answer.ok());
  const auto last = static_cast<std::size_t>(answer.report.iterations);
  EXPECT_EQ(trace[last].residual, answer.report.residual);
  EXPECT_GT(trace[0].residual, 1e-3);
}

TEST(Forward, NoIterationsIsAnAnswerToo) {
  const Robot robot = rfr_in_code();
  Workspace work(robot);
  const Forward answer = forward(robot, {0.193, 0.189, 0.187}, {.max_iterations = 0}, work);
  EXPECT_EQ(answer.report.status, Status::iteration_limit);
  EXPECT_EQ(planar(answer.pose).x, 0);
}

}  // namespace kinematics_test
}  // namespace sinew::test
