#include "strain/relax.hpp"

#include "base/at.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sinew::inline v1::strain {
namespace {

double norm(std::span<const double> x) {
  double sum = 0;
  for (double v : x) sum += v * v;
  return std::sqrt(sum);
}
double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}
/// Eigenvalues down to this count as 0: a round rod that has buckled turns freely.
constexpr double neutral = 1e-9;

}  // namespace

RodWork::RodWork(const RodModel& model)
    : y(at(model.size), 0.0),
      gradient(at(model.size), 0.0),
      frames(at(model.nodes())),
      steps(model.elements.size()),
      omega(model.elements.size()),
      strains(model.elements.size()),
      loads(at(model.nodes())),
      hole_tension(model.holes.size(), 0.0),
      guide_tension(model.guides.size(), 0.0),
      lengths(at(model.tendons), 0.0),
      length_gradient(at(model.tendons) * at(model.size), 0.0),
      pieces(model.pieces.size()) {
  frames[0] = {{0, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  std::size_t most = 0;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const Piece& piece = model.pieces[k];
    const std::size_t square = at(piece.size * piece.padded), rows = at(6 * piece.padded);
    pieces[k].H.resize(square);
    pieces[k].factor.resize(square);
    for (auto* rows_of : {&pieces[k].R, &pieces[k].L, &pieces[k].G}) rows_of->resize(rows);
    pieces[k].fed.resize(2 * rows);
    pieces[k].pivots.resize(at(piece.size));
    most = std::max(most, square);
  }
  scratch.resize(most);
}

LoadedRod::LoadedRod(const RodModel& model)
    : holds(at(model.tendons)),
      model_(&model),
      work_(model),
      tensions_(at(model.tendons), 0.0),
      offsets_(at(model.tendons), 0.0),
      stiff_(at(model.tendons), 0.0),
      stride_((model.tendons + 1 + row - 1) / row * row) {
  columns_.resize(at(model.size * stride_));
  sides_.resize(at(model.size * stride_));
  small_.resize(at(model.tendons * model.tendons));
  trial_.resize(at(model.size));
  step_.resize(at(model.size));
}

double LoadedRod::slack(std::size_t i) const {
  return holds[i].by_tension ? 0 : std::max(0.0, holds[i].free_length - work_.lengths[i]);
}

void LoadedRod::spread_tensions() {
  for (std::size_t i = 0; i < model_->holes.size(); ++i)
    work_.hole_tension[i] = tensions_[at(model_->holes[i].tendon)];
  for (std::size_t i = 0; i < model_->guides.size(); ++i)
    work_.guide_tension[i] = tensions_[at(model_->guides[i].tendon)];
}

double LoadedRod::give(std::size_t i) const {
  if (!(holds[i].toe > 0)) return stiff_[i];
  const double low = holds[i].toe / (2 * stiff_[i]);  // the tension at which it becomes linear
  return tensions_[i] >= low ? stiff_[i] : stiff_[i] * std::sqrt(low / tensions_[i]);
}

double LoadedRod::evaluate() {
  sweep_out(*model_, work_);
  double energy = work_.energy;
  for (std::size_t i = 0; i < holds.size(); ++i) {
    const TendonHold& hold = holds[i];
    if (hold.by_tension) {
      tensions_[i] = hold.tension;
      energy += hold.tension * work_.lengths[i];
    } else {
      const double stretch = std::max(0.0, work_.lengths[i] - hold.free_length + offsets_[i]);
      if (stretch < hold.toe) {
        tensions_[i] = stretch * stretch / (2 * hold.toe * stiff_[i]);
        energy += tensions_[i] * stretch / 3;
      } else {
        const double beyond = stretch - 0.5 * hold.toe;
        tensions_[i] = beyond / stiff_[i];
        energy += 0.5 * beyond * tensions_[i] + hold.toe * hold.toe / (24 * stiff_[i]);
      }
    }
  }
  spread_tensions();
  potential_energy_ = energy;
  return energy;
}

void LoadedRod::linearise(bool hessian) {
  if (hessian && !leans_)
    sweep_back_with_hessian(*model_, work_);
  else
    sweep_back(*model_, work_);
  if (hessian && leans_) take_hessian_of_lean();
}

double LoadedRod::gradient_norm() const { return norm(work_.gradient) / std::sqrt(model_->energy_scale); }

int LoadedRod::factor_all(double shift) {
  factors_ = leans_ ? lean_ : this;
  const int found = factor_with_tendons(shift);
  if (found == 0 || !leans_) return found;
  leans_ = false;  // whether the rod holds is for its own Hessian to say
  linearise(true);
  factors_ = this;
  return factor_with_tendons(shift);
}

int LoadedRod::factor_with_tendons(double shift) {
  const Inertia inertia = factor(*factors_->model_, factors_->work_, shift);
  if (!inertia.ok) return -1;
  active_.clear();
  for (std::size_t i = 0; i < holds.size(); ++i)
    if (!holds[i].by_tension && tensions_[i] > 0) active_.push_back(static_cast<int>(i));
  if (active_.empty()) return inertia.negative;
  const int n = model_->size, m = static_cast<int>(active_.size());
  for (double& x : columns_) x = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j)
      columns_[at(i * stride_ + j)] = work_.length_gradient[at(active_[at(j)] * n + i)];
  solve(*factors_->model_, factors_->work_, columns_.data(), m, stride_);
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) {
      double sum = i == j ? give(at(active_[at(i)])) : 0;
      const double* gradient = work_.length_gradient.data() + active_[at(i)] * n;
      for (int k = 0; k < n; ++k) sum += gradient[k] * columns_[at(k * stride_ + j)];
      small_[at(i * m + j)] = sum;
    }
  int negative = 0;
  for (int k = 0; k < m; ++k) {  // LDLᵀ
    const double d = small_[at(k * m + k)];
    if (!(std::abs(d) > 1e-300)) return -1;
    if (d < 0) ++negative;
    for (int i = k + 1; i < m; ++i) {
      const double l = small_[at(i * m + k)] / d;
      small_[at(i * m + k)] = l;
      for (int j = k + 1; j < m; ++j) small_[at(i * m + j)] -= l * small_[at(k * m + j)];
    }
  }
  return work_.symmetric ? inertia.negative - negative : (inertia.negative + negative) % 2;
}

