#include "sinew/kinematics/arm_legs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

#include "base/at.hpp"
#include "kinematics/arm_legs/legs_work.hpp"
#include "kinematics/load_problem.hpp"
#include "math/plane_axes.hpp"
#include "robot/pose.hpp"

namespace sinew::inline v1 {

ArmLegsWorkspace::ArmLegsWorkspace(const ArmLegs& robot) : impl_(std::make_unique<Impl>()) {
  impl_->robot = robot.identity;
}
ArmLegsWorkspace::~ArmLegsWorkspace() = default;
ArmLegsWorkspace::ArmLegsWorkspace(ArmLegsWorkspace&&) noexcept = default;
ArmLegsWorkspace& ArmLegsWorkspace::operator=(ArmLegsWorkspace&&) noexcept = default;

namespace {

struct Finer {
  int order, elements;
};
constexpr std::array<Finer, 4> along_a_section{{{-1, 8}, {5, 16}, {7, 32}, {9, 64}}};
constexpr std::array<Finer, 5> from_disc_to_disc{{{-1, 2}, {3, 3}, {4, 5}, {5, 8}, {6, 13}}};

std::span<const Finer> finer_bases(const ArmOptions& options) {
  if (options.order >= 0 || options.elements > 0 || !(options.accuracy > 0)) return {};
  if (options.model == ArmModel::rod) return along_a_section;
  if (options.model == ArmModel::subsegment_rod) return from_disc_to_disc;
  return {};
}

/// By more a step of Newton's method may not turn a leg or the platform [rad].
constexpr double longest_turn = 0.6;

}  // namespace

LegsFound iterate_legs(ArmGroup& group, bool is_held, const ArmOptions& options, const StopToken& stop,
                       int spent) {
  LegsFound found;
  double before = std::numeric_limits<double>::infinity();
  bool is_slow = false;
  for (;; ++found.iterations) {
    found.residual = group.evaluate();
    if (is_held) found.residual = group.limb_error();
    if (!std::isfinite(found.residual)) {
      found.status = Status::left_domain;
      return found;
    }
    if (found.residual <= options.tolerance) return found;
    if (found.residual <= 1e3 * options.tolerance && found.residual > 0.3 * before && is_slow)
      return found;  // as near as rounding lets it
    is_slow = found.residual > 0.3 * before;
    before = found.residual;
    if (stop.stop_requested()) {
      found.status = Status::stopped;
      return found;
    }
    if (spent + found.iterations >= options.max_iterations) {
      found.status = Status::iteration_limit;
      return found;
    }
    if (found.iterations >= 15) {
      found.status = Status::stalled;
      return found;
    }
    if (!group.factor_limbs() || !(is_held ? group.plan_at_prescribed_pose() : group.plan())) {
      found.status = Status::singular;
      return found;
    }
    if (group.planned_size() > longest_turn) {
      found.status = Status::stalled;
      return found;
    }
    group.move_as_planned();
  }
}

namespace {

/// All that `put` sets changes from a share of it to the whole, in steps that adapt; the group is at an
/// equilibrium of the first share.
/// @param put what acts, and where a held platform is, at a share of the way
/// @param reached share of it up to which an equilibrium that holds was found
template <class Put>
LegsFound grow(ArmGroup& group, const Put& put, bool is_held, const ArmOptions& options,
               const StopToken& stop, double& reached, int parts = 0) {
  constexpr double least = 1e-4;
  LegsFound all;
  LimbState last = group.state();
  double step = 1;
  for (int part = 1;; ++part) {
    const double share = std::min(1.0, reached + step);
    put(share);
    const LegsFound found = iterate_legs(group, is_held, options, stop, all.iterations);
    all.iterations += found.iterations;
    all.residual = found.residual;
    if (found.status == Status::stopped || found.status == Status::iteration_limit) {
      all.status = found.status;
      return all;
    }
    const bool is_found = found.status == Status::converged && group.clamps_are_aligned();
    if (is_found && group.factor_limbs() &&
        (is_held ? group.unstable_at_prescribed_pose() : group.unstable()) == 0) {
      reached = share;
      if (share == 1) return all;
      group.save(last);
      if (found.iterations <= 6) step *= 2;
    } else {
      all.last = is_found ? Status::unstable : found.status;
      group.restore(last);
      step *= 0.5;
    }
    if (step >= least && (parts == 0 || part < parts)) continue;
    put(reached);
    group.restore(last);
    group.evaluate();
    all.status = Status::stalled;
    return all;
  }
}

ArmGroup::Frame between(const ArmGroup::Frame& from, const Vec<double, 6>& twist, double share) {
  return {from.p + share * twist.head<3>(),
          SO3<double>::exp(Vec3<double>(share * twist.tail<3>())).compose(from.R)};
}

std::string_view words_for(Status status, bool has_potential) {
  switch (status) {
    case Status::stalled:
      if (!has_potential)
        return "inputs and loads led to an equilibrium that is known to hold up to {:.2f} % of them, and "
               "beyond to none: some of the loads have no potential, and what is beyond may hold or not";
      return "inputs and loads led to an equilibrium that holds up to {:.2f} % of them, and beyond to none";
    case Status::iteration_limit:
      return "the bound on iterations was met at {:.2f} % of inputs and loads";
    case Status::stopped:
      return "stopped at {:.2f} % of inputs and loads";
    default:
      return "";
  }
}

/// A leg that the pose is too far from, by more than it may stretch, in words; or empty.
std::string out_of_reach(const ArmLegs& robot, const ArmGroup::Frame& pose) {
  for (std::size_t k = 0; k < robot.legs.size(); ++k) {
    const ArmLeg& leg = robot.legs[k];
    const double way = (pose.point(leg.platform_point) - leg.base.p).norm(),
                 length = leg.arm.length() + leg.strut;
    const bool stretches = std::ranges::any_of(
        leg.arm.sections, [](const ArmSection& section) { return section.start.stretch > 0; });
    if (way > (1 + (stretches ? 1e-2 : 1e-9)) * length)
      return fmt::format(
          "leg {} is out of reach: from its base to the platform it is {:.4g} m, and it is {:.4g} m long", k,
          way, length);
  }
  return {};
}

/// Why a platform is not held at the pose, and the way out.
std::string words_of_held(const ArmLegs& robot, const LegsProblem& problem, const LegsFound& found,
                          double reached) {
  const std::string far = out_of_reach(robot, *problem.held);
  if (!far.empty()) return far;
  if (reached == 1)
    return "coarse polynomials hold the platform at the pose, and finer ones do not: a leg is pulled or bent "
           "too sharply for them";
  const char* why =
      found.last == Status::unstable
          ? "a leg gives way by itself: bend it by tensions, or lead the platform there by track"
      : found.last == Status::singular
          ? "a leg that is straight and does not stretch has no finite stiffness: bend it by tensions"
          : "no equilibrium was found: lead the platform there by track, or give less load";
  return fmt::format("legs held the platform up to {:.2f} % of the way to the pose, and beyond {}",
                     100 * reached, why);
}

/// From where a search has come to.
LegsFound walk_after(const LegsFound& before, ArmGroup& group, const LegsProblem& problem,
                     const ArmOptions& options, const StopToken& stop, double& reached) {
  LegsFound found = walk_legs(group, problem, options, stop, reached);
  found.iterations += before.iterations;
  return found;
}

/// With the platform free; to where it is to be held it goes from there, since legs at rest are straight and
/// would be pressed on a straight way to it.
LegsFound begin_at_rest(ArmGroup& group, const LegsProblem& problem, const ArmOptions& options,
                        const StopToken& stop, double& reached) {
  if (problem.held) group.set_problem(problem.commands, ArmGroup::Wrench::Zero(), problem.loads);
  LegsFound found = grow_legs(group, options, stop, reached);
  if (!problem.held) return found;
  if (found.status != Status::converged) {
    reached = 0;
    return found;
  }
  return walk_after(found, group, problem, options, stop, reached);
}

/// Where legs do not bear a free platform under what acts: without it, then under as much as they bear; the
/// rest comes while the platform is held and goes to its pose. Of a group at rest.
LegsFound begin_unloaded(ArmGroup& group, const LegsProblem& problem, const ArmOptions& options,
                         const StopToken& stop, double& reached) {
  LegsProblem free = problem;
  free.held.reset();
  free.wrench.setZero();
  const std::vector<TendonCommand> loose(problem.commands.size());
  group.set_problem(loose, free.wrench, {});
  LegsFound found = grow_legs(group, options, stop, reached);
  if (found.status == Status::converged) {
    found = walk_after(found, group, free, options, stop, reached);
    if (found.status == Status::converged || found.status == Status::stalled)
      return walk_after(found, group, problem, options, stop, reached);
  }
  reached = 0;
  return found;
}

ArmGroup::Wrench missing_of(ArmGroup& group) {
  group.evaluate();
  return group.constraint_wrench();
}

}  // namespace

double moved_by(ArmGroup& coarse, ArmGroup& fine, bool is_held) {
  const auto &a = coarse.platform(), &b = fine.platform();
  if (!is_held) return (a.p - b.p).norm() + coarse.radius() * (a.R.inverse().compose(b.R)).log().norm();
  const ArmGroup::Wrench change = missing_of(fine) - missing_of(coarse);
  ArmGroup::Matrix twists, by_tendon;
  if (!fine.factor_limbs() || !fine.answers(twists, by_tendon)) return 0;  // at a fold nothing is told
  const Vec<double, 6> twist = twists.rightCols(6) * change;
  return twist.head<3>().norm() + coarse.radius() * twist.tail<3>().norm();
}

LegsFound grow_legs(ArmGroup& group, const ArmOptions& options, const StopToken& stop, double& reached) {
  reached = 0;
  return grow(
      group, [&](double share) { group.set_share(share); }, false, options, stop, reached);
}

std::vector<ArmBasis> bases_of(const ArmOptions& options) {
  std::vector<ArmBasis> bases;
  for (const Finer& finer : finer_bases(options))
    bases.push_back({options.model, finer.order, finer.elements});
  if (bases.empty()) bases.push_back({options.model, options.order, options.elements});
  return bases;
}

namespace {

bool is_for(const ArmOptions& options, const ArmLegsWorkspace::Impl& impl) {
  return impl.model == options.model && impl.order == options.order && impl.elements == options.elements &&
         impl.levels.size() == bases_of(options).size();
}

}  // namespace

void prepare_levels(const ArmOptions& options, const LegsBreaks& breaks, ArmLegsWorkspace& work) {
  ArmLegsWorkspace::Impl& impl = work.impl();
  if (is_for(options, impl) && impl.breaks == breaks) return;
  impl.levels.clear();
  impl.levels.resize(bases_of(options).size());
  impl.model = options.model, impl.order = options.order, impl.elements = options.elements;
  impl.breaks = breaks;
}

LegsProblem::LegsProblem(const ArmLegs& robot, std::span<const TendonCommand> tendons,
                         const ArmLegsLoad& load)
    : commands(tendons.begin(), tendons.end()),
      loads{.gravity = load.gravity.value_or(robot.gravity),
            .along = load.along,
            .following_along = load.following_along,
            .following = load.following,
            .points = load.points} {
  std::copy(load.wrench.begin(), load.wrench.end(), wrench.begin());
}

namespace {

/// In base axes, and in those of a leg in the plane, whose y axis is square to it.
bool leaves_plane(const std::array<double, 6>& wrench) {
  return std::ranges::any_of(axes_out_of_plane, [&](std::size_t k) { return wrench[k] != 0; });
}
bool leaves_own_plane(const std::array<double, 6>& wrench) {
  return wrench[1] != 0 || wrench[3] != 0 || wrench[5] != 0;
}

/// Of loads on legs.
Report loads_misfit(const ArmLegs& robot, const ArmLegsLoad& load) {
  const auto bad = [](const std::string& words) {
    return Report{Status::bad_input, 0, 0, FixedText<240>(words)};
  };
  for (std::size_t i = 0; i < load.points.size(); ++i) {
    const ArmLegsPointLoad& point = load.points[i];
    if (point.leg >= robot.legs.size())
      return bad(fmt::format("load {} is on leg {}, the robot has {} legs, counted from 0", i, point.leg,
                             robot.legs.size()));
    const double length = robot.legs[point.leg].arm.length();
    if (!(point.place > 0 && point.place <= length * (1 + 1e-12)))
      return bad(
          fmt::format("load {} is at {} m of leg {}, which is {} m long", i, point.place, point.leg, length));
    if (!std::ranges::all_of(point.wrench, [](double x) { return std::isfinite(x); }))
      return bad(fmt::format("load {} is not finite", i));
  }
  return {Status::converged, 0, 0, {}};
}

}  // namespace

Report legs_misfit(const ArmLegs& robot, std::span<const TendonCommand> commands, const ArmLegsLoad& load,
                   const ArmOptions& options, const ArmLegsWorkspace& work) {
  const auto bad = [](const std::string& words) {
    return Report{Status::bad_input, 0, 0, FixedText<240>(words)};
  };
  if (work.impl().robot != robot.identity) return bad("the workspace is for another robot");
  if (commands.size() != robot.tendons())
    return bad(fmt::format("the legs have {} tendons, found {} commands", robot.tendons(), commands.size()));
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (!std::isfinite(commands[i].value)) return bad(fmt::format("what holds tendon {} is not finite", i));
    if (commands[i].held == TendonHeld::tension && commands[i].value < 0)
      return bad(fmt::format("tendon {} would have to push with {} N: tensions are at least 0", i,
                             -commands[i].value));
  }
  const auto finite = [](double x) { return std::isfinite(x); };
  if (!std::ranges::all_of(load.wrench, finite) || !std::ranges::all_of(load.along, finite) ||
      !std::ranges::all_of(load.following, finite) || !std::ranges::all_of(load.following_along, finite) ||
      (load.gravity && !std::ranges::all_of(*load.gravity, finite)))
    return bad("a load is not finite");
  if (const Report misfit = loads_misfit(robot, load); !misfit.ok()) return misfit;
  if (robot.is_planar) {
    const auto& gravity = load.gravity.value_or(robot.gravity);
    if (leaves_plane(load.wrench) || leaves_plane(load.following) || gravity[2] != 0 || load.along[2] != 0 ||
        load.following_along[1] != 0 || std::ranges::any_of(load.points, [](const auto& point) {
          return point.following ? leaves_own_plane(point.wrench) : leaves_plane(point.wrench);
        }))
      return bad("a load acts out of the plane, in which alone the robot moves: leave that part of it out");
  }
  if (options.balance != ArmBalance::energy)
    return {Status::unsupported, 0, 0,
            FixedText<240>("legs balance by energy alone in this version: leave balance out")};
  return {Status::converged, 0, 0, {}};
}

