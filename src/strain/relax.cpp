#include "strain/relax.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/at.hpp"
#include "strain/norm.hpp"

namespace sinew::inline v1::strain {
namespace {

/// Eigenvalues down to this count as 0: a round rod that has buckled turns freely.
constexpr double neutral = 1e-9;
/// Length of a step downhill from where the gradient does not tell the way, over √(EI/L).
constexpr double saddle_step = 0.3;
/// In which tendons that become taut or slack in a step are found.
constexpr int most_guesses = 6;

double farthest(std::span<const double> a, std::span<const double> b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

}  // namespace

/// What a tendon held by its end is longer than its free length, below 0 where it is slack [m].
double LoadedRod::beyond(std::size_t i) const {
  return work_.lengths[i] - holds[i].free_length + offsets_[i];
}

/// What the energy falls by in a step that was made with the tendons assumed [J], with each of them taut or
/// slack as its linearised length has it after the step: that is left in then_.
double LoadedRod::foreseen(std::span<const double> step, const Descent& descent) {
  const std::size_t n = at(model_->size);
  double change = 0.5 * dot(work_.gradient, step) - 0.5 * descent.shift * dot(step, step) + descent.surplus;
  for (std::size_t i = 0; i < holds.size(); ++i) {
    then_[i] = assumed_[i];
    if (holds[i].by_tension || holds[i].toe > 0) continue;
    const double along = dot({work_.length_gradient.data() + i * n, n}, step), here = beyond(i),
                 there = here + along;
    then_[i] = there > 0;
    // Of ½ max(0, here + along)² and of what the step's own equation makes of the quadratic terms.
    const double before = std::max(0.0, here), after = std::max(0.0, there),
                 in_step = assumed_[i] ? along * there : 0;
    change += 0.5 * (after * after - before * before - before * along - in_step) / stiff_[i];
  }
  return -change;
}

/// Where the gradient does not tell of the direction in which the energy falls most, as that of a straight
/// column that is pushed along itself: so far in it that the step has the length asked, after a factor that
/// is all but singular (the hard case of a trust region).
void LoadedRod::go_along_lowest(double length, std::span<double> step, Descent& descent) {
  const int n = model_->size;
  // To begin with as the gradient has it; where that tells nothing, any direction will do.
  some_direction(lowest_);
  const double any = 1e-8 * norm(step) / std::sqrt(n);
  for (int i = 0; i < n; ++i) lowest_[at(i)] = step[at(i)] + any * lowest_[at(i)];
  double least = 0, before = 0;
  for (int round = 0; round < 40 && !(round > 8 && std::abs(least - before) < 1e-2 * least); ++round) {
    before = least;
    const double size = norm(lowest_);
    for (int i = 0; i < n; ++i) sides_[at(i * stride_)] = lowest_[at(i)] / size;
    solve_all(sides_, 1, stride_);
    for (int i = 0; i < n; ++i) lowest_[at(i)] = sides_[at(i * stride_)];
    least = 1 / norm(lowest_);
  }
  const double way = dot(work_.gradient, lowest_) > 0 ? -least : least;
  for (double& x : lowest_) x *= way;
  const double along = dot(step, lowest_), short_by = length * length - dot(step, step);
  if (!(short_by > 0)) return;
  const double by = short_by / (along + std::sqrt(along * along + short_by));
  for (int i = 0; i < n; ++i) step[at(i)] += by * lowest_[at(i)];
  descent.surplus = 0.5 * by * least * dot(step, lowest_);
}

/// Of the quadratic model in which the tendons assumed, and no others, are taut.
bool LoadedRod::step_with_assumed(double radius, std::span<double> step, Descent& descent) {
  double low = 0, high = 0, &shift = descent.shift;
  shift = 0;
  for (int tries = 0; tries < 40; ++tries) {
    const int found = factor_all(shift);
    if (tries == 0) descent.negative = found;
    if (found != 0) {  // not positive definite
      low = shift;
      shift = high > 0 ? std::sqrt(std::max(low, 1e-9 * high) * high) : std::max(1e-3, 4 * shift);
      continue;
    }
    for (int i = 0; i < model_->size; ++i) sides_[at(i * stride_)] = -work_.gradient[at(i)];
    for (std::size_t k = 0; k < holds.size(); ++k) {
      if (holds[k].by_tension || (assumed_[k] != 0) == (tensions_[k] > 0)) continue;
      const double pull = (assumed_[k] ? beyond(k) : -beyond(k)) / stiff_[k];
      const double* gradient = work_.length_gradient.data() + k * at(model_->size);
      for (int i = 0; i < model_->size; ++i) sides_[at(i * stride_)] -= pull * gradient[i];
    }
    solve_all(sides_, 1, stride_);
    for (int i = 0; i < model_->size; ++i) step[at(i)] = sides_[at(i * stride_)];
    const double length = norm(step);
    if (length <= 1.1 * radius) {
      const double far = std::min(radius, saddle_step * std::sqrt(model_->energy_scale));
      // where it all but turns freely, as a round rod that has buckled, there is nothing to gain
      if (low < 1e-3 || !leaves_ || length > 0.7 * far) return true;
      if (tries < 20 && shift > 1.3 * low) {  // more than it takes: so much shortens the step
        high = shift;
        shift = std::sqrt(low * high);
        continue;
      }
      go_along_lowest(far, step, descent);
      return true;
    }
    if (shift > 0 && length <= 1.5 * radius && tries > 6) break;
    // Newton on 1/|step| with the derivative |step|' = −step·(H+shift)⁻¹step/|step|
    for (int i = 0; i < model_->size; ++i) sides_[at(i * stride_)] = step[at(i)];
    solve_all(sides_, 1, stride_);
    double slope = 0;
    for (int i = 0; i < model_->size; ++i) slope += sides_[at(i * stride_)] * step[at(i)];
    const double by = length * length / slope * (length - radius) / radius;
    low = shift;
    shift += by;
    if (high > 0 && shift >= high) shift = 0.5 * (low + high);
  }
  const double length = norm(step);
  if (!(length > 0)) return false;
  for (double& x : step) x *= radius / length;
  return true;
}

/// A step of at most `radius`. Where tendons become taut or slack in it, it is made anew with those, for a
/// few rounds: of the steps found the one by which the energy is to fall most is taken.
bool LoadedRod::newton_step(double radius, std::span<double> step, Descent& descent) {
  for (std::size_t i = 0; i < holds.size(); ++i) assumed_[i] = !holds[i].by_tension && tensions_[i] > 0;
  if (!step_with_assumed(radius, step, descent)) return false;
  const double plain = -0.5 * dot(work_.gradient, step) + 0.5 * descent.shift * dot(step, step);
  descent.predicted = foreseen(step, descent);
  descent.factored = true;
  if (then_ == assumed_) return true;
  const Descent first = descent;
  std::ranges::copy(step, first_.begin());
  std::ranges::copy(step, best_.begin());
  assumes_ = true;
  for (int round = 0; round < most_guesses && then_ != assumed_ && left_ > 0; ++round) {
    assumed_ = then_;
    Descent other;
    if (!step_with_assumed(radius, step, other)) break;
    other.predicted = foreseen(step, other);
    descent.factored = false;
    if (!(other.predicted > descent.predicted)) continue;
    other.negative = first.negative;
    descent = other;
    std::ranges::copy(step, best_.begin());
  }
  assumes_ = false;
  std::ranges::copy(best_, step.begin());
  if (descent.predicted > 0) return true;
  descent = first;  // made shorter, a step is no longer what the model's equation says
  descent.predicted = plain;
  descent.factored = false;
  std::ranges::copy(first_, step.begin());
  return true;
}

bool LoadedRod::same_active() const {
  std::size_t next = 0;
  for (std::size_t i = 0; i < holds.size(); ++i) {
    if (holds[i].by_tension || tensions_[i] <= 0) continue;
    if (next == active_.size() || active_[next] != static_cast<int>(i)) return false;
    ++next;
  }
  return next == active_.size();
}

/// Downhill from a saddle along its lowest direction, as far as it pays: to either side, since tendons may
/// become taut on one.
bool LoadedRod::leave_saddle(Relaxed& result, double& energy) {
  std::vector<double> direction(at(model_->size));
  lowest(direction);
  if (!is_one_sided_ && dot(direction, work_.gradient) > 0)  // what is left of the gradient shall help
    for (double& x : direction) x = -x;
  std::copy(work_.y.begin(), work_.y.end(), trial_.begin());
  const double from = energy;
  for (double length = saddle_step * std::sqrt(model_->energy_scale); length > 1e-12; length *= 0.5)
    for (const double way : {length, -length}) {
      for (std::size_t i = 0; i < trial_.size(); ++i) work_.y[i] = trial_[i] + way * direction[i];
      energy = evaluate();
      ++result.evaluations;
      if (energy < from) return true;
    }
  std::copy(trial_.begin(), trial_.end(), work_.y.begin());
  energy = evaluate();
  linearise(true);
  factor_all(0);
  return false;
}

/// Where the gradient is as small as asked: whether the search ends here. Else a saddle was left.
bool LoadedRod::ends_at_rest(const RelaxOptions& options, EnergySearch& search) {
  if (search.kept) return true;
  search.result.negative = factor_all(0);
  if (search.result.negative == 0) return true;
  std::vector<double> direction(at(model_->size));
  if (lowest(direction) > -neutral) {  // it may turn freely
    search.result.negative = 0;
    return true;
  }
  if (!options.leave_saddles || !leave_saddle(search.result, search.energy)) {
    search.result.status = Status::unstable;
    return true;
  }
  search.swept = false;
  return false;
}

/// Whether the factor that was kept is worth another step: the gradient fell by it, and so is soon small
/// enough.
bool LoadedRod::is_worth_keeping(const RelaxOptions& options, const EnergySearch& search) {
  const double residual = search.result.residual, reduced = residual / search.before,
               rate = std::max(reduced, 1e-12);
  if (reduced >= 0.3) leans_ = false;
  return same_active() && reduced < 0.3 &&
         (residual * rate <= options.tolerance || residual * rate * rate <= options.tolerance);
}

/// Newton's step by the factor that was kept.
void LoadedRod::step_by_kept_factor(EnergySearch& search) {
  for (int i = 0; i < model_->size; ++i) sides_[at(i * stride_)] = -work_.gradient[at(i)];
  solve_all(sides_, 1, stride_);
  for (int i = 0; i < model_->size; ++i) work_.y[at(i)] += sides_[at(i * stride_)];
  search.energy = evaluate();
  ++search.result.evaluations;
}

/// Whether a step is accepted: by what the energy fell, or where rounding rules that by the gradient.
/// @param next the energy after it [J]
/// @param ratio of what the energy fell by to what it was to fall by
LoadedRod::StepEnd LoadedRod::check_step(const RelaxOptions& options, const Descent& descent, double next,
                                         EnergySearch& search, double& ratio) {
  ratio = 1;
  if (!(descent.predicted <= 1e-12 * (std::abs(search.energy) + model_->energy_scale))) {
    ratio = (search.energy - next) / descent.predicted;
    return ratio > 1e-4 ? StepEnd::accepted : StepEnd::refused;
  }
  linearise(false);
  const double before = search.before, after = gradient_norm();
  if (after < before * (1 - 1e-4) || after <= options.tolerance) return StepEnd::accepted;
  // Where tendons are stiff a step along them turns the gradient before the next one takes it away.
  const bool is_newton = descent.shift == 0 && descent.negative == 0;
  if (is_newton && after < 1e2 * before && search.forgiven < 3) {
    ++search.forgiven;
    return StepEnd::accepted;
  }
  if (before < 1e3 * options.tolerance) return StepEnd::as_near_as_rounding_lets;
  ratio = 0;
  return StepEnd::refused;
}

/// Where no step is short enough. Down a saddle by so little that rounding hides it, or held back by what
/// becomes taut on one side? Then the search goes on from there, once.
bool LoadedRod::leaves_where_stuck(const RelaxOptions& options, const Descent& descent,
                                   EnergySearch& search) {
  if (descent.negative > 0 && options.leave_saddles && !search.left_saddle &&
      leave_saddle(search.result, search.energy)) {
    search.left_saddle = true;
    search.radius = std::numbers::pi * std::sqrt(model_->energy_scale);
    search.swept = false;
    return true;
  }
  search.result.status = Status::stalled;
  return false;
}

/// A step in the trust region, and its radius for the next one. False where the search ends.
bool LoadedRod::try_step(const RelaxOptions& options, EnergySearch& search) {
  const double scale = std::sqrt(model_->energy_scale), most = 1e3 * scale;
  Relaxed& result = search.result;
  Descent descent;
  if (!newton_step(search.radius, step_, descent)) {
    result.status = Status::stalled;
    return false;
  }
  const double length = norm(step_);
  std::copy(work_.y.begin(), work_.y.end(), trial_.begin());
  for (std::size_t i = 0; i < trial_.size(); ++i) work_.y[i] = trial_[i] + step_[i];
  const double next = evaluate();
  ++result.evaluations;
  double ratio = 1;
  const StepEnd end = check_step(options, descent, next, search, ratio);
  if (end == StepEnd::as_near_as_rounding_lets) {
    search.energy = restore();
    result.negative = std::max(0, factor_all(0));
    result.status = result.negative == 0 ? Status::converged : Status::unstable;
    return false;
  }
  if (ratio < 0.25)
    search.radius = 0.25 * std::min(length, search.radius);
  else if (ratio > 0.75 && length > 0.8 * search.radius)
    search.radius = std::min(most, 2.5 * search.radius);
  if (end == StepEnd::accepted) {
    search.swept = false;
    search.energy = next;
    search.kept = descent.factored && descent.shift == 0 && descent.negative == 0 && length < 0.1 * scale &&
                  same_active();
    return true;
  }
  search.energy = restore();
  search.swept = true;
  return !(search.radius < 1e-14 * scale) || leaves_where_stuck(options, descent, search);
}

Relaxed LoadedRod::relax_energy(const RelaxOptions& options) {
  leaves_ = options.leave_saddles;
  EnergySearch search;
  search.radius = std::numbers::pi * std::sqrt(model_->energy_scale);
  search.energy = evaluate();
  Relaxed& result = search.result;
  ++result.evaluations;
  for (;; ++result.iterations) {
    if (search.kept || !search.swept) linearise(!search.kept);
    search.swept = !search.kept;
    result.residual = gradient_norm();
    if (!std::isfinite(search.energy)) result.residual = std::numeric_limits<double>::quiet_NaN();
    if (result.residual <= options.tolerance) {
      if (ends_at_rest(options, search)) return result;
      continue;
    }
    if (must_end(result, options, left_ <= 0)) return result;
    if (search.kept) {
      search.kept = is_worth_keeping(options, search);
      if (!search.kept) linearise(true);
      search.swept = !search.kept;
    }
    search.before = result.residual;
    if (search.kept)
      step_by_kept_factor(search);
    else if (!try_step(options, search))
      return result;
  }
}

/// Back to where the last step began.
double LoadedRod::restore() {
  std::copy(trial_.begin(), trial_.end(), work_.y.begin());
  const double energy = evaluate();
  linearise(true);
  return energy;
}

/// Implicit steps of ẏ = −gradient, ever longer as the gradient falls, so that the last ones are Newton's:
/// they end where this motion does, at equilibria that hold.
Relaxed LoadedRod::relax_residual(const RelaxOptions& options, double shift) {
  Relaxed result;
  const double scale = std::sqrt(model_->energy_scale);
  evaluate();
  ++result.evaluations;
  linearise(true);
  result.residual = gradient_norm();
  for (;; ++result.iterations) {
    if (result.residual <= options.tolerance) return result;
    if (must_end(result, options, left_ <= 0)) return result;
    const double before = result.residual;
    std::copy(work_.y.begin(), work_.y.end(), trial_.begin());
    bool accept = false;
    for (int tries = 0; tries < 20 && !accept; ++tries) {
      double length = 0;
      if (factor_all(shift) != -1) {
        for (int i = 0; i < model_->size; ++i) sides_[at(i * stride_)] = -work_.gradient[at(i)];
        solve_all(sides_, 1, stride_);
        for (int i = 0; i < model_->size; ++i) step_[at(i)] = sides_[at(i * stride_)];
        length = norm(step_);
      }
      if (length == 0 || length > scale) {
        shift = std::max(4 * shift, 0.01);
        continue;
      }
      for (std::size_t i = 0; i < trial_.size(); ++i) work_.y[i] = trial_[i] + step_[i];
      evaluate();
      ++result.evaluations;
      linearise(false);
      result.residual = gradient_norm();
      accept = result.residual < 3 * before;
      if (!accept) {  // the Hessian's terms are still those of where it was
        std::copy(trial_.begin(), trial_.end(), work_.y.begin());
        evaluate();
        linearise(false);
        shift = std::max(4 * shift, 0.01);
      }
    }
    const bool by_rounding = before < 1e3 * options.tolerance && result.residual > 0.3 * before;
    if (!accept) {
      result.residual = before;
      if (!by_rounding) result.status = Status::stalled;
      return result;
    }
    if (by_rounding) return result;
    if (result.residual > options.tolerance) linearise(true);
    shift *= std::clamp(result.residual / before, 0.1, 2.0);
    if (shift < 1e-4) shift = 0;
  }
}

/// Where loads have no potential, of an equilibrium that is not judged to hold: pushed a little to where the
/// energy's part falls, does it come back? If not, where it comes to rest takes its place.
bool LoadedRod::comes_back(const RelaxOptions& options, Relaxed& result) {
  const std::vector<double> here = work_.y;
  std::vector<double> direction(at(model_->size));
  make_symmetric(*model_, work_);
  lowest(direction);
  work_.symmetric = false;
  const double scale = std::sqrt(model_->energy_scale);
  for (std::size_t i = 0; i < here.size(); ++i) work_.y[i] += 0.03 * scale * direction[i];
  const int iterations = result.iterations;
  result = relax_residual(options, 1);
  result.iterations += iterations;
  if (result.status != Status::converged) return false;
  const bool is_back = farthest(work_.y, here) < 1e-6 * scale;
  check_stability(result);
  if (is_back) result.negative = 0;
  return is_back;
}

/// An equilibrium that holds, where loads have no potential.
Relaxed LoadedRod::relax_without_potential(const RelaxOptions& options) {
  RelaxOptions quick = options;
  quick.max_iterations = std::min(options.max_iterations, 8);
  const std::vector<double> start = work_.y;
  Relaxed result = relax_residual(quick, 0);
  if (result.status == Status::stopped) return result;
  if (result.status == Status::converged) {
    if (check_stability(result)) return result;
    // As along a path, whose places are known to hold.
    const bool is_near = farthest(work_.y, start) < 0.1 * std::sqrt(model_->energy_scale);
    if (is_near && comes_back(options, result)) return result;
  }
  const int before = result.iterations;
  work_.y = start;
  result = relax_residual(options, 1);
  for (int round = 0; round < 4 && result.status == Status::converged; ++round) {
    if (check_stability(result) || comes_back(options, result)) break;
    if (result.status == Status::converged && result.negative == 0 && round == 3)
      result.status = Status::unstable;
  }
  result.iterations += before;
  return result;
}

/// Where loads have no potential: an equilibrium holds if the Hessian's symmetric part is positive definite;
/// else the determinant's sign must be that of the unloaded rod.
bool LoadedRod::check_stability(Relaxed& result) {
  linearise(true);
  const int sign = factor_all(0);
  make_symmetric(*model_, work_);
  const int negative = factor_all(0);
  work_.symmetric = false;
  result.negative = negative == 0 ? 0 : sign;
  return negative == 0;
}

}  // namespace sinew::inline v1::strain
