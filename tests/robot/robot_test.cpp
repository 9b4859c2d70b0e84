/// Robots as one kind: by which models their links are reckoned, and what a serial robot answers.
#include <gtest/gtest.h>

#include "robot/chains.hpp"
#include "sinew/sinew.hpp"

namespace sinew {
namespace robot_test {

Robot robot_of(const char* name) { return load(name).value(); }

TEST(RobotModel, OneRobotByTwoModels) {
  for (const char* name : {"3-rfr", "3-frr", "3-rfrr", "6-ufs"}) {
    const Robot arcs = robot_of(name);
    ASSERT_EQ(arcs.model(), Model::cc) << name;
    EXPECT_FALSE(bears_load(arcs)) << name;
    const Robot chains = arcs.as(Model::prb).value();
    EXPECT_EQ(chains.model(), Model::prb) << name;
    EXPECT_EQ(chains.name(), arcs.name());
    EXPECT_TRUE(bears_load(chains)) << name;
    EXPECT_EQ(input_count(chains), input_count(arcs)) << name;
    EXPECT_NE(chains.identity(), arcs.identity()) << "a workspace of one is not one of the other";
    EXPECT_EQ(chains.as(Model::cc)->model(), Model::cc) << name;
    EXPECT_EQ(arcs.as(Model::cc)->identity(), arcs.identity()) << "the same robot";
    with_chains(chains,
                [&](const auto& of) { EXPECT_EQ(static_cast<int>(of.legs.size()), leg_count(arcs)); });
  }
}

TEST(RobotModel, ModelsThatLinksDoNotHaveAreRefused) {
  for (const char* name : {"3pfs-g2", "3prs", "nottingham-tpcj"}) {
    const auto chains = robot_of(name).as(Model::prb);
    ASSERT_FALSE(chains) << name;
    EXPECT_FALSE(chains.error().empty()) << name;
  }
  EXPECT_FALSE(robot_of("3-rfr").as(Model::rod));
}

TEST(SerialRobotAsRobot, QuestionsOfPlatformsAreUnsupported) {
  const Robot robot = robot_of("nottingham-tpcj");
  Workspace work(robot);
  ASSERT_NE(work.serial, nullptr);
  EXPECT_TRUE(work.serial->fits(*robot.serial()));
  const AnyPose pose = SpatialPose{{0, 0, 0.1}, {1, 0, 0, 0}};
  for (const Report& report :
       {forward(robot, {}, {}, work).report, inverse(robot, pose, {}, work).report,
        velocity(robot, pose, {}, work).report, working_modes(robot, pose, {}, work).report}) {
    EXPECT_EQ(report.status, Status::unsupported);
    EXPECT_NE(report.message.view().find("robot.serial()"), std::string_view::npos);
  }
  EXPECT_EQ(equilibrium(robot, {}, {}, work).report.status, Status::unsupported);
  EXPECT_EQ(to_string(Status::unsupported), "unsupported");
}

}  // namespace robot_test
}  // namespace sinew
