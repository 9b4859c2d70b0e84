/// @file lengths_for_pose.hpp
/// Lengths of rods that hold the platform at a pose.
#pragma once
#include "kinematics/rods/solve.hpp"

namespace sinew::inline v1 {

/// Brings the system to rest at this pose by the lengths of its six inputs: as neighbour of the last answer
/// where the question is to be resumed, else along a path from home. Where that folds the report says where.
Report lengths_for_pose(RodWork& work, const SE3<double>& home, const SE3<double>& wanted,
                        const RodQuestion& question);

}  // namespace sinew::inline v1
