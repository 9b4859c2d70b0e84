/// Frontiers of exact PCC are drawn by chords that keep to them.
#include <gtest/gtest.h>

#include <algorithm>

#include "sinew/io/robot_file.hpp"
#include "sinew/kinematics/serial.hpp"
#include "sinew/tendon/diagram.hpp"

namespace sinew {
namespace frontier_test {

using Point = Vec2<double>;

double distance(const Curve& chords, const Point& x) {
  double least = 1e9;
  for (std::size_t k = 1; k < chords.size(); ++k) {
    const Point along = chords[k] - chords[k - 1];
    const double share = std::clamp((x - chords[k - 1]).dot(along) / along.squaredNorm(), 0.0, 1.0);
    least = std::min(least, (x - chords[k - 1] - share * along).norm());
  }
  return least;
}

TEST(Frontier, ChordsKeepToItWithinTheDeviation) {
  const SerialRobot robot = load_serial("nottingham-tpcj").value();
  SerialWorkspace work(robot);
  for (const Bend& bend : {Bend(0, 0), Bend(0.3, -0.2), Bend(-0.4, 0.4)}) {
    const std::vector<Bend> bends(5, bend);
    tendon_changes(bends, kernel::Model::exact, work);
    DiagramQuestion question;
    question.section = robot.sections[0].map();
    question.envelope = {Envelope::Kind::square, robot.sections[0].limit};
    question.tolerance = 5e-5;
    question.model = kernel::Model::exact;
    question.tendons = {std::span(work.directions).first(3), std::span(work.changes).first(3)};
    const SectionDiagram drawn = section_diagram(question);
    question.deviation = 1e-9;  // as fine as they become
    const SectionDiagram dense = section_diagram(question);
    ASSERT_EQ(drawn.curves.size(), 3u) << to_string(drawn.report);
    ASSERT_EQ(dense.curves.size(), 3u) << to_string(dense.report);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_GT(dense.curves[i].size(), 200u);
      EXPECT_LT(drawn.curves[i].size(), 50u);
      for (const Point& x : dense.curves[i]) EXPECT_LT(distance(drawn.curves[i], x), 1.5e-4);
    }
  }
}

}  // namespace frontier_test
}  // namespace sinew
