#include "kinematics/rods/solve.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "kinematics/rods/start.hpp"
#include "kinematics/rods/trace.hpp"
#include "kinematics/rods/verdict.hpp"
#include "solve/message.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {
namespace {

Report check_inputs(const RodGroup& system, Numbers inputs) {
  if (inputs.size() != at(system.inputs())) {
    Report report = failed(Status::bad_input);
    report.message.append("the robot has ");
    append_number(report.message, system.inputs());
    report.message.append(" inputs, ");
    append_number(report.message, static_cast<int>(inputs.size()));
    report.message.append(" were given");
    return report;
  }
  for (int k = 0; k < system.feeds(); ++k)
    if (!system.in_domain(k, inputs[at(system.input_of(k))])) return beyond_domain(system, k);
  return {};
}

/// Two guides farther apart than their rods and the platform between them reach: no pose exists.
Report check_reach(const RodGroup& system, Numbers inputs) {
  Report report;
  for (int j = 1; j < system.limbs(); ++j)
    for (int k = 0; k < j; ++k) {
      const double apart = (system.base(j) - system.base(k)).norm();
      const double between = (system.platform_point(j) - system.platform_point(k)).norm();
      const double reach = inputs[at(system.input_of(j))] + inputs[at(system.input_of(k))] + between;
      if (apart <= reach) continue;
      report.status = Status::unreachable;
      report.message.append("legs[");
      append_number(report.message, system.leg_of(k));
      report.message.append("] and legs[");
      append_number(report.message, system.leg_of(j));
      report.message.append("] are too short: their guides are ");
      append_mm(report.message, apart);
      report.message.append(" apart, rods and platform reach ");
      append_mm(report.message, reach);
      return report;
    }
  return report;
}

/// Back to the coarse nodes where they resolve the shapes. `before` holds the state.
void lighten(RodWork& work, double truncation) {
  RodGroup& system = *work.system;
  system.coarsen();
  system.evaluate();
  if (system.truncation() > truncation) {
    system.restore(work.before);
    system.evaluate();
  }
  system.linearise();
}

Report begin(RodWork& work, const SE3<double>& home, Numbers inputs, const RodQuestion& question) {
  if (question.warm_start && work.is_solved) return {};
  if (!question.start) return go_home(work, home);
  if (lay_rods(work, *question.start, inputs) || work.is_solved) return {};
  Report report = failed(Status::left_domain);
  report.message.append(
      "the rods cannot be laid to this start: a tip lies on the line of its guide, or behind it; start with "
      "every tip ahead of its guide, or leave start out");
  return report;
}

/// To the target, by its parameter, and where that ends by arc length: only what the curve itself does is a
/// fold.
Report go(RodWork& work, const RodTarget& target, const RodPathOptions& options, bool is_load) {
  RodGroup& system = *work.system;
  const RodTarget begin = present(system);
  RodPathEnd end = follow(system, target, options, work.spare);
  RodFold fold;
  if (!end.arrived && !end.ran_out && !end.stopped && !options.may_stray) {
    fold = find_fold(work, {begin, target, false, {}, {}}, end.progress);
    if (fold.arrived) end.arrived = true, end.residual = fold.residual;
    end.stopped = !end.arrived && !fold.is_found && work.stop.stop_requested();
  }
  if (!end.arrived) return explain(system, end, fold, is_load);
  Report report;
  report.iterations = end.iterations;
  report.residual = end.residual;
  return report;
}

/// First the lengths, then the load; where the unloaded lengths fail, both together.
Report travel(RodWork& work, Numbers inputs, const RodQuestion& question) {
  RodGroup& system = *work.system;
  system.save(work.before);
  const RodPathOptions options{
      .max_iterations = question.max_iterations, .stop = work.stop, .may_stray = question.may_stray};
  const bool is_loaded = question.wrench != RodGroup::Wrench::Zero();
  // from a pose that was asked for, and on a way that is resumed, lengths and load go together
  const bool at_once = question.start || question.warm_start || !is_loaded;
  RodTarget target = target_of(system, inputs, question.wrench);
  if (at_once)
    return go(work, target, options, question.warm_start && target.lengths == present(system).lengths);
  target.wrench.setZero();
  const Report first = go(work, target, options, false);
  if (first.status == Status::stopped) return first;
  target.wrench = question.wrench;
  if (!first.ok()) {
    system.restore(work.before);
    system.evaluate();
    system.linearise();
  }
  Report second = go(work, target, options, first.ok());
  second.iterations += first.iterations;
  return second;
}

/// Newton's method from a start at once: whoever gives a pose wants what is near it. False, with the state as
/// it was, where it does not contract or leads away.
bool jump(RodWork& work, Numbers inputs, const RodQuestion& question, Report& report) {
  RodGroup& system = *work.system;
  system.save(work.before);
  const SE3<double> start = system.platform();
  system.set_inputs(inputs);
  system.set_wrench(question.wrench);
  double error = system.evaluate();
  for (int k = 0; k < 15 && !(error <= 1e-6); ++k) {
    if (!system.linearise()) break;
    const Vec<double, 6> twist = system.step(true);
    if (!(twist.head<3>().norm() + system.radius() * twist.tail<3>().norm() < 0.2 * system.length(0))) break;
    system.move(twist);
    ++report.iterations;
    error = system.evaluate();
  }
  report.status = Status::converged;
  if (error <= 1e-6 && correct(system, report.iterations, report.residual) &&
      (system.platform().p - start.p).norm() < 0.2 * system.length(0))
    return true;
  system.restore(work.before);
  system.evaluate();
  system.linearise();
  return false;
}

}  // namespace

Report solve_rods(RodWork& work, const SE3<double>& home, Numbers inputs, const RodQuestion& asked) {
  work.knows_feeding = false;
  work.signs.reset();
  RodQuestion question = asked;
  question.warm_start = asked.warm_start && work.is_solved;  // else it begins like any other
  if (const Report checked = check_inputs(*work.system, inputs); !checked.ok()) return checked;
  if (!question.wrench.allFinite()) {
    Report report = failed(Status::left_domain);
    report.message.append("the wrench is not a number");
    return report;
  }
  RodGroup& system = *work.system;
  if (Report stopped; note_stop(work.stop, stopped)) return stopped;
  if (question.warm_start) {
    system.save(work.before);
    const double truncation = question.check_stability ? coarse_truncation : system.traits().quick_truncation;
    if (system.can_coarsen(truncation)) lighten(work, truncation);
    system.set_inputs(inputs);
    system.set_wrench(question.wrench);
    Report report;
    if (system.solve_warm(report)) {
      if (question.check_stability)
        report = settle(work, report, truncation);
      else
        resolve(system, report, truncation);
      work.is_solved = report.is_solved();
      return report;
    }
    system.restore(work.before);
    system.evaluate();
    system.linearise();
  }
  if (const Report checked = check_reach(system, inputs); !checked.ok()) return checked;
  if (Report begun = begin(work, home, inputs, question); !begun.ok()) {
    note_stop(work.stop, begun);
    return begun;
  }
  Report report = failed(Status::stalled);
  if (!question.start || !jump(work, inputs, question, report)) report = travel(work, inputs, question);
  work.is_solved = report.ok();
  if (!work.is_solved) return report;
  const Report settled = settle(work, report, system.traits().best_truncation);
  work.is_solved = settled.is_solved();
  return settled;
}

}  // namespace sinew::inline v1
