/// All equilibria that are found, stable and unstable, from beginnings that are the same for every question.
#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "base/at.hpp"
#include "kinematics/arm_legs/forward_from.hpp"
#include "kinematics/arm_legs/legs_work.hpp"
#include "kinematics/arm_legs/search/continuation.hpp"
#include "kinematics/arm_legs/search/resolution.hpp"
#include "kinematics/arms/sense_search.hpp"
#include "kinematics/arms/tensions/tension_search.hpp"
#include "kinematics/arms/whole_potential.hpp"

namespace sinew::inline v1 {
namespace {

/// Parts of each leg whose mean curvatures tell its shape [1]: a solution is found again from them, since
/// Newton's method has the forces in its first step.
constexpr int parts = 16;

/// Equilibria are one where platforms differ by less than these, over the longest leg and [rad], and
/// curvatures by less than this, over its inverse: far above what two searches leave, far below what tells
/// equilibria apart.
constexpr double same_place = 1e-4, same_angle = 1e-3, same_curvature = 1e-2;

/// Newton's steps from one beginning [1]: many of them lead nowhere, and none may cost as much as the
/// question itself may.
constexpr int most_steps_of_beginning = 400;

/// How far from home a platform begins, at most: place over the longest leg [1] and turn [rad], within what
/// legs reach that bend; in the plane, where a turn is about one axis, nearly to the other side.
constexpr double farthest_shift = 0.3, farthest_turn = 0.6, farthest_turn_in_plane = 3;
/// Disturbances are such that legs bend much: forces and tensions up to the usual ones, moments up to this
/// share of them over the longest leg, and changes of tendons up to this share of their distance from the
/// backbone, which bends by as many radians [1].
constexpr double largest_moment = 0.3, largest_change = 0.3;

bool is_same(const ArmLegsEquilibrium& a, const ArmLegsEquilibrium& b, double length) {
  const SE3<double>&from = a.state.platform, &to = b.state.platform;
  if ((from.p - to.p).norm() > same_place * length ||
      from.R.compose(to.R.inverse()).log().norm() > same_angle)
    return false;
  for (std::size_t k = 0; k < a.start.curvatures.size(); ++k)
    for (std::size_t j = 0; j < a.start.curvatures[k].size(); ++j)
      for (std::size_t i = 0; i < 3; ++i)
        if (std::abs(a.start.curvatures[k][j][i] - b.start.curvatures[k][j][i]) > same_curvature / length)
          return false;
  return true;
}

/// Beginnings of searches, the same for every question.
class Beginnings {
 public:
  Beginnings(const ArmLegs& robot, const LegsProblem& problem)
      : robot_(robot),
        problem_(problem),
        length_(legs_size(robot)) {
    for (const ArmLeg& leg : robot.legs) force_ += usual_force(leg.arm);
  }
  /// The platform is elsewhere.
  void put(ArmGroup& group) {
    Vec<double, 6> twist = Vec<double, 6>::Zero();
    const double shift = farthest_shift * length_,
                 turn = robot_.is_planar ? farthest_turn_in_plane : farthest_turn;
    for (const int i : {0, 1, 2, 3, 4, 5})
      if (!robot_.is_planar || i < 2 || i > 4) twist[i] = (i < 3 ? shift : turn) * any();
    group.begin_at(group.platform().displaced(twist));
  }
  /// The question with loads and pulls that are to go.
  LegsProblem disturbed() {
    LegsProblem other = problem_;
    const double share = 0.5 * (1 + any());
    for (const int i : {0, 1, 2, 3, 4, 5})
      if (!robot_.is_planar || i < 2 || i > 4)
        other.wrench[i] += share * force_ * (i < 3 ? 1 : largest_moment * length_) * any();
    for (std::size_t next = 0; const ArmLeg& leg : robot_.legs)
      for (const ArmTendon& tendon : leg.arm.tendons) {
        TendonCommand& command = other.commands[next++];
        const double radius = tendon.routes.back().start_radius;
        if (command.held == TendonHeld::tension)
          command.value = std::max(0.0, command.value + share * usual_tension(leg.arm) * any());
        else
          command.value += largest_change * share * radius * any();
      }
    return other;
  }

 private:
  double any() { return between_(random_); }

