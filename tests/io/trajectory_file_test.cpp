#include "io/table/trajectory_file.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "io/document/parse.hpp"
#include "io/table/posture_table.hpp"
#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/serial.hpp"

namespace sinew {
namespace trajectory_file_test {

std::vector<SerialPosture> some_postures(const SerialRobot& robot) {
  std::vector<SerialPosture> postures(4);
  for (std::size_t k = 0; k < postures.size(); ++k) {
    postures[k].stage = 1e-3 * static_cast<double>(k);
    for (std::size_t m = 0; m < robot.sections.size(); ++m)
      postures[k].bends.push_back(
          {0.02 * std::sin(static_cast<double>(k + m)), -0.01 * static_cast<double>(k)});
  }
  return postures;
}

Trajectory some_trajectory(const SerialRobot& robot) {
  return time_optimal_trajectory(robot, some_postures(robot), {}, 0.02);
}

TEST(TrajectoryTable, HasPosturesThatReadBackTheSame) {
  for (const char* name : {"nottingham-tpcj", "nottingham-neutral", "three-arcs"}) {
    const SerialRobot robot = load_serial(name).value();
    const Trajectory made = some_trajectory(robot);
    ASSERT_TRUE(made.report.ok()) << made.report.message.view();
    const Table table = trajectory_table(robot, made, kernel::Model::linear, {});
    const auto postures = read_postures(table, robot, "table").value();
    ASSERT_EQ(postures.size(), made.points.size());
    for (std::size_t k = 0; k < postures.size(); ++k) {
      EXPECT_EQ(postures[k].stage, made.points[k].posture.stage);
      for (std::size_t m = 0; m < robot.sections.size(); ++m)
        EXPECT_LT((postures[k].bends[m] - made.points[k].posture.bends[m]).norm(), 1e-15) << name;
    }
  }
}

/// Counts of `--set motor`: turns of the screw by the encoder's counts, of the model that was asked for.
TEST(TrajectoryTable, CountsAreThoseOfTheModel) {
  SerialRobot robot = load_serial("nottingham-tpcj").value();
  robot.motor = TendonMotor{2e-3, 4096, 1};
  const Trajectory made = some_trajectory(robot);
  for (const auto& [model, name] :
       {std::pair{kernel::Model::linear, "lsk"}, {kernel::Model::exact, "exact"}}) {
    const Table table = trajectory_table(robot, made, model, TendonMotor{5e-3, 2000, 1});
    for (std::size_t k = 0; k < table.row_count(); ++k) {
      EXPECT_EQ(table.find("stage_counts")->values[k],
                std::nearbyint(table.find("stage")->values[k] * 2000 / 5e-3));
      const std::string tendon = std::string("S4_") + name + "_3";
      EXPECT_EQ(table.find("S4_counts_3")->values[k],
                std::nearbyint(table.find(tendon)->values[k] * 4096 / 2e-3));
    }
  }
  EXPECT_FALSE(trajectory_table(load_serial("nottingham-tpcj").value(), made, kernel::Model::linear, {})
                   .find("S0_counts_1"));
}

TEST(TrajectoryTable, BothModelsAreThoseOfTheKinematics) {
  const SerialRobot robot = load_serial("nottingham-tpcj").value();
  const Trajectory made = some_trajectory(robot);
  const Table table = trajectory_table(robot, made, kernel::Model::linear, {});
  SerialWorkspace work(robot);
  const std::size_t last = made.points.size() - 1;
  tendon_changes(made.points[last].posture.bends, kernel::Model::exact, work);
  EXPECT_EQ(table.find("S2_exact_1")->values[last], work.changes[6]);
  tendon_changes(made.points[last].posture.bends, kernel::Model::linear, work);
  EXPECT_EQ(table.find("S2_lsk_1")->values[last], work.changes[6]);
}

TEST(RosTrajectory, IsYamlWithAPointForEachTime) {
  for (const char* name : {"nottingham-tpcj", "nottingham-neutral"}) {
    const SerialRobot robot = load_serial(name).value();
    const Trajectory made = some_trajectory(robot);
    const auto read = parse_yaml(ros_trajectory(robot, made), "ros");
    ASSERT_TRUE(read) << name;
    EXPECT_EQ(read->root.find("joint_names")->items.size(), 11U);
    const auto& points = read->root.find("points")->items;
    ASSERT_EQ(points.size(), made.points.size());
    for (std::size_t k = 0; k < points.size(); ++k) {
      for (const char* list : {"positions", "velocities", "accelerations"})
        EXPECT_EQ(points[k].find(list)->items.size(), 11U);
      const Node& time = *points[k].find("time_from_start");
      EXPECT_NEAR(time.find("sec")->number + 1e-9 * time.find("nanosec")->number, made.points[k].time, 1e-9);
      EXPECT_EQ(points[k].find("positions")->items[3].number, made.points[k].posture.bends[1][0]);
    }
  }
}

}  // namespace trajectory_file_test
}  // namespace sinew
