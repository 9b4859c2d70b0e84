/// A control loop of 1 kHz: forward kinematics of a flexible tripod whose rods are fed a little each tick;
/// bounded in work, and stopped from outside.
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include "sinew/sinew.hpp"

int main() {
  using Clock = std::chrono::steady_clock;
  const sinew::Robot robot = sinew::load("3pfs-g2").value();
  sinew::Workspace work(robot);  // allocates here, and never in the loop

  // Once, before the loop: from home to the lengths at which it begins.
  double lengths[3] = {0.42, 0.42, 0.42};
  if (!sinew::equilibrium(robot, lengths, {}, work).report.ok()) return 3;

  // In the loop: from the equilibrium of the tick before. A handful of Newton steps, bounded.
  const sinew::EquilibriumOptions warm{.warm_start = true, .max_iterations = 10, .check_stability = false};
  int failures = 0;
  Clock::duration slowest{};
  sinew::SpatialPose pose;
  for (auto tick = Clock::now(), end = tick + std::chrono::seconds(1); tick < end;) {
    const double t = std::chrono::duration<double>(end - tick).count();
    for (int i = 0; i < 3; ++i) lengths[i] = 0.42 + 0.01 * std::sin(6.283 * t + 2.094 * i);

    const auto before = Clock::now();
    const auto now = sinew::equilibrium(robot, lengths, warm, work);
    slowest = std::max(slowest, Clock::now() - before);
    if (now.report.ok()) pose = now.pose;  // else keep the last good pose, and count
    failures += !now.report.ok();

    tick += std::chrono::milliseconds(1);
    std::this_thread::sleep_until(tick);
  }
  std::printf("1000 ticks, %d without a solution, z at last %.1f mm\n", failures, 1e3 * pose.position.z());
  std::fprintf(stderr, "slowest solve %.0f us\n", 1e6 * std::chrono::duration<double>(slowest).count());

  // Another thread, or a signal handler, may end a solve: whoever holds the flag.
  std::atomic<bool> enough = true;
  work.stop = sinew::StopToken(enough);
  const auto stopped = sinew::equilibrium(robot, {0.44, 0.42, 0.41}, {}, work);
  std::printf("%s\n", std::string(sinew::to_string(stopped.report.status)).c_str());
}

// Prints:
//   1000 ticks, 0 without a solution, z at last 383.9 mm
//   stopped
