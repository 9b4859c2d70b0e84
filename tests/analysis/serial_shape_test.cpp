#include "sinew/analysis/shape.hpp"

#include <gtest/gtest.h>

#include "serial_robots.hpp"

namespace sinew::test {
namespace serial_shape_test {

class SerialShapes : public testing::TestWithParam<kernel::Backbone> {
 protected:
  SerialRobot robot = nottingham(GetParam());
  SerialWorkspace work{robot};
  std::mt19937 random{5};
};

TEST_P(SerialShapes, EndWhereTheSectionsDo) {
  for (int k = 0; k < 20; ++k) {
    const auto bends = random_bends(robot, random);
    const SerialShape shape = serial_shape(robot, bends, 4);
    section_ends(bends, work);
    for (std::size_t m = 0; m < bends.size(); ++m) {
      EXPECT_LT((shape.ends[m].p - work.ends[m].p).norm(), 1e-15);
      EXPECT_LT((shape.ends[m].R.matrix() - work.ends[m].R.matrix()).norm(), 1e-13);
      EXPECT_LT((shape.backbones[m].back() - work.ends[m].p).norm(), 1e-15);
    }
    EXPECT_EQ(shape.discs.size(), 40U);
  }
}

/// Drawn tendons have the lengths that the kernel gives them: straight spans between the discs, nothing else
/// changes.
TEST_P(SerialShapes, HaveTendonsOfTheLengthsOfExactPcc) {  // @verifies LSK (1), (2), (5)
  for (int k = 0; k < 20; ++k) {
    const auto bends = random_bends(robot, random);
    const SerialShape shape = serial_shape(robot, bends, 2);
    tendon_changes(bends, kernel::Model::exact, work);
    std::size_t tendon = 0;
    for (std::size_t m = 0; m < bends.size(); ++m)
      for (const auto& line : shape.tendons[m]) {
        double spans = 0;
        for (std::size_t i = 0; i + 1 < line.size(); i += 2) spans += (line[i + 1] - line[i]).norm();
        const double straight = static_cast<double>(m + 1) * robot.sections[m].arc_length();
        EXPECT_NEAR(spans - straight, work.changes[tendon++], 1e-15);
      }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, SerialShapes,
                         testing::Values(kernel::Backbone::twin_pivot, kernel::Backbone::neutral));

}  // namespace serial_shape_test
}  // namespace sinew::test
