#include "strain/relax.hpp"

#include "base/at.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
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
/// What tendons that are held by their ends are softened by, as shares of what the straight rod gives way to
/// them: where the search begins near the answer, where it begins anywhere, and at the least.
constexpr double little = 1e-3, much = 0.3, least = 1e-6;

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
      soft_(at(model.tendons), 0.0),
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

double LoadedRod::lacks(std::size_t i) const {
  return holds[i].by_tension
             ? 0
             : work_.lengths[i] - holds[i].free_length - std::max(0.0, holds[i].compliance) * tensions_[i];
}

void LoadedRod::spread_tensions() {
  for (std::size_t i = 0; i < model_->holes.size(); ++i)
    work_.hole_tension[i] = tensions_[at(model_->holes[i].tendon)];
  for (std::size_t i = 0; i < model_->guides.size(); ++i)
    work_.guide_tension[i] = tensions_[at(model_->guides[i].tendon)];
}

double LoadedRod::give(std::size_t i) const {
  if (!searches_) return holds[i].toe > 0 ? slope_of_toe(i) : std::max(0.0, holds[i].compliance);
  if (!(holds[i].toe > 0)) return stiff_[i];
  return slope_of_toe(i);
}

double LoadedRod::slope_of_toe(std::size_t i) const {
  const double low = holds[i].toe / (2 * stiff_[i]);  // the tension at which it becomes linear
  return tensions_[i] >= low ? stiff_[i] : stiff_[i] * std::sqrt(low / tensions_[i]);
}

double LoadedRod::evaluate() {
  sweep_out(*model_, work_);
  double energy = work_.energy, artificial = 0;
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
        artificial += 0.5 * soft_[i] * tensions_[i] * tensions_[i];
        energy += 0.5 * beyond * tensions_[i] + hold.toe * hold.toe / (24 * stiff_[i]);
      }
    }
  }
  spread_tensions();
  potential_energy_ = energy - artificial;
  return energy;
}

