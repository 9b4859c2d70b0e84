#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "base/at.hpp"
#include "kinematics/arms/arm_work.hpp"
#include "kinematics/arms/published.hpp"

namespace sinew::inline v1 {
namespace {

using strain::LoadedRod;
using strain::NodeLoad;
using strain::NodeShare;
using strain::RodModel;

/// Orders and elements of polynomials.
struct Resolution {
  int order;  ///< −1: the model's, which has one less of what is stiff
  int elements;
};
constexpr std::array<Resolution, 4> along_sections{{{-1, 8}, {5, 16}, {7, 32}, {9, 64}}};
constexpr std::array<Resolution, 6> between_discs{{{-1, 2}, {3, 3}, {4, 5}, {5, 8}, {6, 13}, {7, 20}}};

/// What a model is refined by, coarse to fine, in order and elements alike, so that a step tells what either
/// of them was off; empty where it has one resolution. Between two of them is the finer one's elements with
/// the coarser one's order, which often does as well: resolution 2 k is the k-th, 2 k − 1 the one before it.
std::span<const Resolution> resolutions_of(const ArmOptions& options) {
  if (options.order >= 0 || options.elements > 0 || options.balance != ArmBalance::energy) return {};
  if (options.model == ArmModel::rod) return along_sections;
  if (options.model == ArmModel::subsegment_rod) return between_discs;
  return {};
}

int level_count(const ArmOptions& options) {
  return std::max(1, 2 * static_cast<int>(resolutions_of(options).size()) - 1);
}

Resolution resolution_at(std::span<const Resolution> resolutions, int level) {
  const Resolution& finer = resolutions[at((level + 1) / 2)];
  return {level % 2 == 0 ? finer.order : resolutions[at(level / 2)].order, finer.elements};
}

/// The next of the table that has more elements.
int finer_than(int level) { return ((level + 1) / 2 + 1) * 2; }
/// The one of the table before it.
int coarser_than(int level) { return (level + 1) / 2 * 2 - 2; }

/// By how much the elements of one level lower the error of another: as the fourth power of their length, the
/// order of frames and quadrature.
double error_ratio(const ArmOptions& options, int level, int finer) {
  const auto resolutions = resolutions_of(options);
  const double share = static_cast<double>(resolution_at(resolutions, finer).elements) /
                       static_cast<double>(resolution_at(resolutions, level).elements);
  return share * share * share * share;
}

/// From where an error stands at a level, the level whose next one is to bring it below a bound, if elements
/// rule it; one that has a next, against which it can be checked.
int level_for(const ArmOptions& options, int level, double error, double bound) {
  int to = level;
  while (finer_than(finer_than(to)) < level_count(options) &&
         error > bound * error_ratio(options, level, finer_than(to)))
    to = finer_than(to);
  return to;
}

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

FixedText<240> misfit(const Arm& arm, std::span<const TendonCommand> commands, const ArmLoad& load) {
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

/// Of the highest modes of bending: what a polynomial of this order may lack.
double size_of_highest(const RodModel& model, const std::vector<double>& y) {
  double sum = 0;
  for (const strain::Piece& piece : model.pieces)
    for (std::size_t c = 3; c < 6; ++c)
      if (piece.modes[c] > piece.stretches) {
        for (int k = 1; k <= piece.stretches; ++k) {
          const double value =
              y[at(piece.first + piece.offset[c] + k * (piece.modes[c] / piece.stretches) - 1)];
          sum += value * value;
        }
      }
  return std::sqrt(sum / model.energy_scale);
}

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
  const auto& frame = rod.work().frames.back();
  Mat<double, 3, 3> turn;
  turn << frame.R[0], frame.R[1], frame.R[2], frame.R[3], frame.R[4], frame.R[5], frame.R[6], frame.R[7],
      frame.R[8];
  state.tip.p = {frame.p[0], frame.p[1], frame.p[2]};
  state.tip.R = SO3<double>::from(turn);
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
    if (const auto resolutions = resolutions_of(options); !resolutions.empty()) {
      const Resolution chosen = resolution_at(resolutions, wanted);
      basis.order = chosen.order, basis.elements = chosen.elements;
    }
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

const ArmState& arm_forward(const Arm& arm, std::span<const TendonCommand> commands, const ArmLoad& load,
                            const ArmOptions& options, ArmWorkspace& work) {
  ArmWorkspace::Impl& impl = work.impl();
  ArmState& state = impl.state;
  state.report = {};
  if (impl.robot != arm.identity) {
    state.report = {Status::bad_input, 0, 0, FixedText<240>("the workspace is for another robot")};
    return state;
  }
  if (const auto text = misfit(arm, commands, load); !text.empty()) {
    state.report = {Status::bad_input, 0, 0, text};
    return state;
  }
  if (const Report found = fits_balance(arm, commands, load, options); !found.ok()) {
    state.report = found;
    return state;
  }
  std::copy(commands.begin(), commands.end(), impl.commands.begin());
  std::vector<double> breaks;
  for (const PointLoad& point : load.points) breaks.push_back(point.place);
  const int before = impl.level, count = level_count(options);
  impl.at(arm, options, breaks, 0);
  const bool warm = options.from_last && before >= 0 && impl.level == before;
  if (!warm) impl.level = 0;
  strain::RelaxOptions relax;
  relax.max_iterations = options.max_iterations;
  relax.tolerance = options.tolerance;
  relax.stop = [&work] { return work.stop.stop_requested(); };
  const auto ready = [&](int level) -> LoadedRod& {  // with loads and holds of this question
    ArmRod& entry = impl.at(arm, options, breaks, level);
    set_loads(arm, load, entry.model, entry.rod.work().loads);
    if (entry.lean) set_loads(arm, load, entry.lean->model, entry.lean->rod.work().loads);
    if (!impl.knows_rest) {
      std::fill(entry.rod.work().y.begin(), entry.rod.work().y.end(), 0.0);
      sweep_out(entry.model, entry.rod.work());
      impl.rest_lengths = entry.rod.work().lengths;
      impl.knows_rest = true;
    }
    set_holds(arm, impl, entry.rod);
    return entry.rod;
  };
  const double wanted = options.accuracy * arm.length();
  const bool refines = count > 1 && options.accuracy > 0;
  LoadedRod* rod = &ready(impl.level);
  if (!warm) std::fill(rod->work().y.begin(), rod->work().y.end(), 0.0);
  if (!warm && !options.from_curvatures.empty())
    take_curvatures(options.from_curvatures, rod->model(), rod->work().y);
  bool knows = warm;  // how large the error is, from the question before
  if (const int coarser = coarser_than(impl.level); warm && refines && coarser >= 0) {
    const double shrunk = std::min(1.0, size_of_highest(rod->model(), rod->work().y) / impl.checked_size);
    knows = !(impl.checked * shrunk * shrunk * error_ratio(options, coarser, impl.level) <= 0.3 * wanted);
  }
  if (warm && !knows) {
    const int coarser = coarser_than(impl.level);
    LoadedRod& lighter = ready(coarser);  // what came before was harder to resolve
    carry_over(rod->model(), rod->work(), lighter.model(), lighter.work().y);
    if (impl.balances) lighter.expect(rod->tensions());
    impl.level = coarser;
    rod = &lighter;
  } else if (warm && impl.balances) {
    rod->expect(rod->tensions());
  }
  impl.balances = false;
  const bool by_energy = options.balance == ArmBalance::energy;
  strain::Relaxed found =
      by_energy ? rod->relax(relax) : relax_published(arm, commands, options, relax, warm, *rod);
  if (!refines) impl.checked = 0;
  // What is to be told of further steps: all iterations.
  const auto take = [&found](const strain::Relaxed& last) {
    const int spent = found.iterations;
    found = last;
    found.iterations += spent;
  };
  // Whether the order before does with the elements of a level; then that is the answer.
  // @param off by how much the tip of the level is off at most [m]
  const auto leaner_does = [&](const LoadedRod& finer, int next, const std::array<double, 3>& tip,
                               double off) {
    LoadedRod& lean = ready(next - 1);
    carry_over(finer, lean);
    const strain::Relaxed other = lean.relax(relax);
    found.iterations += other.iterations;
    const auto there = tip_of(lean);
    const double all = off + std::hypot(there[0] - tip[0], there[1] - tip[1], there[2] - tip[2]);
    if (other.status != Status::converged || all > wanted) return false;
    impl.level = next - 1;
    impl.checked = all;
    impl.checked_size = size_of_highest(lean.model(), lean.work().y);
    rod = &lean;
    found.iterations -= other.iterations;
    take(other);
    return true;
  };
  while (refines && found.status == Status::converged) {
    const double size = size_of_highest(rod->model(), rod->work().y);
    const double grown = std::max(1.0, size / impl.checked_size);
    if (knows && grown <= 1.5 && impl.checked * grown * grown <= wanted) break;
    knows = false;
    const int next = finer_than(impl.level);
    if (next >= count && impl.level % 2 == 0) break;
    if (next >= count) {  // nothing has more elements: back to where the last step began
      LoadedRod& lighter = ready(impl.level - 1);
      carry_over(*rod, lighter);
      --impl.level;
      rod = &lighter;
      take(lighter.relax(relax));
      continue;
    }
    LoadedRod& finer = ready(next);
    const double ratio = error_ratio(options, impl.level, next);
    const strain::Approach near = finer.approach(*rod, 1e-3 * wanted);
    found.iterations += near.iterations;
    if (near.close && near.moved * ratio / (ratio - 1) <= wanted) {
      impl.checked = near.moved * ratio / (ratio - 1);
      impl.checked_size = size;
      break;
    }
    if (near.close) {
      const double left = near.moved / (ratio - 1);  // of the finer one
      if (left <= wanted && near.moved < 1e-3 * arm.length() &&
          leaner_does(finer, next, near.tip, left + near.rest))
        break;
      if (const int to = level_for(options, next, left, 0.5 * wanted); to != next) {
        LoadedRod& there = ready(to);
        carry_over(finer, there);
        impl.level = to;
        impl.checked = left;
        rod = &there;
        take(there.relax(relax));
        continue;
      }
    } else {
      carry_over(*rod, finer);
    }
    const strain::Relaxed again = finer.relax(relax);
    found.iterations += again.iterations;
    const auto coarse = tip_of(*rod), fine = tip_of(finer);
    const double moved = std::hypot(fine[0] - coarse[0], fine[1] - coarse[1], fine[2] - coarse[2]);
    impl.checked = moved * ratio / (ratio - 1);
    impl.checked_size = size;
    if (again.status == Status::converged && impl.checked <= wanted) break;
    impl.level = next;
    rod = &finer;
    const int spent = found.iterations;
    found = again;
    found.iterations = spent;
    impl.checked = moved / (ratio - 1);
    impl.checked_size = size_of_highest(finer.model(), finer.work().y);
    if (found.status != Status::converged || impl.checked > wanted || moved >= 1e-3 * arm.length()) continue;
    leaner_does(finer, next, fine, impl.checked);
    break;
  }
  state.resolution = impl.checked;
  impl.balances = found.status == Status::converged;
  set_report(state.report, found, impl, *rod);
  if (!by_energy) state.report.message = FixedText<240>(published_words(found.status));
  if (refines && state.report.ok() && state.resolution > 10 * wanted) {
    state.report.status = Status::stalled;
    state.report.message = FixedText<240>(fmt::format(
        "the finest polynomials still move the tip by {:.1e} m: loads or tensions are too large for this arm",
        state.resolution));
  }
  state.stable = found.negative == 0;
  state.stability_told = by_energy;
  write_state(arm, impl);
  return state;
}

}  // namespace sinew::inline v1
