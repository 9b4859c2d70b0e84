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

}  // namespace

/// How rates of inputs and forces are answered, around the equilibrium at hand.
class FrictionRod::RateProblem {
 public:
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
    std::vector<std::vector<double>> tension = {};
    std::vector<double> end = {};
    std::vector<GuideCheck> checks = {};
  };

  explicit RateProblem(FrictionRod& rod) : rod_(rod), bounds_(rod.chains_.size()) {}

  PathRates::Why find_bounds(std::span<const double> direction);
  PathRates::Why choose_grips(std::span<const double> direction, Response& found);
  Response respond(std::span<const double> input, std::span<const double> force);
  std::vector<double> coordinates() const;
  PathRates::Column column(const Response& to) const;

 private:
  double length_rate(const Unit& unit) const;
  std::vector<std::vector<double>> told_tensions(std::span<const double> input) const;
  void put_input(std::size_t tendon, double input, std::span<const double> told, Eigen::VectorXd& jumps);
  void answer(std::size_t tendon, double input, std::span<const double> told,
              const Eigen::MatrixXd& angles_of, Response& to);
  double check_guides(std::size_t tendon, std::span<const double> rate, std::span<const double> longer,
                      std::span<const double> turns, Response& to) const;

  FrictionRod& rod_;
  std::vector<std::vector<int>> bounds_;  ///< of each guide the side on whose bound it is
};

/// Which guides are on a bound; why rates are not known, where an input's direction makes no sense.
PathRates::Why FrictionRod::RateProblem::find_bounds(std::span<const double> direction) {
  for (std::size_t i = 0; i < bounds_.size(); ++i) {
    Chain& chain = rod_.chains_[i];
    const std::size_t spans = chain.spans.stretch.size(), outer = chain.has_outer ? 1 : 0;
    const bool rubs = chain.tendon.friction > 0, pulls = chain.moves && chain.taut;
    bounds_[i].assign(spans - 1, 0);
    if (chain.tendon.compliance == 0)
      for (std::size_t k = outer; k < spans; ++k) chain.spans.compliance[k] *= stiffer;
    if (rubs && pulls)
      for (const double angle : chain.angle)
        if (angle < no_turn && (chain.has_outer || &angle != chain.angle.data()))
          return PathRates::Why::no_turn;
    if (!chain.moves) {  // held by a tension that friction does not change, or by none
      if (chain.spans.tension == 0 && direction[i] < 0) return PathRates::Why::pushes;
      continue;
    }
    if (!rubs || !chain.taut) continue;
    const std::vector<double>& T = chain.tensions.tension;
    for (std::size_t g = 0; g + 1 < spans; ++g) {
      const double drop = std::log(T[g] / T[g + 1]), b = chain.spans.grip[g];
      bounds_[i][g] = drop >= b - near_bound ? 1 : drop <= near_bound - b ? -1 : 0;
      chain.tensions.grips[g] = static_cast<Grip>(bounds_[i][g]);
    }
  }
  return PathRates::Why::known;
}

/// How guides on their bounds answer to these inputs: what is wrong is exchanged until nothing is.
PathRates::Why FrictionRod::RateProblem::choose_grips(std::span<const double> direction, Response& found) {
  std::size_t fewest = 1000000;
  int patience = 6;
  for (int round = 0; round < most_exchanges; ++round) {
    if (!rod_.factor_tendons()) return PathRates::Why::singular;
    found = respond(direction, {});
    std::vector<GuideCheck> wrong;
    for (const GuideCheck& check : found.checks)
      if (check.holds < -check.rounds) wrong.push_back(check);
    if (wrong.empty()) return PathRates::Why::known;
    if (wrong.size() < fewest) {
      fewest = wrong.size();
      patience = 6;
    } else {
      --patience;
    }
    const std::size_t changed = patience > 0 ? wrong.size() : 1;
    for (std::size_t i = 0; i < changed; ++i)
      rod_.chains_[wrong[i].tendon].tensions.grips[wrong[i].guide] = wrong[i].other;
  }
  return PathRates::Why::undecided;
}

double FrictionRod::RateProblem::length_rate(const Unit& unit) const {
  const int first = rod_.model_->pieces[at(rod_.segments_[at(unit.segment)].piece)].first;
  double rate = 0;
  for (std::size_t j = 0; j < unit.gradient.size(); ++j)
    rate += unit.gradient[j] * rod_.side_[at((first + static_cast<int>(j)) * row)];
  return rate;
}

