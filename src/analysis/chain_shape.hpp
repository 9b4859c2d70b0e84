/// @file chain_shape.hpp
/// What a robot on pseudo-rigid chains looks like: polylines for pictures.
#pragma once
#include "kinematics/chains/chain.hpp"
#include "sinew/analysis/shape.hpp"

namespace sinew::inline v1 {

/// Backbones lead from the base point by the joints to the tip. Tendons lead straight from disc to disc: one
/// at the base, one at the middle of each link, one at the tip, those at the ends square to the backbone
/// there, not to the outermost links. So a tendon is as long as M1 has it, and as M0w to second order in a
/// link's length.
template <class Space>
ShapeOf<Space::dimension> chain_shape(const ChainLegs<Space>& robot, const typename Space::Pose& pose,
                                      std::span<const ChainLegState> legs);

}  // namespace sinew::inline v1
