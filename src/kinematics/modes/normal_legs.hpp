/// @file normal_legs.hpp
/// Legs about the middles of their base and platform points, in units of their own size: lengths of order 1,
/// wherever the robot stands and in whatever unit it is written.
#pragma once
#include <optional>
#include <vector>

#include "kinematics/modes/leg_sections.hpp"
#include "sinew/math/se3.hpp"
#include "sinew/solve/report.hpp"

namespace sinew::inline v1::detail {

struct NormalLegs {
  std::vector<PlatformConstraint<3>> legs;
  Vec3<double> base_middle, platform_middle;
  double size = 0;    ///< of the robot [m]
  Sections sections;  ///< equations of the six most independent legs, orthonormal
  bool base_is_flat = false, platform_is_flat = false;
  Vec3<double> base_normal, platform_normal;  ///< of the planes, where flat

  /// The pose as the given legs see it.
  SE3<double> given(const SE3<double>& pose) const {
    return {size * pose.p + base_middle - pose.rotate(platform_middle), pose.R};
  }
};

/// Report says why not where there is no well-posed problem.
std::optional<NormalLegs> normal_legs(std::span<const PlatformConstraint<3>> legs, Report& report);

}  // namespace sinew::inline v1::detail
