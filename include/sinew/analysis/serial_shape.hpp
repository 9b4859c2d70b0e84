/// @file serial_shape.hpp
/// What a serial robot looks like at given bends: polylines for pictures and for checks of clearance.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "sinew/base/export.hpp"
#include "sinew/robot/serial.hpp"

namespace sinew::inline v1 {

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
