/// @file unit_hint.hpp
/// Numbers that are far outside a robot's own size: more often a forgotten unit than what is meant. They are
/// answered, with a word about it.
#pragma once
#include <string>

#include "query/context.hpp"
#include "sinew/io/node.hpp"
#include "sinew/robot/serial.hpp"

namespace sinew::inline v1 {

/// What a robot's numbers are measured by; 0 where it is not known.
struct RobotScale {
  double length = 0;  ///< that the robot can reach [m]
  double force = 0;   ///< that bends its links by about their length [N]
};
RobotScale scale_of(const Robot& robot);

/// About a number of the query that is far outside, or else of the answer: one sentence, without a full stop.
/// Empty where all are within. `pose.x = 10 is 10 m, 23 times the size of the robot (440 mm); did you mean
/// "10 mm"?`
/// @param robot its file: what `set` changes
/// @param inputs of a robot with a platform; of others none
std::string unit_hint(const Node& query, const Value& answer, const RobotScale& scale, const Node& robot,
                      std::span<const InputOfLeg> inputs);

}  // namespace sinew::inline v1
