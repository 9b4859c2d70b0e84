#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "base/at.hpp"
#include "kinematics/arms/arm_work.hpp"
#include "kinematics/arms/ladder.hpp"
#include "kinematics/arms/published.hpp"

namespace sinew::inline v1 {
namespace {

using strain::LoadedRod;
using strain::NodeLoad;
using strain::NodeShare;
using strain::RodModel;

/// Elements that do for the Hessian of Newton's steps where gradients need more: at least as many as its
/// polynomials need, in number a half to a quarter of the model's; 0: too near to its own to pay.
int lean_elements(const ArmOptions& options, const ArmBasis& basis) {
  const bool rod = options.model == ArmModel::rod;
  if (options.balance != ArmBalance::energy || (!rod && options.model != ArmModel::subsegment_rod)) return 0;
  const int usual = rod ? 3 : 2, order = basis.order < 0 ? usual : basis.order;
  const int fewer = std::max({2, order / 2 + 1, rod ? (basis.elements + 1) / 2 : (basis.elements + 3) / 4});
  return 2 * fewer <= basis.elements ? fewer : 0;
}

void add_dead(NodeLoad& load, const NodeShare& share, const std::array<double, 3>& by) {
  for (std::size_t i = 0; i < 3; ++i) {
    load.force[i] += share.amount * by[i];
    for (std::size_t j = 0; j < 3; ++j) load.couple[3 * i + j] += by[i] * share.moment[j];
  }
}
void add_following(NodeLoad& load, const NodeShare& share, const std::array<double, 3>& by) {
  const auto& d = share.moment;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    load.following[i] += share.amount * by[i];
    load.following[i + 3] += d[j] * by[k] - d[k] * by[j];
  }
}
void add_wrench(NodeLoad& load, const std::array<double, 6>& wrench, bool following) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (following) {
      load.following[i] += wrench[i];
      load.following[i + 3] += wrench[i + 3];
    } else {
      load.force[i] += wrench[i];
      load.moment[i] += wrench[i + 3];
    }
  }
}

}  // namespace

void set_loads(const Arm& arm, const ArmLoad& load, const RodModel& model, std::vector<NodeLoad>& loads) {
  const std::array<double, 3> gravity = load.gravity.value_or(arm.gravity);
  for (std::size_t k = 1; k < loads.size(); ++k) {
    loads[k] = {};
    add_dead(loads[k], model.masses[k], gravity);
    add_dead(loads[k], model.lengths[k], load.along);
    add_following(loads[k], model.lengths[k], load.following_along);
  }
  add_wrench(loads.back(), load.wrench, false);
  add_wrench(loads.back(), load.following, true);
  for (const PointLoad& point : load.points) {
    if (point.place <= 1e-9 * arm.sections.front().length) continue;  // no node is there: the base bears it
    std::size_t nearest = 1;
    for (std::size_t k = 2; k < model.places.size(); ++k)
      if (std::abs(model.places[k] - point.place) < std::abs(model.places[nearest] - point.place))
        nearest = k;
    add_wrench(loads[nearest], point.wrench, point.following);
  }
}

namespace {

bool finite(std::span<const double> values) {
  return std::ranges::all_of(values, [](double x) { return std::isfinite(x); });
}

}  // namespace

FixedText<240> misfit(const Arm& arm, std::span<const TendonCommand> commands, const ArmLoad& load,
                      const ArmOptions& options) {
  FixedText<240> text;
  const auto say = [&](const std::string& words) { text = FixedText<240>(words); };
  if (commands.size() != arm.tendons.size()) {
    say(fmt::format("the arm has {} tendons, found {} commands", arm.tendons.size(), commands.size()));
    return text;
  }
  for (std::size_t i = 0; i < commands.size(); ++i) {
    const bool tension = commands[i].held == TendonHeld::tension;
    if (!std::isfinite(commands[i].value))
      say(fmt::format("what holds tendon {} is not finite", i));
    else if (tension && commands[i].value < 0)
      say(fmt::format("tendon {} would have to push with {} N: tensions are at least 0", i,
                      -commands[i].value));
    if (!text.empty()) return text;
  }
  bool all =
      finite(load.wrench) && finite(load.following) && finite(load.along) && finite(load.following_along);
  if (load.gravity) all = all && finite(*load.gravity);
  for (const PointLoad& point : load.points) {
    all = all && finite(point.wrench);
    if (!(point.place > 0 && point.place <= arm.length() * (1 + 1e-12)))
      say(fmt::format("a load at {} m is not on the arm, which is {} m long", point.place, arm.length()));
  }
  if (!all) say("a load is not finite");
  if (const auto words = basis_misfit(options.model, options.order, options.elements); !words.empty())
    say(words);
  return text;
}

