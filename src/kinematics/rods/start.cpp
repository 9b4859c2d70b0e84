#include "kinematics/rods/start.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/at.hpp"
#include "kinematics/rods/verdict.hpp"

namespace sinew::inline v0 {
template <class System>
RodTarget target_of(const System& system, Numbers inputs, const Vec<double, 6>& wrench) {
  RodTarget target;
  for (int k = 0; k < system.feeds(); ++k) target.lengths[at(k)] = inputs[at(system.input_of(k))];
  target.wrench = wrench;
  return target;
}

template <class System>
Report go_home(RodWorkOf<System>& work, const SE3<double>& home) {
  if (!work.knows_home) {
    work.is_solved = false;
    if (!rest_at(work.system, home)) {
      Report report = failed(Status::singular);
      if (work.system.closes()) report.message.append("a leg beside the rods cannot close at home, or ");
      report.message.append(System::has_no_rest);
      report.message.append("; choose another home");
      return report;
    }
    work.system.save(work.home);
    work.knows_home = true;
    return {};
  }
  work.system.restore(work.home);
  work.system.evaluate();
  work.system.linearise();
  return {};
}

template <class System>
bool lay_rods(RodWorkOf<System>& work, const SE3<double>& pose, Numbers inputs) {
  System& system = work.system;
  work.is_solved = false;
  if (!pose.p.allFinite() || !rest_at(system, pose)) return false;
  work.is_solved = true;
  system.save(work.before);
  // from the lengths at which they rest to those that are given, the platform held
  RodTarget from = present(system), to = target_of(system, inputs, from.wrench);
  ParameterPath end;
  constexpr int any = std::numeric_limits<int>::max();
  follow_parameter(end, {{0.25, 1e-3, work.stop}, 0, any}, [&](double next, double taken) {
    system.save(work.spare);
    for (int k = 0; k < system.rods(); ++k)
      system.set_length(k, std::lerp(from.lengths[at(k)], to.lengths[at(k)], next));
    double residual;
    if (correct_rods(system, end.iterations, residual, 1e-10))
      return ParameterStep{ParameterStep::reached, 1.5 * taken};
    system.restore(work.spare);
    return ParameterStep{ParameterStep::failed, taken / 3};
  });
  if (!end.arrived) system.restore(work.before);
  system.set_wrench(System::Wrench::Zero());
  system.evaluate();
  system.set_wrench(-system.missing());
  system.evaluate();
  work.is_solved = system.linearise();
  return end.arrived && work.is_solved;
}

#define SINEW_FOR(System)                                                      \
  template RodTarget target_of(const System&, Numbers, const Vec<double, 6>&); \
  template Report go_home(RodWorkOf<System>&, const SE3<double>&);             \
  template bool lay_rods(RodWorkOf<System>&, const SE3<double>&, Numbers);
SINEW_FOR_EACH_ROD_SYSTEM(SINEW_FOR)
#undef SINEW_FOR

}  // namespace sinew::inline v0
