#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/at.hpp"
#include "strain/condense.hpp"
#include "strain/friction/friction_rod.hpp"
#include "strain/norm.hpp"
#include "strain/sweep.hpp"

namespace sinew::inline v1::strain {
namespace {

/// Of what tendons that do not stretch give way by at first, the least where that is taken back slowly.
constexpr double least_give = 1e-6;

}  // namespace

double FrictionRod::residual() const { return norm(work_.gradient) / std::sqrt(model_->energy_scale); }

/// Whether the equilibrium holds, after linearise(): where the symmetric part of its Jacobian is positive
/// definite it does; else as the sign of the determinant says.
bool FrictionRod::holds() {
  if (!factor_all(0)) return false;
  if (!potential_) return same_sign_;
  if (negative_ == 0 || !same_sign_ || columns_ == 0) return same_sign_ && negative_ == 0;
  // J = H + LᵀV. Of the symmetric part H + W S Wᵀ, W = [Lᵀ Vᵀ], S = ½ [0 1; 1 0], the negative directions
  // are those of H and of −S⁻¹ − WᵀH⁻¹W less those of −S⁻¹.
  const int n = model_->size, m = columns_;
  Eigen::MatrixXd V, L(m, n);
  std::vector<double> unit(at(n * n), 0.0);
  for (int i = 0; i < n; ++i) unit[at(i * n + i)] = 1;
  Eigen::MatrixXd lengths_of, angles_of;
  geometry_rates(unit.data(), n, n, lengths_of, angles_of);
  tension_rates(lengths_of, angles_of, V);
  L.setZero();
  for (const Chain& chain : chains_) {
    if (!chain.moves) continue;
    for (std::size_t k = 0; k < chain.units.size(); ++k) {
      const Unit& one = chain.units[k];
      const int first = model_->pieces[at(segments_[at(one.segment)].piece)].first;
      for (std::size_t i = 0; i < one.gradient.size(); ++i)
        L(chain.first_column + static_cast<int>(k), first + static_cast<int>(i)) = one.gradient[i];
    }
  }
  Eigen::MatrixXd W(n, 2 * m);
  W << L.transpose(), V.transpose();
  const int stride = (2 * m + row - 1) / row * row;
  std::vector<double> fed(at(n * stride), 0.0);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * m; ++j) fed[at(i * stride + j)] = W(i, j);
  solve(*model_, work_, fed.data(), 2 * m, stride);
  Eigen::MatrixXd B =
      -W.transpose() *
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>, Eigen::Unaligned,
                 Eigen::OuterStride<>>(fed.data(), n, 2 * m, Eigen::OuterStride<>(stride));
  for (int i = 0; i < m; ++i) B(i, m + i) -= 2, B(m + i, i) -= 2;
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(B, Eigen::EigenvaluesOnly).eigenvalues();
  const auto below = (values.array() < 0).count();
  return negative_ + static_cast<int>(below) - m == 0 || same_sign_;
}

/// Newton's steps in coordinates and tensions: the Hessian is taken at the tensions that the last step
/// foresaw, since those of stiff tendons at its end are far off.
/// @param share_left ends where so much of the first residual is left, if that is more than the tolerance
Relaxed FrictionRod::newton(const RelaxOptions& options, double share_left) {
  Relaxed result;
  const double scale = std::sqrt(model_->energy_scale), most = std::numbers::pi * scale;
  constexpr int patience = 6;
  for (Chain& chain : chains_) chain.chosen.clear();
  double best = std::numeric_limits<double>::max(), enough = options.tolerance;
  for (int waits = 0;; ++result.iterations) {
    evaluate();
    sweep_back(*model_, work_);
    add_drag();
    ++result.evaluations;
    result.residual = residual();
    if (result.iterations == 0) enough = std::max(enough, share_left * result.residual);
    if (result.residual < best) {
      if (result.residual < 0.9 * best) waits = 0;
      best = result.residual;
      std::copy(work_.y.begin(), work_.y.end(), start_.begin());
    }
    if (result.residual <= enough || waits > patience || !std::isfinite(result.residual)) break;
    if (must_end(result, options)) return result;
    for (const Chain& chain : chains_)
      if (!chain.spans.held || (chain.tendon.friction > 0 && chain.spans.tension > 0))  // else it is known
        for (std::size_t k = 0; k < chain.units.size(); ++k)
          (chain.units[k].hole ? work_.hole_tension : work_.guide_tension)[at(chain.units[k].entry)] =
              chain.pull[k];
    linearise();
    add_drag();
    if (!find_step()) {
      result.status = Status::singular;
      return result;
    }
    double length = 0;
    for (int i = 0; i < model_->size; ++i) length += side_[at(i * row)] * side_[at(i * row)];
    const double share = std::min(1.0, most / std::sqrt(length));
    for (int i = 0; i < model_->size; ++i) work_.y[at(i)] += share * side_[at(i * row)];
    for (Chain& chain : chains_)
      if (chain.moves)
        for (std::size_t k = 0; k < chain.units.size(); ++k)
          chain.pull[k] += share * change_[chain.first_column + static_cast<int>(k)];
    ++waits;
  }
  if (result.residual > enough || !std::isfinite(result.residual)) {  // as near as rounding lets it?
    std::copy(start_.begin(), start_.end(), work_.y.begin());
    evaluate();
    result.residual = best;
    if (!(best <= 1e3 * options.tolerance)) result.status = Status::stalled;
  }
  linearise();
  return result;
}

