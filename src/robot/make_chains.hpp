/// @file make_chains.hpp
/// From legs on arcs to legs on pseudo-rigid chains.
#pragma once
#include "robot/chains.hpp"
#include "robot/parallel.hpp"
#include "sinew/base/error.hpp"

namespace sinew::inline v1 {

using AnyLegs = std::variant<PlanarRobot, SpatialRobot>;
using AnyChains = std::variant<ChainLegs<Planar>, ChainLegs<Spatial>>;

/// An error names what a leg lacks: `joints`, `material` or `diameter`, or that there are no chains of its
/// kind.
Expected<AnyChains> make_chains(const AnyLegs& legs, PrbDiscretisation discretisation);

}  // namespace sinew::inline v1
