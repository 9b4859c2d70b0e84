#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/at.hpp"
#include "kinematics/arms/arm_work.hpp"
#include "sinew/kinematics/arm.hpp"
#include "strain/friction/friction_rod.hpp"
#include "strain/tangent.hpp"

namespace sinew::inline v1 {
namespace {

using strain::NodeLoad;
using strain::RubbingTendon;

std::vector<RubbingTendon> tendons_of(const Arm& arm) {
  std::vector<RubbingTendon> tendons;
  for (const ArmTendon& tendon : arm.tendons) {
    const double outside = std::clamp(tendon.outside, 0.0, 1.0);
    tendons.push_back(
        {tendon.friction, (1 - outside) * tendon.compliance, outside * tendon.compliance, tendon.pretension});
  }
  return tendons;
}

}  // namespace

struct ArmPath {
  ArmOptions options;
  int level = 0;
  std::vector<double> breaks;
  strain::RodModel model;
  strain::FrictionRod rod;
  ArmLoad load;          ///< of the last point
  bool between = false;  ///< the last step was not reached: its loads are not

  ArmPath(const Arm& arm, const ArmOptions& chosen, int chosen_level, std::vector<double> places,
          const strain::RodModel& made)
      : options(chosen),
        level(chosen_level),
        breaks(std::move(places)),
        model(made),
        rod(model, tendons_of(arm)) {
    load.gravity = {0, 0, 0};
  }
};

namespace {

/// Of the workspace's levels: where the order is chosen by the arm, one finer than the coarsest.
int level_of(const ArmOptions& options) {
  const bool chosen = options.order >= 0 || options.elements > 0,
             refines = options.model == ArmModel::rod || options.model == ArmModel::subsegment_rod;
  return !chosen && refines && options.accuracy > 0 ? 1 : 0;
}

/// The state of the workspace becomes that of the path.
void show(const Arm& arm, ArmWorkspace::Impl& impl) {
  ArmPath& path = *impl.path;
  ArmRod& entry = impl.at(arm, path.options, path.breaks, path.level);
  impl.level = path.level;
  entry.rod.work().y = path.rod.work().y;
  entry.rod.work().loads = path.rod.work().loads;
  ArmState& state = impl.state;
  for (std::size_t i = 0; i < arm.tendons.size(); ++i) {
    state.tensions[i] = path.rod.tension_at_motor(i);
    state.changes[i] = -path.rod.pulled_in(i);
    state.slack[i] = path.rod.slack(i);
    entry.rod.holds[i] = {true, state.tensions[i], 0, arm.tendons[i].compliance};
    impl.rubs = impl.rubs || arm.tendons[i].friction > 0;
  }
  entry.rod.evaluate();
  state.tip = pose_of(entry.rod.work().frames.back());
  state.energy = path.rod.stored();
  state.coordinates = path.model.size;
  state.resolution = 0;
  state.stable = true;
  state.stability_told = true;
}

/// The path to go on with, or a new one; what forbids it, in words.
FixedText<240> begin(const Arm& arm, std::span<const ArmStep> steps, const ArmOptions& options,
                     ArmWorkspace::Impl& impl) {
  std::shared_ptr<ArmPath> last = options.from_last ? impl.path : nullptr;
  const int level = level_of(options);
  std::vector<double> breaks;
  if (last) breaks = last->breaks;
  for (const ArmStep& step : steps)
    for (const PointLoad& point : step.load.points) breaks.push_back(point.place);
  std::ranges::sort(breaks);
  breaks.erase(std::unique(breaks.begin(), breaks.end()), breaks.end());
  const auto same = [&] {
    return last->options.model == options.model && last->options.order == options.order &&
           last->options.elements == options.elements && last->level == level;
  };
  if (last && !same())
    return FixedText<240>("the path that is remembered is of another model, order or number of elements");
  if (last && last->breaks == breaks) return {};
  auto path =
      std::make_shared<ArmPath>(arm, options, level, breaks, impl.at(arm, options, breaks, level).model);
  if (last) {
    std::vector<NodeLoad> loads(path->rod.work().loads.size());
    set_loads(arm, last->load, path->model, loads);
    std::vector<double> y = last->rod.work().y;  // to start from
    if (path->model.size != last->model.size) {
      y.assign(path->rod.work().y.size(), 0.0);
      carry_over(last->model, last->rod.work(), path->model, y);
    }
    if (last->between || !path->rod.remember(last->rod, loads, y)) {
      show(arm, impl);
      return FixedText<240>(
          "a load acts where none did when the path began, and channels are divided there: give it a load of "
          "0 "
          "from the beginning");
    }
    path->load = last->load;
  }
  impl.path = path;
  return {};
}

/// From where a path is to one of its steps.
class Way {
 public:
  Way(const Arm& arm, const ArmStep& step, const ArmPath& path) : from_(path.rod.work().loads), to_(from_) {
    set_loads(arm, step.load, path.model, to_);
    for (std::size_t i = 0; i < step.commands.size(); ++i) {
      const bool by_tension = step.commands[i].held == TendonHeld::tension;
      const double value = step.commands[i].value;
      first_.push_back(by_tension ? path.rod.tension_at_motor(i) : path.rod.pulled_in(i));
      last_.push_back({by_tension, by_tension ? value : -value});
    }
  }
  /// @param share of the way
  strain::PathStep go(strain::FrictionRod& rod, double share, const strain::RelaxOptions& options) const {
    if (share == 1) return rod.step(last_, to_, options);
    std::vector<strain::TendonInput> inputs = last_;
    for (std::size_t i = 0; i < inputs.size(); ++i)
      inputs[i].value = std::lerp(first_[i], last_[i].value, share);
    std::vector<NodeLoad> loads = to_;
    for (std::size_t k = 0; k < loads.size(); ++k) loads[k] = strain::mix(from_[k], to_[k], share);
    return rod.step(inputs, loads, options);
  }

