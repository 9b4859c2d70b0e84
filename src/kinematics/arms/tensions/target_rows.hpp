/// @file target_rows.hpp
/// What a tip, or a platform, is off a target, and its rates by tensions.
#pragma once
#include <string_view>
#include <vector>

#include "sinew/kinematics/arm.hpp"

namespace sinew::inline v1 {

/// What the tip is off, and its rates by tensions: rows of places over the length [1] and of angles [rad].
struct TargetRows {
  std::vector<double> off, J;  ///< J: rows × tendons
};

/// @param J twist of the tip by tensions, 6 rows [m/N, rad/N]; @param length by which places count [m]
TargetRows rows_of(const ArmTarget& target, const SE3<double>& tip, const std::vector<double>& J,
                   double length);
/// What the tip is off: place over the length, angle [rad], the largest.
double off_target(const ArmTarget& target, const SE3<double>& tip, double length);
/// What is wrong with the target, or empty.
std::string_view target_misfit(const ArmTarget& target);

}  // namespace sinew::inline v1
