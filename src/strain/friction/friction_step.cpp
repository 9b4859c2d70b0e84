#include <algorithm>
#include <cmath>
#include <limits>

#include "base/at.hpp"
#include "strain/condense.hpp"
#include "strain/friction/friction_rod.hpp"
#include "strain/sweep.hpp"

namespace sinew::inline v1::strain {
namespace {

/// Of slip, that rounding may have made [m].
constexpr double edge = 1e-14;
/// Of exchanges of grips; where the rod is not stable at its tensions they may not end.
constexpr int most_rounds = 30;

}  // namespace

void FrictionRod::linearise() {
  sweep_back_with_hessian(*model_, work_);
  gradients();
  columns_ = 0;
  for (Chain& chain : chains_) {
    chain.moves = chain.spans.held ? chain.tendon.friction > 0 && chain.spans.tension > 0 : true;
    chain.first_column = columns_;
    if (chain.moves) columns_ += static_cast<int>(chain.units.size());
  }
}

/// From these to ∂T/∂y · x.
void FrictionRod::tension_rates(const Eigen::MatrixXd& lengths_of, const Eigen::MatrixXd& angles_of,
                                Eigen::MatrixXd& rates) const {
  rates.setZero(columns_, lengths_of.cols());
  for (const Chain& chain : chains_) {
    if (!chain.moves || !chain.taut) continue;
    const int count = static_cast<int>(chain.units.size()), outer = chain.has_outer ? 1 : 0,
              spans = count + outer, guides = spans - 1, from = chain.first_column;
    for (int k = 0; k < count; ++k) {
      auto out = rates.row(from + k);
      for (int j = 0; j < count; ++j) {
        const double rate = chain.by_stretch[at((k + outer) * spans + j + outer)];
        if (rate != 0) out += rate * lengths_of.row(from + j);
      }
      if (!(chain.tendon.friction > 0)) continue;
      for (int g = 0; g < guides; ++g) {
        const double rate = chain.by_grip[at((k + outer) * guides + g)];
        if (rate != 0) out += rate * angles_of.row(from + g + 1 - outer);
      }
    }
  }
}

/// Factors the Hessian at these tensions; how lengths and angles answer to tensions.
bool FrictionRod::factor_rod(double shift) {
  const Inertia inertia = factor(*model_, work_, shift);
  if (!inertia.ok) return false;
  negative_ = inertia.negative;
  if (columns_ == 0) return true;
  std::fill(fed_.begin(), fed_.end(), 0.0);
  for (const Chain& chain : chains_) {
    if (!chain.moves) continue;
    for (std::size_t k = 0; k < chain.units.size(); ++k) {
      const Unit& unit = chain.units[k];
      const int first = model_->pieces[at(segments_[at(unit.segment)].piece)].first,
                column = chain.first_column + static_cast<int>(k);
      for (std::size_t i = 0; i < unit.gradient.size(); ++i)
        fed_[at((first + static_cast<int>(i)) * stride_ + column)] = unit.gradient[i];
    }
  }
  solve(*model_, work_, fed_.data(), columns_, stride_);
  geometry_rates(fed_.data(), stride_, columns_, length_answers_, angle_answers_);
  return length_answers_.allFinite() && angle_answers_.allFinite();
}

/// Tensions as the guides' grips say, and how they answer to the coordinates.
bool FrictionRod::factor_tendons() {
  same_sign_ = negative_ % 2 == 0;
  if (columns_ == 0) return true;
  for (Chain& chain : chains_)
    if (chain.moves && chain.taut) chain.tensions.derivatives(chain.spans, chain.by_stretch, chain.by_grip);
  tension_rates(length_answers_, angle_answers_, small_);
  small_.diagonal().array() += 1;
  if (!small_.allFinite()) return false;
  lu_.compute(small_);
  bool positive = lu_.permutationP().determinant() > 0;
  for (int i = 0; i < columns_; ++i) {
    const double pivot = lu_.matrixLU()(i, i);
    if (pivot == 0) return false;
    positive = positive == (pivot > 0);
  }
  same_sign_ = same_sign_ == positive;
  return true;
}

bool FrictionRod::factor_all(double shift) {
  for (Chain& chain : chains_) chain.tensions.loosen(chain.spans, edge);
  return factor_rod(shift) && factor_tendons();
}

/// One column, its rows eight numbers apart, solved with the rod's Hessian; then what tendons make of it.
/// @param jumps by how much tensions differ from those that the gradient was taken at; may be empty
void FrictionRod::add_tendons(std::span<double> sides, const Eigen::VectorXd& jumps) {
  if (columns_ == 0) return;
  Eigen::MatrixXd lengths, angles, rates;
  geometry_rates(sides.data(), row, 1, lengths, angles);
  tension_rates(lengths, angles, rates);
  Eigen::VectorXd t = rates.col(0);
  if (jumps.size() > 0) t += jumps;
  change_ = lu_.solve(t);
  for (int i = 0; i < model_->size; ++i) {
    double sum = 0;
    for (int j = 0; j < columns_; ++j) sum += fed_[at(i * stride_ + j)] * change_[j];
    sides[at(i * row)] -= sum;
  }
}

void FrictionRod::solve_all(std::span<double> sides) {
  solve(*model_, work_, sides.data(), 1, row);
  add_tendons(sides, {});
}

/// Newton's step into `side_`. How each guide answers is chosen so that it is right at the step's end, as far
/// as lengths are linear: a complementarity problem in the spans' tensions, solved by exchanging what is
/// wrong.
bool FrictionRod::find_step() {
  if (!factor_rod(drag_)) return false;
  std::fill(side_.begin(), side_.end(), 0.0);
  for (int i = 0; i < model_->size; ++i) side_[at(i * row)] = -work_.gradient[at(i)];
  solve(*model_, work_, side_.data(), 1, row);
  Eigen::VectorXd jumps = Eigen::VectorXd::Zero(columns_);
  if (columns_ > 0) {
    for (const Chain& chain : chains_)
      if (chain.moves)
        for (std::size_t k = 0; k < chain.units.size(); ++k)
          jumps[chain.first_column + static_cast<int>(k)] = -chain.pull[k];
    choose_grips(-jumps);
    for (Chain& chain : chains_) {
      chain.chosen = chain.tensions.grips;
      chain.was_taut = chain.taut;
    }
    for (Chain& chain : chains_) {
      if (!chain.moves || !chain.taut) continue;
      const std::size_t outer = chain.has_outer ? 1 : 0;
      chain.tensions.follow(chain.spans);
      for (std::size_t k = 0; k < chain.units.size(); ++k)
        jumps[chain.first_column + static_cast<int>(k)] += chain.tensions.tension[k + outer];
    }
  }
  if (!factor_tendons()) return false;
  add_tendons(side_, jumps);
  return true;
}

/// The tensions of all spans at the end of a step: (c + LH⁻¹Lᵀ) t = e − what has come by slip, where each
/// guide sticks or slips as it is taken to.
class FrictionRod::GripProblem {
 public:
  GripProblem(FrictionRod& rod, int size)
      : rod_(rod),
        yields_(Eigen::MatrixXd::Zero(size, size)),
        rows_(size, size),
        stretch_(size),
        right_(size),
        t_(size),
        content_(size) {}

