/// @file pose.hpp
/// The pose of a robot's own space out of the variant at the edge.
#pragma once
#include "sinew/base/assert.hpp"
#include "sinew/robot/any_robot.hpp"

namespace sinew::inline v0 {

template <class Space>
const typename Space::Pose& in_space(const AnyPose& pose) {
  SINEW_EXPECTS(std::holds_alternative<typename Space::Pose>(pose));
  return *std::get_if<typename Space::Pose>(&pose);
}

}  // namespace sinew::inline v0