void write_legs_state(const ArmLegs& robot, const ArmGroup& group, ArmLegsState& state) {
  state.platform = group.platform();
  const int count = group.feeds();
  for (auto* values : {&state.tensions, &state.changes, &state.slack}) values->resize(at(count));
  for (int i = 0; i < count; ++i) {
    state.tensions[at(i)] = group.tension(i);
    state.changes[at(i)] = group.change(i);
    state.slack[at(i)] = group.slack(i);
  }
  state.tip_loads.resize(robot.legs.size());
  for (int k = 0; k < group.limbs(); ++k) {
    const auto wrench = group.tip_wrench(k);
    std::copy(wrench.begin(), wrench.end(), state.tip_loads[at(k)].begin());
  }
  state.energy = group.potential();
}

bool leaves_plane(const ArmLegs& robot, const SE3<double>& pose) {
  constexpr double rounding = 1e-12;
  return robot.is_planar && (std::abs(pose.p[2]) > rounding * legs_size(robot) ||
                             std::abs(pose.R.v[0]) > rounding || std::abs(pose.R.v[1]) > rounding);
}

double legs_size(const ArmLegs& robot) {
  double size = 0;
  for (const ArmLeg& leg : robot.legs) size = std::max(size, leg.arm.length());
  return size;
}