/// Of tendons whose inputs alone say them: rates of the tensions of all spans.
std::vector<std::vector<double>> FrictionRod::RateProblem::told_tensions(
    std::span<const double> input) const {
  std::vector<std::vector<double>> told(input.size());
  for (std::size_t i = 0; i < input.size(); ++i) {
    const Chain& chain = rod_.chains_[i];
    if (chain.moves) continue;
    told[i].push_back(input[i]);
    for (std::size_t k = 0; k + 1 < chain.spans.stretch.size(); ++k)
      told[i].push_back(told[i].back() * std::exp(-chain.spans.grip[k]));
  }
  return told;
}

/// What a tendon's input does to tensions while the rod rests: into the rod's right side, where it alone says
/// them, else into `jumps`.
void FrictionRod::RateProblem::put_input(std::size_t tendon, double input, std::span<const double> told,
                                         Eigen::VectorXd& jumps) {
  const Chain& chain = rod_.chains_[tendon];
  const std::size_t spans = chain.spans.stretch.size(), outer = chain.has_outer ? 1 : 0;
  double factor = input;
  for (std::size_t k = 0; k < chain.units.size(); ++k) {
    if (!chain.moves) {
      const Unit& unit = chain.units[k];
      const int first = rod_.model_->pieces[at(rod_.segments_[at(unit.segment)].piece)].first;
      for (std::size_t j = 0; j < unit.gradient.size(); ++j)
        rod_.side_[at((first + static_cast<int>(j)) * row)] -= unit.gradient[j] * told[k + outer];
    } else if (chain.taut && chain.spans.held) {  // down the tendon to the first guide that sticks
      factor *= chain.tensions.grips[k] == Grip::sticks ? 0 : chain.tensions.ratio(chain.spans, k);
      jumps[chain.first_column + static_cast<int>(k)] = factor;
    } else if (chain.taut) {
      jumps[chain.first_column + static_cast<int>(k)] = chain.by_stretch[(k + outer) * spans] * input;
    }
  }
}

/// Whether the guides of a tendon answer as they were taken to.
/// @param longer,turns rates of its spans' lengths, and of the guides' bounds in ln T
/// @returns what moves into it at its beginning
double FrictionRod::RateProblem::check_guides(std::size_t tendon, std::span<const double> rate,
                                              std::span<const double> longer, std::span<const double> turns,
                                              Response& to) const {
  const Chain& chain = rod_.chains_[tendon];
  const std::vector<double>& T = chain.tensions.tension;
  const std::size_t spans = chain.spans.stretch.size();
  double moved = 0, most_moved = 0, most_rate = 0;
  for (std::size_t k = 0; k < spans; ++k) {
    most_moved = std::max(most_moved, std::abs(longer[k]) + std::abs(chain.spans.compliance[k] * rate[k]));
    if (T[k] > 0) most_rate = std::max(most_rate, std::abs(rate[k]) / T[k]);
  }
  for (std::size_t k = spans; k-- > 1;) {
    moved -= longer[k] - chain.spans.compliance[k] * rate[k];
    const std::size_t g = k - 1;
    const int side = bounds_[tendon][g];
    if (side == 0) continue;
    if (chain.tensions.grips[g] == Grip::sticks)
      to.checks.push_back({tendon, g, static_cast<Grip>(side),
                           turns[g] - side * (rate[g] / T[g] - rate[k] / T[k]),
                           1e-9 * (most_rate + std::abs(turns[g])), false});
    else
      to.checks.push_back({tendon, g, Grip::sticks, side * moved, 1e-9 * most_moved, true});
  }
  return moved;
}

