/// All solutions: assembly modes of given lengths, working modes of a pose, equilibria of elastic rods, and
/// the curve that leads from one of them to the next.
#include <cstdio>
#include <string>

#include "sinew/sinew.hpp"

namespace {

/// Tendon-driven legs of constant curvature: all poses, and all ways to hold one.
void arcs() {
  const auto robot = sinew::load("3-rfr").value();
  sinew::Workspace work(robot);

  const auto modes = sinew::assembly_modes(robot, {0.193, 0.189, 0.187}, work);
  std::printf("%zu assembly modes, %s\n", modes.poses.size(), modes.is_complete ? "no more" : "perhaps more");
  for (const auto& any : modes.poses) {
    const auto& pose = std::get<sinew::PlanarPose>(any);
    std::printf("  x %8.3f mm, y %8.3f mm, phi %7.4f rad\n", 1e3 * pose.x, 1e3 * pose.y, pose.phi);
  }

  // Views into the workspace hold until its next use: what is to last is copied.
  const auto working = sinew::working_modes(robot, sinew::PlanarPose{0.01, 0, 0}, {}, work);
  std::printf("%.0f working modes of one pose\n", working.count);
  double inputs[3];
  working.mode(robot, std::size_t(working.count) - 1, inputs);
  std::printf("  the last: tendons %.3f, %.3f, %.3f mm\n", 1e3 * inputs[0], 1e3 * inputs[1], 1e3 * inputs[2]);
}

/// Elastic rods: equilibria found from many starts, a lower bound of their number.
void rods() {
  const auto robot = sinew::load("3pfs-g2").value();
  sinew::Workspace work(robot);
  std::puts("stable equilibria of the same lengths");
  for (const auto& found : sinew::equilibria(robot, {0.44, 0.42, 0.41}, {}, work))
    if (found.unstable_directions == 0)
      std::printf("  z %.2f mm, energy %.3f J\n", 1e3 * found.pose.position.z(), found.potential);

  // The first of them pressed down, by up to 200 N: beyond the fold there is no equilibrium nearby, and the
  // curve leads back to an unstable one.
  std::puts("pressed down");
  sinew::equilibrium(robot, {0.44, 0.42, 0.41}, {}, work);
  sinew::CurveOptions press;
  press.added_wrench << 0, 0, -200, 0, 0, 0;
  const auto curves = sinew::equilibrium_curves(robot, press, work);
  for (const auto& point : curves.front().points)
    if (point.event != sinew::CurveEvent::none)
      std::printf("  %s at %.1f N, z %.2f mm\n", std::string(sinew::to_string(point.event)).c_str(),
                  200 * point.parameter, 1e3 * point.pose.position.z());
}

}  // namespace

int main() {
  arcs();
  rods();
}

// Prints:
//   2 assembly modes, no more
//     x   12.079 mm, y  -17.443 mm, phi  0.1385 rad
//     x    2.544 mm, y  -21.064 mm, phi  1.9559 rad
//   8 working modes of one pose
//     the last: tendons 190.878, 191.704, 188.835 mm
//   stable equilibria of the same lengths
//     z 387.36 mm, energy 1.023 J
//     z 333.10 mm, energy 2.900 J
//     z 327.57 mm, energy 3.002 J
//     z 317.76 mm, energy 3.149 J
//   pressed down
//     begin at 0.0 N, z 387.36 mm
//     fold at 106.2 N, z 373.80 mm
//     begin at 0.0 N, z 322.31 mm
