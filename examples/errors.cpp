/// What can go wrong, and how it is told: files, arguments, questions without an answer, a deadline.
#include <atomic>
#include <cstdio>

#include "sinew/kinematics/equilibrium.hpp"
#include "sinew/sinew.hpp"

int main() {
  // A file: every error at once, each with place, what was found, the rule and the way out. Nothing throws.
  const auto missing = sinew::load("no-such-robot");
  if (!missing) std::printf("%s\n", missing.error().front().code.c_str());

  const auto robot = sinew::load("3-rfr").value();
  sinew::Workspace work(robot);

  // A pose out of reach: an answer, with the reason.
  const auto far = sinew::inverse(robot, sinew::PlanarPose{0.3, 0, 0}, {}, work);
  std::printf("%s\n", sinew::to_string(far.report).c_str());

  // Arguments that do not fit the robot.
  const auto wrong = sinew::forward(robot, {0.19, 0.19}, {}, work);
  std::printf("%s\n", sinew::to_string(wrong.report).c_str());

  // A bound on the work: the best iterate comes back with its residual, and says that it is no solution.
  const auto hasty = sinew::forward(robot, {0.193, 0.189, 0.187}, {.max_iterations = 1}, work);
  std::printf("%s\n", std::string(sinew::to_string(hasty.report.status)).c_str());

  // Another thread, or a signal handler, may stop a solve: of rods here, which takes the longest.
  const auto rods = sinew::load("3pfs-g2").value();
  sinew::Workspace rod_work(rods);
  std::atomic<bool> enough = true;
  rod_work.stop = sinew::StopToken(enough);
  const auto stopped = sinew::equilibrium(rods, {0.44, 0.42, 0.41}, {}, rod_work);
  std::printf("%s\n", std::string(sinew::to_string(stopped.report.status)).c_str());
}
