#include "kinematics/rods/batch.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "kinematics/rods/verdict.hpp"

namespace sinew::inline v1 {
RodBatch::RodBatch(RodWork& work, const SE3<double>& home)
    : work_(&work),
      system_(work.system->elastica()),
      home_(home),
      rods_(at(system_->limbs())),
      before_(rods_.size()) {
  for (int k = 0; k < system_->limbs(); ++k)
    for (int lane = 0; lane < rod_lanes; ++lane) system_->copy_rod(k, rods_[at(k)], lane);
  for (CoarseRods& rods : rods_) {  // as if nothing had been solved before: lanes without rows stay so
    static_cast<CoarseRods::State&>(rods) = {};
    std::fill_n(rods.length, rod_lanes, 1.0);
  }
}

void RodBatch::set_lengths(int lane, Numbers inputs) {
  for (int k = 0; k < system_->limbs(); ++k) rods_[at(k)].length[lane] = inputs[at(system_->input_of(k))];
}

void RodBatch::to_lane(int lane) {
  for (int k = 0; k < system_->limbs(); ++k) system_->copy_rod(k, rods_[at(k)], lane);
  const SE3<double>& pose = system_->platform();
  for (int c = 0; c < 3; ++c) {
    poses_.position[c][lane] = pose.p[c];
    poses_.quaternion[c + 1][lane] = pose.R.v[c];
  }
  poses_.quaternion[0][lane] = pose.R.w;
}

void RodBatch::from_lane(int lane) {
  for (int k = 0; k < system_->limbs(); ++k) system_->take_rod(k, before_[at(k)], lane);
  const auto& p = poses_before_.position;
  const auto& q = poses_before_.quaternion;
  system_->set_platform({Vec3<double>(p[0][lane], p[1][lane], p[2][lane]),
                         {q[0][lane], Vec3<double>(q[1][lane], q[2][lane], q[3][lane])}});
}

RodQuestion RodBatch::question_of(int lane, bool check_stability) const {
  RodQuestion question;
  for (int k = 0; k < 6; ++k) question.wrench[k] = poses_.wrench[k][lane];
  question.check_stability = check_stability;
  return question;
}

/// What the system holds, its rods on the elements of the lanes.
void RodBatch::take_system(int lane) {
  if (system_->is_fine()) system_->coarsen();
  to_lane(lane);
}

/// A path that leads to what does not hold by itself has missed a fold: whether home leads to what does.
bool RodBatch::settles_from_home(int lane, Numbers inputs, Report& report) {
  const Report other = solve_rods(*work_, home_, inputs, question_of(lane, true));
  if (other.status != Status::converged) return false;
  report = other;
  take_system(lane);
  return true;
}

/// One pose alone: from where the lane was, else from home.
bool RodBatch::solve_lane(int lane, Numbers inputs, bool check_stability, Report& report) {
  RodQuestion question = question_of(lane, check_stability);
  if (knows_[at(lane)]) {
    from_lane(lane);
    system_->set_wrench(question.wrench);
    system_->evaluate();
    work_->is_solved = system_->linearise();
    question.warm_start = true;
  }
  report = solve_rods(*work_, home_, inputs, question);
  if (!work_->is_solved && question.warm_start) {
    question.warm_start = false;
    report = solve_rods(*work_, home_, inputs, question);
  }
  knows_[at(lane)] = work_->is_solved;
  if (!work_->is_solved) return false;
  if (report.status == Status::unstable && !check_stability) report.status = Status::converged;
  take_system(lane);
  return true;
}

double RodBatch::worst() const {
  double worst = 0;
  for (int lane = 0; lane < rod_lanes; ++lane)
    if (knows_[at(lane)] && !(poses_.error[lane] <= worst)) worst = poses_.error[lane];
  return worst;
}

/// All lanes to their new lengths: a step with the factors they have, then with new ones, and with those as
/// long as they gain as much as newer ones would.
void RodBatch::walk() {
  constexpr int rows_carried = 16;  // each rounds a few times by 2e-16
  rod_kernels::advance(rods_, {.moves = false, .from_scratch = ++walked_ % rows_carried == 0}, poses_);
  double error = worst();
  int renewals = 0;
  for (int k = 0; k < 10 && !(error <= rod_tolerance); ++k) {
    // the factors of a step are found in the sweep before it
    const bool renews = renewals == 0 ? k == 0 : renewals < 3 && error > 1e-6;
    rod_kernels::advance(rods_, {.renews = renews}, poses_);
    const double next = worst();
    if (renewals > 0 && !(next < 0.3 * error) && !(next <= rod_tolerance)) break;
    renewals += renews;
    error = next;
  }
}

void RodBatch::put(int lane, std::size_t row, const Report& report, const Found& found) const {
  const auto& p = poses_.position;
  const auto& q = poses_.quaternion;
  found.poses[row] = spatial_pose({Vec3<double>(p[0][lane], p[1][lane], p[2][lane]),
                                   {q[0][lane], Vec3<double>(q[1][lane], q[2][lane], q[3][lane])}});
  found.statuses[row] = report.status;
  if (!found.residuals.empty() && report.is_solved()) found.residuals[row] = report.residual;
}

RodBatch::Home RodBatch::lanes_at_home() {
  for (int lane = 0; lane < rod_lanes; ++lane) take_system(lane);
  for (int k = 0; k < 6; ++k) std::fill_n(poses_.wrench[k], rod_lanes, system_->wrench()[k]);
  rod_kernels::advance(rods_, {.moves = false, .from_scratch = true, .renews = true}, poses_);
  return {rods_, poses_};
}

/// Steps of the ways that lanes take together: lengths change by a twentieth at most in each, loads by half
/// of what bends a rod by its length. 0 where that would be too many.
int RodBatch::way_from(const Home& home, std::span<const double> rows, const RodGroup::Wrench& wrench) {
  constexpr double length_step = 0.05, load_step = 0.5, most = 24;
  const std::size_t inputs = at(system_->inputs());
  double steps = 2;
  for (int lane = 0; lane < rod_lanes; ++lane)
    for (int k = 0; k < system_->limbs() && knows_[at(lane)]; ++k) {
      const double from = home.rods[at(k)].length[lane],
                   to = rows[at(lane) * inputs + at(system_->input_of(k))],
                   load = (wrench.head<3>().norm() + wrench.tail<3>().norm() / to) * to * to /
                          system_->stiffness(k);
      const double own = std::max(std::abs(to - from) / (length_step * from), load / load_step);
      if (own <= most)
        steps = std::max(steps, std::ceil(own));
      else
        knows_[at(lane)] = false;
    }
  return static_cast<int>(steps);
}

/// First the lengths, then the load, as one by one; lanes that do not follow are left.
void RodBatch::walk_from(const Home& home, std::span<const double> rows, const RodGroup::Wrench& wrench,
                         int steps) {
  const std::size_t inputs = at(system_->inputs());
  rods_ = home.rods;
  poses_ = home.poses;
  const auto leave_lost = [&] {
    for (int lane = 0; lane < rod_lanes; ++lane)
      if (!(poses_.error[lane] <= rod_tolerance)) knows_[at(lane)] = false;
  };
  for (int step = 1; step <= steps; ++step) {
    const double way = static_cast<double>(step) / steps;
    for (int k = 0; k < system_->limbs(); ++k)
      for (int lane = 0; lane < rod_lanes; ++lane)
        if (knows_[at(lane)])
          rods_[at(k)].length[lane] = std::lerp(home.rods[at(k)].length[lane],
                                                rows[at(lane) * inputs + at(system_->input_of(k))], way);
    for (int k = 0; k < 6; ++k)
      for (int lane = 0; lane < rod_lanes; ++lane)
        poses_.wrench[k][lane] = std::lerp(home.poses.wrench[k][lane], 0, way);
    walk();
    leave_lost();
  }
  const bool is_loaded = wrench != RodGroup::Wrench::Zero();
  for (int step = 1; step <= steps && is_loaded; ++step) {
    for (int k = 0; k < 6; ++k)
      std::fill_n(poses_.wrench[k], rod_lanes, wrench[k] * static_cast<double>(step) / steps);
    walk();
    leave_lost();
  }
}

void RodBatch::solve_from_home(std::span<const double> rows, const RodGroup::Wrench& wrench,
                               bool check_stability, const Found& found) {
  constexpr std::size_t least = 3;  // fewer are sooner solved alone
  const std::size_t inputs = at(system_->inputs()), count = found.statuses.size();
  const Home home = count >= least ? lanes_at_home() : Home();
  for (std::size_t first = 0; first < count; first += rod_lanes) {
    if (work_->stop.stop_requested()) {
      std::ranges::fill(found.statuses.subspan(first), Status::stopped);
      return;
    }
    const std::size_t here = std::min<std::size_t>(rod_lanes, count - first);
    const auto block = rows.subspan(first * inputs, here * inputs);
    knows_.fill(false);
    for (std::size_t lane = 0; lane < here && here >= least; ++lane) {
      knows_[lane] = wrench.allFinite();
      for (int k = 0; k < system_->feeds(); ++k)
        knows_[lane] = knows_[lane] && system_->in_domain(k, block[lane * inputs + at(system_->input_of(k))]);
    }
    const int steps = way_from(home, block, wrench);
    if (std::ranges::any_of(knows_, std::identity())) {
      walk_from(home, block, wrench, steps);
      if (check_stability)
        rod_kernels::advance(rods_, {.moves = false, .renews = true, .counts_unstable = true}, poses_);
    }
    for (int k = 0; k < 6; ++k) std::fill_n(poses_.wrench[k], rod_lanes, wrench[k]);
    alignas(64) RodLane truncation;
    rod_kernels::truncation(rods_, truncation);
    for (int lane = 0; at(lane) < here; ++lane) {
      Report report;
      report.residual = poses_.error[lane];
      const bool is_sure = knows_[at(lane)] && poses_.error[lane] <= rod_tolerance &&
                           truncation[lane] <= system_->traits().quick_truncation &&
                           !(check_stability && poses_.unstable[lane] > 0);
      knows_[at(lane)] = false;  // another way would not be from home
      if (is_sure || solve_lane(lane, block.subspan(at(lane) * inputs, inputs), check_stability, report))
        put(lane, first + at(lane), report, found);
      else
        found.statuses[first + at(lane)] = report.status;
    }
  }
}

void RodBatch::solve(std::span<const double> rows, const RodGroup::Wrench& wrench, bool check_stability,
                     const Found& found) {
  const std::span<Status> statuses = found.statuses;
  const std::size_t inputs = at(system_->inputs()), count = statuses.size();
  if (count == 0) return;
  const std::size_t stretch = (count + rod_lanes - 1) / rod_lanes;
  for (int k = 0; k < 6; ++k) std::fill_n(poses_.wrench[k], rod_lanes, wrench[k]);
  knows_.fill(false);
  for (std::size_t step = 0; step < stretch; ++step) {
    if (work_->stop.stop_requested()) {
      for (std::size_t k = 0; k < count; ++k)
        if (k % stretch >= step) statuses[k] = Status::stopped;
      return;
    }
    for (std::size_t k = 0; k < rods_.size(); ++k) before_[k] = rods_[k];
    poses_before_ = poses_;
    const auto row = [&](int lane) { return at(lane) * stretch + step; };
    const auto has_row = [&](int lane) { return at(lane) * stretch + step < count; };
    for (int lane = 0; lane < rod_lanes; ++lane) {
      knows_[at(lane)] = knows_[at(lane)] && has_row(lane);
      if (knows_[at(lane)]) set_lengths(lane, rows.subspan(row(lane) * inputs, inputs));
    }
    if (std::ranges::any_of(knows_, std::identity())) {
      walk();
      if (check_stability)
        rod_kernels::advance(rods_, {.moves = false, .renews = true, .counts_unstable = true}, poses_);
    }
    alignas(64) RodLane truncation;
    rod_kernels::truncation(rods_, truncation);
    bool is_renewed = false;
    for (int lane = 0; lane < rod_lanes; ++lane) {
      if (!has_row(lane)) continue;
      Report report;
      report.status = check_stability && poses_.unstable[lane] > 0 ? Status::unstable : Status::converged;
      report.residual = poses_.error[lane];
      if (!knows_[at(lane)] || !(poses_.error[lane] <= rod_tolerance) ||
          !(truncation[lane] <= system_->traits().quick_truncation)) {
        is_renewed = true;
        if (!solve_lane(lane, rows.subspan(row(lane) * inputs, inputs), check_stability, report)) {
          statuses[row(lane)] = report.status;
          continue;
        }
      }
      if (report.status == Status::unstable &&
          settles_from_home(lane, rows.subspan(row(lane) * inputs, inputs), report))
        is_renewed = true;
      put(lane, row(lane), report, found);
    }
    if (is_renewed) {  // factors of the lanes that were solved alone
      rod_kernels::advance(rods_, {.moves = false, .from_scratch = true, .renews = true}, poses_);
    }
  }
}

}  // namespace sinew::inline v1
