/// @file question.hpp
/// From a question of the public face to the rods of a workspace.
#pragma once
#include "kinematics/rods/solve.hpp"
#include "sinew/kinematics/equilibrium.hpp"
#include "sinew/robot/assembly.hpp"

namespace sinew::inline v1 {

/// Home of a robot in space.
inline SE3<double> home_of(const Robot& robot) {
  return SE3<double>::from(std::get<SpatialPose>(home(robot)));
}

/// The question with the weight of the platform in its wrench.
inline RodQuestion question_of(const Robot& robot, const EquilibriumOptions& options, RodWork& rods) {
  RodQuestion question;
  const Vec3<double> gravity = options.gravity.value_or(robot.weight().gravity);
  if (rods.system->set_gravity(gravity)) rods.knows_home = rods.is_solved = false;
  question.wrench = options.wrench;
  question.wrench.head<3>() += robot.weight().platform_mass * gravity;
  if (options.start) question.start = SE3<double>::from(*options.start);
  question.warm_start = options.warm_start;
  question.max_iterations = options.max_iterations.value_or(4000);
  question.check_stability = options.check_stability;
  return question;
}

}  // namespace sinew::inline v1
