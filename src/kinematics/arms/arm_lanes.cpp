#include "kinematics/arms/arm_lanes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/at.hpp"
#include "kinematics/arms/arm_work.hpp"
#include "strain/lanes.hpp"

namespace sinew::inline v1 {
namespace {

using strain::lane_count;
using strain::LaneValues;
using strain::LaneWork;

/// Rows that are solved side by side, so that most find seven others to share lanes with.
constexpr std::size_t most_open = 64;
/// Hessians of a row, after which it is solved by itself.
constexpr int most_hessians = 40;
/// Gradients after a Hessian, with its factors.
constexpr int most_kept = 6;

/// One rod of the ladder in lanes.
struct LaneLevel {
  ArmRod* rod;
  LaneWork own;
  std::unique_ptr<LaneWork> lean;            ///< with fewer elements; may be none
  std::vector<std::vector<double>> elastic;  ///< what the lean Hessian lacks

  std::vector<int>
      shared;  ///< for each coordinate of the next level with more elements, 1 + which of these; 0

  explicit LaneLevel(ArmRod& of) : rod(&of), own(of.model) {
    if (!of.lean) return;
    lean = std::make_unique<LaneWork>(of.lean->model);
    elastic = elastic_difference(of.model, of.lean->model);
  }
};

/// What a row found at a level, or begins with there.
struct Found {
  std::vector<double> y, lengths;
  std::array<double, 12> tip{};  ///< place [m] and rotation matrix, rows first
  double energy = 0;             ///< without tendons [J]

  strain::Three place() const { return {tip[0], tip[1], tip[2]}; }
};

/// A row that is being solved, and where the rows before it on its stretch ended.
struct OpenRow {
  OpenRow(const ArmOptions& options, const Arm& arm)
      : commands(arm.tendons.size()),
        found(at(level_count(options))),
        ladder(options, arm.length(), rung) {}

  std::size_t row = 0, end = 0;  ///< the row, and where its stretch ends
  bool is_open = false;          ///< there is a row to be solved
  bool is_done = false;          ///< that was told its answer
  bool follows = false;          ///< the row before it was solved
  std::vector<TendonCommand> commands;
  ArmLoad load;
  std::vector<Found> found;  ///< by level
  Rung rung, start;          ///< start: what the row before left, for who begins again
  std::vector<double> start_y;
  ResolutionLadder ladder;
  ResolutionLadder::Step step = {ResolutionLadder::Step::Kind::answer};
  bool leans = true;  ///< where a level has a lean rod
  double radius = 0;  ///< of Newton's steps in this solve
  double residual = 0, standing_residual = 0;
  int hessians = 0, iterations = 0;
};

/// Of all lanes at once.
LaneValues lane_dots(const std::vector<LaneValues>& a, const std::vector<LaneValues>& b) {
  LaneValues sum;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int l = 0; l < lane_count; ++l) sum[l] += a[i][l] * b[i][l];
  return sum;
}

}  // namespace

struct ArmLanes::Impl {
  Impl(const Arm& of, const ArmOptions& by) : arm(of), options(by), rods(of), alone(of) {
    levels.resize(at(level_count(options)));
    options.from_last = false;
    none.wrench = {};
    level(0);
    LaneWork& rest = levels[0]->own;  // y is 0
    sweep_out(levels[0]->rod->model, rest);
    for (const LaneValues& length : rest.lengths) rest_lengths.push_back(length[0]);
    for (auto* values : {&state.tensions, &state.changes, &state.slack}) values->resize(arm.tendons.size());
  }

  LaneLevel& level(int which) {
    auto& entry = levels[at(which)];
    if (!entry) {
      entry = std::make_unique<LaneLevel>(rods.impl().at(arm, options, {}, which));
      set_loads(arm, none, entry->rod->model, entry->own.loads);
      if (entry->lean) set_loads(arm, none, entry->rod->lean->model, entry->lean->loads);
    }
    return *entry;
  }

