#include <algorithm>
#include <cmath>
#include <limits>

#include "base/at.hpp"
#include "strain/relax.hpp"

namespace sinew::inline v1::strain {
namespace {

/// What tendons that are held by their ends are softened by, as shares of what the straight rod gives way to
/// them: where the search begins near the answer, where it begins anywhere, and at the least.
constexpr double little = 1e-3, much = 0.3, least = 1e-6;

}  // namespace

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
  tolerance_ = options.tolerance;
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
  if (ended() || result.status == Status::unreachable || !options.may_grow) return result;
  for (const double share : {much, little}) {
    spent = result.iterations;
    result = grow(options, share);
    result.grew = true;
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
