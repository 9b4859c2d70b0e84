/// @file tip_curve.hpp
/// Ways of the tip alone: a ball as thick as the robot among the solids, for where searches for a whole
/// posture find nothing. The body then follows the tip's way as far as its sections can.
#pragma once
#include <cstdint>
#include <vector>

#include "plan/deadline.hpp"
#include "plan/obstacles.hpp"
#include "sinew/plan/scene.hpp"

namespace sinew::inline v0 {

/// Points not more than 1 mm apart, from where the tip is at stage 0 to the target, along which the ball
/// keeps the scene's clearance; shortened and rounded off as far as that allows. Empty where none was found,
/// or where this library was built without OMPL.
/// @param seed one seed, one curve
std::vector<Vec3<double>> tip_curve(const InsertionScene& scene, const Obstacles& obstacles,
                                    std::uint64_t seed, const Deadline& deadline);

}  // namespace sinew::inline v0