  void solve(std::size_t count, std::size_t length, const StopToken& stop);
  void begin_next(OpenRow& open);
  void begin(OpenRow& open);
  void take(OpenRow& open, const ResolutionLadder::Step& step);
  void finish(OpenRow& open);
  void solve_alone(OpenRow& open);
  void newton(int which, bool leans);
  void compare(int which, bool leans, int finer, const std::array<bool, lane_count>& wants);
  void load_lanes(LaneWork& work, int which);
  void ask_lanes(LaneWork& work);
  void keep(OpenRow& open, int which, int lane, const LaneWork& work);

  const Arm& arm;
  ArmOptions options;
  ArmWorkspace rods;   ///< has the rods of the lanes
  ArmWorkspace alone;  ///< for rows that are solved by themselves
  ArmLoad none;        ///< what all rows have in common: nothing but weight
  std::vector<std::unique_ptr<LaneLevel>> levels;
  std::vector<double> rest_lengths;
  std::vector<std::unique_ptr<OpenRow>> open_rows;
  std::array<OpenRow*, lane_count> in_lanes{};
  std::size_t next_row = 0, rows = 0, stretch = 1;
  const Ask* ask = nullptr;
  const Tell* tell = nullptr;
  ArmState state;
};

/// The next row of its stretch, or of another; closes where there is none.
void ArmLanes::Impl::begin_next(OpenRow& open) {
  ++open.row;
  for (;;) {
    if (open.row >= open.end) {
      if (next_row >= rows) {
        open.is_open = false;
        return;
      }
      open.row = next_row;
      open.end = next_row = std::min(rows, next_row + stretch);
      open.follows = false;
    }
    if ((*ask)(open.row, open.commands, open.load)) break;
    (*tell)(open.row, nullptr);
    open.follows = false;
    ++open.row;
  }
  open.is_open = true;
  open.is_done = false;
  begin(open);
}

void ArmLanes::Impl::begin(OpenRow& open) {
  Found* last = open.follows ? &open.found[at(open.rung.level)] : nullptr;
  open.start = open.rung;
  if (last) open.start_y = last->y;
  open.hessians = open.iterations = 0;
  open.leans = true;
  bool fits = true;
  for (const TendonCommand& command : open.commands) fits = fits && command.held == TendonHeld::tension;
  const auto all_zero = [](const auto& values) {
    return std::ranges::all_of(values, [](double x) { return x == 0; });
  };
  const ArmLoad& load = open.load;
  fits = fits && all_zero(std::span(load.wrench).subspan<3>()) &&  // a moment has no potential
         all_zero(load.following) && all_zero(load.along) && all_zero(load.following_along) &&
         load.points.empty() && !load.gravity;
  if (!fits || !misfit(arm, open.commands, open.load, options).empty()) {
    solve_alone(open);
    return;
  }
  const double size = last ? size_of_variation(level(open.rung.level).rod->model, last->y) : 0;
  ResolutionLadder::Step step = open.ladder.begin(open.follows, size);
  if (!open.follows) {
    open.found[0].y.assign(at(level(0).rod->model.size), 0.0);
    step.from = 0;
  }
  take(open, step);
}

void ArmLanes::Impl::take(OpenRow& open, const ResolutionLadder::Step& step) {
  open.step = step;
  if (step.kind == ResolutionLadder::Step::Kind::answer) {
    finish(open);
    return;
  }
  const strain::RodModel& model = level(step.level).rod->model;
  Found& found = open.found[at(step.level)];
  found.y.resize(at(model.size));
  if (step.kind == ResolutionLadder::Step::Kind::solve && step.level != step.from) {
    const strain::RodModel& from = level(step.from).rod->model;
    if (!is_within(from, model) && !is_within(model, from)) {
      solve_alone(open);
      return;
    }
    take_shared(from, open.found[at(step.from)].y, model, found.y);
  }
  open.radius = std::numbers::pi * std::sqrt(model.energy_scale);
}

