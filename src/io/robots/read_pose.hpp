/// @file read_pose.hpp
/// Poses as robot files and queries write them.
#pragma once
#include <array>

#include "io/document/reader.hpp"
#include "sinew/math/se3.hpp"

namespace sinew::inline v1 {

/// What the numbers of poses may be: of questions that give one, and of rows, which put others in its place.
struct PoseRange {
  static constexpr Range coordinate = Range::place();        ///< x, y, z [m], and parts of quaternions
  static constexpr Range angle = Range::turn();              ///< [rad]
  static constexpr Range component = Range::between(-1, 1);  ///< e₁ and e₂, of `independent`
  static constexpr double least_square = 1e-12;              ///< of a quaternion that tells a turn
};

/// `{x, y, phi}`, all required.
PlanarPose read_planar_pose(Reader pose);

/// `{position: [x, y, z], quaternion: [w, x, y, z]}`; the quaternion need not be normalised; no turn
/// where it is left out. In its place `tilt`, `azimuth`, `torsion`, see math/tilt.hpp, each 0 by default.
SpatialPose read_spatial_pose(Reader pose);

/// `[x, y, z]`: what falls falls so [m/s²], base axes.
Vec3<double> read_gravity(const Reader& gravity);
/// The same of a robot that may be one in the plane, where gravity acts in it.
std::array<double, 3> read_gravity_of(const Reader& gravity, bool is_planar);

}  // namespace sinew::inline v1
