#include "kinematics/rods/verdict.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "solve/message.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v1 {
namespace {

/// Of the rods the one nearest to straight: by how much less than its length it spans.
struct Straightest {
  int rod = 0;
  double slack = 1, tension = 0;  ///< 1 − chord/length; axial force in EI/L²
};
Straightest straightest(const RodGroup& system) {
  Straightest found;
  for (int k = 0; k < system.limbs(); ++k) {
    const RodResult rod = system.rod(k);
    const double slack = 1 - rod.chord / rod.length;
    if (slack >= found.slack) continue;
    found = {k, slack, rod.axial_force * rod.length * rod.length / system.stiffness(k)};
  }
  return found;
}

/// Axial force in EI/L² beyond which a rod counts as straight.
constexpr double max_tension = 60;

}  // namespace

bool is_pulled_straight(const RodGroup& system) { return straightest(system).tension > max_tension; }

Report failed(Status status) {
  Report report;
  report.status = status;
  return report;
}

void say(Report& report, std::string_view text) {
  if (!report.message.empty()) report.message.append("; ");
  report.message.append(text);
}

Report explain(const RodGroup& system, const RodPathEnd& end, const RodFold& fold, bool is_load) {
  Report report = failed(Status::singular);
  report.iterations = end.iterations;
  report.residual = end.residual;
  if (end.stopped) {
    say_stopped(report);
    return report;
  }
  if (end.ran_out) {
    report.status = Status::iteration_limit;
    report.message.append("the path to the answer takes more steps than max_iterations; raise it");
    return report;
  }
  const auto percent = [&] {
    append_number(report.message, static_cast<int>(100 * (fold.is_found ? fold.parameter : end.progress)));
    report.message.append(" % of the way");
  };
  if (system.is_finest() && system.truncation() > worst_truncation) {
    report.status = Status::left_domain;
    report.message.append("the rods bend too sharply to be resolved at ");
    percent();
    return report;
  }
  const Straightest tight = straightest(system);
  if (tight.tension > max_tension) {
    report.status = Status::unreachable;
    report.message.append("legs[");
    append_number(report.message, system.leg_of(tight.rod));
    report.message.append("] is pulled straight at ");
    percent();
    report.message.append(is_load ? " to this load; give it less"
                                  : " to these inputs: it is too short for the others");
    return report;
  }
  if (!fold.is_found) {
    report.status = Status::stalled;
    report.message.append("the path ends at ");
    percent();
    report.message.append("; start nearer, or allow more iterations");
    return report;
  }
  if (is_load) {
    report.message.append("the robot buckles at ");
    percent();
    report.message.append(" to this load: a fold, no equilibrium is nearby beyond it");
  } else {
    report.message.append("the inputs pass a fold at ");
    percent();
    report.message.append(" from the start: no equilibrium is nearby beyond it");
  }
  return report;
}

Report beyond_domain(const RodGroup& system, int feed) {
  Report report = failed(Status::left_domain);
  report.message.append("inputs[");
  append_number(report.message, system.input_of(feed));
  report.message.append(feed < system.limbs() ? "] is not a length a rod can have; it must be positive"
                                              : "] is beyond what its leg can do");
  return report;
}

bool is_in_domain(const RodGroup& system, Report& report) {
  for (int k = system.limbs(); k < system.feeds(); ++k) {
    if (system.in_domain(k, system.held(k))) continue;
    const int iterations = report.iterations;
    report = beyond_domain(system, k);
    report.iterations = iterations;
    return false;
  }
  return true;
}

bool resolve(RodGroup& system, Report& report, double truncation) {
  while (!system.is_finest() && system.truncation() > truncation) {
    system.refine();
    if (!correct(system, report.iterations, report.residual)) {
      report.status = Status::stalled;
      say(report, "the rods bend too sharply to be resolved");
      return false;
    }
  }
  if (!(system.truncation() <= std::max(worst_truncation, truncation))) {
    report.status = Status::left_domain;
    say(report, "the rods bend more sharply than their nodes resolve");
    return false;
  }
  return true;
}

LimbSigns count_unstable_rods(RodWork& work) {
  const RodGroup& system = *work.system;
  if (!work.signs)
    work.signs = signs_of(
        system, [&](int rod) { return work.unstable_rods[at(rod)] = system.unstable_with_tip_held(rod); });
  return *work.signs;
}

Report settle(RodWork& work, Report report, double truncation) {
  RodGroup& system = *work.system;
  work.signs.reset();
  if (!is_in_domain(system, report) || !resolve(system, report, truncation)) return report;
  system.linearise();
  const int unstable = count_unstable_rods(work).unstable;
  if (unstable == 0) return report;
  report.status = Status::unstable;
  say(report, "");
  append_number(report.message, unstable);
  report.message.append(unstable == 1 ? " direction in which the robot does not hold by itself"
                                      : " directions in which the robot does not hold by itself");
  return report;
}

}  // namespace sinew::inline v1
