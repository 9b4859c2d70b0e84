/// @file shape.hpp
/// What a robot looks like at a configuration: polylines for pictures and for checks of clearance.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "sinew/base/export.hpp"
#include "sinew/robot/assembly.hpp"
#include "sinew/robot/serial.hpp"

namespace sinew::inline v1 {

template <int D>
using PolylineOf = std::vector<Vec<double, D>>;  ///< base frame [m]

/// Points in the base frame [m].
/// @tparam D dimension of the robot's space
template <int D>
struct ShapeOf {
  std::vector<PolylineOf<D>> backbones;               ///< a leg; a rail as far as its carriage
  std::vector<std::array<PolylineOf<D>, 2>> tendons;  ///< a leg: tendon 1, tendon 2; empty of a rail
  std::vector<std::array<Vec<double, D>, 2>> lines;   ///< a leg: the segment along which its closure pulls
  PolylineOf<D> platform;                             ///< its points, in leg order
  PolylineOf<D> base;                                 ///< base points, in leg order
};

using Polyline = PolylineOf<2>;   ///< points in the plane, base frame [m]
using PlanarShape = ShapeOf<2>;   ///< of a planar robot
using SpatialShape = ShapeOf<3>;  ///< of a spatial one
/// The shape in the robot's space.
using AnyShape = std::variant<PlanarShape, SpatialShape>;

/// Of a robot of either space [m], its legs in file order. Empty where pose or coordinates are not those of
/// this robot, and by the model prb.
/// @param coordinates of the links at this pose, as `forward`, `inverse` and `equilibrium` answer them
/// @param samples points of each backbone, at least 2
SINEW_API AnyShape any_shape(const Robot& robot, const AnyPose& pose, Numbers coordinates, int samples);

/// Of a planar robot [m]; empty of a spatial one.
inline PlanarShape shape(const Robot& robot, const AnyPose& pose, Numbers coordinates, int samples) {
  const AnyShape any = any_shape(robot, pose, coordinates, samples);
  const auto* planar = std::get_if<PlanarShape>(&any);
  return planar ? *planar : PlanarShape{};
}

/// A disc of a segment: it stands on the frame, its axis along z.
struct DiscShape {
  SE3<double> base;  ///< of its proximal face, in the robot's base frame [m]
  double height;     ///< [m]
  double radius;     ///< [m]
};

/// Base frame [m].
struct SerialShape {
  std::vector<std::vector<Vec3<double>>> backbones;  ///< per section
  std::vector<std::vector<std::vector<Vec3<double>>>>
      tendons;                    ///< per section, per tendon: base to its last disc
  std::vector<DiscShape> discs;   ///< from base to tip
  std::vector<SE3<double>> ends;  ///< of the sections
};

/// Tendons run straight from hole to hole. @param bends one a section [rad] @param samples points of each
/// joint's arc, at least 2
SINEW_API SerialShape serial_shape(const SerialRobot& robot, std::span<const Bend> bends, int samples);

}  // namespace sinew::inline v1
