/// @file path.hpp
/// Paths of equilibria on chains: how they are followed, and what keeps one from beginning.
#pragma once
#include "kinematics/chains/solver.hpp"
#include "solve/continuation.hpp"

namespace sinew::inline v0 {

/// From an equilibrium on, as long as Newton's method follows; `put` sets what is held, or measured, at a
/// part of the way and answers the wrench there.
template <class Space, class Put>
ParameterPath follow_path(Solver<Space>& solver, ChainState<Space>& state, ChainWork& work, Put&& put) {
  ParameterPath end;
  follow_parameter(end, {{1, 1e-6, work.stop}, 0, solver.max_iterations()}, [&](double next, double taken) {
    const Vec<double, Space::dof> load = put(next);
    auto pose = state.pose;
    work.legs = state.legs;
    const bool is_solved = solver.solve(pose, work.legs, work.hold, load);
    end.iterations = solver.iterations();
    if (!is_solved) return ParameterStep{ParameterStep::failed, taken / 4};
    state.pose = pose;
    std::swap(state.legs, work.legs);
    state.wrench = load;
    return ParameterStep{ParameterStep::reached, 2 * taken};
  });
  return end;
}

void measure_tendons(const auto& leg, ChainLegState& state) {
  for (const int side : {1, -1})
    state.tendon_length[side > 0 ? 0 : 1] =
        leg.chain.tendon_length(state.of(leg.chain), leg.tendon_offset, side);
}

template <class Space>
void measure_tendons(const ChainRobot<Space>& robot, ChainState<Space>& state) {
  for (std::size_t i = 0; i < robot.legs.size(); ++i) measure_tendons(robot.legs[i], state.legs[i]);
}

/// A tendon that pushes by less counts as loose [N].
inline constexpr double slack_tolerance = 1e-9;

template <class Space>
void name_slack(const ChainState<Space>& state, Report& report) {
  for (std::size_t i = 0; i < state.legs.size(); ++i)
    for (std::size_t k = 0; k < 2; ++k)
      if (state.legs[i].tension[k] < -slack_tolerance)
        return say_leg(report, Status::slack, i,
                       k == 0 ? ": tendon 1 would have to push" : ": tendon 2 would have to push");
}

/// Whether a length that is held leaves a leg's joints nothing: one equation for the length, one for the
/// closure, which of evenly bent free ends are the same where there are but two joints.
template <class Space>
bool is_rigid(const ChainLeg<Space>& leg, const ChainHold& hold) {
  return hold.length_of >= 0 && leg.chain.joints() <= (leg.has_strut() ? 1 : 2);
}

/// The largest change of a tendon's length that no joint needs half a turn for [m].
template <class Space>
double most_change(const ChainLeg<Space>& leg) {
  double most = 0;
  for (int j = 0; j < leg.chain.joints(); ++j)
    most += std::numbers::pi * leg.tendon_offset * leg.chain.turn_weight(j);
  return most;
}

/// Why no path can lead to that; ok where one may.
template <class Space>
Report check_hold(const ChainRobot<Space>& robot, std::span<const ChainHold> hold) {
  Report report;
  for (std::size_t i = 0; i < hold.size() && report.ok(); ++i) {
    const ChainLeg<Space>& leg = robot.legs[i];
    if (is_rigid(leg, hold[i])) {
      say_leg(report, Status::singular, i,
              " has so few joints that none can yield while its tendon's length is held; give the link more "
              "joints, or hold tensions");
    } else if (hold[i].length_of >= 0 && !(std::abs(hold[i].length - leg.chain.length) < most_change(leg))) {
      say_leg(report, Status::left_domain, i, ": a tendon that is ");
      append_mm(report.message, hold[i].length);
      report.message.append(
          " long would fold every joint by half a turn; its length at rest changes by at most ");
      append_mm(report.message, most_change(leg));
    }
  }
  return report;
}

/// `singular` where the platform is not held at all.
template <class Space>
void check_regularity(const Solver<Space>& solver, const typename Solver<Space>::Reduced& reduced,
                      Report& report) {
  if (solver.regularity(reduced) > 1e-10) return;
  report.status = Status::singular;
  report.message = {};
  report.message.append("the platform can move with everything held: a type II singularity, see velocity");
}

}  // namespace sinew::inline v0
