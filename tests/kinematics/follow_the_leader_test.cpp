/// A robot that advances along the curve that its tip draws.
#include "sinew/kinematics/trajectory.hpp"

#include <gtest/gtest.h>

#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/serial.hpp"

namespace sinew::test {
namespace follow_the_leader_test {

using Bends = std::vector<Bend>;

SerialRobot robot_named(const char* name) { return *load_serial(name); }
double length_of(const SerialRobot& robot) {
  double length = 0;
  for (const Section& section : robot.sections) length += section.length();
  return length;
}

TEST(FollowTheLeader, NoWayChangesNothing) {
  const SerialRobot robot = robot_named("nottingham-tpcj");
  const Bends bends{{.1, 0}, {0, .1}, {-.2, 0}, {.05, .05}, {.1, -.1}};
  FollowTheLeader follower(robot);
  follower.begin(bends);
  const Bends now = follower.advance(0, bends.back());
  for (std::size_t m = 0; m < bends.size(); ++m) EXPECT_LT((now[m] - bends[m]).norm(), 1e-14);
}

/// By a section's length each section has the bend of the next one, and in many steps as in one.
TEST(FollowTheLeader, SectionsTakeOverFromThoseBeforeThem) {
  for (const char* name : {"nottingham-tpcj", "nottingham-neutral"}) {
    const SerialRobot robot = robot_named(name);
    const std::size_t count = robot.sections.size();
    Bends bends;
    for (std::size_t m = 0; m < count; ++m) {
      EXPECT_NEAR(robot.sections[m].length(), robot.sections[0].length(), 1e-12);
      bends.emplace_back(0.02 * static_cast<double>(m), -0.01 * static_cast<double>(m * m));
    }
    const Bend leader(0.1, 0.2);
    const double length = robot.sections[0].length();
    FollowTheLeader at_once(robot), slowly(robot);
    at_once.begin(bends);
    slowly.begin(bends);
    const Bends now = at_once.advance(length, leader);
    Bends then;
    for (int i = 0; i < 1000; ++i) then = slowly.advance(length / 1000, leader);
    for (std::size_t m = 0; m < count; ++m) {
      EXPECT_LT((now[m] - (m + 1 < count ? bends[m + 1] : leader)).norm(), 1e-12);
      EXPECT_LT((then[m] - now[m]).norm(), 1e-9);
    }
  }
}

/// The ends of sections come to where ends were one section before, for a robot that began straight.
TEST(FollowTheLeader, BodyStaysOnTheCurveOfItsTip) {
  const SerialRobot robot = robot_named("nottingham-neutral");
  const std::size_t count = robot.sections.size();
  ASSERT_GT(count, 1u);
  FollowTheLeader follower(robot);
  follower.begin(Bends(count, Bend(0, 0)));
  const double length = robot.sections[0].length();
  SerialWorkspace work(robot);
  std::vector<Vec3<double>> before;
  double stage = 0;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const Bends bends = follower.advance(length, Bend(0.3, 0.1 * static_cast<double>(i)));
    stage += length;
    section_ends(bends, work);
    std::vector<Vec3<double>> ends;
    for (const auto& end : work.ends) ends.push_back(end.p + Vec3<double>(0, 0, stage));
    for (std::size_t m = 0; m + 1 < count && !before.empty(); ++m)
      EXPECT_LT((ends[m] - before[m + 1]).norm(), 1e-12 * length_of(robot)) << i << ' ' << m;
    before = ends;
  }
}

}  // namespace follow_the_leader_test
}  // namespace sinew::test
