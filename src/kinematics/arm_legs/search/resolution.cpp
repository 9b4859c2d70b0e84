#include "kinematics/arm_legs/search/resolution.hpp"

#include <algorithm>

#include "base/at.hpp"
#include "kinematics/arms/ladder.hpp"

namespace sinew::inline v1 {
namespace {

/// Levels of polynomials at most [1]: between discs an arm has one more, finer than legs are refined to.
constexpr std::size_t most_levels = 5;
/// By how much polynomials that are finer move the platform, or would if it were free [m].
double moved_by(ArmGroup& coarse, ArmGroup& fine, bool is_pose_prescribed) {
  const auto &a = coarse.platform(), &b = fine.platform();
  if (!is_pose_prescribed)
    return (a.p - b.p).norm() + coarse.radius() * (a.R.inverse().compose(b.R)).log().norm();
  const ArmGroup::Wrench change = constraint_wrench(fine) - constraint_wrench(coarse);
  ArmGroup::Matrix twists, by_tendon;
  if (!fine.factor_limbs() || !fine.answers(twists, by_tendon)) return 0;  // at a fold nothing is told
  const Vec<double, 6> twist = twists.rightCols(6) * change;
  return twist.head<3>().norm() + coarse.radius() * twist.tail<3>().norm();
}

/// The error that the finer ones have themselves, as errors fall with the fourth power of elements [m].
double error_left(double moved, const ArmBasis& coarse, const ArmBasis& fine) {
  const double by = static_cast<double>(fine.elements) / coarse.elements;
  return moved / (by * by * by * by - 1);
}

}  // namespace

std::vector<ArmBasis> bases_of(const ArmOptions& options) {
  std::vector<ArmBasis> bases;
  const auto finer = resolutions_of(options);
  if (options.accuracy > 0)
    for (const auto& [order, elements] : finer.first(std::min(finer.size(), most_levels)))
      bases.push_back({options.model, order, elements});
  if (bases.empty()) bases.push_back({options.model, options.order, options.elements});
  return bases;
}

bool levels_are_for(const ArmOptions& options, const ArmLegsWorkspace::Impl& impl) {
  return impl.model == options.model && impl.order == options.order && impl.elements == options.elements &&
         impl.levels.size() == bases_of(options).size();
}

void prepare_levels(const ArmOptions& options, const LegsBreaks& breaks, ArmLegsWorkspace& work) {
  ArmLegsWorkspace::Impl& impl = work.impl();
  if (levels_are_for(options, impl) && impl.breaks == breaks) return;
  impl.levels.clear();
  impl.levels.resize(bases_of(options).size());
  impl.model = options.model, impl.order = options.order, impl.elements = options.elements;
  impl.breaks = breaks;
}

LegsFound refine_levels(const ArmLegs& robot, const LegsProblem& problem, const ArmOptions& options,
                        ArmLegsWorkspace& work, Refinement how, NewtonBudget& budget, LegsFound found) {
  ArmLegsWorkspace::Impl& impl = work.impl();
  const auto bases = bases_of(options);
  const bool is_pose_prescribed = problem.prescribed_pose.has_value();
  for (std::size_t next = at(impl.level + 1); found.status == Status::converged && next < bases.size();
       ++next) {
    auto& level = impl.levels[next];
    if (!level || !how.keeps_groups) level = std::make_unique<ArmGroup>(robot, bases[next], impl.breaks);
    ArmGroup &coarse = *impl.levels[next - 1], &fine = *level;
    fine.set_problem(problem.commands, problem.wrench, problem.loads);
    fine.carry_over_from(coarse);
    fine.set_share(1);
    impl.level = static_cast<int>(next);
    found = iterate_legs(fine, is_pose_prescribed, budget);
    if (how.keeps_stable && found.status == Status::converged && !is_stable(fine, is_pose_prescribed))
      found.status = Status::unstable;
    if (found.status != Status::converged) break;  // what the coarser one found is none of the finer
    impl.state.resolution =
        error_left(moved_by(coarse, fine, is_pose_prescribed), bases[next - 1], bases[next]);
    if (impl.state.resolution <= options.accuracy * legs_size(robot)) break;
  }
  return found;
}

ArmGroup::Wrench constraint_wrench(ArmGroup& group) {
  group.evaluate();
  return group.constraint_wrench();
}

}  // namespace sinew::inline v1
