/// @file tripod_loci.hpp
/// Where the symmetric 3PRS is singular: curves in the plane of e₁ and e₂, the same at every height.
/// Operation mode e₃ = 0, every carriage below its platform point. Theory: docs/theory/tripod_rigid.md
#pragma once
#include <array>
#include <optional>

namespace sinew::inline v1 {

/// Circles of the rails and of the platform points, and the struts [m]; leg 1 lies along y, see [3PFS (7),
/// (12)].
struct TripodSize {
  double base_radius, platform_radius, strut_length;
};

/// Distances of the platform points from the robot's axis, each in the plane of its hinge, over the
/// platform's radius: the left sides of (19).  @implements 3PFS (19)
std::array<double, 3> radial_positions(double e1, double e2);

/// The right sides of (19), (r_A − L)/r and (r_A + L)/r: where one of the three reaches either, that strut is
/// square to its rail and its carriage cannot follow (type I). Between them the pose can be reached.
std::array<double, 2> radial_limits(const TripodSize& size);

/// Determinant of the left matrix of (17), rows in its order [m⁶]; NaN where a strut does not reach.
double tripod_determinant(const TripodSize& size, double e1, double e2);

/// |(e₁, e₂)| of the first type I in a direction [rad] from e₁ towards e₂; none up to 1.
std::optional<double> inverse_locus(const TripodSize& size, double direction);

/// |(e₁, e₂)| of the first type II in a direction, before the type I: the limit that comes first. None in the
/// directions in which type I comes first.
std::optional<double> forward_locus(const TripodSize& size, double direction);

}  // namespace sinew::inline v1
