/// @file lines.hpp
/// What the lines of a robot's J have in common where they are dependent: type II singularities by their
/// geometry. Theory: docs/theory/lines.md
///
/// A row (f, m) is a line along the unit vector f with the moment m about a reference point O′; a twist (v,
/// ω) of the platform, v that of O′, is free where f·v + m·ω = 0 for every row. Rows are homogenised: f of
/// length one, m divided by the platform radius, so that nothing here depends on the unit of length.
#pragma once
#include <limits>
#include <optional>
#include <string_view>

#include "sinew/math/linalg.hpp"

namespace sinew::inline v1 {

/// In the plane by name; in space the varieties of lines of Grassmann geometry, whose customary number begins
/// the text of `to_string` ("5a general linear complex").
enum class LineClass {
  regular,    ///< the lines leave no twist free
  undefined,  ///< a row is not a finite number
  none,       ///< no rows, or rows of zeros only

  concurrent,  ///< plane, rank 2: meet in a point
  parallel,    ///< plane, rank 2
  coincident,  ///< plane, rank 1

  single_line,            ///< 1
  skew_pair,              ///< 2a
  planar_pencil,          ///< 2b: in one plane, and through one point or parallel
  regulus,                ///< 3a: one family of lines of a hyperboloid
  two_pencils,            ///< 3b: planar pencils in two planes, with one line in common
  bundle,                 ///< 3c: through one point, or parallel
  plane_of_lines,         ///< 3d
  elliptic_congruence,    ///< 4a: no line meets them all
  hyperbolic_congruence,  ///< 4b: meet two skew lines
  parabolic_congruence,   ///< 4c: pencils centred along one line, in planes through it
  degenerate_congruence,  ///< 4d: in one plane, or through one point of that plane
  general_complex,        ///< 5a: leave a screw motion free
  special_complex,        ///< 5b: meet one line: leave a rotation or (line at infinity) a translation free
};

/// In words, for people: `concurrent`, `5a general linear complex`.
SINEW_API std::string_view to_string(LineClass kind) noexcept;

/// The one motion that lines of rank 5 leave free, base frame.
struct Screw {
  double pitch;            ///< [m/rad]; 0: a rotation, infinite: a translation
  Vec3<double> point;      ///< of the axis, nearest to O′; O′ itself for a translation
  Vec3<double> direction;  ///< unit; of its components z, y, x the first that is not zero is positive
};

/// Type II: J loses rank, the platform moves with the inputs held.
struct TypeTwo {
  bool singular = false;  ///< rank below the freedoms; true too where nothing can be told (`undefined`)
  int rank = 0;           ///< number of σᵢ/σmax above `type_2_tolerance`
  LineClass kind = LineClass::regular;
  /// σmax/σmin of the homogenised rows. NaN above 1e15, where it says how they were rounded, and where there
  /// are fewer rows than freedoms.
  double condition = std::numeric_limits<double>::quiet_NaN();
  std::optional<Vec3<double>> point;  ///< `concurrent` (z = 0) or `bundle`: where the lines meet, base frame
  std::optional<Screw> screw;         ///< rank 5 in space
};

/// A singular value of the homogenised rows counts as 0 up to this share of the largest.
inline constexpr double type_2_tolerance = 1e-10;

/// Homogenised rows (fx, fy, m/radius), without unit and up to 24, of lines in the plane; `reference` is O′
/// in the base frame [m], `radius` that by which moments were divided [m]. No heap. Rows of zeros (a leg
/// without a line) count as absent.
SINEW_API TypeTwo classify(const MatrixView& lines, const Vec2<double>& reference, double radius);

/// The same in space: rows (f, m/radius) of six numbers, without unit; `reference` and `radius` [m].
SINEW_API TypeTwo classify(const MatrixView& lines, const Vec3<double>& reference, double radius);

}  // namespace sinew::inline v1