int LoadedRod::factor_exactly() {
  std::vector<double> used = stiff_;
  for (std::size_t i = 0; i < holds.size(); ++i) stiff_[i] = holds[i].compliance;
  const int negative = factor_all(0);
  stiff_ = used;
  return negative;
}

/// With the factors of the small matrix.
void LoadedRod::solve_small(std::span<double> t) const {
  const int m = static_cast<int>(active_.size());
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < i; ++j) t[at(i)] -= small_[at(i * m + j)] * t[at(j)];
  for (int i = m; i-- > 0;) {
    for (int j = i + 1; j < m; ++j) t[at(i)] -= small_[at(i * m + j)] * t[at(j)];
    t[at(i)] /= small_[at(i * m + i)];
  }
}

void LoadedRod::solve_all(std::span<double> sides, int columns, int stride, double* pulls) {
  solve(*factors_->model_, factors_->work_, sides.data(), columns, stride);
  const int n = model_->size, m = static_cast<int>(active_.size());
  if (m == 0) return;
  std::array<double, 64> t{};
  for (int c = 0; c < columns; ++c) {
    for (int i = 0; i < m; ++i) {
      double sum = 0;
      const double* gradient = work_.length_gradient.data() + active_[at(i)] * n;
      for (int k = 0; k < n; ++k) sum += gradient[k] * sides[at(k * stride + c)];
      t[at(i)] = sum;
    }
    solve_small(t);
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < m; ++j) sides[at(k * stride + c)] -= columns_[at(k * stride_ + j)] * t[at(j)];
    if (pulls != nullptr)
      for (int i = 0; i < m; ++i) pulls[i * stride + c] = t[at(i)];
  }
}

void LoadedRod::answer_to_feed(int k, std::span<double> step, std::span<double> pulls) const {
  const int m = static_cast<int>(active_.size());
  for (int i = 0; i < m; ++i) pulls[at(i)] = i == k ? 1 : 0;
  solve_small(pulls);
  for (int i = 0; i < model_->size; ++i) {
    double sum = 0;
    for (int j = 0; j < m; ++j) sum += columns_[at(i * stride_ + j)] * pulls[at(j)];
    step[at(i)] = sum;
  }
  for (int i = 0; i < m; ++i) pulls[at(i)] = -pulls[at(i)];
}

