#include "plan/insertion_figure.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "scenes.hpp"

namespace sinew {
namespace insertion_figure_test {

using test::compressor_of;
using test::named;
using test::open_scene;

std::vector<InsertionStep> straight(const InsertionScene& scene, int count) {
  std::vector<InsertionStep> steps(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    steps[static_cast<std::size_t>(k)].stage = 1e-3 * k;
    steps[static_cast<std::size_t>(k)].bends.assign(scene.robot.sections.size(), Bend(0, 0));
  }
  return steps;
}

double largest(const std::vector<double>& values) {
  double most = -1e9;
  for (const double x : values)
    if (std::isfinite(x)) most = std::max(most, x);
  return most;
}

TEST(InsertionFigure, ShowsEveryPhaseInBothViews) {
  InsertionScene scene = open_scene();
  scene.solids.push_back(named(box_mesh({0.01, 0.02, 0.04}), "box", {0.02, 0, 0.01}));
  const auto steps = straight(scene, 41);
  const InsertionCheck check = check_insertion(scene, steps);
  const Figure figure = insertion_phases(scene, steps, check, 4);
  ASSERT_EQ(figure.panels.size(), 8U);
  EXPECT_EQ(figure.columns, 4);
  for (std::size_t k = 0; k < 4; ++k) {
    // the tip is where the stage is; the tube ends there
    const Panel& side = figure.panels[4 + k];
    double tip = -1e9;
    for (std::size_t s = 1; s < side.series.size(); ++s)
      if (side.series[s].mark == Mark::polygon) tip = std::max(tip, largest(side.series[s].y));
    EXPECT_NEAR(tip, 10.0 * static_cast<double>(k + 1), 1e-6);
    // a box seen from a side: four edges twice; all of them sharp
    EXPECT_NEAR(largest(side.series[0].x), 25, 1e-9);
    EXPECT_NEAR(largest(side.series[0].y), 30, 1e-9);
  }
}

/// Axes that lie askew, no solid, no step, a robot that is nowhere near: a figure all the same.
TEST(InsertionFigure, IsThereForAnyScene) {
  InsertionScene scene = open_scene("nottingham-neutral");
  EXPECT_TRUE(insertion_phases(scene, {}, {}, 4).panels.empty());
  scene.axis = Vec3<double>(1, 1, 1) / std::sqrt(3.0);
  const auto steps = straight(scene, 3);
  for (const int phases : {1, 2, 7}) {
    const Figure figure = insertion_phases(scene, steps, {}, phases);
    EXPECT_EQ(figure.panels.size(), 2U * static_cast<std::size_t>(phases));
    EXPECT_FALSE(gnuplot_script(figure, "way").empty());
  }
  EXPECT_EQ(insertion_curves(scene, {}, {}).panels.size(), 3U);
  EXPECT_FALSE(insertion_curves(scene, {steps.data(), 1}, {}).panels[1].x.high);  // one stage is no range
  const std::vector<InsertionStep> out(steps.rbegin(), steps.rend());
  EXPECT_EQ(insertion_curves(scene, out, {}).panels[1].x.high, 2.0);
}

TEST(InsertionFigure, CurvesAreThoseOfThePlan) {
  InsertionScene scene = compressor_of({});
  auto steps = straight(scene, 5);
  steps[2].bends[3] = Bend(0.1, -0.2);
  const InsertionCheck check = check_insertion(scene, steps);
  const Figure figure = insertion_curves(scene, steps, check);
  EXPECT_NEAR(figure.panels[1].series[3].y[2], 0.1 * 180 / M_PI, 1e-12);
  EXPECT_NEAR(figure.panels[2].series[3].y[2], -0.2 * 180 / M_PI, 1e-12);
  for (std::size_t k = 0; k < steps.size(); ++k)
    EXPECT_NEAR(figure.panels[0].series[0].y[k], 1e3 * check.steps[k].spot.distance, 1e-12);
}

}  // namespace insertion_figure_test
}  // namespace sinew
