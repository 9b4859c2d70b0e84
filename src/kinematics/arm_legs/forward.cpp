#include "sinew/kinematics/arm_legs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/at.hpp"
#include "kinematics/arm_legs/arm_group.hpp"
#include "kinematics/load_problem.hpp"

namespace sinew::inline v1 {

struct ArmLegsWorkspace::Impl {
  std::shared_ptr<const char> robot;
  ArmModel model = ArmModel::subsegment_rod;
  int order = -2, elements = 0;
  std::vector<std::unique_ptr<ArmGroup>> levels;
  int level = -1;  ///< of the last equilibrium; −1: none was
  ArmLegsState state;
};

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

struct Found {
  Status status = Status::converged;
  int iterations = 0;
  double residual = 0;
};

/// Newton's method at one share of inputs and loads.
Found iterate(ArmGroup& group, const ArmOptions& options, double longest_step, const StopToken& stop,
              int spent) {
  Found found;
  double before = std::numeric_limits<double>::infinity();
  bool is_slow = false;
  for (;; ++found.iterations) {
    found.residual = group.evaluate();
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
    if (!group.factor_limbs() || !group.plan()) {
      found.status = Status::singular;
      return found;
    }
    if (group.planned_size() > longest_step) {
      found.status = Status::stalled;
      return found;
    }
    group.move_as_planned();
  }
}

/// Inputs and loads grow together from nothing, in steps that adapt.
/// @param reached share of them up to which an equilibrium that holds was found
Found grow(ArmGroup& group, const ArmOptions& options, const StopToken& stop, double& reached) {
  constexpr double least = 1e-4, longest_turn = 0.6;
  Found all;
  LimbState last = group.state();
  double step = 1;
  reached = group.share();
  while (true) {
    const double share = std::min(1.0, reached + step);
    group.set_share(share);
    const Found found = iterate(group, options, longest_turn, stop, all.iterations);
    all.iterations += found.iterations;
    all.residual = found.residual;
    if (found.status == Status::stopped || found.status == Status::iteration_limit) {
      all.status = found.status;
      return all;
    }
    const bool is_found = found.status == Status::converged && group.mounts_hold();
    if (is_found && group.factor_limbs() && group.unstable() == 0) {
      reached = share;
      if (share == 1) return all;
      group.save(last);
      if (found.iterations <= 6) step *= 2;
      continue;
    }
    group.restore(last);
    step *= 0.5;
    if (step < least) {
      group.evaluate();
      all.status = Status::stalled;
      return all;
    }
  }
}

FixedText<240> misfit_of(const ArmLegs& robot, std::span<const TendonCommand> commands,
                         const ArmLegsLoad& load) {
  const auto text = [](const std::string& words) { return FixedText<240>(words); };
  if (commands.size() != robot.tendons())
    return text(fmt::format("the legs have {} tendons, found {} commands", robot.tendons(), commands.size()));
  for (std::size_t i = 0; i < commands.size(); ++i) {
    if (!std::isfinite(commands[i].value)) return text(fmt::format("what holds tendon {} is not finite", i));
    if (commands[i].held == TendonHeld::tension && commands[i].value < 0)
      return text(fmt::format("tendon {} would have to push with {} N: tensions are at least 0", i,
                              -commands[i].value));
  }
  const auto finite = [](double x) { return std::isfinite(x); };
  if (!std::ranges::all_of(load.wrench, finite) ||
      (load.gravity && !std::ranges::all_of(*load.gravity, finite)))
    return text("a load is not finite");
  return {};
}

void write_state(const ArmLegs& robot, const ArmGroup& group, ArmLegsState& state) {
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

std::string_view words_for(Status status) {
  switch (status) {
    case Status::stalled:
      return "inputs and loads led to an equilibrium that holds up to {:.2f} % of them, and beyond to none";
    case Status::iteration_limit:
      return "the bound on iterations was met at {:.2f} % of inputs and loads";
    case Status::stopped:
      return "stopped at {:.2f} % of inputs and loads";
    default:
      return "";
  }
}

}  // namespace

const ArmLegsState& arm_legs_forward(const ArmLegs& robot, std::span<const TendonCommand> commands,
                                     const ArmLegsLoad& load, const ArmOptions& options,
                                     ArmLegsWorkspace& work) {
  ArmLegsWorkspace::Impl& impl = work.impl();
  ArmLegsState& state = impl.state;
  state = {};
  const auto refuse = [&](Status status, FixedText<240> text) -> const ArmLegsState& {
    state.report = {status, 0, 0, text};
    return state;
  };
  if (impl.robot != robot.identity)
    return refuse(Status::bad_input, FixedText<240>("the workspace is for another robot"));
  if (const auto text = misfit_of(robot, commands, load); !text.empty())
    return refuse(Status::bad_input, text);
  if (options.balance != ArmBalance::energy)
    return refuse(Status::unsupported,
                  FixedText<240>("legs balance by energy alone in this version: leave balance out"));
  const auto bases = finer_bases(options);
  const std::size_t count = std::max<std::size_t>(1, bases.size());
  if (impl.model != options.model || impl.order != options.order || impl.elements != options.elements ||
      impl.levels.size() != count) {
    impl.levels.clear();
    impl.levels.resize(count);
    impl.model = options.model, impl.order = options.order, impl.elements = options.elements;
  }
  impl.level = -1;
  const auto ready = [&](std::size_t level) -> ArmGroup& {
    ArmBasis basis{options.model, options.order, options.elements};
    if (!bases.empty()) basis.order = bases[level].order, basis.elements = bases[level].elements;
    // Anew: the rest of a group is where its shapes are those at rest.
    impl.levels[level] = std::make_unique<ArmGroup>(robot, basis);
    ArmGroup::Wrench wrench;
    std::copy(load.wrench.begin(), load.wrench.end(), wrench.begin());
    impl.levels[level]->set_problem(commands, wrench, load.gravity.value_or(robot.gravity));
    return *impl.levels[level];
  };
  ArmGroup* group = &ready(0);
  impl.level = 0;
  Found found = grow(*group, options, work.stop, state.reached);
  double size = 0;
  for (int k = 0; k < group->limbs(); ++k) size = std::max(size, group->length(k));
  const double wanted = options.accuracy * size;
  for (std::size_t next = 1; found.status == Status::converged && next < bases.size(); ++next) {
    ArmGroup& finer = ready(next);
    finer.carry_over_from(*group);
    finer.set_share(1);
    Found again = iterate(finer, options, 0.6, work.stop, found.iterations);
    if (again.status == Status::converged && (!finer.factor_limbs() || finer.unstable() != 0))
      again.status = Status::unstable;
    found.iterations += again.iterations;
    if (again.status != Status::converged) {  // what the coarser one found is none of the finer
      const double spent = found.iterations;
      found = again;
      found.iterations = static_cast<int>(spent);
      impl.level = static_cast<int>(next);
      group = &finer;
      break;
    }
    const auto &a = group->platform(), &b = finer.platform();
    const double moved = (a.p - b.p).norm() + group->radius() * (a.R.inverse().compose(b.R)).log().norm();
    const double by = static_cast<double>(bases[next].elements) / bases[next - 1].elements;
    const double ratio = by * by * by * by;
    group = &finer;
    impl.level = static_cast<int>(next);
    found.residual = again.residual;
    state.resolution = moved / (ratio - 1);
    if (state.resolution <= wanted) break;
  }
  state.report.status = found.status;
  state.report.iterations = found.iterations;
  state.report.residual = found.residual;
  if (found.status == Status::unstable || found.status == Status::singular)
    state.report.message = FixedText<240>("what coarser polynomials found does not hold by finer ones");
  else
    state.report.message =
        FixedText<240>(fmt::format(fmt::runtime(words_for(found.status)), 100 * state.reached));
  if (state.report.ok() && state.resolution > 10 * wanted) {
    state.report.status = Status::stalled;
    state.report.message = FixedText<240>(fmt::format(
        "the finest polynomials still move the platform by {:.1e} m: loads or tensions are too large",
        state.resolution));
  }
  state.stable = found.status == Status::converged;
  write_state(robot, *group, state);
  return state;
}

ArmLegsRates arm_legs_rates(const ArmLegs&, ArmLegsWorkspace& work) {
  ArmLegsWorkspace::Impl& impl = work.impl();
  ArmLegsRates rates;
  if (impl.level < 0 || !impl.state.report.ok()) return rates;
  ArmGroup& group = *impl.levels[at(impl.level)];
  group.evaluate();
  if (!group.linearise()) return rates;
  const int count = group.feeds();
  rates.regular = true;
  const auto stiffness = group.stiffness();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) rates.stiffness[at(6 * i + j)] = stiffness(i, j);
  rates.J.assign(at(6 * count), 0.0);
  for (int k = 0; k < count; ++k) {
    const ArmGroup::Wrench side = -group.input_wrench_jacobian(k);
    ArmGroup::Twist twist;
    group.factors().solve(side.data(), twist.data());
    for (int i = 0; i < 6; ++i) rates.J[at(i * count + k)] = twist[i];
  }
  return rates;
}

ArmLegsLoadPath arm_legs_follow_load(const ArmLegs& robot, const std::array<double, 6>& direction,
                                     double limit, ArmLegsWorkspace& work) {
  ArmLegsWorkspace::Impl& impl = work.impl();
  ArmLegsLoadPath path;
  path.state = impl.state;
  ArmGroup::Wrench load;
  std::copy(direction.begin(), direction.end(), load.begin());
  if (impl.level < 0 || !impl.state.report.ok() || !load.allFinite() || load.isZero(0) || !(limit > 0))
    return path;
  ArmGroup& group = *impl.levels[at(impl.level)];
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
  write_state(robot, group, impl.state);
  path.state = impl.state;
  return path;
}

const ArmWorkspace& arm_legs_shape(const ArmLegsWorkspace& work, std::size_t leg) {
  const ArmLegsWorkspace::Impl& impl = work.impl();
  return impl.levels[at(impl.level)]->shape(static_cast<int>(leg));
}

}  // namespace sinew::inline v1
