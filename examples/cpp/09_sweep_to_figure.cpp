/// A sweep over the workspace of a robot on all cores, its table read back, and its figure:
///
///     09_sweep_to_figure && sinew plot workspace.csv --as contour --value worst -o workspace.svg
#include <cstdio>

#include "sinew/io/table.hpp"
#include "sinew/study/study.hpp"
#include "sinew/study/sweep.hpp"

/// One query of docs/protocol.md put at a grid of poses: docs/studies.md
constexpr const char* workspace = R"(sinew: 1
title: Worst condition number of the 3-RFR over all turns
robot: 3-rfr
query: {query: velocity, pose: {x: $x, y: $y, phi: $phi}}
axes:
  y: {from: -100 mm, to: 100 mm, count: 41}
  x: {from: -100 mm, to: 100 mm, count: 41}
  phi: {from: -15 deg, to: 15 deg, count: 7}
outputs: {condition: indices.condition_homogenised}
reduce:
  over: [phi]
  columns: {worst: {max: condition}, reached: part}
)";

int main() {
  if (!sinew::write_text(workspace, "workspace.yaml")) return 4;
  const auto study = sinew::read_study("workspace.yaml");
  if (!study) return std::puts(sinew::to_string(study.error()).c_str()), 2;

  const auto done = sinew::sweep(*study, {.output = "workspace.csv"});
  if (!done) return std::puts(sinew::to_string(done.error()).c_str()), 4;
  std::printf("%zu samples, %s\n", done->samples, done->sampler.c_str());
  std::fprintf(stderr, "%.3f s of computing on %d threads\n", done->computing, done->threads);

  // The columns by name; lengths in m, as everything.
  const sinew::Table table = sinew::read_result("workspace.csv").value();
  const auto* x = table.find("x");
  const auto* y = table.find("y");
  const auto* worst = table.find("worst");
  const auto* reached = table.find("reached");
  std::size_t best = 0, whole = 0;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    if (reached->values[row] < 1) continue;  // some turns are out of reach
    if (whole++ == 0 || worst->values[row] < worst->values[best]) best = row;
  }
  std::printf("%zu of %zu places allow all turns\n", whole, table.row_count());
  std::printf("best at x %.0f mm, y %.0f mm: condition number %.3f at worst\n", 1e3 * x->values[best],
              1e3 * y->values[best], worst->values[best]);
}

// Prints:
//   11767 samples, poses in lanes
//   52 of 1681 places allow all turns
//   best at x 0 mm, y 0 mm: condition number 1.414 at worst
