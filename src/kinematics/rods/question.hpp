/// @file question.hpp
/// From a question of the public face to the rods of a workspace.
#pragma once
#include "kinematics/rods/solve.hpp"
#include "sinew/kinematics/equilibrium.hpp"
#include "sinew/robot/assembly.hpp"

namespace sinew::inline v0 {

/// Home of a robot in space.
inline SE3<double> home_of(const Robot& robot) {
  return SE3<double>::from(std::get<SpatialPose>(home(robot)));
}

/// What weighs on rods; a state at rest under another gravity is none.
template <class System>
void set_gravity(RodWorkOf<System>& rods, const Vec3<double>& gravity) {
  if constexpr (requires { rods.system.gravity(); }) {
    if (rods.system.gravity() == gravity) return;
    rods.system.set_gravity(gravity);
    if (!rods.system.has_mass()) return;
    rods.knows_home = rods.is_solved = false;
  }
}

template <class System>
inline constexpr int most_iterations = System::is_slow ? 400 : 4000;

/// The question with the weight of the platform in its wrench.
template <class Work>
RodQuestion question_of(const Robot& robot, const EquilibriumOptions& options, Work& rods) {
  RodQuestion question;
  const Vec3<double> gravity = options.gravity.value_or(robot.weight().gravity);
  set_gravity(rods, gravity);
  question.wrench = options.wrench;
  question.wrench.head<3>() += robot.weight().platform_mass * gravity;
  if (options.start) question.start = SE3<double>::from(*options.start);
  question.resume = options.resume;
  using System = std::decay_t<decltype(rods.system)>;
  question.max_iterations = options.max_iterations.value_or(most_iterations<System>);
  question.judge = options.judge;
  return question;
}

}  // namespace sinew::inline v0
