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

}  // namespace

/// A step of at most `radius`; `shift` starts at what the last one needed.
bool LoadedRod::newton_step(double& shift, double radius, std::span<double> step, int& negative) {
  double low = 0, high = 0;
  shift = 0;
  for (int tries = 0; tries < 40; ++tries) {
    const int found = factor_all(shift);
    if (tries == 0) negative = found;
    if (found != 0) {  // not positive definite
      low = shift;
      shift = high > 0 ? std::sqrt(std::max(low, 1e-9 * high) * high) : std::max(1e-3, 4 * shift);
      continue;
    }
    for (int i = 0; i < model_->size; ++i) sides_[at(i * stride_)] = -work_.gradient[at(i)];
    solve_all(sides_, 1, stride_);
    for (int i = 0; i < model_->size; ++i) step[at(i)] = sides_[at(i * stride_)];
    const double length = norm(step);
    if (length <= 1.1 * radius) return true;
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
  for (double length = 0.3 * std::sqrt(model_->energy_scale); length > 1e-12; length *= 0.5)
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

Relaxed LoadedRod::relax_energy(const RelaxOptions& options) {
  Relaxed result;
  const double scale = std::sqrt(model_->energy_scale), most = 1e3 * scale;
  double radius = std::numbers::pi * scale, energy = evaluate(), shift = 0, before = 0, rate = 1;
  ++result.evaluations;
  bool kept = false;         // a factor of a Hessian near by, positive definite
  bool swept = false;        // the Hessian at hand is of this iterate
  bool left_saddle = false;  // where no step was short enough
  for (;; ++result.iterations) {
    if (!kept) {
      if (!swept) linearise(true);
      swept = true;
    } else {
      linearise(false);
      swept = false;
    }
    result.residual = gradient_norm();
    if (!std::isfinite(energy)) result.residual = std::numeric_limits<double>::quiet_NaN();
    if (result.residual <= options.tolerance) {
      if (kept) return result;
      result.negative = factor_all(0);
      if (result.negative == 0) return result;
      std::vector<double> direction(at(model_->size));
      if (lowest(direction) > -neutral) {  // it may turn freely
        result.negative = 0;
        return result;
      }
      if (!options.leave_saddles || !leave_saddle(result, energy)) {
        result.status = Status::unstable;
        return result;
      }
      swept = false;
      continue;
    }
    if (must_end(result, options, left_ <= 0)) return result;
    if (kept) {  // worth another step of the same factor, or a new one
      const double reduced = result.residual / before;
      rate = std::max(reduced, 1e-12);
      kept =
          same_active() && reduced < 0.3 &&
          (result.residual * rate <= options.tolerance || result.residual * rate * rate <= options.tolerance);
      if (reduced >= 0.3) leans_ = false;
      if (!kept) linearise(true);
      swept = !kept;
    }
    before = result.residual;
    if (kept) {
      for (int i = 0; i < model_->size; ++i) sides_[at(i * stride_)] = -work_.gradient[at(i)];
      solve_all(sides_, 1, stride_);
      for (int i = 0; i < model_->size; ++i) work_.y[at(i)] += sides_[at(i * stride_)];
      energy = evaluate();
      ++result.evaluations;
      continue;
    }
    int negative = 0;
    if (!newton_step(shift, radius, step_, negative)) {
      result.status = Status::stalled;
      return result;
    }
    const double length = norm(step_),
                 predicted = -0.5 * dot(work_.gradient, step_) + 0.5 * shift * length * length;
    std::copy(work_.y.begin(), work_.y.end(), trial_.begin());
    for (std::size_t i = 0; i < trial_.size(); ++i) work_.y[i] = trial_[i] + step_[i];
    const double next = evaluate();
    ++result.evaluations;
    bool accept = false;
    double ratio = 1;
    if (predicted <= 1e-12 * (std::abs(energy) + model_->energy_scale)) {  // rounding rules the difference
      linearise(false);
      const double after = gradient_norm();
      accept = after < before * (1 - 1e-4) || after <= options.tolerance;
      if (!accept && before < 1e3 * options.tolerance) {  // as near as rounding lets it
        energy = restore();
        result.negative = std::max(0, factor_all(0));
        result.status = result.negative == 0 ? Status::converged : Status::unstable;
        return result;
      }
      if (!accept) ratio = 0;
    } else {
      ratio = (energy - next) / predicted;
      accept = ratio > 1e-4;
    }
    if (ratio < 0.25)
      radius = 0.25 * std::min(length, radius);
    else if (ratio > 0.75 && length > 0.8 * radius)
      radius = std::min(most, 2.5 * radius);
    swept = false;
    if (accept) {
      energy = next;
      kept = shift == 0 && negative == 0 && length < 0.1 * scale && same_active();
    } else {
      energy = restore();
      swept = true;
      if (radius < 1e-14 * scale) {
        // Down a saddle by so little that rounding hides it, or held back by what becomes taut on one side?
        if (negative > 0 && options.leave_saddles && !left_saddle && leave_saddle(result, energy)) {
          left_saddle = true;
          radius = std::numbers::pi * scale;
          swept = false;
          continue;
        }
        result.status = Status::stalled;
        return result;
      }
    }
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
      linearise(true);
      result.residual = gradient_norm();
      accept = result.residual < 3 * before;
      if (!accept) {
        restore();
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
    shift *= std::clamp(result.residual / before, 0.1, 2.0);
    if (shift < 1e-4) shift = 0;
  }
}

/// An equilibrium that holds, where loads have no potential.
Relaxed LoadedRod::relax_without_potential(const RelaxOptions& options) {
  RelaxOptions quick = options;
  quick.max_iterations = std::min(options.max_iterations, 8);
  const std::vector<double> start = work_.y;
  Relaxed result = relax_residual(quick, 0);
  if (result.status == Status::stopped || (result.status == Status::converged && judge(result)))
    return result;
  int iterations = result.iterations;
  work_.y = start;
  result = relax_residual(options, 1);
  for (int round = 0; round < 4 && result.status == Status::converged; ++round) {
    iterations += result.iterations;
    if (judge(result)) break;
    // Pushed a little to where the energy's part falls, does it come back?
    const std::vector<double> here = work_.y;
    std::vector<double> direction(at(model_->size));
    make_symmetric(*model_, work_);
    lowest(direction);
    work_.symmetric = false;
    const double scale = std::sqrt(model_->energy_scale);
    for (std::size_t i = 0; i < here.size(); ++i) work_.y[i] += 0.03 * scale * direction[i];
    result = relax_residual(options, 1);
    double moved = 0;
    for (std::size_t i = 0; i < here.size(); ++i) moved = std::max(moved, std::abs(work_.y[i] - here[i]));
    if (result.status == Status::converged) {
      judge(result);
      if (moved < 1e-6 * scale) {
        result.negative = 0;
        break;
      }
      if (result.negative == 0 && round == 3) result.status = Status::unstable;
    }
  }
  result.iterations = iterations;
  return result;
}

/// Where loads have no potential: an equilibrium holds if the Hessian's symmetric part is positive definite;
/// else the determinant's sign must be that of the unloaded rod.
bool LoadedRod::judge(Relaxed& result) {
  linearise(true);
  const int sign = factor_all(0);
  make_symmetric(*model_, work_);
  const int negative = factor_all(0);
  work_.symmetric = false;
  result.negative = negative == 0 ? 0 : sign;
  return negative == 0;
}

}  // namespace sinew::inline v1::strain
