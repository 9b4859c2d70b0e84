#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "strain/norm.hpp"
#include "strain/relax.hpp"

namespace sinew::inline v1::strain {

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
  assumed_.resize(holds.size());
  then_.resize(holds.size());
  for (auto* steps : {&first_, &best_, &lowest_}) steps->resize(at(model.size));
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

/// Whether a tendon counts as one that pulls by its stretch; of those at rest, as `lowest()` has it.
bool LoadedRod::pulls(std::size_t i) const {
  for (std::size_t k = 0; k < resting_.size(); ++k)
    if (resting_[k] == i) return (tautened_ >> k & 1U) != 0;
  return !holds[i].by_tension && tensions_[i] > 0;
}

int LoadedRod::factor_with_tendons(double shift) {
  --left_;
  const Inertia inertia = factor(*factors_->model_, factors_->work_, shift);
  if (!inertia.ok) return -1;
  active_.clear();
  for (std::size_t i = 0; i < holds.size(); ++i)
    if (assumes_ ? assumed_[i] != 0 : pulls(i)) active_.push_back(static_cast<int>(i));
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

}  // namespace sinew::inline v1::strain