double LoadedRod::lowest(std::span<double> direction) {
  double shift = 0;
  for (int tries = 0; factor_all(shift) != 0 && tries < 60; ++tries) shift = shift == 0 ? 1e-3 : 2 * shift;
  std::vector<double> x(at(model_->size * row), 0.0);
  for (int i = 0; i < model_->size; ++i) direction[at(i)] = 1 + 0.37 * std::sin(1.0 + 2.3 * i);
  double value = 0;
  for (int round = 0; round < 30; ++round) {
    const double length = norm(direction);
    for (int i = 0; i < model_->size; ++i) x[at(i * row)] = direction[at(i)] / length;
    solve_all(x, 1, row);
    double along = 0;
    for (int i = 0; i < model_->size; ++i) {
      along += x[at(i * row)] * direction[at(i)] / length;
      direction[at(i)] = x[at(i * row)];
    }
    const double next = 1 / along - shift;
    if (round > 2 && std::abs(next - value) < 1e-9 * (std::abs(next) + shift + 1e-3)) {
      value = next;
      break;
    }
    value = next;
  }
  const double length = norm(direction);
  for (double& v : direction) v /= length;
  return value;
}

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

/// Downhill from a saddle along its lowest direction, as far as it pays.
bool LoadedRod::leave_saddle(Relaxed& result, double& energy) {
  std::vector<double> direction(at(model_->size));
  lowest(direction);
  std::copy(work_.y.begin(), work_.y.end(), trial_.begin());
  const double from = energy;
  for (double length = 0.3 * std::sqrt(model_->energy_scale); length > 1e-12; length *= 0.5) {
    for (std::size_t i = 0; i < trial_.size(); ++i) work_.y[i] = trial_[i] + length * direction[i];
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
  bool kept = false;   // a factor of a Hessian near by, positive definite
  bool swept = false;  // the Hessian at hand is of this iterate
  for (;; ++result.iterations) {
    if (!kept) {
      if (!swept) linearise(true);
      swept = true;
    } else {
      linearise(false);
      swept = false;
    }
    result.residual = gradient_norm();
    if (!std::isfinite(energy) || !std::isfinite(result.residual)) {
      result.status = Status::left_domain;
      return result;
    }
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
    if (result.iterations >= options.max_iterations) {
      result.status = Status::iteration_limit;
      return result;
    }
    if (options.stop && options.stop()) {
      result.status = Status::stopped;
      return result;
    }
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
    if (!std::isfinite(result.residual)) {
      result.status = Status::left_domain;
      return result;
    }
    if (result.residual <= options.tolerance) return result;
    if (result.iterations >= options.max_iterations) {
      result.status = Status::iteration_limit;
      return result;
    }
    if (options.stop && options.stop()) {
      result.status = Status::stopped;
      return result;
    }
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

void make_symmetric(const RodModel& model, RodWork& work) {
  for (std::size_t k = 0; k < model.pieces.size(); ++k) {
    const Piece& piece = model.pieces[k];
    PieceTerms& terms = work.pieces[k];
    for (int i = 0; i < piece.size; ++i)
      for (int j = 0; j < i; ++j) {
        double &a = terms.H[at(i * piece.padded + j)], &b = terms.H[at(j * piece.padded + i)];
        a = b = 0.5 * (a + b);
      }
    for (std::size_t i = 0; i < terms.R.size(); ++i)
      terms.R[i] = terms.L[i] = 0.5 * (terms.R[i] + terms.L[i]);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < i; ++j)
        terms.P.a[i][j] = terms.P.a[j][i] = 0.5 * (terms.P.a[i][j] + terms.P.a[j][i]);
  }
  work.symmetric = true;
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

/// From here; tendons that do not stretch are let give way, and what they gave is taken back.
Relaxed LoadedRod::relax_here(const RelaxOptions& options) {
  Relaxed result;
  for (int round = 0; round < 30; ++round) {
    Relaxed one = potential_ ? relax_energy(options) : relax_without_potential(options);
    one.iterations += result.iterations;
    one.evaluations += result.evaluations;
    result = one;
    double off = 0;
    for (std::size_t i = 0; i < holds.size(); ++i) {
      if (holds[i].by_tension || holds[i].compliance > 0) continue;
      const double wanted = std::max(0.0, offsets_[i] + work_.lengths[i] - holds[i].free_length);
      off = std::max(off, std::abs(wanted - offsets_[i]));
      offsets_[i] = wanted;
    }
    if (off < 1e-12 || (result.status != Status::converged && result.status != Status::unstable)) break;
  }
  return result;
}

/// Loads and inputs grow from nothing, the rod follows.
Relaxed LoadedRod::grow(const RelaxOptions& options) {
  leans_ = false;  // that rod's loads do not grow
  const std::vector<TendonHold> targets = holds;
  const std::vector<NodeLoad> loads = work_.loads;
  for (double& y : work_.y) y = 0;
  for (std::size_t i = 0; i < holds.size(); ++i) offsets_[i] = 0;
  sweep_out(*model_, work_);
  const std::vector<double> free = work_.lengths;
  Relaxed result;
  double done = 0, step = 0.2;
  RelaxOptions each = options;
  each.max_iterations = std::min(options.max_iterations, 40);
  std::vector<double> y = work_.y, offsets = offsets_;
  while (done < 1) {
    const double share = std::min(1.0, done + step);
    for (std::size_t i = 0; i < holds.size(); ++i) {
      holds[i].tension = share * targets[i].tension;
      holds[i].free_length = free[i] + share * (targets[i].free_length - free[i]);
    }
    for (std::size_t k = 0; k < loads.size(); ++k) {
      NodeLoad& load = work_.loads[k];
      for (int i = 0; i < 3; ++i) load.force[i] = share * loads[k].force[i];
      for (int i = 0; i < 9; ++i) load.couple[i] = share * loads[k].couple[i];
      for (int i = 0; i < 3; ++i) load.moment[i] = share * loads[k].moment[i];
      for (int i = 0; i < 6; ++i) load.following[i] = share * loads[k].following[i];
    }
    const Relaxed one = relax_here(each);
    result.iterations += one.iterations;
    result.evaluations += one.evaluations;
    result.residual = one.residual;
    result.status = one.status;
    result.negative = one.negative;
    if (one.status == Status::stopped) break;
    if (one.status == Status::converged) {
      done = share;
      step *= one.iterations < 8 ? 2 : 1;
      y = work_.y;
      offsets = offsets_;
    } else {
      work_.y = y;
      offsets_ = offsets;
      step *= 0.35;
      if (step < 1e-3 || result.iterations > 20 * options.max_iterations) break;
    }
  }
  result.reached = done;
  holds = targets;
  work_.loads = loads;
  if (done < 1) {
    evaluate();
    linearise(true);
    result.residual = gradient_norm();
    if (result.status != Status::stopped) result.status = Status::stalled;
  }
  return result;
}

Relaxed LoadedRod::relax(const RelaxOptions& options) {
  // Only tendons that pull by their stretch need the gradients of their lengths.
  work_.finds_length_gradients =
      std::ranges::any_of(holds, [](const TendonHold& hold) { return !hold.by_tension; });
  const Relaxed result = relax_from_here(options);
  work_.finds_length_gradients = true;
  leans_ = false;
  return result;
}

void LoadedRod::take_holds() {
  for (std::size_t i = 0; i < holds.size(); ++i) {
    offsets_[i] = 0;
    stiff_[i] = holds[i].compliance > 0 ? holds[i].compliance : 1e-6;
  }
}

Relaxed LoadedRod::relax_from_here(const RelaxOptions& options) {
  take_holds();
  potential_ = true;
  for (const NodeLoad& load : work_.loads) {
    for (double x : load.moment) potential_ = potential_ && x == 0;
    for (double x : load.following) potential_ = potential_ && x == 0;
  }
  work_.symmetric = potential_;
  leans_ = lean_ != nullptr && potential_;
  factors_ = nullptr;
  RelaxOptions direct = options;
  direct.max_iterations = std::min(options.max_iterations, 60);
  Relaxed result = relax_here(direct);
  const bool ended = result.status == Status::converged || result.status == Status::stopped ||
                     result.status == Status::left_domain;
  if (ended || options.max_iterations <= direct.max_iterations) return result;
  const int spent = result.iterations;
  result = grow(options);
  result.iterations += spent;
  return result;
}

}  // namespace sinew::inline v1::strain
