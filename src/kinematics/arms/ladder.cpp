#include "kinematics/arms/ladder.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/at.hpp"

namespace sinew::inline v1 {
namespace {

constexpr std::array<Resolution, 4> along_sections{{{-1, 8}, {5, 16}, {7, 32}, {9, 64}}};
constexpr std::array<Resolution, 6> between_discs{{{-1, 2}, {3, 3}, {4, 5}, {5, 8}, {6, 13}, {7, 20}}};

/// What a model is refined by, coarse to fine, in order and elements alike, so that a step tells what either
/// of them was off; empty where it has one resolution. Between two of them is the finer one's elements with
/// the coarser one's order, which often does as well: resolution 2 k is the k-th, 2 k − 1 the one before it.
std::span<const Resolution> resolutions_of(const ArmOptions& options) {
  if (options.order >= 0 || options.elements > 0 || options.balance != ArmBalance::energy) return {};
  if (options.model == ArmModel::rod) return along_sections;
  if (options.model == ArmModel::subsegment_rod) return between_discs;
  return {};
}

/// The next of the table that has more elements.
int finer_than(int level) { return ((level + 1) / 2 + 1) * 2; }
/// The one of the table before it.
int coarser_than(int level) { return (level + 1) / 2 * 2 - 2; }

/// By how much the elements of one level lower the error of another: as the fourth power of their length, the
/// order of frames and quadrature.
double error_ratio(const ArmOptions& options, int level, int finer) {
  const double share = static_cast<double>(resolution_at(options, finer).elements) /
                       static_cast<double>(resolution_at(options, level).elements);
  return share * share * share * share;
}

/// From where an error stands at a level, the level whose next one is to bring it below a bound, if elements
/// rule it; one that has a next, against which it can be checked.
int level_for(const ArmOptions& options, int level, double error, double bound) {
  int to = level;
  while (finer_than(finer_than(to)) < level_count(options) &&
         error > bound * error_ratio(options, level, finer_than(to)))
    to = finer_than(to);
  return to;
}

double distance(const strain::Three& a, const strain::Three& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// From where on a tip that moves says nothing of errors, over the arm's length.
constexpr double far = 1e-3;

}  // namespace

int level_count(const ArmOptions& options) {
  return std::max(1, 2 * static_cast<int>(resolutions_of(options).size()) - 1);
}

Resolution resolution_at(const ArmOptions& options, int level) {
  const auto resolutions = resolutions_of(options);
  const Resolution& finer = resolutions[at((level + 1) / 2)];
  return {level % 2 == 0 ? finer.order : resolutions[at(level / 2)].order, finer.elements};
}

double size_of_highest(const strain::RodModel& model, const std::vector<double>& y) {
  double sum = 0;
  for (const strain::Piece& piece : model.pieces)
    for (std::size_t c = 3; c < 6; ++c)
      if (piece.modes[c] > piece.stretches) {
        for (int k = 1; k <= piece.stretches; ++k) {
          const double value =
              y[at(piece.first + piece.offset[c] + k * (piece.modes[c] / piece.stretches) - 1)];
          sum += value * value;
        }
      }
  return std::sqrt(sum / model.energy_scale);
}

ResolutionLadder::ResolutionLadder(const ArmOptions& options, double length, Rung& rung)
    : options_(options),
      length_(length),
      wanted_(options.accuracy * length),
      count_(level_count(options)),
      refines_(count_ > 1 && options.accuracy > 0),
      rung_(&rung) {}

ResolutionLadder::Step ResolutionLadder::begin(bool warm, double size) {
  if (!warm) rung_->level = 0;
  const int last = rung_->level, coarser = coarser_than(last);
  knows_ = warm;
  if (warm && refines_ && coarser >= 0) {  // what came before may have been harder to resolve
    const double shrunk = std::min(1.0, size / rung_->checked_size);
    knows_ = !(rung_->checked * shrunk * shrunk * error_ratio(options_, coarser, last) <= 0.3 * wanted_);
    if (!knows_) rung_->level = coarser;
  }
  if (!refines_) rung_->checked = rung_->checked_size = 0;
  return aim(Aim::answer, rung_->level, last);
}

ResolutionLadder::Step ResolutionLadder::after_solve(const Solved& solved) {
  stands_ = false;
  switch (aim_) {
    case Aim::answer:
      stands_ = true;
      size_ = solved.size;
      tip_ = solved.tip;
      return solved.converged ? go_on() : answer();
    case Aim::leaner:
      return leaner_does(solved) ? answer() : beyond();
    case Aim::leaner_at_last:
      leaner_does(solved);
      return answer();
    case Aim::finer:
      break;
  }
  const double moved = distance(solved.tip, tip_);
  rung_->checked = moved * ratio_ / (ratio_ - 1);
  rung_->checked_size = size_;
  if (solved.converged && rung_->checked <= wanted_) return answer();  // the coarse one does
  stands_ = true;
  size_ = solved.size;
  tip_ = solved.tip;
  rung_->level = next_;
  rung_->checked = moved / (ratio_ - 1);
  rung_->checked_size = size_;
  if (!solved.converged) return answer();
  if (rung_->checked > wanted_ || moved >= far * length_) return go_on();
  off_ = rung_->checked;
  reference_ = tip_;
  return aim(Aim::leaner_at_last, next_ - 1, next_);
}

/// After an equilibrium that stands for an answer.
ResolutionLadder::Step ResolutionLadder::go_on() {
  if (!refines_) return answer();
  const double grown = std::max(1.0, size_ / rung_->checked_size);
  if (knows_ && grown <= 1.5 && rung_->checked * grown * grown <= wanted_) return answer();
  knows_ = false;
  next_ = finer_than(rung_->level);
  if (next_ >= count_) {  // nothing has more elements: back to where the last step began, or it ends here
    if (rung_->level % 2 == 0) return answer();
    --rung_->level;
    return aim(Aim::answer, rung_->level, rung_->level + 1);
  }
  return {Step::Kind::compare, next_, rung_->level};
}

ResolutionLadder::Step ResolutionLadder::after_comparison(const strain::Approach& near) {
  near_ = near;
  ratio_ = error_ratio(options_, rung_->level, next_);
  if (!near.close) return aim(Aim::finer, next_, rung_->level);
  if (const double off = near.moved * ratio_ / (ratio_ - 1); off <= wanted_) {
    rung_->checked = off;
    rung_->checked_size = size_;
    return answer();
  }
  left_ = near.moved / (ratio_ - 1);
  if (left_ <= wanted_ && near.moved < far * length_) {
    off_ = left_ + near.rest;
    reference_ = near.tip;
    return aim(Aim::leaner, next_ - 1, next_);
  }
  return beyond();
}

/// After a comparison that told the finer one is needed, or one beyond it.
ResolutionLadder::Step ResolutionLadder::beyond() {
  const int to = level_for(options_, next_, left_, 0.5 * wanted_);
  if (to == next_) return aim(Aim::finer, next_, next_);
  rung_->level = to;
  rung_->checked = left_;
  return aim(Aim::answer, to, next_);
}

/// Whether the order before does with the elements of a level; then that is the answer.
bool ResolutionLadder::leaner_does(const Solved& solved) {
  const double all = off_ + distance(solved.tip, reference_);
  if (!solved.converged || all > wanted_) return false;
  stands_ = true;
  rung_->level = next_ - 1;
  rung_->checked = all;
  rung_->checked_size = solved.size;
  return true;
}

}  // namespace sinew::inline v1