/// With what resists a motion that has no time to be slow.
void FrictionRod::add_drag() {
  if (drag_ == 0) return;
  for (std::size_t i = 0; i < work_.gradient.size(); ++i)
    work_.gradient[i] += drag_ * (work_.y[i] - anchor_[i]);
}

/// Implicit steps of ẏ = −residual from where the rod was, ever longer, until Newton's method finds the end:
/// as far as it then moves by itself.
Relaxed FrictionRod::flow(const RelaxOptions& options) {
  Relaxed result;
  RelaxOptions each = options;
  each.max_iterations = 25;
  std::vector<std::vector<double>> pulls(chains_.size());
  const auto keep = [&] {
    anchor_ = work_.y;
    for (std::size_t i = 0; i < chains_.size(); ++i) pulls[i] = chains_[i].pull;
  };
  keep();
  double drag = 1;
  bool ended = false;
  while (!ended) {
    drag_ = drag < 1e-3 ? 0 : drag;
    const Relaxed one = newton(each, drag_ > 0 ? 0.02 : 0);
    ended = drag_ == 0 && one.status == Status::converged;
    drag_ = 0;
    result.iterations += one.iterations;
    result.evaluations += one.evaluations;
    result.residual = one.residual;
    result.status = one.status;
    if (one.status == Status::stopped) break;
    if (one.status == Status::converged) {
      keep();
      drag *= one.iterations <= 2 ? 0.1 : 0.3;
    } else {
      work_.y = anchor_;
      for (std::size_t i = 0; i < chains_.size(); ++i) chains_[i].pull = pulls[i];
      drag = std::max(0.01, 4 * drag);
      if (drag > 1e5) break;
    }
    if (!ended && result.iterations >= 4 * options.max_iterations) {
      result.status = Status::iteration_limit;
      break;
    }
  }
  return result;
}

/// Tendons that do not stretch give way by this share of what they do at first.
void FrictionRod::soften(double share) {
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    Chain& chain = chains_[i];
    if (chain.tendon.compliance > 0) continue;
    for (std::size_t k = 0; k < chain.units.size(); ++k) {
      const double before = chain.compliance[k];
      chain.compliance[k] = share * chain.give[k];
      if (before > 0) chain.offset[k] *= chain.compliance[k] / before;
    }
  }
}

/// Tendons that do not stretch are let give way, and what they gave is taken back.
Relaxed FrictionRod::rigid(const RelaxOptions& options, bool flows) {
  Relaxed result;
  double share = 1, before = std::numeric_limits<double>::infinity(), lowest_failed = 0;
  soften(share);
  std::vector<double> y;
  std::vector<std::vector<double>> pulls(chains_.size());
  bool failed = false;
  const auto remember_start = [&] {
    y = work_.y;
    for (std::size_t i = 0; i < chains_.size(); ++i) pulls[i] = chains_[i].pull;
  };
  const auto recall = [&] {
    work_.y = y;
    for (std::size_t i = 0; i < chains_.size(); ++i) chains_[i].pull = pulls[i];
  };
  const bool any = std::ranges::any_of(chains_, [](const Chain& c) { return c.tendon.compliance <= 0; });
  for (int round = 0; round < 40; ++round) {
    RelaxOptions each = options;
    if (any) each.tolerance = std::max(options.tolerance, std::min(1e-4, before));
    const bool damps = flows && (round == 0 || failed);
    const Relaxed one = damps ? flow(each) : newton(each, 0);
    failed = one.status != Status::converged;
    if (round == 0) first_iterations_ = one.iterations;
    result.status = one.status;
    result.residual = one.residual;
    result.iterations += one.iterations;
    result.evaluations += one.evaluations;
    if (one.status == Status::stopped) break;
    if (failed && flows && !damps) {
      recall();
      continue;
    }
    if (failed) {
      if (round == 0 || share >= 1) break;
      lowest_failed = share;
      soften(share = std::min(1.0, 10 * share));
      recall();
      continue;
    }
    remember_start();
    double off = 0;
    for (Chain& chain : chains_) {
      if (chain.tendon.compliance > 0) continue;
      const std::size_t outer = chain.has_outer ? 1 : 0;
      for (std::size_t k = 0; k < chain.units.size(); ++k) {
        const double wanted = chain.compliance[k] * chain.tensions.tension[k + outer];
        off = std::max(off, std::abs(wanted - chain.offset[k]));
        chain.offset[k] = wanted;
      }
    }
    if (off < 1e-13 && each.tolerance <= options.tolerance) break;
    if (off > 0.2 * before && share > least_give && 0.1 * share > 2 * lowest_failed) soften(share *= 0.1);
    before = off;
    if (round == 39) result.status = Status::stalled;
  }
  return result;
}

Relaxed FrictionRod::equilibrium(const RelaxOptions& options, bool flows) {
  std::vector<std::vector<double>> offsets;
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    const auto& tension = now_.tendons[i].tension;
    chains_[i].pull.assign(tension.begin() + 1, tension.end());
    offsets.push_back(chains_[i].offset);
  }
  Relaxed result = rigid(options, flows);
  if (result.status == Status::converged && !holds()) {
    result.negative = 1;
    result.status = Status::unstable;
  }
  if (result.status != Status::converged) {
    work_.y = now_.y;
    for (std::size_t i = 0; i < chains_.size(); ++i) chains_[i].offset = offsets[i];
  }
  return result;
}

}  // namespace sinew::inline v1::strain
