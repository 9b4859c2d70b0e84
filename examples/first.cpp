/// The ten lines of the README: a pose, its tendons, and back.
#include <cstdio>

#include "sinew/sinew.hpp"

int main() {
  auto robot = sinew::load("3-rfr").value();  // or a file: "robots/3-rfr.yaml"
  sinew::Workspace work(robot);               // all memory, once; one per thread

  auto there = sinew::inverse(robot, sinew::PlanarPose{0.010, -0.005, 0.1}, {}, work);
  std::printf("tendons %.3f %.3f %.3f mm\n", 1e3 * there.inputs[0], 1e3 * there.inputs[1],
              1e3 * there.inputs[2]);

  auto back = sinew::forward(robot, {0.193, 0.189, 0.187}, {}, work);  // no heap, no throw, bounded steps
  if (!back.ok()) return 3;
  auto pose = std::get<sinew::PlanarPose>(back.pose);
  std::printf("pose %.3f mm, %.3f mm, %.4f rad\n", 1e3 * pose.x, 1e3 * pose.y, pose.phi);
}
