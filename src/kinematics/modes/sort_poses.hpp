/// The order in which answers list spatial poses.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "sinew/math/se3.hpp"

namespace sinew::inline v1 {

/// Below this two poses are one: a double mode is known to the root of the rounding error only.
inline constexpr double same_pose = 1e-6;

/// z descending, then y, then x, then the quaternion; coordinates that differ by rounding count as equal.
inline void sort_poses(std::span<SpatialPose> poses, double size) {
  const auto key = [size](const SpatialPose& pose) {
    std::array<double, 7> k;
    for (int i = 0; i < 3; ++i)
      k[static_cast<std::size_t>(i)] = -std::round(pose.position[2 - i] / (1e-9 * size));
    for (std::size_t i = 0; i < 4; ++i) k[3 + i] = -std::round(pose.quaternion[i] / 1e-9);
    return k;
  };
  std::ranges::sort(poses, {}, key);
}

}  // namespace sinew::inline v1
