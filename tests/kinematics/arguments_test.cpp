/// Arguments that do not fit the robot: they are answered, by `bad_input` or by numbers that are none, and
/// nothing is read or written beyond its end.
#include <gtest/gtest.h>

#include <cmath>

#include "every_robot.hpp"
#include "kinematics/chains/chain_motion.hpp"
#include "serial_robots.hpp"
#include "sinew/analysis/singularity.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/equilibrium.hpp"
#include "sinew/kinematics/equilibrium_curve.hpp"
#include "sinew/kinematics/forward.hpp"
#include "sinew/kinematics/serial.hpp"
#include "sinew/sinew.hpp"

namespace sinew {
namespace arguments_test {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
const AnyPose planar = PlanarPose{0.01, 0, 0}, spatial = SpatialPose{{0, 0, 0.2}, {1, 0, 0, 0}};

bool is_planar(const Robot& robot) { return std::holds_alternative<PlanarPose>(home(robot)); }
const AnyPose& other_space(const Robot& robot) { return is_planar(robot) ? spatial : planar; }

std::vector<double> numbers(int count) { return std::vector<double>(static_cast<std::size_t>(count), 0.4); }

/// Counts the answers that say `bad_input`; all others are errors.
struct Asked {
  int count = 0;
  void refused(const Report& report, const Robot& robot, const char* what) {
    ++count;
    EXPECT_EQ(report.status, Status::bad_input) << robot.name() << ": " << what << ": " << to_string(report);
    EXPECT_FALSE(report.message.empty()) << robot.name() << ": " << what;
  }
};

/// Every typed question, with this pose and this workspace, at least one of which does not fit.
void ask_all(const Robot& robot, const AnyPose& pose, Workspace& work, Asked& asked, bool is_pose_wrong) {
  const std::vector<double> inputs = numbers(input_count(robot)), q = numbers(coordinate_count(robot)),
                            twist = numbers(dof(robot));
  asked.refused(forward(robot, inputs, {.start = pose}, work).report, robot, "forward");
  asked.refused(inverse(robot, pose, {}, work).report, robot, "inverse");
  asked.refused(working_modes(robot, pose, {}, work).report, robot, "working_modes");
  asked.refused(velocity(robot, pose, q, work).report, robot, "velocity");
  asked.refused(type_2_distance(robot, pose, twist, {}, work).report, robot, "type_2_distance");
  Track track(robot, {}, work);
  asked.refused(track.advance(pose), robot, "track");
  EXPECT_TRUE(std::isinf(assemble(robot, pose, q, work).closure_error)) << robot.name();
  EXPECT_TRUE(leg_states(robot, pose, q, work).empty()) << robot.name();
  EXPECT_FALSE(map_sample(robot, pose, {}, work).is_reachable);
  EXPECT_TRUE(singularity_map(robot, PoseGrid::at(pose), {}, work).samples.empty());
  std::visit([](const auto& shape) { EXPECT_TRUE(shape.backbones.empty()); },
             any_shape(robot, pose, is_pose_wrong ? q : std::vector<double>(), 5));
  std::vector<double> modes = numbers(input_count(robot));
  working_modes(robot, pose, {}, work).mode(robot, 0, modes);
  EXPECT_TRUE(std::isnan(modes[0]));
  nearest_pose(robot, std::span(&pose, 1), pose);
  project_to_constraints(robot, pose);
}

void ask_rods(const Robot& robot, Workspace& work, Asked& asked) {
  const std::vector<double> inputs = numbers(input_count(robot)), six = numbers(6);
  const SpatialWrench load = SpatialWrench::Ones();
  asked.refused(equilibrium(robot, inputs, {}, work).report, robot, "equilibrium");
  asked.refused(inverse_equilibrium(robot, IndependentPose{0.4, 0, 0}, {}, work).report, robot, "tilt");
  asked.refused(inverse_equilibrium(robot, std::get<SpatialPose>(spatial), {}, work).report, robot, "pose");
  EXPECT_TRUE(equilibria(robot, inputs, {}, work).empty());
  EXPECT_TRUE(equilibrium_curves(robot, {.added_wrench = load}, work).empty());
  EXPECT_EQ(follow_load(robot, load, 10, work).load, 0);
  EXPECT_TRUE(analyse_equilibrium(robot, work).rods.empty());
  EXPECT_FALSE(sense_wrench(robot, inputs, six, six, {}, work).report.ok());
  std::vector<SpatialPose> poses(1);
  std::vector<Status> statuses(1, Status::converged);
  equilibrium_batch(robot, inputs, load, poses, statuses, work);
  EXPECT_NE(statuses[0], Status::converged);
}

TEST(Arguments, APoseOfTheOtherSpaceIsAnsweredByEveryQuestion) {
  Asked asked;
  for (const std::string_view name : test::parallel_robot_names()) {
    const Robot robot = load(std::string(name)).value();
    Workspace work(robot);
    ask_all(robot, other_space(robot), work, asked, true);
    EXPECT_TRUE(std::isnan(std::get<PlanarPose>(between(planar, spatial, 0.5)).x));
  }
  RecordProperty("questions", asked.count);
}

TEST(Arguments, AWorkspaceOfAnotherRobotIsAnsweredByEveryQuestion) {
  Asked asked;
  const auto names = test::parallel_robot_names();
  for (const std::string_view name : names)
    for (const std::string_view other : names) {
      if (name == other) continue;
      const Robot robot = load(std::string(name)).value(), another = load(std::string(other)).value();
      Workspace work(another);
      ask_all(robot, home(robot), work, asked, false);
      if (bears_load(robot)) ask_rods(robot, work, asked);
    }
  RecordProperty("questions", asked.count);
}

/// The legs of a robot, each so often.
Robot many_times(const Robot& robot, int times) {
  const auto repeated = [&](auto legs) {
    const auto once = legs.legs;
    for (int k = 1; k < times; ++k) legs.legs.insert(legs.legs.end(), once.begin(), once.end());
    return decltype(legs)(legs.legs, legs.home, legs.platform_radius);
  };
  return robot.planar() ? Robot("many", repeated(*robot.planar()))
                        : Robot("many", repeated(*robot.spatial()));
}

TEST(Arguments, RobotsOfMoreLegsThanTheBuildCarriesAreAnswered) {
  Asked asked;
  for (const char* name : {"3-rfr", "3prs", "6-ufs", "3pfs-g2", "hexapod", "hexapod-heavy", "2prs-1pfs"}) {
    const Robot robot = many_times(load(name).value(), 12);
    Workspace work(robot);
    ask_all(robot, home(robot), work, asked, false);
    if (bears_load(robot)) ask_rods(robot, work, asked);
    std::visit([](const auto& shape) { EXPECT_TRUE(shape.backbones.empty()); },
               any_shape(robot, home(robot), numbers(coordinate_count(robot)), 5));
    EXPECT_FALSE(constrained_pose(robot, {0.4, 0.1, 0}).ok());
  }
}

TEST(Arguments, TheSameFileOpenedTwiceIsTwoRobots) {
  const Robot one = load("3pfs-g2").value(), other = load("3pfs-g2").value(), copy = one;
  Workspace work(one);
  const std::vector<double> inputs{0.44, 0.42, 0.41};
  EXPECT_EQ(equilibrium(other, inputs, {}, work).report.status, Status::bad_input);
  EXPECT_TRUE(equilibrium(one, inputs, {}, work).report.ok());
  EXPECT_TRUE(equilibrium(copy, inputs, {}, work).report.ok());
}

TEST(Arguments, SpansOfAnotherLengthAreAnswered) {
  Asked asked;
  for (const std::string_view name : test::parallel_robot_names()) {
    const Robot robot = load(std::string(name)).value();
    Workspace work(robot);
    const AnyPose at = home(robot);
    for (const int more : {-1, 1, 40}) {
      const std::vector<double> inputs = numbers(input_count(robot) + more),
                                q = numbers(coordinate_count(robot) + more),
                                twist = numbers(dof(robot) + more);
      const std::vector<int> signs(static_cast<std::size_t>(leg_count(robot) + more), 1);
      EXPECT_FALSE(forward(robot, inputs, {}, work).report.ok());
      EXPECT_FALSE(forward(robot, {}, {}, work).report.ok());
      asked.refused(velocity(robot, at, q, work).report, robot, "coordinates");
      asked.refused(type_2_distance(robot, at, twist, {}, work).report, robot, "direction");
      EXPECT_FALSE(inverse(robot, at, {.bending = signs}, work).report.ok());
      EXPECT_FALSE(inverse(robot, at, {.curvature = q}, work).report.ok());
      EXPECT_FALSE(inverse(robot, at, {.elbow = signs}, work).report.ok());
      EXPECT_FALSE(inverse(robot, at, {.start = inputs}, work).report.ok());
      const Velocity here = velocity(robot, at, work.coordinates, work);
      asked.refused(rates(here, twist, work), robot, "twist");
      std::visit([](const auto& shape) { EXPECT_TRUE(shape.backbones.empty()); }, any_shape(robot, at, q, 5));
    }
  }
}

TEST(Arguments, ChainsOfAnotherRobotAreAnswered) {
  for (const char* name : {"3-rfr", "3-frr", "3-rfrr", "6-ufs"}) {
    with_chains(load(name)->as(Model::prb).value(), [&]<class Chains>(const Chains& chains) {
      using Space = typename Chains::Space;
      Chains robot = chains;
      ChainState<Space> state;
      ChainWork work;
      const typename Space::Pose pose{};
      const Vec<double, Space::dof> wrench = Vec<double, Space::dof>::Zero();
      for (const std::size_t legs : {std::size_t{0}, robot.legs.size() - 1, robot.legs.size() + 1}) {
        state.legs.resize(legs);
        state.hold.resize(legs);
        const std::vector<double> curvature(legs, 2.0);
        EXPECT_EQ(equilibrium(robot, state.hold, wrench, state, work).status, Status::bad_input);
        EXPECT_EQ(follow_load(robot, wrench, 1, state, work).report.status, Status::bad_input);
        EXPECT_FALSE(inverse_statics(robot, wrench, state, work).ok());
        EXPECT_EQ(follow_least_norm(robot, pose, pose, state.legs).status, Status::bad_input);
        EXPECT_TRUE(std::isnan(smallest_hessian_eigenvalue(robot, state)));
        EXPECT_TRUE(std::isnan(potential(robot, state)));
        EXPECT_TRUE(std::isnan(constant_curvature_energy_gap(robot, state, wrench)));
        EXPECT_TRUE(std::isnan(stiffness(robot, state, work)(0, 0)));
        EXPECT_TRUE(std::isnan(compliance(robot, state, work)(0, 0)));
        EXPECT_TRUE(std::isnan(linear_compliance(robot, state)(0, 0)));
        EXPECT_TRUE(std::isnan(chain_rates(robot, pose, state.legs).closure_error));
        ChainState<Space> at_rest;
        EXPECT_EQ(unloaded_equilibrium(robot, pose, curvature, false, at_rest).status, Status::bad_input);
      }
    });
  }
}

TEST(Arguments, SerialQuestionsOfAnotherRobotAreAnswered) {
  const SerialRobot five = load_serial("nottingham-tpcj").value(), three = load_serial("three-arcs").value();
  SerialWorkspace work(five), other(three);
  const std::vector<Bend> bends(5, Bend(0.1, 0)), two(2, Bend(0.1, 0)), many(13, Bend(0.1, 0));
  const TipTarget target{.position = {0.01, 0, 0.1}};
  const auto model = kernel::Model::exact;
  EXPECT_EQ(inverse(five, target, {}, other).report.status, Status::bad_input);
  EXPECT_EQ(inverse(five, target, {.start = two}, work).report.status, Status::bad_input);
  EXPECT_EQ(inverse(five, {.position = {nan, 0, 0}}, {}, work).report.status, Status::bad_input);
  EXPECT_EQ(
      inverse(five, {.position = {0, 0, 0.1}, .direction = Vec3<double>(0, 0, 0)}, {}, work).report.status,
      Status::bad_input);
  EXPECT_EQ(bends_of_changes(five, std::vector<double>(3), model, work).status, Status::bad_input);
  EXPECT_EQ(bends_of_changes(five, std::vector<double>(15), model, other).status, Status::bad_input);
  EXPECT_EQ(check_limits(five, many).status, Status::bad_input);
  EXPECT_EQ(check_limits(five, bends, std::vector<double>(2)).status, Status::bad_input);
  EXPECT_EQ(resolved_rate(five, two, {}, {}, work).report.status, Status::bad_input);
  EXPECT_EQ(resolved_rate(five, bends, {}, {}, other).report.status, Status::bad_input);
  for (const std::span<const Bend> wrong :
       {std::span<const Bend>(), std::span<const Bend>(two), std::span<const Bend>(many)}) {
    tendon_changes(wrong, model, work);
    EXPECT_TRUE(std::isnan(work.changes[0]));
    section_ends(wrong, work);
    EXPECT_TRUE(std::isnan(work.ends[0].p[0]));
    tip_motion(wrong, work);
    EXPECT_TRUE(std::isnan(work.J[0]));
    tendon_rates(wrong, model, work);
    EXPECT_TRUE(std::isnan(work.K[0]));
    extension_motion(wrong, model, work);
    EXPECT_TRUE(std::isnan(work.extension_jacobians[0].tendons));
    EXPECT_TRUE(std::isnan(pull_of_all(wrong, model, work).x));
    EXPECT_TRUE(serial_shape(five, wrong, 5).backbones.empty());
  }
  std::vector<double> changes(15);
  tendon_changes_batch(std::vector<double>(9), model, changes, work);
  EXPECT_TRUE(std::isnan(changes[0]));
  add_slack(std::vector<double>(2), work);
  EXPECT_TRUE(std::isnan(work.changes[0]));
  set_extensions(five, std::vector<double>(2), work);
  EXPECT_TRUE(std::isnan(work.extensions[0]));
}

}  // namespace arguments_test
}  // namespace sinew
