/// @file shape.hpp
/// What a robot looks like at a configuration: polylines for pictures.
#pragma once
#include "sinew/robot/assembly.hpp"

namespace sinew::inline v0 {

using Polyline = std::vector<Vec2<double>>;  ///< base frame [m]

struct PlanarShape {
  std::vector<Polyline> backbones;                 ///< a leg
  std::vector<std::array<Polyline, 2>> tendons;    ///< a leg: tendon 1, tendon 2
  std::vector<std::array<Vec2<double>, 2>> lines;  ///< a leg: the segment along which its closure pulls
  Polyline platform;                               ///< its points, in leg order
  Polyline base;                                   ///< base points, in leg order
};

/// @param samples points of each backbone, at least 2
SINEW_API PlanarShape shape(const AnyRobot& robot, const AnyPose& pose, Numbers coordinates, int samples);

}  // namespace sinew::inline v0
