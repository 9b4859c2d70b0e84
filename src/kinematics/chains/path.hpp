/// @file path.hpp
/// Paths of equilibria on chains: how they are followed, and what keeps one from beginning.
#pragma once
#include <cmath>
#include <memory>
#include <numbers>

#include "base/limits.hpp"
#include "kinematics/chains/chain_group.hpp"
#include "kinematics/effort_sensor.hpp"
#include "math/linalg.hpp"
#include "solve/message.hpp"

namespace sinew::inline v1 {

/// An equilibrium that a typed question found, and the robot with its bases as motors turn them.
template <class Space>
struct HeldChains {
  ChainLegs<Space> robot;
  ChainState<Space> state;
  Report report;
};

/// What solvers keep in a caller's `ChainWork` from one question to the next.
template <class Space>
struct ChainMemory {
  ChainGroup<Space> group;
  LimbState spare;
  LimbPlaces<Space> places;
  std::shared_ptr<HeldChains<Space>> held;  ///< what the last typed question found
};

/// The memory of a work. Allocates the first time.
template <class Space>
ChainMemory<Space>& memory_in(ChainWork& work) {
  std::shared_ptr<void>& kept = Space::dimension == 2 ? work.planar : work.spatial;
  if (!kept) kept = std::make_shared<ChainMemory<Space>>();
  return *static_cast<ChainMemory<Space>*>(kept.get());
}

/// The group of a work, at this state. Allocates the first time.
template <class Space>
ChainMemory<Space>& memory_of(ChainWork& work, const ChainLegs<Space>& robot, const ChainState<Space>& state,
                              const ChainOptions& options = {}) {
  auto& memory = memory_in<Space>(work);
  memory.group.set_robot(robot, options.evenly_bent);
  memory.group.set_state(state);
  return memory;
}

/// ... evaluated and linearised there.
template <class Space>
ChainGroup<Space>& linearised(ChainWork& work, const ChainLegs<Space>& robot,
                              const ChainState<Space>& state) {
  ChainGroup<Space>& group = memory_of(work, robot, state).group;
  group.evaluate();
  group.linearise();
  return group;
}

/// A joint that turned further than this since the last equilibrium [rad] may be on another branch: the step
/// is refused.
inline constexpr double chain_reach = 0.5;

/// What a path on chains solves: an `error` of where the group is, and Newton's step that `find_step` plans
/// from there and whose size it tells.
template <class Error, class FindStep>
struct ChainSteps {
  Error error;
  FindStep find_step;
};
template <class Error, class FindStep>
ChainSteps(Error, FindStep) -> ChainSteps<Error, FindStep>;

/// From where the group is, as long as each step is half as long as the one before. Errors alone tell less:
/// one short step along a stiff chord makes them grow, and the next one takes that back. They must be small
/// at last: where closures leave joints nothing, forces change without a step.
template <class Space, class Steps>
bool correct(ChainGroup<Space>& group, int& iterations, const Steps& steps) {
  const LimbTraits& traits = group.traits();
  group.restart();
  double size, left = 0, ahead = 0;
  const auto evaluate = [&] {
    group.evaluate();
    group.linearise();
    left = steps.error();
    ahead = steps.find_step();
    if (left < 1e-13 && ahead < 1e-9) return 0.0;
    return ahead > traits.tolerance ? ahead : std::max(ahead, left);
  };
  const auto step = [&] {
    if (!std::isfinite(ahead)) return false;
    group.move_as_planned();
    return group.turned() < chain_reach;
  };
  return contract(evaluate, step, traits.tolerance, traits.rounding, iterations, size) &&
         left < traits.tolerance;
}

/// From an equilibrium on, as long as Newton's method follows; `put` sets what is held, or measured, at a
/// part of the way. The group is then at the last equilibrium, evaluated and linearised there.
template <class Space, class Put, class Steps>
ParameterPath follow_path(ChainMemory<Space>& memory, StopToken stop, int max_iterations, Put&& put,
                          const Steps& steps) {
  auto& group = memory.group;
  const ParameterPath end = follow_parts(group, memory.spare, {{1, 1e-9, stop}, 0, max_iterations}, put,
                                         [&](int& iterations) { return correct(group, iterations, steps); });
  if (!end.arrived) {
    group.evaluate();
    group.linearise();
  }
  return end;
}

/// Smallest over largest singular value, rows of moments divided by a length and columns of turns by another:
/// 0 where nothing says how the platform moves.
template <class Space>
double regularity(const MatrixView& matrix, double row_length, double column_length) {
  constexpr int turns = Space::dof - Space::dimension;
  Eigen::Matrix<double, Space::dof, Eigen::Dynamic, Eigen::RowMajor, Space::dof, max_rows> scaled = matrix;
  scaled.template bottomRows<turns>() /= row_length;
  scaled.template rightCols<turns>() /= column_length;
  if (!scaled.allFinite()) return 0;
  std::array<double, static_cast<std::size_t>(Space::dof)> sigma;
  singular_values(MatrixView(scaled.data(), scaled.rows(), scaled.cols()), sigma);
  return sigma.back() / sigma.front();
}
/// Of the platform's stiffness.
template <class Space>
double regularity(const ChainGroup<Space>& group) {
  return regularity<Space>(group.stiffness(), group.radius(), group.radius());
}

template <class Space>
void name_slack(const ChainState<Space>& state, Report& report) {
  for (std::size_t i = 0; i < state.legs.size(); ++i)
    for (std::size_t k = 0; k < 2; ++k)
      if (state.legs[i].tension[k] < -slack_tolerance)
        return say_leg(report, Status::slack, i,
                       k == 0 ? ": tendon 1 would have to push" : ": tendon 2 would have to push");
}

/// The largest change of a tendon's length that no joint needs half a turn for [m].
template <class Space>
double max_change(const ChainLeg<Space>& leg) {
  double most = 0;
  for (int j = 0; j < leg.chain.joints(); ++j)
    most += std::numbers::pi * leg.tendon_offset * leg.chain.turn_weight(j);
  return most;
}

/// Why no path can lead to that; ok where one may.
template <class Space>
Report check_hold(const ChainLegs<Space>& robot, std::span<const TendonConstraint> hold) {
  Report report;
  for (std::size_t i = 0; i < hold.size() && report.ok(); ++i) {
    const ChainLeg<Space>& leg = robot.legs[i];
    if (is_rigid(leg, hold[i])) {
      say_leg(report, Status::singular, i,
              " has so few joints that none can yield while its tendon's length is held; give the link more "
              "joints, or hold tensions");
    } else if (hold[i].length_of >= 0 && !(std::abs(hold[i].length - leg.chain.length) < max_change(leg))) {
      say_leg(report, Status::left_domain, i, ": a tendon that is ");
      append_mm(report.message, hold[i].length);
      report.message.append(
          " long would fold every joint by half a turn; its length at rest changes by at most ");
      append_mm(report.message, max_change(leg));
    }
  }
  return report;
}

/// `singular` where the platform is not held at all.
inline void check_regularity(double regularity, Report& report) {
  if (regularity > 1e-10) return;
  report.status = Status::singular;
  report.message = {};
  report.message.append("the platform can move with everything held: a type II singularity, see velocity");
}

}  // namespace sinew::inline v1
