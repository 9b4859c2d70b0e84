/// @file singularity_map.hpp
/// Singularities over a grid of poses: determinant, conditions and both types at every one of them.
/// Theory: docs/theory/singularity.md
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "sinew/analysis/lines.hpp"
#include "sinew/kinematics/inverse.hpp"

namespace sinew::inline v1 {

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
