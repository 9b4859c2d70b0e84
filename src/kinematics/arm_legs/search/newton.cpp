#include "kinematics/arm_legs/search/newton.hpp"

#include <cmath>
#include <limits>

namespace sinew::inline v1 {
namespace {

/// The largest turn of a leg or the platform in one of Newton's steps [rad]: up to there a step that is
/// linear in the turn is right to 6 % (sin 0.6 = 0.565), and further ones may lead to other equilibria than
/// the nearest.
constexpr double longest_turn = 0.6;
/// Steps at one share [1]. Near an equilibrium errors square with each, so that a handful does; what takes
/// more than this does not converge, or converges elsewhere, and half the share costs less.
constexpr int most_newton_steps = 15;
/// A step that leaves more than this share of the residual [1] is none of quadratic convergence ...
constexpr double slow_share = 0.3;
/// ... and where two of them follow within this multiple of the tolerance [1] what is left is taken for
/// rounding of large terms that cancel; further away it is a failure to converge.
constexpr double rounding_multiple = 1e3;
/// Tensions over usual ones [1] that are as good as the least, and times that they are looked for [1]: one
/// does where shapes do not depend on them.
constexpr double least_relief = 1e-9;
constexpr int most_reliefs = 3;

}  // namespace

LegsFound iterate_legs(ArmGroup& group, bool is_pose_prescribed, NewtonBudget& budget) {
  LegsFound found;
  double before = std::numeric_limits<double>::infinity();
  bool was_slow = false;
  const auto end = [&](Status status) {
    found.status = status;
    return found;
  };
  for (int steps = 0;; ++steps, ++budget.iterations) {
    found.residual = group.evaluate();
    if (is_pose_prescribed) found.residual = group.limb_error();
    if (!std::isfinite(found.residual)) return end(Status::left_domain);
    if (found.residual <= budget.tolerance) return found;
    const bool is_slow = found.residual > slow_share * before;
    if (found.residual <= rounding_multiple * budget.tolerance && is_slow && was_slow)
      return found;  // as near as rounding lets it
    was_slow = is_slow;
    before = found.residual;
    if (budget.stop.stop_requested()) return end(Status::stopped);
    if (budget.iterations >= budget.max_iterations) return end(Status::iteration_limit);
    if (steps >= most_newton_steps) return end(Status::stalled);
    if (!group.factor_limbs() || !(is_pose_prescribed ? group.plan_at_prescribed_pose() : group.plan()))
      return end(Status::singular);
    if (group.planned_size() > longest_turn) return end(Status::stalled);
    group.move_as_planned();
  }
}

bool is_stable(ArmGroup& group, bool is_pose_prescribed) {
  return group.factor_limbs() &&
         (is_pose_prescribed ? group.unstable_at_prescribed_pose() : group.unstable()) == 0;
}

void come_to_least_tensions(ArmGroup& group, bool is_pose_prescribed, NewtonBudget& budget,
                            LegsFound& found) {
  for (int round = 0; round < most_reliefs && found.status == Status::converged; ++round) {
    if (!group.factor_limbs() || !(group.relief() > least_relief)) return;
    const LimbState before = group.state();
    if (is_pose_prescribed ? group.plan_at_prescribed_pose() : group.plan()) {
      group.move_as_planned();
      ++budget.iterations;
      const LegsFound after = iterate_legs(group, is_pose_prescribed, budget);
      if (after.status == Status::converged && is_stable(group, is_pose_prescribed)) {
        found.residual = after.residual;
        continue;
      }
    }
    group.restore(before);
    group.evaluate();
    return;
  }
}

}  // namespace sinew::inline v1
