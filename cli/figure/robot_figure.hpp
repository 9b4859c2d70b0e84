/// @file robot_figure.hpp
/// The shape of a robot: projections, or a picture in space.
#pragma once
#include "io/figure/figure.hpp"
#include "request.hpp"

namespace sinew::cli {

/// The answer to `shape`. A planar robot in its plane, a spatial one from the front and from above, a serial
/// one from the front and from the side; with an eye any in space.
Figure robot_figure(const Answer& shape, const OpenRobot& robot, const std::optional<Eye>& eye);

}  // namespace sinew::cli
