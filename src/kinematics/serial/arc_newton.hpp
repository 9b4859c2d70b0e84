/// The last digits of the bends of three arcs, by Newton's method on all six of them.
#pragma once
#include <optional>

#include "kinematics/serial/arc_pairs.hpp"

namespace sinew::inline v1 {
namespace detail {

struct ArcSolution {
  ThreeBends bends;
  int sign;         ///< which of the tip's two quaternions the arcs make up
  double residual;  ///< lengths by the robot's, angles in rad
};

SE3<double> tip_of(const std::array<double, 3>& lengths, const ThreeBends& bends);

/// The largest of what is missing to the pose.
double pose_error(const ThreeBends& bends, const ThreeArcPose& pose);

double distance(const ThreeBends& a, const ThreeBends& b);

/// From a guess near a regular solution. Nothing where that leads to none.
std::optional<ArcSolution> polished(const ThreeArcPose& pose, const OuterBends& guess);

/// From anywhere, also where the Jacobian is singular.
std::optional<ArcSolution> settled(const ThreeArcPose& pose, const OuterBends& guess);

/// Smallest singular value of the Jacobian.
double regularity(const ThreeArcPose& pose, const ThreeBends& bends);

bool is_within_limit(const ThreeArcPose& pose, const ThreeBends& bends);

}  // namespace detail
}  // namespace sinew::inline v1
