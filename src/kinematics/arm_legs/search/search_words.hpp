/// @file search_words.hpp
/// Why a search ended without an equilibrium, in words.
#pragma once
#include <string>

#include "kinematics/arm_legs/legs_work.hpp"
#include "kinematics/arm_legs/search/newton.hpp"

namespace sinew::inline v1 {

/// Of a free platform, or of one at a prescribed pose.
/// @param has_potential what acts has one
/// @param reached share of inputs and loads, or of the way to the pose [1]
std::string words_of_search(const ArmLegs& robot, const LegsProblem& problem, const LegsFound& found,
                            bool has_potential, double reached);

}  // namespace sinew::inline v1
