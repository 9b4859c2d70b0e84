#include "kinematics/arm_legs/forward_from.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/arm_legs/question_check.hpp"
#include "kinematics/arm_legs/search/resolution.hpp"

namespace sinew::inline v1 {
namespace {

void write_stability(ArmGroup& group, ArmLegsState& state) {
  if (!group.clamps_are_aligned()) {
    state.report.status = Status::stalled;
  } else if (state.stable = is_stable(group, false); !state.stable) {
    state.report.status = Status::unstable;
    state.report.message = FixedText<240>(
        group.has_potential()
            ? "the equilibrium does not hold by itself"
            : "whether the equilibrium holds is not known: some of the loads have no potential, and the "
              "symmetric part of its stiffness is not positive definite");
  }
}

/// Of each leg finite curvatures of one part at least.
bool is_shape(const std::vector<std::array<double, 3>>& leg) {
  return !leg.empty() && std::ranges::all_of(leg, [](const std::array<double, 3>& part) {
    return std::ranges::all_of(part, [](double x) { return std::isfinite(x); });
  });
}

}  // namespace

void refine_by_newton(const ArmLegs& robot, const LegsProblem& problem, const ArmOptions& options,
                      ArmLegsWorkspace& work, LegsFound found, NewtonBudget& budget) {
  ArmLegsWorkspace::Impl& impl = work.impl();
  ArmLegsState& state = impl.state;
  state = {};
  impl.level = 0;
  found = refine_levels(robot, problem, options, work, {false, false}, budget, found);
  ArmGroup& group = impl.group();
  state.report = {found.status, budget.iterations, found.residual, {}};
  state.reached = found.status == Status::converged ? 1 : 0;
  if (found.status == Status::converged) {
    write_stability(group, state);
    report_coarse(state.resolution, options.accuracy, legs_size(robot), "platform", state.report);
  }
  write_legs_state(robot, group, state);
}

const ArmLegsState& arm_legs_forward_from(const ArmLegs& robot, const ArmLegsStart& start,
                                          std::span<const TendonCommand> commands, const ArmLegsLoad& load,
                                          const ArmOptions& options, ArmLegsWorkspace& work) {
  ArmLegsWorkspace::Impl& impl = work.impl();
  Report misfit = legs_misfit(robot, commands, load, options, work);
  const auto bad = [&](std::string_view words) {
    if (misfit.ok() && !words.empty()) misfit = {Status::bad_input, 0, 0, FixedText<240>(words)};
  };
  if (start.curvatures.size() != robot.legs.size() || !std::ranges::all_of(start.curvatures, is_shape))
    bad("a shape to begin at has finite curvatures of at least one part of every leg");
  bad(pose_misfit(robot, start.platform, "the pose to begin at"));
  if (!misfit.ok()) return refuse_question(misfit, work);
  const LegsProblem problem(robot, commands, load);
  prepare_levels(options, breaks_for(robot, problem.loads), work);
  impl.levels[0] = std::make_unique<ArmGroup>(robot, bases_of(options).front(), impl.breaks);
  ArmGroup& group = *impl.levels[0];
  group.set_problem(problem.commands, problem.wrench, problem.loads);
  group.take(start);
  NewtonBudget budget(options, work.stop);
  refine_by_newton(robot, problem, options, work, iterate_legs(group, false, budget), budget);
  if (Report& report = impl.state.report; report.message.empty()) {
    if (report.status == Status::stalled)
      report.message = FixedText<240>("no equilibrium was found near the shape to begin at");
    else if (report.status == Status::iteration_limit)
      report.message = FixedText<240>("the bound on iterations was met");
  }
  return impl.state;
}

}  // namespace sinew::inline v1
