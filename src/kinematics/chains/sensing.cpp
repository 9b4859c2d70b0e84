/// The wrench from tensions.
#include "sinew/kinematics/chain_sensing.hpp"

#include <algorithm>
#include <cmath>

#include "kinematics/chains/path.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v0 {
namespace {

template <class Space>
Report check_measured(const ChainRobot<Space>& robot, std::span<const MeasuredTension> measured,
                      const ChainState<Space>& state) {
  Report report;
  const auto refuse = [&](std::string_view why) {
    report.status = Status::bad_input;
    report.message.append(why);
    return report;
  };
  if (!fits(robot, state)) return refuse("the state is of another robot");
  if (measured.size() != static_cast<std::size_t>(Space::dof))
    return refuse("a wrench is told by as many tensions as the platform has freedoms");
  for (std::size_t k = 0; k < measured.size(); ++k) {
    const auto [leg, tension] = measured[k];
    if (leg < 0 || leg >= static_cast<int>(robot.legs.size()) ||
        state.hold[static_cast<std::size_t>(leg)].length_of < 0 || !std::isfinite(tension))
      return refuse("a tension that is measured is a number, and of a tendon whose length is held");
    for (std::size_t j = 0; j < k; ++j)
      if (measured[j].leg == leg) return refuse("a leg's tension is measured once");
  }
  return check_hold(robot, std::span<const ChainHold>(state.hold));
}

/// ∂wrench/∂tensions = S R⁻¹, S the platform's stiffness and R what its motion does to the tensions.
template <class Space>
Mat<double, Space::dof, Space::dof> by_tensions(const Mat<double, Space::dof, Space::dof>& S,
                                                const Mat<double, Space::dof, Space::dof>& R) {
  Mat<double, Space::dof, Space::dof> rows;
  for (int k = 0; k < Space::dof; ++k)
    rows.row(k) = Solver<Space>::solution(R.transpose(), S.row(k).transpose()).transpose();
  return rows;
}

void say_not_reached(const ParameterPath& end, const ChainWork& work, Report& report) {
  report.status = end.ran_out ? Status::iteration_limit : Status::stalled;
  if (!note_stop(work.stop, report))
    report.message.append(end.ran_out ? "the iterations ran out before these tensions were met"
                                      : "no wrench near the unloaded platform makes the tendons so tense; "
                                        "check the tensions and lengths");
}

}  // namespace

template <class Space>
SensedLoad<Space> sense_wrench(const ChainRobot<Space>& robot, std::span<const MeasuredTension> measured,
                               ChainState<Space>& state, ChainWork& work, const ChainOptions& options) {
  using Motion = Vec<double, Space::dof>;
  SensedLoad<Space> sensed{check_measured(robot, measured, state),
                           Mat<double, Space::dof, Space::dof>::Zero()};
  Report& report = sensed.report;
  if (!report.ok()) return sensed;
  std::vector<MeasuredTension> first(measured.begin(), measured.end()), now = first;
  for (MeasuredTension& one : first) {
    const auto leg = static_cast<std::size_t>(one.leg);
    one.tension = state.legs[leg].tension[static_cast<std::size_t>(state.hold[leg].length_of)];
  }
  work.hold.assign(state.hold.begin(), state.hold.end());
  Solver<Space> solver(robot, work, options);
  solver.measure(now);
  const ParameterPath end = follow_path(solver, state, work, [&](double part) {
    for (std::size_t k = 0; k < now.size(); ++k)
      now[k].tension = std::lerp(first[k].tension, measured[k].tension, part);
    return Motion::Zero().eval();
  });
  measure_tendons(robot, state);
  const auto reached = solver.reduce(state.pose, state.legs, state.hold, Motion::Zero());
  state.wrench = solver.balance();
  report.residual = solver.residual();
  report.iterations = solver.iterations();
  if (end.progress < 1) {
    say_not_reached(end, work, report);
  } else if (!(solver.regularity(reached) > 1e-10)) {
    report.status = Status::singular;
    report.message.append("here the tensions do not tell the wrench: some motion changes none of them");
  } else {
    name_slack(state, report);
    sensed.sensitivity = by_tensions<Space>(stiffness(robot, state, work), reached.S);
  }
  return sensed;
}

#define SINEW_OF(Space)                                                                                   \
  template SINEW_API SensedLoad<Space> sense_wrench(const ChainRobot<Space>&,                             \
                                                    std::span<const MeasuredTension>, ChainState<Space>&, \
                                                    ChainWork&, const ChainOptions&);
SINEW_OF(Planar)
SINEW_OF(Spatial)
#undef SINEW_OF

}  // namespace sinew::inline v0
