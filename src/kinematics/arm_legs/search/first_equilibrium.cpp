#include "kinematics/arm_legs/search/first_equilibrium.hpp"

#include "kinematics/arm_legs/search/continuation.hpp"

namespace sinew::inline v1 {
namespace {

/// From where a search has come to.
LegsFound walk_after(const LegsFound& before, ArmGroup& group, const LegsProblem& problem,
                     const ArmOptions& options, const StopToken& stop, double& reached) {
  LegsFound found = walk_legs(group, problem, options, stop, reached);
  found.iterations += before.iterations;
  return found;
}

}  // namespace

LegsFound begin_at_rest(ArmGroup& group, const LegsProblem& problem, const ArmOptions& options,
                        const StopToken& stop, double& reached) {
  if (problem.prescribed_pose) group.set_problem(problem.commands, ArmGroup::Wrench::Zero(), problem.loads);
  LegsFound found = grow_legs(group, options, stop, reached);
  if (!problem.prescribed_pose) return found;
  if (found.status != Status::converged) {
    reached = 0;
    return found;
  }
  return walk_after(found, group, problem, options, stop, reached);
}

LegsFound begin_unloaded(ArmGroup& group, const LegsProblem& problem, const ArmOptions& options,
                         const StopToken& stop, double& reached) {
  LegsProblem free = problem;
  free.prescribed_pose.reset();
  free.wrench.setZero();
  const std::vector<TendonCommand> loose(problem.commands.size());
  group.set_problem(loose, free.wrench, {});
  LegsFound found = grow_legs(group, options, stop, reached);
  if (found.status == Status::converged) {
    found = walk_after(found, group, free, options, stop, reached);
    if (found.status == Status::converged || found.status == Status::stalled)
      return walk_after(found, group, problem, options, stop, reached);
  }
  reached = 0;
  return found;
}

}  // namespace sinew::inline v1
