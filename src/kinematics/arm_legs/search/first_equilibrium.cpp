#include "kinematics/arm_legs/search/first_equilibrium.hpp"

#include "kinematics/arm_legs/search/continuation.hpp"

namespace sinew::inline v1 {
namespace {

/// By what tendons give way at first, over what an arm yields to them [1]: as soft as bends by loads are not
/// much larger, and stiff enough to hold the arm.
constexpr double first_softness = 0.3;

}  // namespace

LegsFound begin_softened(ArmGroup& group, const LegsProblem& problem, NewtonBudget& budget, double& reached) {
  group.soften(first_softness);
  LegsFound found = begin_at_rest(group, problem, budget, reached);
  if (found.status == Status::converged)
    found = tighten_legs(group, first_softness, problem.prescribed_pose.has_value(), budget);
  else
    group.soften(0);
  return found;
}

LegsFound begin_at_rest(ArmGroup& group, const LegsProblem& problem, NewtonBudget& budget, double& reached) {
  if (problem.prescribed_pose) group.set_problem(problem.commands, ArmGroup::Wrench::Zero(), problem.loads);
  LegsFound found = grow_legs(group, budget, reached);
  if (!problem.prescribed_pose) return found;
  if (found.status == Status::converged) return walk_legs(group, problem, budget, reached);
  reached = 0;
  return found;
}

LegsFound begin_unloaded(ArmGroup& group, const LegsProblem& problem, NewtonBudget& budget, double& reached) {
  LegsProblem free = problem;
  free.prescribed_pose.reset();
  free.wrench.setZero();
  const std::vector<TendonCommand> loose(problem.commands.size());
  group.set_problem(loose, free.wrench, {});
  LegsFound found = grow_legs(group, budget, reached);
  if (found.status == Status::converged) {
    found = walk_legs(group, free, budget, reached);
    if (found.status == Status::converged || found.status == Status::stalled)
      return walk_legs(group, problem, budget, reached);
  }
  reached = 0;
  return found;
}

}  // namespace sinew::inline v1