 private:
  std::vector<NodeLoad> from_, to_;
  std::vector<double> first_;
  std::vector<strain::TendonInput> last_;
};

Report report_of(const strain::PathStep& went) {
  Report report{went.found.status, went.found.iterations, went.found.residual, {}};
  if (report.status == Status::stopped)
    report.message = FixedText<240>("stopped");
  else if (report.status == Status::iteration_limit)
    report.message = FixedText<240>(
        fmt::format("{} iterations led to {:.0f} % of the step: more, or smaller steps, may lead further",
                    report.iterations, 100 * went.found.reached));
  else if (!report.ok())
    report.message =
        FixedText<240>(fmt::format("no equilibrium was found: the path led to one up to {:.0f} % of the step",
                                   100 * went.found.reached));
  return report;
}

void put(const strain::FrictionRod& rod, const strain::PathStep& went, const ArmState& state,
         ArmPathPoint& point) {
  point.state = state;
  for (std::size_t i = 0; i < state.tensions.size(); ++i) {
    const auto tensions = rod.tensions(i), angles = rod.angles(i);
    point.tensions.emplace_back(tensions.begin(), tensions.end());
    point.angles.emplace_back(angles.begin(), angles.end());
  }
  point.motor_work = went.motors;
  point.friction_loss = went.friction;
  point.parts = went.parts;
}

}  // namespace

std::vector<ArmPathPoint> arm_follow(const Arm& arm, std::span<const ArmStep> steps,
                                     const ArmOptions& options, ArmWorkspace& work) {
  ArmWorkspace::Impl& impl = work.impl();
  std::vector<ArmPathPoint> points;
  const auto refuse = [&](Status status, const FixedText<240>& text) {
    impl.state.report = {status, 0, 0, text};
    points.emplace_back().state = impl.state;
    return points;
  };
  if (impl.robot != arm.identity)
    return refuse(Status::bad_input, FixedText<240>("the workspace is for another robot"));
  if (options.balance != ArmBalance::energy)
    return refuse(Status::unsupported, FixedText<240>("paths are followed with the balance by energy alone"));
  if (options.model == ArmModel::prb)
    for (std::size_t m = 0; m < arm.sections.size(); ++m)
      if (arm.sections[m].discs.count == 0)
        return refuse(
            Status::unsupported,
            FixedText<240>(fmt::format("joints (prb) have no guides along the channels of section {}, "
                                       "on which tendons rub: take another model",
                                       m)));
  for (std::size_t k = 0; k < steps.size(); ++k)
    if (const auto text = misfit(arm, steps[k].commands, steps[k].load, options); !text.empty())
      return refuse(Status::bad_input, FixedText<240>(fmt::format("step {}: {}", k + 1, text.view())));
  for (std::size_t k = 0; k < steps.size(); ++k)
    if (steps[k].divisions < 1)
      return refuse(Status::bad_input,
                    FixedText<240>(fmt::format("step {}: its way has {} divisions; give 1 or more", k + 1,
                                               steps[k].divisions)));
  if (steps.empty()) return points;
  if (const auto text = begin(arm, steps, options, impl); !text.empty())
    return refuse(Status::bad_input, text);
  ArmPath& path = *impl.path;
  for (std::size_t i = 0; i < arm.tendons.size(); ++i)
    if (path.rod.angles(i).empty())
      return refuse(Status::unsupported, FixedText<240>("this model has no guides where a tendon runs"));
  strain::RelaxOptions relax;
  relax.max_iterations = options.max_iterations;
  relax.tolerance = options.tolerance;
  relax.stop = [&work] { return work.stop.stop_requested(); };
  for (const ArmStep& step : steps) {
    std::copy(step.commands.begin(), step.commands.end(), impl.commands.begin());
    const Way way(arm, step, path);
    for (int part = 1; part <= step.divisions; ++part) {
      const bool is_last = part == step.divisions;
      const strain::PathStep went = way.go(path.rod, is_last ? 1 : double(part) / step.divisions, relax);
      path.between = went.found.status != Status::converged || !is_last;
      show(arm, impl);
      impl.state.report = report_of(went);
      put(path.rod, went, impl.state, points.emplace_back());
      if (!impl.state.report.ok()) return points;
    }
    path.load = step.load;
    path.load.gravity = step.load.gravity.value_or(arm.gravity);
  }
  return points;
}

ArmPathRates arm_path_rates(const Arm& arm, std::span<const double> direction, ArmWorkspace& work,
                            bool matrices) {
  using Why = strain::PathRates::Why;
  ArmWorkspace::Impl& impl = work.impl();
  ArmPathRates rates;
  const auto refuse = [&](std::string_view why) {
    rates.message = FixedText<240>(why);
    return rates;
  };
  const std::size_t tendons = arm.tendons.size();
  if (impl.robot != arm.identity) return refuse("the workspace is for another robot");
  if (direction.size() != tendons)
    return refuse(fmt::format("the arm has {} tendons; give a rate for each", tendons));
  if (!std::ranges::all_of(direction, [](double rate) { return std::isfinite(rate); }))
    return refuse("a rate is no number");
  if (!impl.path || impl.path->between)
    return refuse("rates with friction are of where a path ends: follow one first");
  std::vector<double> inputs(direction.begin(), direction.end());
  for (std::size_t i = 0; i < tendons; ++i)
    if (impl.commands[i].held == TendonHeld::change) inputs[i] = -inputs[i];
  ArmPath& path = *impl.path;
  const auto n = at(path.model.size);
  const std::vector<double> twists = tip_rows(path.model, path.rod.work());
  const strain::PathRates found = matrices ? path.rod.rates(inputs, twists, 6) : path.rod.rates(inputs);
  if (found.why == Why::no_turn)
    return refuse(
        "a tendon that rubs does not turn at one of its guides: there friction begins with its turn");
  if (found.why == Why::pushes) return refuse("a tendon without tension cannot pull less");
  if (found.why == Why::undecided) return refuse("no choice of guides that slip fits this direction");
  if (found.why != Why::known) return refuse("the equilibrium is a fold: it has no rates");
  const auto put_twist = [&](const std::vector<double>& y, double* to, std::size_t stride) {
    for (std::size_t k = 0; k < 6; ++k)
      to[k * stride] =
          std::inner_product(y.begin(), y.end(), twists.begin() + static_cast<std::ptrdiff_t>(k * n), 0.0);
  };
  put_twist(found.y, rates.twist.data(), 1);
  for (std::size_t i = 0; i < tendons; ++i) {
    rates.tensions.push_back(found.tension[i].front());
    rates.changes.push_back(-found.end[i]);
  }
  rates.slipping = found.slipping;
  rates.regular = true;
  if (!matrices) return rates;
  rates.tendons = static_cast<int>(tendons);
  const auto put = [&](const std::vector<strain::PathRates::Column>& columns, bool by_inputs,
                       std::vector<double>& moved, std::vector<double>& changes,
                       std::vector<double>& tensions) {
    const std::size_t count = columns.size();
    moved.resize(6 * count);
    changes.resize(tendons * count);
    tensions.resize(tendons * count);
    for (std::size_t j = 0; j < count; ++j) {
      // a change that is held is what its tendon is paid out, the rod's input what it is pulled in
      const double way = by_inputs && impl.commands[j].held == TendonHeld::change ? -1 : 1;
      put_twist(columns[j].y, moved.data() + j, count);
      for (std::size_t k = 0; k < 6; ++k) moved[k * count + j] *= way;
      for (std::size_t i = 0; i < tendons; ++i) {
        changes[i * count + j] = -way * columns[j].end[i];
        tensions[i * count + j] = way * columns[j].tension[i];
      }
    }
  };
  put(found.by_inputs, true, rates.J, rates.changes_by_inputs, rates.tensions_by_inputs);
  put(found.by_forces, false, rates.compliance, rates.changes_by_wrench, rates.tensions_by_wrench);
  for (std::size_t i = 0; i < tendons; ++i) {
    const bool by_change = impl.commands[i].held == TendonHeld::change;
    rates.least.push_back(by_change ? -found.most[i] : found.least[i]);
    rates.most.push_back(by_change ? -found.least[i] : found.most[i]);
  }
  return rates;
}

}  // namespace sinew::inline v1
