/// @file lines.hpp
/// What the lines of a robot's J have in common where they are dependent: type II singularities by their
/// geometry. Theory: docs/theory/lines.md
///
/// A row (f, m) is a line along the unit vector f with the moment m about a reference point O′; a twist (v,
/// ω) of the platform, v that of O′, is free where f·v + m·ω = 0 for every row. Rows are homogenised: f of
/// length one, m divided by the platform radius, so that nothing here depends on the unit of length.
#pragma once
#include "sinew/analysis/velocity.hpp"

namespace sinew::inline v1 {

/// Homogenised rows (fx, fy, m/radius), without unit and up to 24, of lines in the plane; `reference` is O′
/// in the base frame [m], `radius` that by which moments were divided [m]. No heap. Rows of zeros (a leg
/// without a line) count as absent.
TypeTwo classify(const MatrixView& lines, const Vec2<double>& reference, double radius);

/// The same in space: rows (f, m/radius) of six numbers, without unit; `reference` and `radius` [m].
TypeTwo classify(const MatrixView& lines, const Vec3<double>& reference, double radius);

}  // namespace sinew::inline v1