LegsFound walk_legs(ArmGroup& group, const LegsProblem& problem, const ArmOptions& options,
                    const StopToken& stop, double& reached, int parts) {
  LegsProblem on_the_way = problem;
  std::vector<double> first;
  for (std::size_t i = 0; i < problem.commands.size(); ++i)
    first.push_back(group.value_of(static_cast<int>(i), problem.commands[i].held));
  const ArmGroup::Wrench wrench = group.wrench();
  const LegsLoads loads = group.loads();
  const ArmGroup::Frame from = group.platform();
  const Vec<double, 6> way = problem.held ? twist_between(from, *problem.held) : Vec<double, 6>::Zero();
  const auto put = [&](double share) {
    for (std::size_t i = 0; i < first.size(); ++i)
      on_the_way.commands[i].value = std::lerp(first[i], problem.commands[i].value, share);
    const ArmGroup::Wrench acts = (1 - share) * wrench + share * problem.wrench;
    group.set_problem(on_the_way.commands, acts, mix(loads, problem.loads, share));
    if (problem.held) group.set_platform(between(from, way, share));
  };
  reached = 0;
  return grow(group, put, problem.held.has_value(), options, stop, reached, parts);
}

Report LegsWalk::go(const LegsProblem& problem, bool from_last) {
  ArmLegsWorkspace::Impl& impl = work_.impl();
  if (!from_last || !before_ || !impl.has_last()) {
    ArmOptions options = options_;
    options.from_last = from_last;
    solve_legs(robot_, problem, options, work_, first_);
    before_.reset();
    if (impl.has_last()) before_ = problem;
    return impl.state.report;
  }
  ArmGroup& group = impl.group();
  group.save(state_);
  ArmOptions options = options_;
  options.max_iterations = std::min(options.max_iterations, 60);
  double reached = 0;
  const LegsFound found = walk_legs(group, problem, options, work_.stop, reached, 12);
  if (found.status == Status::converged) {
    before_ = problem;
  } else {
    group.set_problem(before_->commands, before_->wrench, before_->loads);
    group.restore(state_);
    group.evaluate();
  }
  write_legs_state(robot_, group, impl.state);
  impl.state.report = {Status::converged, found.iterations, found.residual, {}};
  impl.state.resolution = 0;
  return {found.status, found.iterations, found.residual, {}};
}

