/// @file map_figure.hpp
/// Heat maps of a singularity map.
#pragma once
#include <functional>

#include "io/figure/figure.hpp"
#include "request.hpp"
#include "sinew/analysis/singularity.hpp"

namespace sinew::cli {

/// Why a map of these axes cannot be drawn; empty where it can: two axes vary, or three, of which the last
/// has few values.
Errors refuse_to_draw(const PoseGrid& grid, const std::vector<Input>& axes);

/// The sample at a pose that need not be one of the map.
using Probe = std::function<MapSample(const AnyPose& pose)>;

/// Homogenised inverse condition, a panel for each value of the third axis, with the curve on which the
/// determinant goes through zero.
Figure map_figure(const SingularityMap& map, const Probe& probe, const std::vector<Input>& axes,
                  std::string_view robot);

}  // namespace sinew::cli
