/// Answers are views into the workspace: they hold until its next use. Copy what is to last.
#include <cstdio>
#include <thread>
#include <vector>

#include "sinew/sinew.hpp"

int main() {
  const auto robot = sinew::load("3-rfr").value();
  sinew::Workspace work(robot);

  const auto here = sinew::inverse(robot, sinew::PlanarPose{0.01, 0, 0}, {}, work);
  const std::vector<double> kept(here.inputs.begin(), here.inputs.end());  // a copy
  const auto there = sinew::inverse(robot, sinew::PlanarPose{-0.01, 0, 0}, {}, work);
  std::printf("kept %.3f mm; the view is now that of the second pose: %.3f mm\n", 1e3 * kept[0],
              1e3 * there.inputs[0]);

  // The robot is constant and shared; each thread has a workspace of its own.
  std::vector<double> first(2);
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < 2; ++i)
      threads.emplace_back([&robot, &first, i] {
        sinew::Workspace own(robot);
        first[i] = sinew::inverse(robot, sinew::PlanarPose{0, 0.01 * double(i), 0}, {}, own).inputs[0];
      });
  }
  std::printf("two threads: %.3f mm, %.3f mm\n", 1e3 * first[0], 1e3 * first[1]);
}