void carry_over(const RodModel& from, const strain::RodWork& work, const RodModel& to,
                std::vector<double>& y) {
  if (is_within(from, to) || is_within(to, from)) {
    take_shared(from, work.y, to, y);
    return;
  }
  std::fill(y.begin(), y.end(), 0.0);
  int near = 0;
  for (const strain::Piece& fine : to.pieces) {
    double* own = y.data() + fine.first;
    const strain::Span& last = to.spans[at(fine.first_span + fine.spans - 1)];
    for (int e = to.spans[at(fine.first_span)].first_element; e < last.first_element + last.elements; ++e) {
      const strain::Element& element = to.elements[at(e)];
      for (int g = 0; g < element.points; ++g) {
        const double place = to.places[at(e)] + element.length * (0.5 + (g == 0 ? -1 : 1) / std::sqrt(12.0));
        const auto bent = strain_at(from, work, place, near);
        for (std::size_t c = 0; c < 6; ++c)
          for (int a = 0; a < fine.modes[c]; ++a)
            own[fine.offset[c] + a] += element.weight * element.modes[at(g)][at(a)] *
                                       (bent[c] - element.rest[at(g)][c]) / fine.scale[c];
      }
    }
  }
}

/// And tensions, from which those of tendons that do not stretch are found again.
static void carry_over(const LoadedRod& from, LoadedRod& to) {
  carry_over(from.model(), from.work(), to.model(), to.work().y);
  to.expect(from.tensions());
}

namespace {

void set_holds(const Arm& arm, const ArmWorkspace::Impl& impl, LoadedRod& rod) {
  for (std::size_t i = 0; i < rod.holds.size(); ++i) {
    const ArmTendon& tendon = arm.tendons[i];
    const TendonCommand& command = impl.commands[i];
    rod.holds[i].by_tension = command.held == TendonHeld::tension;
    rod.holds[i].tension = command.value;
    rod.holds[i].free_length = impl.rest_lengths[i] + command.value - tendon.compliance * tendon.pretension;
    rod.holds[i].compliance = tendon.compliance;
  }
}

std::array<double, 3> tip_of(const LoadedRod& rod) {
  const auto& frame = rod.work().frames.back();
  return {frame.p[0], frame.p[1], frame.p[2]};
}

void write_state(const Arm& arm, ArmWorkspace::Impl& impl) {
  LoadedRod& rod = impl.rod();
  ArmState& state = impl.state;
  state.tip = pose_of(rod.work().frames.back());
  for (std::size_t i = 0; i < arm.tendons.size(); ++i) {
    const ArmTendon& tendon = arm.tendons[i];
    state.tensions[i] = rod.tensions()[i];
    state.slack[i] = rod.slack(i);
    state.changes[i] = impl.commands[i].held == TendonHeld::change
                           ? impl.commands[i].value
                           : rod.work().lengths[i] - impl.rest_lengths[i] -
                                 tendon.compliance * (state.tensions[i] - tendon.pretension);
  }
  state.coordinates = rod.model().size;
  state.energy = rod.potential();
  for (std::size_t i = 0; i < arm.tendons.size(); ++i)  // what a held tension would do is its motor's work
    if (const double T = state.tensions[i]; impl.commands[i].held == TendonHeld::tension)
      state.energy += T * (0.5 * arm.tendons[i].compliance * T - rod.work().lengths[i]);
}

std::string_view words_for(const strain::Relaxed& found) {
  switch (found.status) {
    case Status::stalled:
      if (found.reached == 1)
        return "no equilibrium was found with tendons as stiff as these: they may pull against one another";
      return "no equilibrium was found: loads and inputs led to one up to {:.0f} % of them";
    case Status::iteration_limit:
      return "the bound on iterations was met";
    case Status::left_domain:
      return "an iterate was not finite";
    case Status::unstable:
      return "the equilibrium does not hold by itself";
    case Status::stopped:
      return "stopped";
    default:
      return "";
  }
}

/// Which tendon is too short, and by how much.
std::string too_short(const ArmWorkspace::Impl& impl, const LoadedRod& rod) {
  std::size_t worst = 0;
  for (std::size_t i = 1; i < rod.holds.size(); ++i)
    if (rod.lacks(i) > rod.lacks(worst)) worst = i;
  return fmt::format(
      "tendon {} does not stretch and is held too short, against others or beyond what the arm can bend: the "
      "nearest shape that was found has its change at {:.3g} m, not at {:.3g} m",
      worst, impl.commands[worst].value + rod.lacks(worst), impl.commands[worst].value);
}

void set_report(Report& report, const strain::Relaxed& found, const ArmWorkspace::Impl& impl,
                const LoadedRod& rod) {
  report.status = found.status;
  report.iterations = found.iterations;
  report.residual = found.residual;
  report.message = FixedText<240>(found.status == Status::unreachable
                                      ? too_short(impl, rod)
                                      : fmt::format(fmt::runtime(words_for(found)), 100 * found.reached));
}

}  // namespace

