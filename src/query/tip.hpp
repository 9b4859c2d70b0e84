/// @file tip.hpp
/// Where a question wants the tip of an arm or a serial robot.
#pragma once
#include <array>

#include "query/context.hpp"

namespace sinew::inline v1 {

/// A pose, or a position, a direction of the tip's axis, or both.
struct AskedTip {
  std::optional<SpatialPose> pose;
  std::optional<std::array<double, 3>> position, direction;  ///< [m], [1], of any length
};
/// @param is_direction_enough without a position
AskedTip read_tip(Question& question, bool is_direction_enough);

}  // namespace sinew::inline v1