void LegsWalk::keep() {
  ArmLegsWorkspace::Impl& impl = work_.impl();
  if (before_) kept_.emplace(Kept{*before_, impl.group().state(), impl.level, impl.breaks});
}

void LegsWalk::bring_back() {
  if (!kept_) return;
  ArmLegsWorkspace::Impl& impl = work_.impl();
  impl.level = kept_->level;
  prepare_levels(options_, kept_->breaks, work_);
  if (auto& level = impl.levels[at(impl.level)]; !level)
    level = std::make_unique<ArmGroup>(robot_, bases_of(options_)[at(impl.level)], impl.breaks);
  ArmGroup& group = impl.group();
  group.set_problem(kept_->problem.commands, kept_->problem.wrench, kept_->problem.loads);
  group.restore(kept_->state);
  const double residual = group.evaluate();
  before_ = kept_->problem;
  write_legs_state(robot_, group, impl.state);
  impl.state.report = {Status::converged, 0, residual, {}};
  impl.state.resolution = 0;
  impl.state.reached = 1;
  impl.state.stable = true;
}

void solve_legs(const ArmLegs& robot, const LegsProblem& problem, const ArmOptions& options,
                ArmLegsWorkspace& work, LegsEnd end) {
  ArmLegsWorkspace::Impl& impl = work.impl();
  const bool is_held = problem.held.has_value();
  const auto bases = bases_of(options);
  const bool goes_on = options.from_last && is_for(options, impl) && impl.has_last();
  // Rods have nodes where loads act: groups are made anew where others are to. Loads that go need theirs on
  // the way, and no longer.
  const LegsBreaks breaks = breaks_for(robot, problem.loads);
  std::unique_ptr<ArmGroup> parted;
  if (!goes_on) {
    prepare_levels(options, breaks, work);
  } else if (!has_all(impl.breaks, breaks)) {
    parted = std::move(impl.levels[at(impl.level)]);
    prepare_levels(options, together(breaks, breaks_for(robot, parted->loads())), work);
  }
  ArmLegsState& state = impl.state;
  state = {};
  const auto put = [&](ArmGroup& group) {
    group.set_problem(problem.commands, problem.wrench, problem.loads);
  };
  const auto ready = [&](std::size_t level) -> ArmGroup& {
    // Anew: the rest of a group is where its shapes are those at rest.
    impl.levels[level] = std::make_unique<ArmGroup>(robot, bases[level], impl.breaks);
    put(*impl.levels[level]);
    return *impl.levels[level];
  };
  LegsFound found;
  ArmGroup* group = nullptr;
  std::size_t level = 0;
  bool began_anew = false;
  if (goes_on) {
    // One level coarser: the next one then says how far both are off.
    level = at(std::max(0, impl.level - 1));
    const ArmGroup& last = parted ? *parted : impl.group();
    if (!impl.levels[level])
      impl.levels[level] = std::make_unique<ArmGroup>(robot, bases[level], impl.breaks);
    group = impl.levels[level].get();
    if (group != &last) {
      std::vector<TendonCommand> commands = problem.commands;
      for (std::size_t i = 0; i < commands.size(); ++i)
        commands[i].value = last.value_of(static_cast<int>(i), commands[i].held);
      group->carry_over_from(last);
      group->set_problem(commands, last.wrench(), last.loads());
      group->set_share(1);
    }
    found = walk_legs(*group, problem, options, work.stop, state.reached);
    began_anew =
        end != LegsEnd::on_the_way && found.status != Status::converged && found.status != Status::stopped;
  }
  if (!goes_on || began_anew) {
    const int spent = found.iterations;
    level = 0;
    group = &ready(0);
    found = begin_at_rest(*group, problem, options, work.stop, state.reached);
    if (is_held && found.status == Status::stalled && state.reached == 0) {
      const LegsFound before = found;
      group = &ready(0);
      found = begin_unloaded(*group, problem, options, work.stop, state.reached);
      found.iterations += before.iterations;
    }
    found.iterations += spent;
  }
  impl.level = static_cast<int>(level);
  const double wanted = options.accuracy * legs_size(robot);
  for (std::size_t next = level + 1;
       found.status == Status::converged && next < bases.size() && end != LegsEnd::coarse; ++next) {
    const bool is_there = goes_on && !began_anew && impl.levels[next];
    ArmGroup& finer = is_there ? *impl.levels[next] : ready(next);
    if (is_there) put(finer);
    finer.carry_over_from(*group);
    finer.set_share(1);
    LegsFound again = iterate_legs(finer, is_held, options, work.stop, found.iterations);
    if (again.status == Status::converged &&
        (!finer.factor_limbs() || (is_held ? finer.unstable_at_prescribed_pose() : finer.unstable()) != 0))
      again.status = Status::unstable;
    again.iterations += found.iterations;
    if (again.status != Status::converged) {  // what the coarser one found is none of the finer
      found = again;
      impl.level = static_cast<int>(next);
      group = &finer;
      break;
    }
    found = again;
    const double moved = moved_by(*group, finer, is_held);
    const double by = static_cast<double>(bases[next].elements) / bases[next - 1].elements;
    const double ratio = by * by * by * by;
    group = &finer;
    impl.level = static_cast<int>(next);
    state.resolution = moved / (ratio - 1);
    if (state.resolution <= wanted) break;
  }
  state.report.status = found.status;
  state.report.iterations = found.iterations;
  state.report.residual = found.residual;
  if (found.status == Status::unstable || found.status == Status::singular)
    state.report.message = FixedText<240>("what coarser polynomials found does not hold by finer ones");
  else if (found.status != Status::converged)
    state.report.message =
        FixedText<240>(is_held && found.status == Status::stalled
                           ? words_of_held(robot, problem, found, state.reached)
                           : fmt::format(fmt::runtime(words_for(found.status, group->loads_have_potential())),
                                         100 * state.reached));
  else if (began_anew)
    state.report.message = FixedText<240>(
        "from the last equilibrium none that holds was found on the way here; this is what the rest grows "
        "into");
  if (state.report.ok() && state.resolution > 10 * wanted) {
    state.report.status = Status::stalled;
    state.report.message = FixedText<240>(fmt::format(
        "the finest polynomials still move the platform by {:.1e} m: loads or tensions are too large",
        state.resolution));
  }
  state.stable = found.status == Status::converged;
  if (is_held && state.stable) {
    group->set_wrench(problem.wrench + missing_of(*group));
    group->evaluate();
    state.stable = group->factor_limbs() && group->unstable() == 0;
  }
  write_legs_state(robot, *group, state);
}