ArmWorkspace::Impl::Impl(const Arm& arm) : robot(arm.identity), commands(arm.tendons.size()) {
  for (auto* values : {&state.tensions, &state.changes, &state.slack}) values->resize(arm.tendons.size());
}

ArmRod& ArmWorkspace::Impl::at(const Arm& arm, const ArmOptions& options,
                               const std::vector<double>& at_breaks, int wanted) {
  rubs = false;
  if (options.model != model || options.balance != balance || options.order != order ||
      options.elements != elements || at_breaks != breaks) {
    levels.clear();
    level = -1;
    knows_rest = false;  // a channel is not as long as the way between discs
    model = options.model, balance = options.balance, breaks = at_breaks;
    order = options.order, elements = options.elements;
  }
  if (levels.empty()) levels.resize(v1::at(level_count(options)));
  auto& entry = levels[v1::at(wanted)];
  if (!entry) {
    ArmBasis basis{model, order, elements, balance == ArmBalance::collocated};
    if (level_count(options) > 1) {
      const Resolution chosen = resolution_at(options, wanted);
      basis.order = chosen.order, basis.elements = chosen.elements;
    }
    basis.elements = elements_of(basis);
    entry = std::make_unique<ArmRod>(make_rod(arm, basis, breaks));
    if (basis.elements = lean_elements(options, basis); basis.elements > 0) {
      entry->lean = std::make_unique<ArmRod>(make_rod(arm, basis, breaks));
      if (entry->lean->model.size == entry->model.size && is_within(entry->lean->model, entry->model))
        entry->rod.lean_on(entry->lean->rod);
      else
        entry->lean.reset();
    }
  }
  return *entry;
}

ArmWorkspace::ArmWorkspace(const Arm& arm) : impl_(std::make_unique<Impl>(arm)) {}
ArmWorkspace::~ArmWorkspace() = default;
ArmWorkspace::ArmWorkspace(ArmWorkspace&&) noexcept = default;
ArmWorkspace& ArmWorkspace::operator=(ArmWorkspace&&) noexcept = default;

namespace {

/// The rod of a level with the loads and holds of this question.
class AskedRods {
 public:
  AskedRods(const Arm& arm, const ArmLoad& load, const ArmOptions& options, ArmWorkspace::Impl& impl)
      : arm_(arm),
        load_(load),
        options_(options),
        impl_(impl) {
    for (const PointLoad& point : load.points) breaks_.push_back(point.place);
    impl_.at(arm, options, breaks_, 0);
  }
  LoadedRod& at(int level) {
    ArmRod& entry = impl_.at(arm_, options_, breaks_, level);
    set_loads(arm_, load_, entry.model, entry.rod.work().loads);
    if (entry.lean) set_loads(arm_, load_, entry.lean->model, entry.lean->rod.work().loads);
    if (!impl_.knows_rest) {
      std::fill(entry.rod.work().y.begin(), entry.rod.work().y.end(), 0.0);
      sweep_out(entry.model, entry.rod.work());
      impl_.rest_lengths = entry.rod.work().lengths;
      impl_.knows_rest = true;
    }
    set_holds(arm_, impl_, entry.rod);
    return entry.rod;
  }
  /// With coordinates and tensions of another level.
  LoadedRod& at(int level, int from) {
    LoadedRod& rod = at(level);
    if (level != from) carry_over(known(from), rod);
    return rod;
  }
  /// One that is as the question has it.
  LoadedRod& known(int level) { return impl_.levels[v1::at(level)]->rod; }

