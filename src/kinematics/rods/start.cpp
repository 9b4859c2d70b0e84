#include "kinematics/rods/start.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/at.hpp"
#include "kinematics/rods/verdict.hpp"

namespace sinew::inline v1 {
RodTarget target_of(const RodGroup& system, Numbers inputs, const Vec<double, 6>& wrench) {
  RodTarget target;
  for (int k = 0; k < system.feeds(); ++k) target.lengths[at(k)] = inputs[at(system.input_of(k))];
  target.wrench = wrench;
  return target;
}

Report go_home(RodWork& work, const SE3<double>& home) {
  if (!work.knows_home) {
    work.is_solved = false;
    if (!work.system->rest_at(home)) {
      Report report = failed(Status::singular);
      if (work.system->closes()) report.message.append("a leg beside the rods cannot close at home, or ");
      report.message.append(work.system->traits().has_no_rest);
      report.message.append("; choose another home");
      return report;
    }
    work.system->save(work.home);
    work.knows_home = true;
    return {};
  }
  work.system->restore(work.home);
  work.system->evaluate();
  work.system->linearise();
  return {};
}

bool lay_rods(RodWork& work, const SE3<double>& pose, Numbers inputs) {
  RodGroup& system = *work.system;
  work.is_solved = false;
  if (!pose.p.allFinite() || !system.rest_at(pose)) return false;
  work.is_solved = true;
  system.save(work.before);
  // from the lengths at which they rest to those that are given, the platform held
  RodTarget from = present(system), to = target_of(system, inputs, from.wrench);
  ParameterPath end;
  constexpr int any = std::numeric_limits<int>::max();
  follow_parameter(end, {{0.25, 1e-3, work.stop}, 0, any}, [&](double next, double taken) {
    system.save(work.spare);
    for (int k = 0; k < system.limbs(); ++k)
      system.set_feed(k, std::lerp(from.lengths[at(k)], to.lengths[at(k)], next));
    double residual;
    if (system.correct_rods(end.iterations, residual, 1e-10))
      return ParameterStep{ParameterStep::reached, 1.5 * taken};
    system.restore(work.spare);
    return ParameterStep{ParameterStep::failed, taken / 3};
  });
  if (!end.arrived) system.restore(work.before);
  work.is_solved = system.balance(false);
  return end.arrived && work.is_solved;
}

}  // namespace sinew::inline v1
