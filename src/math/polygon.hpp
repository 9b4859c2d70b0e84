/// @file polygon.hpp
/// Convex sets of the plane bounded by straight lines and one circle about the origin: vertices, areas and
/// sums, with what is thinner than rounding kept as a segment or a point. Any unit of length. Theory:
/// docs/theory/section_diagram.md
///
/// Lines are few, so vertices are those crossings of two lines that no third one cuts off: no order of
/// insertion, no box that stands for infinity, and each vertex is as exact as the two lines it comes from.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "sinew/math/vec.hpp"

namespace sinew::inline v1 {

/// What the half-planes have in common; absent where it is unbounded. A set thinner than rounding, on either
/// side of nothing, is a segment or a point. Takes time ~ count³.
std::optional<Polygon> intersection(std::span<const HalfPlane> half_planes);

/// Where two lines cross; absent where they are parallel.
std::optional<Vec2<double>> crossing(const HalfPlane& a, const HalfPlane& b);

/// Area, 0 of a segment or a point.
double area(const Polygon& polygon);

/// The smallest convex set that holds the points. Those closer than `tolerance` are one, and no vertex lies
/// within `tolerance` of the line through its neighbours.
Polygon hull(Polygon points, double tolerance);

/// All differences a − b. The Minkowski sum of a and the mirror image of b.
Polygon difference(const Polygon& a, const Polygon& b);

/// A polygon cut with the disc |x| ≤ radius. From corner k to the next the boundary is straight where arc[k]
/// is 0, else an arc of the circle over that angle [rad], counter-clockwise. A whole disc is one corner with
/// an arc of 2π.
struct DiscCut {
  double radius = 0;        ///< of the disc
  Polygon corners;          ///< counter-clockwise
  std::vector<double> arc;  ///< of each corner [rad]
};
/// The polygon cut with the disc |x| ≤ radius.
DiscCut cut_with_disc(const Polygon& polygon, double radius);

/// Area, circular segments included.
double area(const DiscCut& cut);

/// Points of the boundary; a chord between them is nowhere farther from its arc than `deviation`.
Polygon boundary(const DiscCut& cut, double deviation);

}  // namespace sinew::inline v1