void ArmLanes::Impl::finish(OpenRow& open) {
  const Found& found = open.found[at(open.rung.level)];
  const double* R = found.tip.data() + 3;
  Mat<double, 3, 3> turn;
  turn << R[0], R[1], R[2], R[3], R[4], R[5], R[6], R[7], R[8];
  state.tip.p = {found.tip[0], found.tip[1], found.tip[2]};
  state.tip.R = SO3<double>::from(turn);
  state.energy = found.energy;
  for (std::size_t i = 0; i < arm.tendons.size(); ++i) {
    const ArmTendon& tendon = arm.tendons[i];
    const double T = open.commands[i].value;
    state.tensions[i] = T;
    state.changes[i] = found.lengths[i] - rest_lengths[i] - tendon.compliance * (T - tendon.pretension);
    state.energy += 0.5 * tendon.compliance * T * T;
  }
  state.coordinates = static_cast<int>(found.y.size());
  state.resolution = open.rung.told;
  state.report = {Status::converged, open.iterations, open.standing_residual, {}};
  if (open.ladder.refines() && state.resolution > 10 * open.ladder.wanted()) {
    solve_alone(open);  // it has words for that
    return;
  }
  (*tell)(open.row, &state);
  open.follows = stretch > 1;
  open.is_done = true;
}

/// As `arm_forward` does, from where the row began.
void ArmLanes::Impl::solve_alone(OpenRow& open) {
  ArmWorkspace::Impl& impl = alone.impl();
  ArmOptions by = options;
  by.from_last = open.follows;
  if (open.follows) {
    impl.at(arm, options, {}, open.start.level).rod.work().y = open.start_y;
    static_cast<Rung&>(impl) = open.start;
    impl.balances = false;  // no tensions are to be found again
  }
  const ArmState* answer = &arm_forward(arm, open.commands, open.load, by, alone);
  if (by.from_last && !answer->report.ok() && answer->report.status != Status::stopped) {
    by.from_last = false;
    answer = &arm_forward(arm, open.commands, open.load, by, alone);
  }
  open.is_done = true;
  if (answer->report.status == Status::stopped) return;
  open.follows = stretch > 1 && answer->report.ok();
  if (open.follows) {
    open.rung = impl;
    open.found[at(impl.level)].y = impl.rod().work().y;
  }
  (*tell)(open.row, answer);
}

/// Rows without lanes are as the first one is, and nobody asks what becomes of them.
void ArmLanes::Impl::ask_lanes(LaneWork& work) {
  for (int l = 0; l < lane_count; ++l) {
    const OpenRow& open = *(in_lanes[at(l)] ? in_lanes[at(l)] : in_lanes[0]);
    for (std::size_t i = 0; i < open.commands.size(); ++i) work.tensions[i][l] = open.commands[i].value;
    for (std::size_t i = 0; i < 3; ++i) work.tip_force[i][l] = open.load.wrench[i];
  }
}
void ArmLanes::Impl::load_lanes(LaneWork& work, int which) {
  ask_lanes(work);
  for (int l = 0; l < lane_count; ++l) {
    const OpenRow& open = *(in_lanes[at(l)] ? in_lanes[at(l)] : in_lanes[0]);
    const std::vector<double>& y = open.found[at(which)].y;
    for (std::size_t i = 0; i < y.size(); ++i) work.y[i][l] = y[i];
  }
}

void ArmLanes::Impl::keep(OpenRow& open, int which, int lane, const LaneWork& work) {
  Found& found = open.found[at(which)];
  for (std::size_t i = 0; i < found.y.size(); ++i) found.y[i] = work.y[i][lane];
  found.lengths.resize(work.lengths.size());
  for (std::size_t i = 0; i < found.lengths.size(); ++i) found.lengths[i] = work.lengths[i][lane];
  for (std::size_t i = 0; i < found.tip.size(); ++i) found.tip[i] = work.tip[i][lane];
  found.energy = work.energy[lane];
}

