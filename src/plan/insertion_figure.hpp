/// @file insertion_figure.hpp
/// Pictures of a way in.
#pragma once
#include <span>

#include "io/figure/figure.hpp"
#include "sinew/plan/insertion.hpp"
#include "sinew/plan/scene.hpp"

namespace sinew::inline v1 {

/// The robot among the solids at evenly spread steps, the last one among them: above along the stage's axis,
/// below from the side. Of solids their sharp edges are drawn, from the side of those alone that are not far
/// before or behind the robot.
/// @param steps with what a check found of them
/// @param phases how many, > 0
Figure insertion_phases(const InsertionScene& scene, std::span<const InsertionStep> steps,
                        const InsertionCheck& check, int phases);

/// Clearance and bends over the stage.
Figure insertion_curves(const InsertionScene& scene, std::span<const InsertionStep> steps,
                        const InsertionCheck& check);

}  // namespace sinew::inline v1
