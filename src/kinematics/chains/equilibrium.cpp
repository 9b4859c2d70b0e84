/// Equilibria of platforms on chains: at rest, along paths to a load, with the pose held.
#include <algorithm>
#include <cmath>
#include <limits>

#include "kinematics/chains/path.hpp"
#include "solve/stopped.hpp"

namespace sinew::inline v0 {
namespace {

ChainHold between(const ChainHold& from, const ChainHold& to, double part) {
  ChainHold hold = to;
  hold.length = std::lerp(from.length, to.length, part);
  for (std::size_t k = 0; k < 2; ++k) hold.tension[k] = std::lerp(from.tension[k], to.tension[k], part);
  return hold;
}

/// What the state itself has of the things a leg is to hold.
ChainHold present(const ChainLegState& leg, const ChainHold& to) {
  ChainHold hold{to.length_of, 0, leg.tension};
  if (to.length_of >= 0) hold.length = leg.tendon_length[static_cast<std::size_t>(to.length_of)];
  return hold;
}

void say_how_far(Report& report, double done) {
  report.message.append(report.status == Status::iteration_limit ? "the iterations ran out at "
                                                                 : "the path of equilibria ends at ");
  const int per_mille = static_cast<int>(1000 * done);
  append_number(report.message, per_mille / 10);
  report.message.append(".");
  append_number(report.message, per_mille % 10);
  report.message.append(" % of the way to these inputs and this wrench");
  if (report.status != Status::iteration_limit)
    report.message.append(": it folds, or is lost; another branch (bending) or start may lead on");
}

Report wrong_sizes() {
  Report report;
  report.status = Status::bad_input;
  report.message.append(
      "each leg of the robot needs one value, and a state of its own: give those of this robot");
  return report;
}

/// A path to a wrench, and to what is held where the platform is free.
template <class Space>
Report follow(Solver<Space>& solver, const ChainRobot<Space>& robot, std::span<const ChainHold> hold,
              const Vec<double, Space::dof>& wrench, ChainState<Space>& state, ChainWork& work) {
  work.first.resize(hold.size());
  for (std::size_t i = 0; i < hold.size(); ++i) work.first[i] = present(state.legs[i], hold[i]);
  work.hold.resize(hold.size());
  const Vec<double, Space::dof> first = state.wrench;
  const auto put = [&](double part) -> Vec<double, Space::dof> {
    for (std::size_t i = 0; i < hold.size(); ++i) work.hold[i] = between(work.first[i], hold[i], part);
    return first + part * (wrench - first);
  };
  const ParameterPath end = follow_path(solver, state, work, put);
  const double done = end.progress;
  if (done < 1) put(done);
  state.hold.assign(work.hold.begin(), work.hold.end());
  measure_tendons(robot, state);
  if (done < 1) solver.reduce(state.pose, state.legs, state.hold, state.wrench);  // what is left there
  Report report;
  report.residual = solver.residual();
  report.iterations = solver.iterations();
  if (done < 1) {
    report.status = end.ran_out ? Status::iteration_limit : Status::stalled;
    if (!note_stop(work.stop, report)) say_how_far(report, done);
  } else {
    name_slack(state, report);
  }
  // from a singular start a step may lead anywhere
  if (solver.iterations() > 0) check_regularity(solver, solver.begun(), report);
  if (done == 1) check_regularity(solver, solver.reached(), report);
  return report;
}

/// Tensions and shapes that hold the pose without a wrench, from nearly so.
template <class Space>
Report settle(const ChainRobot<Space>& robot, ChainState<Space>& state) {
  ChainWork work;
  Solver<Space> solver(robot, work, {}, Free::tensions);
  Report report;
  if (!solver.solve(state.pose, state.legs, state.hold, state.wrench)) {
    report.status = Status::unreachable;
    report.message.append("no tensions hold the chains at this pose");
  }
  report.residual = solver.residual();
  measure_tendons(robot, state);
  return report;
}

}  // namespace

template <class Space>
Report rest(const ChainRobot<Space>& robot, const typename Space::Pose& pose,
            std::span<const double> curvature, bool holds_lengths, ChainState<Space>& state) {
  if (curvature.size() != robot.legs.size()) return wrong_sizes();
  state.pose = pose;
  state.legs.assign(robot.legs.size(), {});
  state.hold.assign(robot.legs.size(), {});
  state.wrench.setZero();
  Report report;
  const auto platform = Space::frame(pose);
  ChainClosure<Space> at;
  bool is_even = true;
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    const auto& leg = robot.legs[i];
    ChainLegState& own = state.legs[i];
    const auto n = static_cast<std::size_t>(leg.chain.joints());
    const auto bend = [&](double angle) {
      for (std::size_t j = 0; j < n; ++j) own.angles[j] = angle * even_bend(leg.chain, static_cast<int>(j));
      close_chain(leg, platform, own.of(leg.chain), at);
    };
    double angle = -curvature[i] * leg.chain.link_length();
    if (!leg.has_strut()) {  // the chord shrinks with the bend: start where a series puts it
      bend(0);
      const double short_by = std::max(0.0, -at.c / leg.chain.length);
      const double turn = std::min(5.0, std::sqrt(24 * short_by));
      angle = (curvature[i] < 0 ? 1 : -1) * std::max(turn, 1e-3) / static_cast<double>(n + 1);
    }
    for (int round = 0; round < 50; ++round) {
      bend(angle);
      double slope = 0;
      for (std::size_t j = 0; j < n; ++j) slope += at.c_q[j] * even_bend(leg.chain, static_cast<int>(j));
      const double step = at.c / slope;
      if (!std::isfinite(step)) break;
      angle -= std::clamp(step, -0.2, 0.2);
      if (std::abs(step) < 1e-15) break;
    }
    bend(angle);
    report.residual = worse(report.residual, at.c);
    if (!(std::abs(at.c) < 1e-11 * leg.chain.length) && report.ok())
      say_leg(report, Status::unreachable, i, " has no even bend at this pose near the curvature given");
    const std::size_t inner = inner_tendon(own, leg.chain), last = n - 1;
    const auto pull = leg.chain.tendon_bend(static_cast<int>(last), own.angles[last], leg.tendon_offset,
                                            inner == 0 ? 1 : -1);
    own.tension[inner] = std::abs(leg.spring(static_cast<int>(last)) * own.angles[last] / pull.rate);
    measure_tendons(leg, own);
    // straight tendons pull less at a clamped first joint than at the others: even is no rest there
    is_even = is_even && !(leg.chain.model == ChainModel::discs && leg.chain.base == ChainBase::clamped);
  }
  if (report.ok() && !is_even) report = settle(robot, state);
  for (std::size_t i = 0; i < robot.legs.size(); ++i)
    state.hold[i] = present(
        state.legs[i],
        {holds_lengths ? static_cast<int>(inner_tendon(state.legs[i], robot.legs[i].chain)) : -1, 0, {}});
  return report;
}