/// One Newton step of the rows in lanes, and as many by its factors as bring a gradient to 0. Who is not
/// there yet takes another one later, maybe among other rows.
void ArmLanes::Impl::newton(int which, bool leans) {
  LaneLevel& here = level(which);
  const strain::RodModel& model = here.rod->model;
  LaneWork& work = here.own;
  LaneWork& factors = leans ? *here.lean : work;
  const double scale = std::sqrt(model.energy_scale);
  enum class Lane { empty, alone, again, kept, solved };
  std::array<Lane, lane_count> lanes{};
  load_lanes(work, which);
  sweep_out(model, work);
  if (leans) {
    sweep_back(model, work);
    ask_lanes(factors);
    factors.y = work.y;
    sweep_out(here.rod->lean->model, factors);
    sweep_back_and_factor(here.rod->lean->model, factors, here.elastic);
  } else {
    sweep_back_and_factor(model, work, {});
  }
  const auto potential = [&](int l) {
    double sum = work.energy[l];
    for (std::size_t i = 0; i < work.tensions.size(); ++i) sum += work.tensions[i][l] * work.lengths[i][l];
    return sum;
  };
  const auto in_domain = [&](int l) { return work.largest_turn[l] < strain::largest_lane_turn; };
  LaneValues squares = lane_dots(work.gradient, work.gradient), before, energy, predicted, lengths;
  for (std::size_t i = 0; i < work.side.size(); ++i)
    for (int l = 0; l < lane_count; ++l) factors.side[i][l] = -work.gradient[i][l];
  strain::solve(leans ? here.rod->lean->model : model, factors);
  const LaneValues steps = lane_dots(factors.side, factors.side),
                   slopes = lane_dots(work.gradient, factors.side);
  for (int l = 0; l < lane_count; ++l) {
    OpenRow* open = in_lanes[at(l)];
    if (!open) continue;
    before[l] = open->residual = std::sqrt(squares[l]) / scale;
    const double length = std::sqrt(steps[l]);
    const bool is_good = factors.smallest_pivot[l] > 1e-12;
    ++open->hessians;
    if (!std::isfinite(open->residual) || !in_domain(l) || open->hessians > most_hessians) {
      lanes[at(l)] = Lane::alone;
    } else if (!is_good) {
      lanes[at(l)] = leans ? Lane::again : Lane::alone;
      open->leans = false;  // whether the rod holds is for its own Hessian to say
    } else if (open->residual <= options.tolerance) {
      lanes[at(l)] = Lane::solved;
      keep(*open, which, l, work);
    } else if (!(length <= 1.1 * open->radius)) {
      lanes[at(l)] = Lane::alone;
    } else {
      lanes[at(l)] = Lane::kept;
      ++open->iterations;
    }
    energy[l] = potential(l);
    predicted[l] = -0.5 * slopes[l];
    lengths[l] = length;
  }
  const auto is_kept = [&](int l) { return lanes[at(l)] == Lane::kept; };
  const auto any_kept = [&] {
    for (int l = 0; l < lane_count; ++l)
      if (is_kept(l)) return true;
    return false;
  };
  const auto step = [&] {
    LaneValues share;
    for (int l = 0; l < lane_count; ++l) share[l] = is_kept(l) ? 1 : 0;
    for (std::size_t i = 0; i < work.y.size(); ++i)
      for (int l = 0; l < lane_count; ++l) work.y[i][l] += share[l] * factors.side[i][l];
    sweep_out(model, work);
  };
  if (any_kept()) step();
  for (int l = 0; l < lane_count; ++l) {  // as far as the energy tells, and near enough to keep the factors
    if (!is_kept(l)) continue;
    OpenRow& open = *in_lanes[at(l)];
    if (!in_domain(l)) {
      lanes[at(l)] = Lane::alone;
    } else if (predicted[l] > 1e-12 * (std::abs(energy[l]) + model.energy_scale)) {
      const double ratio = (energy[l] - potential(l)) / predicted[l];
      if (!(ratio > 1e-4)) {
        lanes[at(l)] = Lane::alone;
        continue;
      }
      if (ratio < 0.25) open.radius = 0.25 * std::min(lengths[l], open.radius);
    }
    if (is_kept(l) && lengths[l] >= 0.1 * scale) {
      lanes[at(l)] = Lane::again;
      keep(open, which, l, work);
    }
  }
  for (int round = 0; any_kept(); ++round) {
    sweep_back(model, work);
    squares = lane_dots(work.gradient, work.gradient);
    for (int l = 0; l < lane_count; ++l) {
      if (!is_kept(l)) continue;
      OpenRow& open = *in_lanes[at(l)];
      open.residual = std::sqrt(squares[l]) / scale;
      if (open.residual <= options.tolerance) {
        lanes[at(l)] = Lane::solved;
        keep(open, which, l, work);
        continue;
      }
      const double rate = open.residual / before[l];
      const bool goes_on = rate < 0.3 && round < most_kept && in_domain(l) &&
                           open.residual * rate * rate * rate <= options.tolerance;
      if (!(rate < 1e3) || (before[l] < 1e3 * options.tolerance && rate > 0.5)) {
        lanes[at(l)] = Lane::alone;  // astray, or as near as rounding lets it
      } else if (!goes_on) {
        lanes[at(l)] = Lane::again;
        if (rate >= 0.3) open.leans = false;
        keep(open, which, l, work);
      } else {
        ++open.iterations;
      }
      before[l] = open.residual;
    }
    if (!any_kept()) break;
    for (std::size_t i = 0; i < work.side.size(); ++i)
      for (int l = 0; l < lane_count; ++l) factors.side[i][l] = -work.gradient[i][l];
    strain::solve(leans ? here.rod->lean->model : model, factors);
    step();
  }
  std::array<bool, lane_count> wants{};
  bool any = false;
  int finer = 0;
  for (int l = 0; l < lane_count; ++l) {
    if (lanes[at(l)] == Lane::alone) solve_alone(*in_lanes[at(l)]);
    if (lanes[at(l)] != Lane::solved) continue;
    OpenRow& open = *in_lanes[at(l)];
    const Found& found = open.found[at(which)];
    const ResolutionLadder::Step next = open.ladder.after_solve({true, model, found.y, found.place()});
    if (open.ladder.stands()) open.standing_residual = open.residual;
    open.leans = true;
    take(open, next);
    if (open.step.kind == ResolutionLadder::Step::Kind::compare && !open.is_done) {
      wants[at(l)] = any = true;
      finer = next.level;
    }
  }
  if (any) compare(which, leans, finer, wants);
}

