#include <gtest/gtest.h>

#include <cmath>

#include "sinew/robot.hpp"
#include "sinew/solve.hpp"

namespace sinew::test {

TEST(RailDomain, SlidesBeyondTheRailsDomainAreNoSolution) {  // rails of 1e9 m, a robot of that size
  Document document = read_robot_file("3prs").value();
  const auto huge = [&](const std::string& path, double metres) {
    document = with(document, path, make_node(metres)).value();
  };
  huge("platform.radius", 1.25e8);
  huge("platform.home.position[2]", 5e8);
  huge("defaults.closure.length", 3.5e8);
  for (const char* leg : {"legs[0]", "legs[1]", "legs[2]"}) {
    huge(std::string(leg) + ".base.point.radius", 2.5e8);
    huge(std::string(leg) + ".platform_point.radius", 1.25e8);
  }
  const Robot robot = read_robot(document).value();
  Workspace work(robot);
  const double below = std::sqrt(3.5 * 3.5 - 1.25 * 1.25) * 1e8;  // the platform
  for (const double z : {5e8, 1.2e9, -6e8}) {
    const Inverse within = inverse(robot, SpatialPose{{0, 0, z}, {1, 0, 0, 0}}, {}, work);
    ASSERT_TRUE(within.ok()) << to_string(within.report);
    for (const double slide : within.inputs) EXPECT_NEAR(slide, z - below, 1);
  }
  for (const double z : {1.4e9, -7e8, 3e9}) {  // slides of 1.03e9 m and more
    const Inverse beyond = inverse(robot, SpatialPose{{0, 0, z}, {1, 0, 0, 0}}, {}, work);
    EXPECT_FALSE(beyond.ok()) << z;
    const std::string said(beyond.report.message.view());
    EXPECT_NE(said.find("puts the carriage further away than 1e9 m along its rail"), said.npos) << said;
    EXPECT_EQ(said.find("strut"), said.npos) << said;
  }
}

}  // namespace sinew::test