const ArmLegsState& arm_legs_forward(const ArmLegs& robot, std::span<const TendonCommand> commands,
                                     const ArmLegsLoad& load, const ArmOptions& options,
                                     ArmLegsWorkspace& work) {
  ArmLegsState& state = work.impl().state;
  if (const Report misfit = legs_misfit(robot, commands, load, options, work); !misfit.ok()) {
    state = {};
    state.report = misfit;
    return state;
  }
  solve_legs(robot, {robot, commands, load}, options, work);
  return state;
}

ArmLegsHeld arm_legs_hold(const ArmLegs& robot, const SE3<double>& pose,
                          std::span<const TendonCommand> commands, const ArmLegsLoad& load,
                          const ArmOptions& options, ArmLegsWorkspace& work) {
  ArmLegsHeld held;
  ArmLegsState& state = work.impl().state;
  Report misfit = legs_misfit(robot, commands, load, options, work);
  if (misfit.ok() && !(pose.p.allFinite() && pose.R.matrix().allFinite()))
    misfit = {Status::bad_input, 0, 0, FixedText<240>("the pose is not finite")};
  if (misfit.ok() && leaves_plane(robot, pose))
    misfit = {Status::bad_input, 0, 0, FixedText<240>("the pose is out of the plane")};
  if (!misfit.ok()) {
    state = {};
    state.report = misfit;
    held.state = state;
    return held;
  }
  LegsProblem problem(robot, commands, load);
  problem.held = pose;
  solve_legs(robot, problem, options, work);
  held.state = state;
  if (!state.report.ok()) return held;
  const ArmGroup::Wrench wrench = work.impl().group().wrench() - problem.wrench;
  std::copy(wrench.begin(), wrench.end(), held.wrench.begin());
  return held;
}