/// Rates of a tendon's tensions and of its end, from those of coordinates and tensions.
void FrictionRod::RateProblem::answer(std::size_t tendon, double input, std::span<const double> told,
                                      const Eigen::MatrixXd& angles_of, Response& to) {
  const Chain& chain = rod_.chains_[tendon];
  const std::size_t spans = chain.spans.stretch.size(), outer = chain.has_outer ? 1 : 0;
  std::vector<double>& rate = to.tension[tendon];
  std::vector<double> longer(spans, 0.0), turns(spans, 0.0);  // e' and, of the guide after it, b'
  rate.assign(spans, 0.0);
  for (std::size_t k = 0; k < chain.units.size(); ++k) {
    longer[k + outer] = length_rate(chain.units[k]);
    if (!chain.moves) continue;
    rate[k + outer] = rod_.change_[chain.first_column + static_cast<int>(k)];
    if (k + outer > 0) turns[k + outer - 1] = angles_of(chain.first_column + static_cast<int>(k), 0);
  }
  if (!chain.spans.held) longer[0] += input;
  if (!chain.moves) rate.assign(told.begin(), told.end());
  if (outer > 0 && chain.spans.held) rate[0] = input;
  if (outer > 0 && chain.moves && chain.taut && !chain.spans.held) {
    for (std::size_t k = 0; k < spans; ++k) rate[0] += chain.by_stretch[k] * longer[k];
    for (std::size_t g = 0; g + 1 < spans; ++g) rate[0] += chain.by_grip[g] * turns[g];
  }
  const double moved = check_guides(tendon, rate, longer, turns, to);
  to.end[tendon] = chain.spans.held ? moved + chain.tendon.outside * input : input;
  if (outer == 0) rate.insert(rate.begin(), std::nan(""));  // a motor at rest may hold any within bounds
}

/// Into the rod's `side_` and `change_`: rates of coordinates and of the spans' tensions.
FrictionRod::RateProblem::Response FrictionRod::RateProblem::respond(std::span<const double> input,
                                                                     std::span<const double> force) {
  const std::size_t tendons = rod_.chains_.size();
  const std::vector<std::vector<double>> told = told_tensions(input);
  Eigen::VectorXd jumps = Eigen::VectorXd::Zero(rod_.columns_);
  std::fill(rod_.side_.begin(), rod_.side_.end(), 0.0);
  for (std::size_t j = 0; j < force.size(); ++j) rod_.side_[j * row] = force[j];
  for (std::size_t i = 0; i < tendons; ++i) put_input(i, input[i], told[i], jumps);
  solve(*rod_.model_, rod_.work_, rod_.side_.data(), 1, row);
  rod_.change_ = Eigen::VectorXd::Zero(rod_.columns_);
  rod_.add_tendons(rod_.side_, jumps);
  Eigen::MatrixXd lengths_of, angles_of;
  rod_.geometry_rates(rod_.side_.data(), row, 1, lengths_of, angles_of);
  Response to;
  to.tension.assign(tendons, {});
  to.end.assign(tendons, 0.0);
  for (std::size_t i = 0; i < tendons; ++i) answer(i, input[i], told[i], angles_of, to);
  return to;
}

/// Rates of the coordinates, as respond() left them.
std::vector<double> FrictionRod::RateProblem::coordinates() const {
  std::vector<double> y(at(rod_.model_->size));
  for (int i = 0; i < rod_.model_->size; ++i) y[at(i)] = rod_.side_[at(i * row)];
  return y;
}

PathRates::Column FrictionRod::RateProblem::column(const Response& to) const {
  PathRates::Column one{coordinates(), {}, to.end};
  for (const std::vector<double>& rate : to.tension) one.tension.push_back(rate.front());
  return one;
}

PathRates FrictionRod::rates(std::span<const double> direction, std::span<const double> forces, int count) {
  PathRates result;
  std::copy(now_.y.begin(), now_.y.end(), work_.y.begin());
  evaluate();
  linearise();
  if (!factor_rod(0)) return result;
  RateProblem problem(*this);
  RateProblem::Response found;
  result.why = problem.find_bounds(direction);
  if (result.why == PathRates::Why::known) result.why = problem.choose_grips(direction, found);
  if (result.why != PathRates::Why::known) return result;
  result.y = problem.coordinates();
  result.tension = found.tension;
  result.end = found.end;
  for (const auto& check : found.checks)
    if (check.slips) ++result.slipping;
  if (count == 0) return result;

  // The choice stays around the direction: what each input adds is linear, and so are the checks.
  constexpr double infinite = std::numeric_limits<double>::infinity();
  std::vector<double> unit(chains_.size(), 0.0);
  for (std::size_t i = 0; i < chains_.size(); ++i) {
    unit[i] = 1;
    const RateProblem::Response to = problem.respond(unit, {});
    result.by_inputs.push_back(problem.column(to));
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
    result.by_forces.push_back(problem.column(problem.respond(unit, forces.subspan(at(k) * n, n))));
  return result;
}

}  // namespace sinew::inline v1::strain
