// A small program of a user: nothing here knows how sinew was built or where it is. It makes a robot in its
// own code, so that objects and memory cross the border of the library both ways, whatever instruction set
// either side is compiled for.
#include <cmath>
#include <iostream>

#include "sinew/sinew.hpp"

static_assert(alignof(sinew::Velocity) == alignof(double) && alignof(sinew::Forward) == alignof(double),
              "a public type is over-aligned");

// One of the library's robots, changed by its document.
sinew::Robot in_code() {
  const auto document = sinew::read_robot_file("3-rfr").value();
  return sinew::read_robot(sinew::with(document, "name", sinew::make_node("in code")).value()).value();
}

int main() {
  if (std::string(sinew::version()) != SINEW_VERSION_STRING) return 1;
  const auto missing = sinew::load("no/such/file.yaml");
  if (missing || sinew::to_string(missing.error()).find("no/such/file.yaml") == std::string::npos) return 2;

  const sinew::Robot mine = in_code(), theirs = sinew::load("3-rfr").value();
  sinew::Workspace work(mine), their_work(theirs);
  const sinew::PlanarPose pose{0.01, -0.005, 0.1};
  const auto inputs = sinew::inverse(mine, pose, {}, work);
  const auto same = sinew::inverse(theirs, pose, {}, their_work);
  if (!inputs.ok() || !same.ok()) return 3;
  for (std::size_t i = 0; i < 3; ++i)
    if (std::abs(inputs.inputs[i] - same.inputs[i]) > 1e-15) return 4;

  const std::vector<double> lengths(inputs.inputs.begin(), inputs.inputs.end());
  const auto back = sinew::forward(mine, lengths, {}, work);
  if (!back.ok() || std::abs(std::get<sinew::PlanarPose>(back.pose).phi - 0.1) > 1e-12) return 5;
  const auto moved = sinew::velocity(mine, back.pose, std::vector<double>(work.coordinates), work);
  if (!moved.report.ok() || moved.U.rows() != 3) return 6;

  auto session = sinew::Session::open("3-rfr").value();
  if (session.answer(R"({"query": "describe"})").find("3-RFR") == std::string::npos) return 7;
  std::cout << "sinew " << sinew::version() << '\n';
  return 0;
}
