/// @file singularity.hpp
/// Singularities around a pose and over many: how far the platform can move in a direction before it meets
/// one of type II; determinant, conditions and both types over a grid. Theory: docs/theory/singularity.md
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "sinew/analysis/velocity.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::inline v1 {

/// How a direction is searched.
struct TypeTwoSearch {
  InverseOptions branch = {};  ///< of the first pose; it is followed from there
  /// Largest s looked at, a factor of the direction. Default: a full turn; for a direction without rotation
  /// there is none, as the legs end it.
  double limit = std::numeric_limits<double>::quiet_NaN();
  bool both_ways = false;  ///< also against the direction; the nearer one is answered
};

/// What the search found.
struct TypeTwoDistance {
  bool found = false;  ///< a type II singularity lies in that direction
  /// s of the type II, a multiple of the direction (metres where its linear part has unit length), negative
  /// where it lies against the direction; not found: how far the search came.
  double distance = 0;
  AnyPose pose;    ///< there
  TypeTwo type_2;  ///< there
  /// Where nothing was found: converged if the limit was reached; unreachable if the branch ends, with the
  /// leg that ends it.
  Report report;
};

/// The nearest type II along a straight motion: in the plane (x, y, φ) + s·direction; in space p + s·v,
/// exp(s·ω)·R, of a platform that hinges hold in planes the nearest pose in these. The distance is the
/// multiple of the direction given, exact to 1e-10 for directions of a length near one. A pose that is itself
/// singular has the distance 0.
/// @param direction a twist in base axes: (vx, vy, ω) or (v, ω) [m], [rad] per unit of s. `bad_input` where
/// it, or the pose, does not fit the robot
SINEW_API TypeTwoDistance type_2_distance(const Robot& robot, const AnyPose& pose, Numbers direction,
                                          const TypeTwoSearch& search, Workspace& work);

/// One coordinate of a pose [m] or [rad]: a value that stays (count 1), or `count` values from … to, both
/// included.
struct MapAxis {
  double from = 0;  ///< the first value
  double to = 0;    ///< the last value
  int count = 1;    ///< ≥ 1

  /// Value k < count. From both ends alike, so that −a … a is symmetric and 0 is 0.
  double at(int k) const {
    if (k == 0 || k + 1 >= count) return k == 0 ? from : to;
    return (from * (count - 1 - k) + to * k) / (count - 1);
  }
};

/// Poses of a map, the first axis running fastest. The axes are x, y, φ in the plane; in space x, y, z and
/// the rotation vector rx, ry, rz of the platform in the base frame, R = exp(r): slices of SO(3) through the
/// identity, wherever home is.
struct PoseGrid {
  bool is_spatial = false;
  std::array<MapAxis, 6> axes = {};  ///< in the plane the first three

  /// The grid of one pose.
  SINEW_API static PoseGrid at(const AnyPose& pose);

  /// Coordinates of a pose: 3 in the plane, 6 in space.
  std::size_t axis_count() const { return is_spatial ? 6 : 3; }
  /// Number of poses: the product of the counts of the axes.
  SINEW_API std::size_t size() const;
  /// Coordinates of pose k < size() [m], [rad], as the axes say.
  SINEW_API std::array<double, 6> coordinates(std::size_t k) const;
  /// Pose k < size().
  AnyPose pose(std::size_t k) const { return pose(coordinates(k)); }
  /// The pose of any coordinates [m], [rad].
  SINEW_API AnyPose pose(const std::array<double, 6>& coordinates) const;
};

/// One pose of a map. Numbers are absent (NaN) where the pose is not reachable.
struct MapSample {
  /// NaN, of whatever unit: what stands for a number that there is not.
  static constexpr double absent = std::numeric_limits<double>::quiet_NaN();

  bool is_reachable = false;
  bool is_type_2 = false;
  LineClass kind = LineClass::undefined;  ///< of the legs' lines
  std::uint32_t type_1 = 0;               ///< bit i: leg i
  /// Of J in the units of its rows ([m⁴] of a 3-RFR); absent too where J is not square
  double determinant = absent;
  double inverse_condition = absent;  ///< σmin/σmax of J as the paper has it, mixing units; 0 below 1e-15
  double inverse_condition_homogenised = absent;  ///< of unit lines, moments divided by the platform radius
};

/// The samples in the order of the grid; fewer where the caller stopped it.
struct SingularityMap {
  PoseGrid grid;
  std::vector<MapSample> samples;

  /// Whether the caller let it finish.
  bool is_complete() const { return samples.size() == grid.size(); }
};

/// Called now and then with the number of poses done and of all; false stops the map.
using Progress = std::function<bool(std::size_t done, std::size_t total)>;

/// A pose by inverse kinematics on a branch, its leg's solution chosen anew at each pose, and its velocity
/// analysis. No heap.
SINEW_API MapSample map_sample(const Robot& robot, const AnyPose& pose, const InverseOptions& branch,
                               Workspace& work);

/// Takes a sample of pose k of a grid; false ends the map.
using TakeSample = std::function<bool(std::size_t k, const MapSample& sample)>;

/// The samples of a map in the order of its grid, handed over one by one and kept nowhere: a map of any size
/// in constant memory. Answers how many were taken; fewer than the grid has where `take` ended it, a stop was
/// requested, or the poses are none of this robot's.
SINEW_API std::size_t visit_map(const Robot& robot, const PoseGrid& grid, const InverseOptions& branch,
                                Workspace& work, const TakeSample& take);

/// The same, kept.
SINEW_API SingularityMap singularity_map(const Robot& robot, const PoseGrid& grid,
                                         const InverseOptions& branch, Workspace& work,
                                         const Progress& progress = {});

}  // namespace sinew::inline v1
