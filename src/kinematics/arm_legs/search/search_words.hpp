/// @file search_words.hpp
/// Why a search ended without an equilibrium, in words.
#pragma once
#include <string>

#include "kinematics/arm_legs/legs_work.hpp"
#include "kinematics/arm_legs/search/newton.hpp"

namespace sinew::inline v1 {

/// Of a free platform. @param has_potential what acts has one; @param reached share of inputs and loads
std::string words_of_search(Status status, bool has_potential, double reached);
/// Why a platform is not kept at the prescribed pose, and the way out. @param reached share of the way to it
std::string words_of_pose(const ArmLegs& robot, const LegsProblem& problem, const LegsFound& found,
                          double reached);

}  // namespace sinew::inline v1