/// LoadedRod::approach() of lanes that were just solved, by their factors.
void ArmLanes::Impl::compare(int which, bool leans, int finer, const std::array<bool, lane_count>& wants) {
  LaneLevel &here = level(which), &there = level(finer);
  const strain::RodModel& model = there.rod->model;
  LaneWork &coarse = leans ? *here.lean : here.own, &fine = there.own;
  if (here.shared.empty()) {
    std::vector<double> numbers(here.own.y.size()), found(fine.y.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<double>(i + 1);
    take_shared(here.rod->model, numbers, model, found);
    here.shared.assign(found.begin(), found.end());
  }
  const double enough = 1e-3 * options.accuracy * arm.length(), scale = std::sqrt(model.energy_scale);
  std::array<strain::Approach, lane_count> near{};
  std::array<strain::Three, lane_count> from{}, last{};
  std::array<double, lane_count> step_before{}, residual_before{};
  std::array<bool, lane_count> goes_on = wants;
  ask_lanes(fine);
  for (std::size_t i = 0; i < fine.y.size(); ++i)
    fine.y[i] = here.shared[i] > 0 ? here.own.y[at(here.shared[i] - 1)] : LaneValues{};
  for (int l = 0; l < lane_count; ++l) {
    if (!wants[at(l)]) continue;
    from[at(l)] = last[at(l)] = in_lanes[at(l)]->found[at(which)].place();
  }
  sweep_out(model, fine);
  const auto distance = [](const strain::Three& a, const strain::Three& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  };
  for (int round = 1; round <= 5 && std::ranges::any_of(goes_on, [](bool x) { return x; }); ++round) {
    sweep_back(model, fine);
    const LaneValues squares = lane_dots(fine.gradient, fine.gradient);
    for (std::size_t i = 0; i < fine.y.size(); ++i)
      for (int l = 0; l < lane_count; ++l) {
        if (here.shared[i] > 0)
          coarse.side[at(here.shared[i] - 1)][l] = -fine.gradient[i][l];
        else
          fine.y[i][l] -= fine.gradient[i][l];
      }
    strain::solve(leans ? here.rod->lean->model : here.rod->model, coarse);
    for (std::size_t i = 0; i < fine.y.size(); ++i)
      if (here.shared[i] > 0)
        for (int l = 0; l < lane_count; ++l) fine.y[i][l] += coarse.side[at(here.shared[i] - 1)][l];
    sweep_out(model, fine);
    for (int l = 0; l < lane_count; ++l) {
      const auto lane = at(l);
      if (!goes_on[lane]) continue;
      const double residual = std::sqrt(squares[l]) / scale;
      const strain::Three tip{fine.tip[0][l], fine.tip[1][l], fine.tip[2][l]};
      const double step = distance(tip, last[lane]), moved = distance(tip, from[lane]);
      near[lane].iterations = round;
      if (!std::isfinite(residual) || !std::isfinite(step) ||
          !(fine.largest_turn[l] < strain::largest_lane_turn)) {
        goes_on[lane] = false;
        continue;
      }
      if (round > 1) {
        const double rate = std::max(step / step_before[lane], residual / residual_before[lane]);
        const double rest = rate < 0.5 ? step * rate / (1 - rate) : step;
        if (!(rate < 0.5) && step > enough) {
          goes_on[lane] = false;
        } else if (rest <= std::max(0.05 * moved, enough)) {
          near[lane] = {true, round, tip, rest, moved + rest};
          goes_on[lane] = false;
          keep(*in_lanes[lane], finer, l, fine);
        }
      }
      last[lane] = tip;
      step_before[lane] = step;
      residual_before[lane] = residual;
    }
  }
  for (int l = 0; l < lane_count; ++l) {
    if (!wants[at(l)]) continue;
    OpenRow& open = *in_lanes[at(l)];
    open.iterations += near[at(l)].iterations;
    take(open, open.ladder.after_comparison(near[at(l)]));
  }
}

void ArmLanes::Impl::solve(std::size_t count, std::size_t length, const StopToken& stop) {
  rows = count;
  stretch = std::max<std::size_t>(1, length);
  next_row = 0;
  alone.stop = stop;
  const std::size_t stretches = (rows + stretch - 1) / stretch;
  while (open_rows.size() < std::min(most_open, stretches))
    open_rows.push_back(std::make_unique<OpenRow>(options, arm));
  for (auto& open : open_rows) {
    open->row = open->end = 0;
    open->is_open = open->is_done = true;
  }
  std::vector<std::size_t> waiting(2 * levels.size());
  const auto key = [&](const OpenRow& open) {
    const bool leans = open.leans && level(open.step.level).lean;
    return at(2 * open.step.level) + (leans ? 1 : 0);
  };
  while (!stop.stop_requested()) {
    std::ranges::fill(waiting, 0);
    for (auto& open : open_rows) {
      while (open->is_open && open->is_done) begin_next(*open);
      if (open->is_open) ++waiting[key(*open)];
    }
    const auto most = std::ranges::max_element(waiting);
    if (*most == 0) return;
    const auto chosen = static_cast<std::size_t>(most - waiting.begin());
    in_lanes = {};
    std::size_t lane = 0;
    for (auto& open : open_rows)
      if (lane < in_lanes.size() && open->is_open && key(*open) == chosen) in_lanes[lane++] = open.get();
    newton(static_cast<int>(chosen / 2), chosen % 2 == 1);
  }
}

bool ArmLanes::fits(const Arm&, const ArmOptions& options) {
  return options.balance == ArmBalance::energy && options.model != ArmModel::prb;
}

ArmLanes::ArmLanes(const Arm& arm, const ArmOptions& options) : impl_(std::make_unique<Impl>(arm, options)) {}
ArmLanes::~ArmLanes() = default;

void ArmLanes::solve(std::size_t rows, std::size_t stretch, const Ask& ask, const Tell& tell,
                     StopToken stop) {
  impl_->ask = &ask;
  impl_->tell = &tell;
  impl_->solve(rows, stretch, stop);
}

}  // namespace sinew::inline v1
