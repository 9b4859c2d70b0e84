/// The ten lines of the README: a pose from three tendon lengths, and a pose out of reach.
#include <cstdio>

#include "sinew/sinew.hpp"

int main() {
  auto robot = sinew::load("3-rfr");  // or a file: "robots/3-rfr.yaml"
  if (!robot) return std::puts(sinew::to_string(robot.error()).c_str()), 2;
  sinew::Workspace work(*robot);  // all memory, once; one per thread

  auto at = sinew::forward(*robot, {0.193, 0.189, 0.187}, {}, work);  // no heap, no throw, bounded steps
  auto pose = std::get<sinew::PlanarPose>(at.pose);
  std::printf("x %.3f mm, y %.3f mm, phi %.4f rad\n", 1e3 * pose.x, 1e3 * pose.y, pose.phi);

  auto far = sinew::inverse(*robot, sinew::PlanarPose{0.3, 0, 0}, {}, work);
  if (!far.ok()) std::puts(sinew::to_string(far.report).c_str());
}

// Prints:
//   x 12.079 mm, y -17.443 mm, phi 0.1385 rad
//   unreachable: legs[0] needs a chord of 380.895 mm, its backbone is 200 mm long
