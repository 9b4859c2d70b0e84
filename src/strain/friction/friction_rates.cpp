/// What changes at once where inputs begin to change: one-sided, since a guide that slips one way sticks
/// when its tendon turns back. Theory: docs/theory/tendon_friction.md
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/at.hpp"
#include "strain/condense.hpp"
#include "strain/friction/friction_rod.hpp"

namespace sinew::inline v1::strain {
namespace {

/// A guide counts as slipping within this of its bound, in ln T.
constexpr double near_bound = 1e-7;
/// Below this a guide turns its tendon by nothing [rad]: how the angle grows there depends on the way.
constexpr double no_turn = 1e-9;
/// Of tendons that do not stretch, over what they are given while equilibria are looked for.
constexpr double stiffer = 1e-6;
constexpr int most_exchanges = 60;

/// A guide on a bound, and whether it answers as it was taken to: `holds` is linear in the rates, and not
/// below 0 where it does.
struct GuideCheck {
  std::size_t tendon, guide;
  Grip other;            ///< how it answers else
  double holds, rounds;  ///< what rounding may make of 0
  bool slips;
};

/// What a choice of guides that slip makes of rates.
struct Response {
  std::vector<std::vector<double>> tension;
  std::vector<double> end;
  std::vector<GuideCheck> checks;
};

}  // namespace

PathRates FrictionRod::rates(std::span<const double> direction, std::span<const double> forces, int count) {
  PathRates result;
  const std::size_t tendons = chains_.size();
  std::copy(now_.y.begin(), now_.y.end(), work_.y.begin());
  evaluate();
  linearise();
  if (!factor_rod(0)) return result;
  std::vector<std::vector<int>> bounds(tendons);  // of each guide the side on whose bound it is
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
  // Into `side_` and `change_`: coordinates and tensions of the spans.
  const auto respond = [&](std::span<const double> input, std::span<const double> force) {
    Response to;
    std::vector<std::vector<double>> told(tendons);  // T' of spans where inputs alone say it
    Eigen::VectorXd jumps = Eigen::VectorXd::Zero(columns_);
    std::fill(side_.begin(), side_.end(), 0.0);
    for (std::size_t j = 0; j < force.size(); ++j) side_[j * row] = force[j];
    for (std::size_t i = 0; i < tendons; ++i) {
      const Chain& chain = chains_[i];
      const std::size_t spans = chain.spans.stretch.size(), outer = chain.has_outer ? 1 : 0;
      double factor = input[i];
      if (!chain.moves) {
        told[i].push_back(factor);
        for (std::size_t k = 0; k + 1 < spans; ++k)
          told[i].push_back(told[i].back() * std::exp(-chain.spans.grip[k]));
      }
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
          jumps[chain.first_column + static_cast<int>(k)] = chain.by_stretch[(k + outer) * spans] * input[i];
        }
      }
    }
    solve(*model_, work_, side_.data(), 1, row);
    change_ = Eigen::VectorXd::Zero(columns_);
    add_tendons(side_, jumps);
    Eigen::MatrixXd lengths_of, angles_of;
    geometry_rates(side_.data(), row, 1, lengths_of, angles_of);

    to.tension.assign(tendons, {});
    to.end.assign(tendons, 0.0);
    for (std::size_t i = 0; i < tendons; ++i) {
      const Chain& chain = chains_[i];
      const std::size_t spans = chain.spans.stretch.size(), outer = chain.has_outer ? 1 : 0;
      std::vector<double>& rate = to.tension[i];
      std::vector<double> longer(spans, 0.0), turns(spans, 0.0);  // e' and, of the guide after it, b'
      rate.assign(spans, 0.0);
      for (std::size_t k = 0; k < chain.units.size(); ++k) {
        longer[k + outer] = length_rate(chain.units[k]);
        if (!chain.moves) continue;
        rate[k + outer] = change_[chain.first_column + static_cast<int>(k)];
        if (k + outer > 0) turns[k + outer - 1] = angles_of(chain.first_column + static_cast<int>(k), 0);
      }
      if (!chain.spans.held) longer[0] += input[i];
      if (!chain.moves) rate = told[i];
      if (outer > 0 && chain.spans.held) rate[0] = input[i];
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
        if (chain.tensions.grips[g] == Grip::sticks)
          to.checks.push_back({i, g, static_cast<Grip>(side),
                               turns[g] - side * (rate[g] / T[g] - rate[k] / T[k]),
                               1e-9 * (most_rate + std::abs(turns[g])), false});
        else
          to.checks.push_back({i, g, Grip::sticks, side * moved, 1e-9 * most_moved, true});
      }
      if (chain.spans.held)
        to.end[i] = moved + chain.tendon.outside * input[i];
      else
        to.end[i] = input[i];
      if (outer == 0) rate.insert(rate.begin(), std::nan(""));  // a motor at rest may hold any within bounds
    }
    return to;
  };
  const auto coordinates = [&] {
    std::vector<double> y(at(model_->size));
    for (int i = 0; i < model_->size; ++i) y[at(i)] = side_[at(i * row)];
    return y;
  };
  std::size_t fewest = 1000000;
  int patience = 6;
  Response found;
  for (int round = 0;; ++round) {
    if (round == most_exchanges) {
      result.why = PathRates::Why::undecided;
      return result;
    }
    if (!factor_tendons()) return result;
    found = respond(direction, {});
    std::vector<GuideCheck> wrong;
    for (const GuideCheck& check : found.checks)
      if (check.holds < -check.rounds) wrong.push_back(check);
    if (wrong.empty()) break;
    if (wrong.size() < fewest) {
      fewest = wrong.size();
      patience = 6;
    } else {
      --patience;
    }
    const std::size_t changed = patience > 0 ? wrong.size() : 1;
    for (std::size_t i = 0; i < changed; ++i)
      chains_[wrong[i].tendon].tensions.grips[wrong[i].guide] = wrong[i].other;
  }
  result.y = coordinates();
  result.tension = found.tension;
  result.end = found.end;
  for (const GuideCheck& check : found.checks)
    if (check.slips) ++result.slipping;
  result.why = PathRates::Why::known;
  if (count == 0) return result;

  // The choice stays around the direction: what each input adds is linear, and so are the checks.
  const auto column = [&](const Response& to) {
    PathRates::Column one{coordinates(), {}, to.end};
    for (const std::vector<double>& rate : to.tension) one.tension.push_back(rate.front());
    return one;
  };
  constexpr double infinite = std::numeric_limits<double>::infinity();
  std::vector<double> unit(tendons, 0.0);
  for (std::size_t i = 0; i < tendons; ++i) {
    unit[i] = 1;
    const Response to = respond(unit, {});
    result.by_inputs.push_back(column(to));
    unit[i] = 0;
    const Chain& chain = chains_[i];
    double down = !chain.moves && chain.spans.tension == 0 ? -direction[i] : -infinite, up = infinite;
    for (std::size_t k = 0; k < to.checks.size(); ++k) {
      const double by = to.checks[k].holds, left = std::max(0.0, found.checks[k].holds);
      if (std::abs(by) <= to.checks[k].rounds) continue;
      if (by > 0)
        down = std::max(down, -left / by);
      else
        up = std::min(up, -left / by);
    }
    result.least.push_back(direction[i] + down);
    result.most.push_back(direction[i] + up);
  }
  const std::size_t n = at(model_->size);
  for (int k = 0; k < count; ++k)
    result.by_forces.push_back(column(respond(unit, forces.subspan(at(k) * n, n))));
  return result;
}

}  // namespace sinew::inline v1::strain