void LoadedRod::linearise(bool hessian) {
  left_ -= hessian ? 1 : 0;
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
  --left_;
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

/// The elastic energy's second variation at rest times a vector: near the identity, but for taper and for
/// what the quadrature makes of polynomials.
void LoadedRod::elastic(std::span<const double> x, std::span<double> y) const {
  std::ranges::fill(y, 0.0);
  for (const Piece& piece : model_->pieces) {
    const Span& last = model_->spans[at(piece.first_span + piece.spans - 1)];
    for (int e = model_->spans[at(piece.first_span)].first_element; e < last.first_element + last.elements;
         ++e) {
      const Element& element = model_->elements[at(e)];
      for (std::size_t g = 0; g < at(element.points); ++g)
        for (std::size_t c = 0; c < 6; ++c) {
          const std::size_t first = at(piece.first + piece.offset[c]);
          double strain = 0;
          for (std::size_t a = 0; a < at(piece.modes[c]); ++a) strain += element.modes[g][a] * x[first + a];
          strain *= element.weight * element.stiffness[g][c] * piece.scale[c] * piece.scale[c];
          for (std::size_t a = 0; a < at(piece.modes[c]); ++a) y[first + a] += element.modes[g][a] * strain;
        }
    }
  }
}

double LoadedRod::lowest(std::span<double> direction) {
  double shift = 0;
  for (int tries = 0; factor_all(shift) != 0 && tries < 60; ++tries) shift = shift == 0 ? 1e-3 : 2 * shift;
  const std::size_t n = at(model_->size);
  std::vector<double> x(n * row, 0.0), weighted(n);
  for (std::size_t i = 0; i < n; ++i) direction[i] = 1 + 0.37 * std::sin(1.0 + 2.3 * static_cast<double>(i));
  double value = 0;
  for (int round = 0; round < 30; ++round) {
    elastic(direction, weighted);
    const double size = dot(direction, weighted);  // in elastic energy; 1 from the second round on
    // With a shift it is the Hessian's lowest direction, else that of its ratio to the elastic energy.
    const std::span<const double> side = shift > 0 ? direction : std::span<double>(weighted);
    for (std::size_t i = 0; i < n; ++i) x[i * row] = side[i];
    solve_all(x, 1, row);
    double along = 0;
    for (std::size_t i = 0; i < n; ++i) along += x[i * row] * side[i];
    const double before = shift > 0 ? dot(direction, direction) : size, next = before / along - shift;
    for (std::size_t i = 0; i < n; ++i) direction[i] = x[i * row];
    elastic(direction, weighted);
    const double length = std::sqrt(dot(direction, weighted));
    for (double& v : direction) v /= length;
    const bool ends = round > 2 && std::abs(next - value) < 1e-9 * (std::abs(next) + shift + 1e-3);
    value = next;
    if (ends) break;
  }
  if (shift > 0) value *= dot(direction, direction);  // of the same direction, over its elastic energy
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
  if (dot(direction, work_.gradient) > 0)  // what is left of the gradient shall help
    for (double& x : direction) x = -x;
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
    if (result.iterations >= options.max_iterations || left_ <= 0) {
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
    if (result.iterations >= options.max_iterations || left_ <= 0) {
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

/// Tendons held by their ends give way by this share of `yields_`, where that is more than their own
/// compliance; at `expected` tensions they are as long as they truly are.
void LoadedRod::soften(double share, std::span<const double> expected) {
  for (std::size_t i = 0; i < holds.size(); ++i) {
    const TendonHold& hold = holds[i];
    soft_[i] = offsets_[i] = 0;
    if (hold.by_tension) continue;
    if (hold.compliance > 0)
      soft_[i] = hold.toe > 0 ? 0 : std::max(0.0, share * yields_[i] - hold.compliance);
    else
      soft_[i] = std::max(share, least) * yields_[i];
    stiff_[i] = std::max(0.0, hold.compliance) + soft_[i];
    offsets_[i] = soft_[i] * expected[i];
  }
}

/// From here with softened tendons; what that gave is taken back and tendons become stiffer, until they give
/// way by their own compliance alone (the method of multipliers).
/// @param expected their tensions, to begin with
Relaxed LoadedRod::tighten(const RelaxOptions& options, double share, std::vector<double> expected) {
  Relaxed result;
  double before =
      std::numeric_limits<double>::infinity();  // what was taken back last, over a radian's length
  double failed = 0;                            // a share that was too little to go on with
  int failures = 0, hopeless = 0;
  std::vector<double> y = work_.y;
  soften(share, expected);
  for (int round = 0; round < 60; ++round) {
    RelaxOptions each = options;
    if (std::ranges::any_of(soft_, [](double x) { return x > 0; }))  // else this is the last round
      each.tolerance = std::max(options.tolerance, std::min(1e-3, 0.01 * before));
    Relaxed one = potential_ ? relax_energy(each) : relax_without_potential(each);
    one.iterations += result.iterations;
    one.evaluations += result.evaluations;
    result = one;
    if (one.status == Status::stopped || one.status == Status::left_domain || left_ <= 0) break;
    if (one.status != Status::converged) {
      if (round == 0 || ++failures > 6) break;
      failed = share;
      share *= std::sqrt(10.0);
      work_.y = y;
      soften(share, expected);
      continue;
    }
    double off = 0;
    for (std::size_t i = 0; i < holds.size(); ++i) {
      if (!(soft_[i] > 0)) continue;
      off = std::max(off, std::abs(soft_[i] * tensions_[i] - offsets_[i]) /
                              std::sqrt(yields_[i] * model_->energy_scale));
      expected[i] = tensions_[i];
    }
    const bool is_small = off <= 1e-11 && (off <= 0.1 * options.tolerance || off > 0.3 * before);
    if ((off == 0 || is_small) && each.tolerance <= options.tolerance) return result;
    // Tensions grow and lengths do not change: no shape near by has tendons that short.
    hopeless = share <= least && off > 0.5 * before && off > 1e-7 ? hopeless + 1 : 0;
    if (hopeless == 3) {
      result.status = Status::unreachable;
      return result;
    }
    if ((share > little || off > 0.2 * before) && 0.1 * share > failed) share = std::max(least, 0.1 * share);
    before = off;
    y = work_.y;
    soften(share, expected);
  }
  if (result.status == Status::converged) result.status = Status::stalled;
  return result;
}

/// Loads and inputs grow from nothing, tendons softened, the rod follows; at the end they are tightened.
Relaxed LoadedRod::grow(const RelaxOptions& options, double softness) {
  leans_ = false;  // that rod's loads do not grow
  const std::vector<TendonHold> targets = holds;
  const std::vector<NodeLoad> loads = work_.loads;
  for (double& y : work_.y) y = 0;
  std::vector<double> expected(holds.size(), 0.0);
  soften(softness, expected);
  sweep_out(*model_, work_);
  const std::vector<double> free = work_.lengths;
  Relaxed result;
  double done = 0, step = 0.2;
  RelaxOptions each = options;
  each.max_iterations = std::min(options.max_iterations, 40);
  std::vector<double> y = work_.y;
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
    Relaxed one = potential_ ? relax_energy(each) : relax_without_potential(each);
    result.iterations += one.iterations;
    result.evaluations += one.evaluations;
    result.residual = one.residual;
    result.status = one.status;
    result.negative = one.negative;
    if (one.status == Status::stopped || left_ <= 0) break;
    if (one.status == Status::converged) {
      done = share;
      step *= one.iterations < 8 ? 2 : 1;
      y = work_.y;
    } else {
      work_.y = y;
      step *= 0.35;
      if (step < 1e-3) break;
    }
  }
  result.reached = done;
  holds = targets;
  work_.loads = loads;
  if (done == 1 && result.status == Status::converged) {
    const int spent = result.iterations;
    result = tighten(options, softness, tensions_);
    result.iterations += spent;
  }
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
  const bool by_length = std::ranges::any_of(holds, [](const TendonHold& hold) { return !hold.by_tension; });
  if (by_length) find_yields();
  work_.finds_length_gradients = by_length;
  searches_ = true;
  const Relaxed result = search(options);
  searches_ = false;
  work_.finds_length_gradients = true;
  leans_ = false;
  return result;
}

void LoadedRod::take_holds() {
  for (std::size_t i = 0; i < holds.size(); ++i) {
    offsets_[i] = soft_[i] = 0;
    stiff_[i] = std::max(0.0, holds[i].compliance);
  }
}

/// Near the start, then from softened tendons, then from no load.
Relaxed LoadedRod::search(const RelaxOptions& options) {
  potential_ = true;
  for (const NodeLoad& load : work_.loads) {
    for (double x : load.moment) potential_ = potential_ && x == 0;
    for (double x : load.following) potential_ = potential_ && x == 0;
  }
  work_.symmetric = potential_;
  leans_ = lean_ != nullptr && potential_;
  factors_ = nullptr;
  std::vector<double> expected = std::move(expected_);
  expected_.clear();
  expected.resize(holds.size(), 0.0);
  // in Hessians and factors: a large rod gets fewer, so that it ends in time
  left_ = static_cast<int>(options.max_iterations * std::clamp(4000.0 / model_->size, 4.0, 20.0));
  RelaxOptions direct = options;
  direct.max_iterations = std::min(options.max_iterations, 60);
  const std::vector<double> start = work_.y;
  Relaxed result = tighten(direct, little, expected);
  const auto ended = [&] {
    return result.status == Status::converged || result.status == Status::stopped ||
           result.status == Status::left_domain;
  };
  if (ended() || options.max_iterations <= direct.max_iterations) return result;
  int spent = result.iterations;
  work_.y = start;
  result = tighten(direct, much, expected);
  result.iterations += spent;
  if (ended() || result.status == Status::unreachable) return result;
  for (const double share : {much, little}) {
    spent = result.iterations;
    result = grow(options, share);
    result.iterations += spent;
    if (ended()) break;
  }
  return result;
}

/// What tendons give way by where the rod is straight and of stiffness 1 [m/N].
void LoadedRod::find_yields() {
  if (!yields_.empty()) return;
  yields_.assign(holds.size(), 0.0);
  const std::vector<double> y = work_.y;
  std::ranges::fill(work_.y, 0.0);
  sweep_out(*model_, work_);
  sweep_back(*model_, work_);
  const std::size_t n = y.size();
  for (std::size_t i = 0; i < holds.size(); ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      const double x = work_.length_gradient[i * n + k];
      yields_[i] += x * x;
    }
    if (!(yields_[i] > 0)) yields_[i] = 1e-6;
  }
  work_.y = y;
}

}  // namespace sinew::inline v1::strain