ArmLegsRates arm_legs_rates(const ArmLegs& robot, ArmLegsWorkspace& work) {
  ArmLegsWorkspace::Impl& impl = work.impl();
  ArmLegsRates rates;
  if (!impl.has_last()) return rates;
  ArmGroup& group = impl.group();
  group.evaluate();
  ArmGroup::Matrix twists, by_tendon;
  rates.regular = group.factor_limbs() && group.answers(twists, by_tendon);
  if (!rates.regular) return rates;
  const auto flat = [](const ArmGroup::Matrix& matrix) {
    return std::vector<double>(matrix.data(), matrix.data() + matrix.size());
  };
  const int count = group.feeds();
  rates.J = flat(twists.leftCols(count));
  rates.compliance = flat(twists.rightCols(6));
  rates.answers = flat(by_tendon.leftCols(count));
  rates.answers_by_wrench = flat(by_tendon.rightCols(6));
  rates.has_stiffness = group.linearise();
  if (!rates.has_stiffness) return rates;
  const auto stiffness = group.stiffness();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      if (!robot.is_planar || i != j || i < 2 || i > 4) rates.stiffness[at(6 * i + j)] = stiffness(i, j);
  return rates;
}

ArmLegsLoadPath arm_legs_follow_load(const ArmLegs& robot, const std::array<double, 6>& direction,
                                     double limit, ArmLegsWorkspace& work) {
  ArmLegsWorkspace::Impl& impl = work.impl();
  ArmLegsLoadPath path;
  path.state = impl.state;
  ArmGroup::Wrench load;
  std::copy(direction.begin(), direction.end(), load.begin());
  if (!impl.has_last() || !load.allFinite() || load.isZero(0) || !(limit > 0)) return path;
  if (robot.is_planar && !load.segment<3>(2).isZero(0)) return path;
  ArmGroup& group = impl.group();
  group.evaluate();
  if (!group.linearise()) return path;
  auto places = places_of<Spatial>(group);
  const GrownLoad grown = grow_load<Spatial>(group, places, load, limit, work.stop, {.iterations = 100000});
  constexpr LoadEnd ends[] = {LoadEnd::limit, LoadEnd::fold,    LoadEnd::bifurcation, LoadEnd::stability,
                              LoadEnd::limit, LoadEnd::stalled, LoadEnd::iterations,  LoadEnd::stopped};
  path.end = ends[static_cast<int>(grown.end)];
  path.load = grown.load;
  path.definite_until = grown.definite_until;
  impl.state.report.residual = group.evaluate();
  impl.state.report.iterations += grown.iterations;
  write_legs_state(robot, group, impl.state);
  path.state = impl.state;
  return path;
}

const ArmWorkspace& arm_legs_shape(const ArmLegsWorkspace& work, std::size_t leg) {
  const ArmLegsWorkspace::Impl& impl = work.impl();
  return impl.levels[at(impl.level)]->shape(static_cast<int>(leg));
}

}  // namespace sinew::inline v1
