/// What changes at once where inputs begin to change: one-sided, since a guide that slips one way sticks
/// when its tendon turns back. Theory: docs/theory/tendon_friction.md
#include <algorithm>
#include <cmath>

#include "base/at.hpp"
#include "strain/condense.hpp"
#include "strain/friction_rod.hpp"

namespace sinew::inline v1::strain {
namespace {

/// A guide counts as slipping within this of its bound, in ln T.
constexpr double near_bound = 1e-7;
/// Below this a guide turns its tendon by nothing [rad]: how the angle grows there depends on the way.
constexpr double no_turn = 1e-9;
/// Of tendons that do not stretch, over what they are given while equilibria are looked for.
constexpr double stiffer = 1e-6;
constexpr int most_exchanges = 60;

}  // namespace

PathRates FrictionRod::rates(std::span<const double> direction) {
  PathRates result;
  const std::size_t tendons = chains_.size();
  std::copy(now_.y.begin(), now_.y.end(), work_.y.begin());
  evaluate();
  linearise();
  if (!factor_rod(0)) return result;
  std::vector<std::vector<int>> bounds(tendons);   // of each guide the side on whose bound it is
  std::vector<std::vector<double>> told(tendons);  // T' of spans where inputs alone say it
  for (std::size_t i = 0; i < tendons; ++i) {
    Chain& chain = chains_[i];
    const std::size_t spans = chain.spans.stretch.size(), outer = chain.has_outer ? 1 : 0;
    const bool rubs = chain.tendon.friction > 0, pulls = chain.moves && chain.taut;
    bounds[i].assign(spans - 1, 0);
    if (chain.tendon.compliance == 0)
      for (std::size_t k = outer; k < spans; ++k) chain.spans.compliance[k] *= stiffer;
    if (rubs && pulls)
      for (const double angle : chain.angle)
        if (angle < no_turn && (chain.has_outer || &angle != chain.angle.data())) {
          result.why = PathRates::Why::no_turn;
          return result;
        }
    if (!chain.moves) {  // held by a tension that friction does not change, or by none
      if (chain.spans.tension == 0 && direction[i] < 0) {
        result.why = PathRates::Why::pushes;
        return result;
      }
      double rate = direction[i];
      told[i].push_back(rate);
      for (std::size_t k = 0; k + 1 < spans; ++k) told[i].push_back(rate *= std::exp(-chain.spans.grip[k]));
      continue;
    }
    if (!rubs || !chain.taut) continue;
    const std::vector<double>& T = chain.tensions.tension;
    for (std::size_t g = 0; g + 1 < spans; ++g) {
      const double drop = std::log(T[g] / T[g + 1]), b = chain.spans.grip[g];
      bounds[i][g] = drop >= b - near_bound ? 1 : drop <= near_bound - b ? -1 : 0;
      chain.tensions.grips[g] = static_cast<Grip>(bounds[i][g]);
    }
  }
  const auto length_rate = [&](const Unit& unit) {
    const int first = model_->pieces[at(segments_[at(unit.segment)].piece)].first;
    double rate = 0;
    for (std::size_t j = 0; j < unit.gradient.size(); ++j)
      rate += unit.gradient[j] * side_[at((first + static_cast<int>(j)) * row)];
    return rate;
  };
  std::size_t fewest = 1000000;
  int patience = 6;
  for (int round = 0;; ++round) {
    if (round == most_exchanges) {
      result.why = PathRates::Why::undecided;
      return result;
    }
    if (!factor_tendons()) return result;
    Eigen::VectorXd jumps = Eigen::VectorXd::Zero(columns_);
    std::fill(side_.begin(), side_.end(), 0.0);
    for (std::size_t i = 0; i < tendons; ++i) {
      const Chain& chain = chains_[i];
      const std::size_t spans = chain.spans.stretch.size(), outer = chain.has_outer ? 1 : 0;
      double factor = direction[i];
      for (std::size_t k = 0; k < chain.units.size(); ++k) {
        if (!chain.moves) {
          const Unit& unit = chain.units[k];
          const int first = model_->pieces[at(segments_[at(unit.segment)].piece)].first;
          for (std::size_t j = 0; j < unit.gradient.size(); ++j)
            side_[at((first + static_cast<int>(j)) * row)] -= unit.gradient[j] * told[i][k + outer];
        } else if (chain.taut && chain.spans.held) {  // down the tendon to the first guide that sticks
          factor *= chain.tensions.grips[k] == Grip::sticks ? 0 : chain.tensions.ratio(chain.spans, k);
          jumps[chain.first_column + static_cast<int>(k)] = factor;
        } else if (chain.taut) {
          jumps[chain.first_column + static_cast<int>(k)] =
              chain.by_stretch[(k + outer) * spans] * direction[i];
        }
      }
    }
    solve(*model_, work_, side_.data(), 1, row);
    change_ = Eigen::VectorXd::Zero(columns_);
    add_tendons(side_, jumps);
    Eigen::MatrixXd lengths_of, angles_of;
    geometry_rates(side_.data(), row, 1, lengths_of, angles_of);

    struct Wrong {
      Chain* chain;
      std::size_t guide;
      Grip to;
    };
    std::vector<Wrong> wrong;
    result.tension.assign(tendons, {});
    result.end.assign(tendons, 0.0);
    result.slipping = 0;
    for (std::size_t i = 0; i < tendons; ++i) {
      Chain& chain = chains_[i];
      const std::size_t spans = chain.spans.stretch.size(), outer = chain.has_outer ? 1 : 0;
      std::vector<double>& rate = result.tension[i];
      std::vector<double> longer(spans, 0.0), turns(spans, 0.0);  // e' and, of the guide after it, b'
      rate.assign(spans, 0.0);
      for (std::size_t k = 0; k < chain.units.size(); ++k) {
        longer[k + outer] = length_rate(chain.units[k]);
        if (!chain.moves) continue;
        rate[k + outer] = change_[chain.first_column + static_cast<int>(k)];
        if (k + outer > 0) turns[k + outer - 1] = angles_of(chain.first_column + static_cast<int>(k), 0);
      }
      if (!chain.spans.held) longer[0] += direction[i];
      if (!chain.moves) rate = told[i];
      if (outer > 0 && chain.spans.held) rate[0] = direction[i];
      if (outer > 0 && chain.moves && chain.taut && !chain.spans.held) {
        for (std::size_t k = 0; k < spans; ++k) rate[0] += chain.by_stretch[k] * longer[k];
        for (std::size_t g = 0; g + 1 < spans; ++g) rate[0] += chain.by_grip[g] * turns[g];
      }
      const std::vector<double>& T = chain.tensions.tension;
      double moved = 0, most_moved = 0, most_rate = 0;
      for (std::size_t k = 0; k < spans; ++k) {
        most_moved =
            std::max(most_moved, std::abs(longer[k]) + std::abs(chain.spans.compliance[k] * rate[k]));
        if (T[k] > 0) most_rate = std::max(most_rate, std::abs(rate[k]) / T[k]);
      }
      for (std::size_t k = spans; k-- > 1;) {
        moved -= longer[k] - chain.spans.compliance[k] * rate[k];
        const std::size_t g = k - 1;
        const int side = bounds[i][g];
        if (side == 0) continue;
        if (chain.tensions.grips[g] == Grip::sticks) {
          if (side * (rate[g] / T[g] - rate[k] / T[k]) - turns[g] > 1e-9 * (most_rate + std::abs(turns[g])))
            wrong.push_back({&chain, g, static_cast<Grip>(side)});
        } else if (side * moved < -1e-9 * most_moved) {
          wrong.push_back({&chain, g, Grip::sticks});
        } else {
          ++result.slipping;
        }
      }
      if (chain.spans.held)
        result.end[i] = moved + chain.tendon.outside * direction[i];
      else
        result.end[i] = direction[i];
      if (outer == 0) rate.insert(rate.begin(), std::nan(""));  // a motor at rest may hold any within bounds
    }
    if (wrong.empty()) break;
    if (wrong.size() < fewest) {
      fewest = wrong.size();
      patience = 6;
    } else {
      --patience;
    }
    const std::size_t changed = patience > 0 ? wrong.size() : 1;
    for (std::size_t i = 0; i < changed; ++i) wrong[i].chain->tensions.grips[wrong[i].guide] = wrong[i].to;
  }
  result.y.resize(at(model_->size));
  for (int i = 0; i < model_->size; ++i) result.y[at(i)] = side_[at(i * row)];
  result.why = PathRates::Why::known;
  return result;
}

}  // namespace sinew::inline v1::strain
