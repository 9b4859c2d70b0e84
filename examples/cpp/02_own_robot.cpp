/// A robot of your own: a text file with units, mistakes in it told by line, then changed and asked; and what
/// an answer says where there is none.
#include <cstdio>
#include <string>

#include "sinew/io/table.hpp"
#include "sinew/sinew.hpp"

/// Three tendon-driven links between free revolute joints, evenly around two circles: docs/robot-files.md
constexpr const char* mine = R"(sinew: 1
name: mine
architecture: 3-RFR
base: {radius: 190 mm, angle: 90 deg}
platform: {radius: 50 mm, angle: 30 deg}
defaults:
  link: {length: 200 mm, tendon_offset: 5 mm}
)";

constexpr const char* mistaken = R"(sinew: 1
name: mistaken
architecture: 3-RFR
base: {radius: 190 mm, angle: 90 deg}
platform: {radius: 50 mm, angle: 30 deg}
defaults:
  link: {length: 0.2 kg, tendon_offset: 5 mm, colour: red}
)";

int main() {
  // Every mistake of a file at once, each with its place, what was found, the rule and the way out. Nothing
  // throws.
  if (!sinew::write_text(mistaken, "mistaken.yaml") || !sinew::write_text(mine, "mine.yaml")) return 4;
  const auto refused = sinew::load("mistaken.yaml");
  if (!refused) {
    std::printf("%s\n", refused.error().front().message.c_str());
    for (const sinew::Error& error : refused.error())
      std::printf("%s: %s\n", error.where.c_str(), error.code.c_str());
  }

  // The file read once; a variant of it with one length changed.
  const sinew::Document document = sinew::read_robot_file("mine.yaml").value();
  const auto shorter = sinew::with(document, "defaults.link.length", sinew::make_node("180 mm")).value();
  const sinew::Robot robot = sinew::read_robot(shorter).value();
  sinew::Workspace work(robot);

  const auto at = sinew::inverse(robot, sinew::PlanarPose{0.005, -0.005, 0.087}, {}, work);
  std::printf("tendons %.3f, %.3f, %.3f mm\n", 1e3 * at.inputs[0], 1e3 * at.inputs[1], 1e3 * at.inputs[2]);

  // A pose out of reach, arguments that do not fit the robot: answers, with the reason.
  const auto far = sinew::inverse(robot, sinew::PlanarPose{0.3, 0, 0}, {}, work);
  std::printf("%s\n", sinew::to_string(far.report).c_str());
  const auto wrong = sinew::forward(robot, {0.19, 0.19}, {}, work);
  std::printf("%s\n", sinew::to_string(wrong.report).c_str());

  // A bound on the work: the best iterate comes back with its residual, and says that it is no solution.
  const auto hasty = sinew::forward(robot, {0.175, 0.173, 0.171}, {.max_iterations = 1}, work);
  std::printf("%s\n", std::string(sinew::to_string(hasty.report.status)).c_str());
}

// Prints:
//   defaults.link.length = "0.2 kg" is a mass; give a length ("0.2 m", "200 mm", or 0.2 for metres).
//   mistaken.yaml:7:18: wrong_dimension
//   mistaken.yaml:7:47: unknown_key
//   tendons 174.991, 173.264, 171.762 mm
//   unreachable: legs[0] needs a chord of 380.895 mm, its backbone is 180 mm long
//   bad_input: the robot has 3 inputs, 2 were given
//   iteration_limit
