#include "kinematics/arm_legs/search/continuation.hpp"

#include <algorithm>
#include <cmath>

#include "robot/pose.hpp"

namespace sinew::inline v1 {
namespace {

/// A shorter step than this share of the way [1] means that the equilibrium is lost: at a fold steps would
/// halve without end, and what was reached is told in hundredths of a per cent.
constexpr double shortest_step = 1e-4;
/// Newton's steps after which the next share may be twice as long [1]: less than half of those it may take,
/// so that there is room for more.
constexpr int quick_newton_steps = 6;

/// All that `put` sets changes from a share of it to the whole; the group is at an equilibrium of the first.
/// @param put what acts, and where a prescribed pose is, at a share of the way
/// @param reached share of it up to which a stable equilibrium was found
template <class Put>
LegsFound continue_to_end(ArmGroup& group, const Put& put, bool is_pose_prescribed, NewtonBudget& budget,
                          double& reached, int max_steps = 0) {
  LegsFound all;
  LimbState last = group.state();
  double step = 1;
  for (int tried = 1;; ++tried) {
    const double share = std::min(1.0, reached + step);
    put(share);
    const int before = budget.iterations;
    const LegsFound found = iterate_legs(group, is_pose_prescribed, budget);
    all.residual = found.residual;
    const bool is_found = found.status == Status::converged && group.clamps_are_aligned();
    if (is_found && is_stable(group, is_pose_prescribed)) {
      reached = share;
      if (share == 1) return all;
      group.save(last);
      if (budget.iterations - before <= quick_newton_steps) step *= 2;
    } else {
      all.last_step = is_found ? Status::unstable : found.status;
      group.restore(last);
      step *= 0.5;
    }
    const bool is_over = found.status == Status::stopped || found.status == Status::iteration_limit;
    if (!is_over && step >= shortest_step && (max_steps == 0 || tried < max_steps)) continue;
    put(reached);
    group.restore(last);
    group.evaluate();
    all.status = is_over ? found.status : Status::stalled;
    return all;
  }
}

/// Tendons become stiffer by this factor at a time [1], less where that leads to no equilibrium, and no more
/// often than factors that do not matter are tried; down to this share of what the arm yields to them [1].
/// Then lengths are off by no more than this over the leg's [1], within reach of Newton's method, or the
/// rounds end.
constexpr double stiffer = 0.1, hardly_stiffer = 0.8, least_softness = 1e-6, nearly_as_long = 1e-9;
constexpr int most_rounds_of_tightening = 40;
/// Where tendons are as stiff as this [1] and one is too long, it is its length that has no equilibrium.
constexpr double short_at = 1e-3;

}  // namespace

LegsFound tighten_legs(ArmGroup& group, double softness, bool is_pose_prescribed, NewtonBudget& budget) {
  LimbState last = group.state();
  double factor = stiffer;
  LegsFound found;
  ArmGroup::LengthError left;
  const auto go_to = [&](double share) {
    group.soften(share);
    found = iterate_legs(group, is_pose_prescribed, budget);
    if (found.status == Status::converged &&
        !(group.clamps_are_aligned() && is_stable(group, is_pose_prescribed)))
      found.status = Status::unstable;
    return found.status == Status::converged;
  };
  for (int round = 0; round < most_rounds_of_tightening && factor < hardly_stiffer; ++round) {
    const double share = std::max(least_softness, factor * softness);
    if (go_to(share)) {
      group.save(last);
      const bool is_stiffest = softness == least_softness;
      softness = share;
      left = group.softened_error();
      if (is_stiffest && std::abs(left.error) < nearly_as_long * left.length) break;
    } else if (found.status == Status::stopped || found.status == Status::iteration_limit) {
      break;
    } else {
      group.restore(last);
      factor = std::sqrt(factor);
    }
  }
  if (found.status != Status::stopped && found.status != Status::iteration_limit && !go_to(0)) {
    found.status = Status::stalled;
    if (softness <= short_at && left.error > nearly_as_long * left.length)
      found = {.status = Status::unreachable,
               .residual = found.residual,
               .short_tendon = left.feed,
               .short_by = left.error};
  }
  group.soften(0);
  return found;
}

ArmGroup::Frame displaced_by_share(const ArmGroup::Frame& from, const Vec<double, 6>& twist, double share) {
  return {from.p + share * twist.head<3>(),
          SO3<double>::exp(Vec3<double>(share * twist.tail<3>())).compose(from.R)};
}

LegsFound grow_legs(ArmGroup& group, NewtonBudget& budget, double& reached) {
  reached = 0;
  return continue_to_end(
      group, [&](double share) { group.set_share(share); }, false, budget, reached);
}

LegsFound walk_legs(ArmGroup& group, const LegsProblem& problem, NewtonBudget& budget, double& reached,
                    int max_steps) {
  LegsProblem on_the_way = problem;
  std::vector<double> first;
  for (std::size_t i = 0; i < problem.commands.size(); ++i)
    first.push_back(group.value_of(static_cast<int>(i), problem.commands[i].held));
  const ArmGroup::Wrench wrench = group.wrench();
  const LegsLoads loads = group.loads();
  const ArmGroup::Frame from = group.platform();
  const auto& pose = problem.prescribed_pose;
  const Vec<double, 6> way = pose ? twist_between(from, *pose) : Vec<double, 6>::Zero();
  const auto put = [&](double share) {
    for (std::size_t i = 0; i < first.size(); ++i)
      on_the_way.commands[i].value = std::lerp(first[i], problem.commands[i].value, share);
    const ArmGroup::Wrench acts = (1 - share) * wrench + share * problem.wrench;
    group.set_problem(on_the_way.commands, acts, mix(loads, problem.loads, share));
    if (pose) group.set_platform(displaced_by_share(from, way, share));
  };
  reached = 0;
  return continue_to_end(group, put, pose.has_value(), budget, reached, max_steps);
}

}  // namespace sinew::inline v1