  const ArmLegs& robot_;
  const LegsProblem& problem_;
  double length_, force_ = 0;
  std::mt19937 random_{1};
  std::uniform_real_distribution<double> between_{-1, 1};
};

/// Equilibria of one question, each once.
class Equilibria {
 public:
  Equilibria(const ArmLegs& robot, const LegsProblem& problem, const ArmOptions& options,
             ArmLegsWorkspace& work)
      : robot_(robot),
        problem_(problem),
        options_(options),
        work_(work) {}
  /// That of the workspace, if it is new.
  void add() {
    ArmLegsWorkspace::Impl& impl = work_.impl();
    if (!impl.state.report.ok() && impl.state.report.status != Status::unstable) return;
    ArmLegsEquilibrium one{impl.state, impl.group().start_here(parts)};
    const double length = legs_size(robot_);
    if (std::ranges::none_of(found,
                             [&](const ArmLegsEquilibrium& other) { return is_same(one, other, length); }))
      found.push_back(std::move(one));
  }
  /// From a disturbed question to the question in two ways: at once by Newton's method, which finds unstable
  /// equilibria, too, and evenly, which keeps to stable ones. @param moves_platform to elsewhere, at first
  void search_from(Beginnings& beginnings, bool moves_platform) {
    ArmLegsWorkspace::Impl& impl = work_.impl();
    impl.levels[0] = std::make_unique<ArmGroup>(robot_, bases_of(options_).front(), impl.breaks);
    ArmGroup& group = *impl.levels[0];
    const LegsProblem disturbed = beginnings.disturbed();
    group.set_problem(disturbed.commands, disturbed.wrench, disturbed.loads);
    if (moves_platform) beginnings.put(group);
    double reached = 0;
    ArmOptions some = options_;
    some.max_iterations = std::min(some.max_iterations, most_steps_of_beginning);
    NewtonBudget there(some, work_.stop), at_once(some, work_.stop), evenly(some, work_.stop);
    const bool has_grown = grow_legs(group, there, reached).status == Status::converged;
    const LimbState state = group.state();
    group.set_problem(problem_.commands, problem_.wrench, problem_.loads);
    group.set_share(1);
    refine_and_add(iterate_legs(group, false, at_once), at_once);
    if (!has_grown) return;
    group.set_problem(disturbed.commands, disturbed.wrench, disturbed.loads);
    group.restore(state);
    group.evaluate();
    refine_and_add(walk_legs(group, problem_, evenly, reached), evenly);
  }

  std::vector<ArmLegsEquilibrium> found;

 private:
  void refine_and_add(const LegsFound& coarse, NewtonBudget& budget) {
    if (coarse.status != Status::converged) return;
    refine_by_newton(robot_, problem_, options_, work_, coarse, budget);
    add();
  }

  const ArmLegs& robot_;
  const LegsProblem& problem_;
  const ArmOptions& options_;
  ArmLegsWorkspace& work_;
};

}  // namespace

std::vector<ArmLegsEquilibrium> arm_legs_equilibria(const ArmLegs& robot,
                                                    std::span<const TendonCommand> commands,
                                                    const ArmLegsLoad& load, const ArmOptions& options,
                                                    int starts, ArmLegsWorkspace& work) {
  ArmOptions each = options;
  each.from_last = false;
  const ArmLegsState first = arm_legs_forward(robot, commands, load, each, work);
  if (first.report.status == Status::bad_input || first.report.status == Status::unsupported)
    return {ArmLegsEquilibrium{first, {}}};
  const LegsProblem problem(robot, commands, load);
  Equilibria equilibria(robot, problem, each, work);
  equilibria.add();
  Beginnings beginnings(robot, problem);
  for (int k = 1; k < starts && !work.stop.stop_requested(); ++k)
    equilibria.search_from(beginnings, k % 2 == 0);
  std::vector<ArmLegsEquilibrium> found = std::move(equilibria.found);
  if (found.empty()) return {ArmLegsEquilibrium{first, {}}};
  std::ranges::stable_sort(
      found, {}, [&](const ArmLegsEquilibrium& one) { return whole_potential(one.state, commands); });
  arm_legs_forward_from(robot, found.front().start, commands, load, each, work);
  return found;
}

}  // namespace sinew::inline v1