  void build(const Eigen::VectorXd& lengths);
  bool solve();
  /// Of a guide, or of a whole tendon, that does not answer as it was taken to.
  struct Wrong {
    Chain* chain;
    std::size_t guide;
    Grip to;
    bool taut = true, exchanges = false;  ///< all of the tendon
  };
  std::vector<Wrong> find_wrong();
  static void exchange(const Wrong& wrong);

 private:
  void find_wrong_guides(Chain& chain, double small, std::vector<Wrong>& wrong) const;

  FrictionRod& rod_;
  Eigen::MatrixXd yields_, rows_;
  Eigen::VectorXd stretch_, right_, t_, content_;  ///< content: what comes by slip
};

/// @param lengths what spans of the rod become longer by in the step, at the tensions of the gradient
void FrictionRod::GripProblem::build(const Eigen::VectorXd& lengths) {
  for (const Chain& a : rod_.chains_) {
    if (!a.moves) continue;
    const int outer = a.has_outer ? 1 : 0, count = static_cast<int>(a.units.size());
    for (int k = 0; k < count + outer; ++k) {
      stretch_[a.first_span + k] = a.spans.stretch[at(k)];
      yields_(a.first_span + k, a.first_span + k) = a.spans.compliance[at(k)];
    }
    for (int k = 0; k < count; ++k) stretch_[a.first_span + outer + k] += lengths[a.first_column + k];
    for (const Chain& b : rod_.chains_) {
      if (!b.moves) continue;
      yields_.block(a.first_span + outer, b.first_span + (b.has_outer ? 1 : 0), count,
                    static_cast<int>(b.units.size())) +=
          rod_.length_answers_.block(a.first_column, b.first_column, count, static_cast<int>(b.units.size()));
    }
  }
}

/// With the guides' grips as they are taken; false where there are no such tensions.
bool FrictionRod::GripProblem::solve() {
  rows_.setZero();
  right_.setZero();
  for (const Chain& chain : rod_.chains_) {
    if (!chain.moves) continue;
    const int spans = static_cast<int>(chain.spans.stretch.size());
    if (!chain.taut) {
      for (int k = 0; k < spans; ++k) rows_(chain.first_span + k, chain.first_span + k) = 1;
      continue;
    }
    int base = chain.first_span;
    for (int k = 0; k < spans; ++k) {
      const int line = chain.first_span + k;
      if (k > 0 && chain.tensions.grips[at(k - 1)] != Grip::sticks) {  // its own row says how it follows
        rows_(line, line) = 1;
        rows_(line, line - 1) = -chain.tensions.ratio(chain.spans, at(k - 1));
      } else {
        base = line;
      }
      if (base == chain.first_span && chain.spans.held) {
        if (k == 0) rows_(line, line) = 1, right_[line] = chain.spans.tension;
      } else {
        rows_.row(base) += yields_.row(line);
        right_[base] += stretch_[line];
      }
    }
  }
  t_ = rows_.partialPivLu().solve(right_);
  if (!t_.allFinite()) return false;
  content_ = stretch_ - yields_ * t_;
  return true;
}

void FrictionRod::GripProblem::find_wrong_guides(Chain& chain, double small,
                                                 std::vector<Wrong>& wrong) const {
  double moved = 0;
  for (std::size_t k = chain.spans.stretch.size(); k-- > 1;) {
    const std::size_t g = k - 1;
    const int line = chain.first_span + static_cast<int>(k);
    moved -= content_[line];
    if (!(chain.spans.grip[g] > 0)) continue;
    const Grip grip = chain.tensions.grips[g];
    const double f = std::exp(chain.spans.grip[g]);
    if (grip == Grip::sticks) {
      if (t_[line - 1] > f * t_[line] + small) wrong.push_back({&chain, g, Grip::outward});
      if (t_[line] > f * t_[line - 1] + small) wrong.push_back({&chain, g, Grip::inward});
    } else if (static_cast<double>(grip) * moved < -edge) {
      wrong.push_back({&chain, g, Grip::sticks});
    }
  }
}

std::vector<FrictionRod::GripProblem::Wrong> FrictionRod::GripProblem::find_wrong() {
  std::vector<Wrong> wrong;
  const double small = 1e-12 * t_.cwiseAbs().maxCoeff();
  for (Chain& chain : rod_.chains_) {
    if (!chain.moves) continue;
    const auto spans = static_cast<Eigen::Index>(chain.spans.stretch.size());
    if (chain.taut ? !chain.spans.held && t_.segment(chain.first_span, spans).maxCoeff() <= 0
                   : content_.segment(chain.first_span, spans).sum() > edge)
      wrong.push_back({&chain, 0, Grip::sticks, !chain.taut, true});
    else if (chain.taut && chain.tendon.friction > 0)
      find_wrong_guides(chain, small, wrong);
  }
  return wrong;
}

void FrictionRod::GripProblem::exchange(const Wrong& wrong) {
  if (wrong.exchanges)
    wrong.chain->taut = wrong.taut;
  else
    wrong.chain->tensions.grips[wrong.guide] = wrong.to;
}

/// @param tensions those at which the gradient was taken
void FrictionRod::choose_grips(const Eigen::VectorXd& tensions) {
  bool any = false;
  int size = 0;
  for (Chain& chain : chains_) {
    chain.first_span = size;
    if (!chain.moves) continue;
    any = any || chain.tendon.friction > 0 || !chain.spans.held;
    size += static_cast<int>(chain.spans.stretch.size());
  }
  if (!any) return;
  Eigen::MatrixXd ahead, unused;
  geometry_rates(side_.data(), row, 1, ahead, unused);
  GripProblem problem(*this, size);
  problem.build(ahead.col(0) + length_answers_ * tensions);
  for (Chain& chain : chains_)  // as the last step had it
    if (chain.moves && chain.chosen.size() == chain.tensions.grips.size()) {
      chain.tensions.grips = chain.chosen;
      chain.taut = chain.was_taut;
    }
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  int patience = 6;
  for (int round = 0; round < most_rounds; ++round) {
    if (!problem.solve()) return;
    const std::vector<GripProblem::Wrong> wrong = problem.find_wrong();
    if (wrong.empty()) return;
    if (wrong.size() < fewest) {
      fewest = wrong.size();
      patience = 6;
    } else {
      --patience;
    }
    const std::size_t changed = patience > 0 ? wrong.size() : 1;  // one by one it does not go round
    for (std::size_t i = 0; i < changed; ++i) GripProblem::exchange(wrong[i]);
  }
}

}  // namespace sinew::inline v1::strain