template <class Space>
Report equilibrium(const ChainRobot<Space>& robot, std::span<const ChainHold> hold,
                   const Vec<double, Space::dof>& wrench, ChainState<Space>& state, ChainWork& work,
                   const ChainOptions& options) {
  if (hold.size() != robot.legs.size() || state.legs.size() != robot.legs.size()) return wrong_sizes();
  Solver<Space> solver(robot, work, options);
  const Report report = check_hold(robot, hold);
  return report.ok() || options.evenly_bent ? follow(solver, robot, hold, wrench, state, work) : report;
}

template <class Space>
Report hold_pose(const ChainRobot<Space>& robot, const Vec<double, Space::dof>& wrench,
                 ChainState<Space>& state, ChainWork& work, const ChainOptions& options) {
  if (robot.legs.size() < static_cast<std::size_t>(Space::dof)) {
    Report report;
    report.status = Status::unreachable;
    report.message.append(
        "fewer legs than the platform has freedoms hold no pose under load; give the robot more legs");
    return report;
  }
  if (!fits(robot, state)) return wrong_sizes();
  work.near.clear();
  for (std::size_t i = 0; i < robot.legs.size(); ++i)
    work.near.push_back(state.legs[i].tension[inner_tendon(state.legs[i], robot.legs[i].chain)]);
  Solver<Space> solver(robot, work, options, Free::tensions);
  const std::vector<ChainHold> held = state.hold;
  const std::vector<ChainHold> hold(held.size());  // whatever tensions come out
  const Report report = follow(solver, robot, hold, wrench, state, work);
  for (std::size_t i = 0; i < hold.size(); ++i) state.hold[i] = present(state.legs[i], held[i]);
  return report;
}

template <class Space>
Mat<double, Space::dof, Space::dof> stiffness(const ChainRobot<Space>& robot, const ChainState<Space>& state,
                                              ChainWork& work) {
  if (!fits(robot, state))
    return Mat<double, Space::dof, Space::dof>::Constant(std::numeric_limits<double>::quiet_NaN());
  Solver<Space> solver(robot, work, {});
  return solver.reduce(state.pose, state.legs, state.hold, state.wrench).S;
}

template <class Space>
Mat<double, Space::dof, Space::dof> compliance(const ChainRobot<Space>& robot, const ChainState<Space>& state,
                                               ChainWork& work) {
  const auto S = stiffness(robot, state, work);
  Mat<double, Space::dof, Space::dof> C;
  for (int k = 0; k < Space::dof; ++k)
    C.col(k) = Solver<Space>::solution(S, Vec<double, Space::dof>::Unit(k));
  return C;
}

#define SINEW_OF(Space)                                                                                   \
  template SINEW_API Report rest(const ChainRobot<Space>&, const Space::Pose&, std::span<const double>,   \
                                 bool, ChainState<Space>&);                                               \
  template SINEW_API Report equilibrium(const ChainRobot<Space>&, std::span<const ChainHold>,             \
                                        const Vec<double, Space::dof>&, ChainState<Space>&, ChainWork&,   \
                                        const ChainOptions&);                                             \
  template SINEW_API Report hold_pose(const ChainRobot<Space>&, const Vec<double, Space::dof>&,           \
                                      ChainState<Space>&, ChainWork&, const ChainOptions&);               \
  template SINEW_API Mat<double, Space::dof, Space::dof> stiffness(const ChainRobot<Space>&,              \
                                                                   const ChainState<Space>&, ChainWork&); \
  template SINEW_API Mat<double, Space::dof, Space::dof> compliance(const ChainRobot<Space>&,             \
                                                                    const ChainState<Space>&, ChainWork&);
SINEW_OF(Planar)
SINEW_OF(Spatial)
#undef SINEW_OF

}  // namespace sinew::inline v0
