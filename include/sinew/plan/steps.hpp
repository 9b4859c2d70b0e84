/// @file steps.hpp
/// Where an inserted robot is, step by step. Between two steps its stage and all its bends move straight from
/// the one to the other, in proportion.
#pragma once
#include <span>
#include <vector>

#include "sinew/base/export.hpp"
#include "sinew/kinematics/trajectory.hpp"

namespace sinew::inline v1 {

/// A posture on the way in, with what is nearest to the robot.
struct InsertionStep : SerialPosture {
  double clearance = 0;         ///< least distance between robot and solids [m]; < 0: they overlap
  int solid = -1;               ///< where it is; −1: none is near
  Vec3<double> place{0, 0, 0};  ///< point of the backbone there [m]
};

/// More steps on the curves through these: by the stage, shape-preserving (Fritsch, Butland), so that no bend
/// leaves the interval of its neighbours. The given steps are among them.
/// @param max_stage between two of the answer [m], > 0
SINEW_API std::vector<InsertionStep> interpolated(std::span<const InsertionStep> steps, double max_stage);

}  // namespace sinew::inline v1