 private:
  const Arm& arm_;
  const ArmLoad& load_;
  const ArmOptions& options_;
  ArmWorkspace::Impl& impl_;
  std::vector<double> breaks_;
};

/// Up the ladder until it says that the answer is found; iterations are those of all steps together.
/// @param first the ladder's first step, which is not made yet
template <class Solve>
strain::Relaxed climb(ResolutionLadder& ladder, ResolutionLadder::Step step, AskedRods& rods, Solve solve) {
  strain::Relaxed found;
  int iterations = 0;
  while (step.kind != ResolutionLadder::Step::Kind::answer) {
    if (step.kind == ResolutionLadder::Step::Kind::compare) {
      const strain::Approach near =
          rods.at(step.level).approach(rods.known(step.from), 1e-3 * ladder.wanted());
      iterations += near.iterations;
      step = ladder.after_comparison(near);
      continue;
    }
    LoadedRod& rod = rods.at(step.level, step.from);
    const strain::Relaxed one = solve(rod);
    iterations += one.iterations;
    step = ladder.after_solve({one.status == Status::converged, rod.model(), rod.work().y, tip_of(rod)});
    if (ladder.stands()) found = one;
  }
  found.iterations = iterations;
  return found;
}

/// What cannot be asked of this arm, or of this workspace.
Report refusal(const Arm& arm, std::span<const TendonCommand> commands, const ArmLoad& load,
               const ArmOptions& options, const ArmWorkspace::Impl& impl) {
  if (impl.robot != arm.identity)
    return {Status::bad_input, 0, 0, FixedText<240>("the workspace is for another robot")};
  if (const auto text = misfit(arm, commands, load, options); !text.empty())
    return {Status::bad_input, 0, 0, text};
  return fits_balance(arm, commands, load, options);
}

}  // namespace

const ArmState& arm_forward(const Arm& arm, std::span<const TendonCommand> commands, const ArmLoad& load,
                            const ArmOptions& options, ArmWorkspace& work) {
  ArmWorkspace::Impl& impl = work.impl();
  ArmState& state = impl.state;
  state.report = refusal(arm, commands, load, options, impl);
  if (!state.report.ok()) return state;
  std::copy(commands.begin(), commands.end(), impl.commands.begin());
  const int before = impl.level;
  AskedRods rods(arm, load, options, impl);
  const bool warm = options.from_last && before >= 0 && impl.level == before;
  strain::RelaxOptions relax;
  relax.max_iterations = options.max_iterations;
  relax.tolerance = options.tolerance;
  relax.may_grow = impl.may_grow;
  relax.stop = [&work] { return work.stop.stop_requested(); };
  const bool by_energy = options.balance == ArmBalance::energy;
  ResolutionLadder ladder(options, arm.length(), impl);
  ResolutionLadder::Step first =
      ladder.begin(warm, warm ? size_of_variation(impl.rod().model(), impl.rod().work().y) : 0);
  LoadedRod& rod = rods.at(first.level);
  if (!warm && !options.from_curvatures.empty()) {
    take_curvatures(options.from_curvatures, rod.model(), rod.work().y);
  } else if (!warm) {
    std::fill(rod.work().y.begin(), rod.work().y.end(), 0.0);
  } else {
    const LoadedRod& last = rods.known(first.from);
    if (first.level != first.from) carry_over(last.model(), last.work(), rod.model(), rod.work().y);
    if (impl.balances) rod.expect(last.tensions());
  }
  first.from = first.level;
  impl.balances = false;
  const strain::Relaxed found = climb(ladder, first, rods, [&](LoadedRod& asked) {
    if (!by_energy) return relax_published(arm, commands, options, relax, warm, asked);
    const strain::Relaxed one = asked.relax(relax);
    impl.grew = impl.grew || one.grew;
    return one;
  });
  state.resolution = impl.told;
  impl.balances = found.status == Status::converged;
  set_report(state.report, found, impl, impl.rod());
  if (!by_energy) state.report.message = FixedText<240>(published_words(found.status));
  if (ladder.refines() && state.report.ok())
    report_coarse(state.resolution, options.accuracy, arm.length(), "tip", state.report);
  state.stable = found.negative == 0;
  state.stability_told = by_energy;
  write_state(arm, impl);
  return state;
}

}  // namespace sinew::inline v1
