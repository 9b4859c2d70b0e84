#include "kinematics/arm_legs/search/legs_walk.hpp"

#include <algorithm>

#include "base/at.hpp"
#include "kinematics/arm_legs/search/continuation.hpp"
#include "kinematics/arm_legs/search/resolution.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {
namespace {

/// Newton's steps, and equilibria that are tried, on the way to one that differs little from the one before
/// [1]: beyond, half the step is tried, which costs less than to follow a way that is this crooked.
constexpr int most_iterations = 60, most_equilibria = 12;

}  // namespace

Report LegsWalk::go_first(const LegsProblem& problem, bool from_last) {
  const ArmLegsWorkspace::Impl& impl = work_.impl();
  ArmOptions options = options_;
  options.from_last = from_last;
  solve_legs(robot_, problem, options, work_, first_);
  before_.reset();
  if (impl.has_last()) before_ = problem;
  return impl.state.report;
}

Report LegsWalk::go(const LegsProblem& problem, bool from_last) {
  ArmLegsWorkspace::Impl& impl = work_.impl();
  if (!from_last || !before_ || !impl.has_last()) return go_first(problem, from_last);
  ArmGroup& group = impl.group();
  group.save(state_);
  ArmOptions options = options_;
  options.max_iterations = std::min(options.max_iterations, most_iterations);
  double reached = 0;
  NewtonBudget budget(options, work_.stop);
  const LegsFound found = walk_legs(group, problem, budget, reached, most_equilibria);
  if (found.status == Status::converged) {
    before_ = problem;
  } else {
    group.set_problem(before_->commands, before_->wrench, before_->loads);
    group.restore(state_);
    group.evaluate();
  }
  write_legs_state(robot_, group, impl.state);
  impl.state.report = {Status::converged, budget.iterations, found.residual, {}};
  impl.state.resolution = 0;
  Report report{found.status, budget.iterations, found.residual, {}};
  if (found.status == Status::stopped) say_stopped(report);
  return report;
}

void LegsWalk::keep() {
  ArmLegsWorkspace::Impl& impl = work_.impl();
  if (before_) kept_.emplace(Kept{*before_, impl.group().state(), impl.level, impl.breaks});
}

void LegsWalk::bring_back() {
  if (!kept_) return;
  ArmLegsWorkspace::Impl& impl = work_.impl();
  impl.level = kept_->level;
  prepare_levels(options_, kept_->breaks, work_);
  if (auto& level = impl.levels[at(impl.level)]; !level)
    level = std::make_unique<ArmGroup>(robot_, bases_of(options_)[at(impl.level)], impl.breaks);
  ArmGroup& group = impl.group();
  group.set_problem(kept_->problem.commands, kept_->problem.wrench, kept_->problem.loads);
  group.restore(kept_->state);
  const double residual = group.evaluate();
  before_ = kept_->problem;
  write_legs_state(robot_, group, impl.state);
  impl.state.report = {Status::converged, 0, residual, {}};
  impl.state.resolution = 0;
  impl.state.reached = 1;
  impl.state.stable = true;
}

}  // namespace sinew::inline v1
