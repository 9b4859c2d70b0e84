#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/at.hpp"
#include "kinematics/arm_legs/legs_work.hpp"
#include "kinematics/arms/inverse_search.hpp"
#include "kinematics/arms/sense_search.hpp"
#include "robot/pose.hpp"

namespace sinew::inline v1 {
namespace {

constexpr int parts = 16;  ///< of the shape that is told of each leg

bool holds(ArmGroup& group) { return group.factor_limbs() && group.unstable() == 0; }

/// From the coarsest group's equilibrium to finer ones, by Newton's method alone.
LegsFound refine(const ArmLegs& robot, const LegsProblem& problem, const ArmOptions& options,
                 ArmLegsWorkspace& work, LegsFound found) {
  ArmLegsWorkspace::Impl& impl = work.impl();
  const auto bases = bases_of(options);
  const double wanted = options.accuracy * legs_size(robot);
  impl.level = 0;
  double resolution = 0;
  for (std::size_t next = 1; found.status == Status::converged && next < bases.size(); ++next) {
    ArmGroup& coarse = *impl.levels[next - 1];
    impl.levels[next] = std::make_unique<ArmGroup>(robot, bases[next], impl.breaks);
    ArmGroup& fine = *impl.levels[next];
    fine.set_problem(problem.commands, problem.wrench, problem.loads);
    fine.carry_over_from(coarse);
    fine.set_share(1);
    LegsFound again = iterate_legs(fine, false, options, work.stop, 0);
    again.iterations += found.iterations;
    found = again;
    impl.level = static_cast<int>(next);
    const double by = static_cast<double>(bases[next].elements) / bases[next - 1].elements;
    resolution = moved_by(coarse, fine, false) / (by * by * by * by - 1);
    if (resolution <= wanted) break;
  }
  ArmLegsState& state = impl.state;
  state = {};
  ArmGroup& group = impl.group();
  state.report = {found.status, found.iterations, found.residual, {}};
  state.resolution = resolution;
  state.reached = found.status == Status::converged ? 1 : 0;
  if (found.status == Status::converged) {
    if (!group.clamps_are_aligned()) {
      state.report.status = Status::stalled;
    } else if (state.stable = holds(group); !state.stable) {
      state.report.status = Status::unstable;
      state.report.message = FixedText<240>(
          group.has_potential()
              ? "the equilibrium does not hold by itself"
              : "whether the equilibrium holds is not known: some of the loads have no potential, and the "
                "symmetric part of its stiffness is not positive definite");
    }
    if (resolution > 10 * wanted) {
      state.report.status = Status::stalled;
      state.report.message = FixedText<240>(fmt::format(
          "the finest polynomials still move the platform by {:.1e} m: loads or tensions are too large",
          resolution));
    }
  }
  write_legs_state(robot, group, state);
  return found;
}

/// What is least at an equilibrium that holds: with the motors that hold tensions [J].
double whole_potential(const ArmLegsState& one, std::span<const TendonCommand> commands) {
  double sum = one.energy;
  for (std::size_t i = 0; i < commands.size(); ++i)
    if (commands[i].held == TendonHeld::tension) sum += one.tensions[i] * one.changes[i];
  return sum;
}

bool is_same(const ArmLegsEquilibrium& a, const ArmLegsEquilibrium& b, double length) {
  const SE3<double>&from = a.state.platform, &to = b.state.platform;
  if ((from.p - to.p).norm() > 1e-4 * length || from.R.compose(to.R.inverse()).log().norm() > 1e-3)
    return false;
  for (std::size_t k = 0; k < a.start.curvatures.size(); ++k)
    for (std::size_t j = 0; j < a.start.curvatures[k].size(); ++j)
      for (std::size_t i = 0; i < 3; ++i)
        if (std::abs(a.start.curvatures[k][j][i] - b.start.curvatures[k][j][i]) > 1e-2 / length) return false;
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
    const double shift = 0.3 * length_, turn = robot_.is_planar ? 3 : 0.6;
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
        other.wrench[i] += share * force_ * (i < 3 ? 1 : 0.3 * length_) * any();
    for (std::size_t next = 0; const ArmLeg& leg : robot_.legs)
      for (const ArmTendon& tendon : leg.arm.tendons) {
        TendonCommand& command = other.commands[next++];
        const double radius = tendon.routes.back().start_radius;
        if (command.held == TendonHeld::tension)
          command.value = std::max(0.0, command.value + share * usual_tension(leg.arm) * any());
        else
          command.value += 0.3 * share * radius * any();
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

}  // namespace

const ArmLegsState& arm_legs_forward_from(const ArmLegs& robot, const ArmLegsStart& start,
                                          std::span<const TendonCommand> commands, const ArmLegsLoad& load,
                                          const ArmOptions& options, ArmLegsWorkspace& work) {
  ArmLegsWorkspace::Impl& impl = work.impl();
  Report misfit = legs_misfit(robot, commands, load, options, work);
  const auto bad = [&](std::string_view words) {
    if (misfit.ok()) misfit = {Status::bad_input, 0, 0, FixedText<240>(words)};
  };
  const auto is_shape = [](const std::vector<std::array<double, 3>>& leg) {
    return !leg.empty() && std::ranges::all_of(leg, [](const std::array<double, 3>& part) {
      return std::ranges::all_of(part, [](double x) { return std::isfinite(x); });
    });
  };
  if (start.curvatures.size() != robot.legs.size() || !std::ranges::all_of(start.curvatures, is_shape))
    bad("a shape to begin at has finite curvatures of at least one part of every leg");
  if (!(start.platform.p.allFinite() && start.platform.R.matrix().allFinite()))
    bad("the pose to begin at is not finite");
  if (leaves_plane(robot, start.platform)) bad("the pose to begin at is out of the plane");
  if (!misfit.ok()) {
    impl.state = {};
    impl.state.report = misfit;
    return impl.state;
  }
  const LegsProblem problem(robot, commands, load);
  prepare_levels(options, breaks_for(robot, problem.loads), work);
  impl.levels[0] = std::make_unique<ArmGroup>(robot, bases_of(options).front(), impl.breaks);
  ArmGroup& group = *impl.levels[0];
  group.set_problem(problem.commands, problem.wrench, problem.loads);
  group.take(start);
  refine(robot, problem, options, work, iterate_legs(group, false, options, work.stop, 0));
  if (Report& report = impl.state.report; !report.is_solved() && report.message.empty())
    report.message = FixedText<240>("no equilibrium was found near the shape to begin at");
  return impl.state;
}

std::vector<ArmLegsEquilibrium> arm_legs_equilibria(const ArmLegs& robot,
                                                    std::span<const TendonCommand> commands,
                                                    const ArmLegsLoad& load, const ArmOptions& options,
                                                    int starts, ArmLegsWorkspace& work) {
  ArmLegsWorkspace::Impl& impl = work.impl();
  ArmOptions each = options;
  each.from_last = false;
  ArmLegsState first = arm_legs_forward(robot, commands, load, each, work);
  std::vector<ArmLegsEquilibrium> found;
  const auto add = [&] {
    if (!impl.state.report.ok() && impl.state.report.status != Status::unstable) return;
    ArmLegsEquilibrium one{impl.state, impl.group().start_here(parts)};
    const double length = legs_size(robot);
    if (std::ranges::none_of(found,
                             [&](const ArmLegsEquilibrium& other) { return is_same(one, other, length); }))
      found.push_back(std::move(one));
  };
  const bool is_refused =
      first.report.status == Status::bad_input || first.report.status == Status::unsupported;
  if (!is_refused) add();
  const LegsProblem problem(robot, commands, load);
  Beginnings beginnings(robot, problem);
  for (int k = 1; k < starts && !is_refused && !work.stop.stop_requested(); ++k) {
    impl.levels[0] = std::make_unique<ArmGroup>(robot, bases_of(each).front(), impl.breaks);
    ArmGroup& group = *impl.levels[0];
    const LegsProblem disturbed = beginnings.disturbed();
    group.set_problem(disturbed.commands, disturbed.wrench, disturbed.loads);
    if (k % 2 == 0) beginnings.put(group);
    double reached = 0;
    ArmOptions some = each;
    some.max_iterations = std::min(each.max_iterations, 400);
    const LegsFound there = grow_legs(group, some, work.stop, reached);
    // At once to the question, which may be where it does not hold; and evenly, where it does.
    const LimbState state = group.state();
    group.set_problem(problem.commands, problem.wrench, problem.loads);
    group.set_share(1);
    if (const LegsFound at_once = iterate_legs(group, false, some, work.stop, 0);
        at_once.status == Status::converged) {
      refine(robot, problem, each, work, at_once);
      add();
    }
    if (there.status != Status::converged) continue;
    group.set_problem(disturbed.commands, disturbed.wrench, disturbed.loads);
    group.restore(state);
    group.evaluate();
    const LegsFound evenly = walk_legs(group, problem, some, work.stop, reached);
    if (evenly.status != Status::converged) continue;
    refine(robot, problem, each, work, evenly);
    add();
  }
  if (found.empty()) {
    found.push_back({first, {}});
    return found;
  }
  std::ranges::stable_sort(
      found, {}, [&](const ArmLegsEquilibrium& one) { return whole_potential(one.state, commands); });
  arm_legs_forward_from(robot, found.front().start, commands, load, each, work);
  return found;
}

}  // namespace sinew::inline v1
