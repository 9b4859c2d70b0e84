#include "kinematics/arms/ladder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "base/at.hpp"

namespace sinew::inline v1 {
namespace {

constexpr std::array<Resolution, 4> along_sections{{{-1, 8}, {5, 16}, {7, 32}, {9, 64}}};
constexpr std::array<Resolution, 6> between_discs{{{-1, 2}, {3, 3}, {4, 5}, {5, 8}, {6, 13}, {7, 20}}};

/// The next of the table that has more elements.
int finer_than(int level) { return ((level + 1) / 2 + 1) * 2; }
/// The one of the table before it.
int coarser_than(int level) { return (level + 1) / 2 * 2 - 2; }

/// The order of frames and quadrature: errors fall with this power of the length of elements.
constexpr double full_power = 4;
/// Where polynomials are still too coarse for that they fall more slowly, and this slowly at worst.
constexpr double least_power = 0.5;

double elements_at(const ArmOptions& options, int level) {
  return static_cast<double>(resolution_at(options, level).elements);
}

/// What the elements of one level leave of the error of another.
double error_share(const ArmOptions& options, int level, int finer, double power) {
  return std::pow(elements_at(options, finer) / elements_at(options, level), -power);
}

/// From where an error stands at a level, the level whose next one is to bring it below a bound, if elements
/// rule it; one that has a next, against which it can be checked.
int level_for(const ArmOptions& options, int level, double error, double bound, double power) {
  int to = level;
  while (finer_than(finer_than(to)) < level_count(options) &&
         error * error_share(options, level, finer_than(to), power) > bound)
    to = finer_than(to);
  return to;
}

double distance(const strain::Three& a, const strain::Three& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

strain::Three difference(const strain::Three& a, const strain::Three& b, double share) {
  return {share * (a[0] - b[0]), share * (a[1] - b[1]), share * (a[2] - b[2])};
}

/// An error beyond so many times the accuracy is reported [1]: it is an estimate by two polynomials, and less
/// would refuse answers that are good enough.
constexpr double reported_multiple = 10;
constexpr std::string_view coarse_words = "the finest polynomials still";

/// The least accuracy of one digit that is not below an error over the length.
double enough_for(double error) {
  const double digit = std::pow(10, std::floor(std::log10(error)));
  return std::min(1.0, std::ceil(error / digit * (1 - 1e-12)) * digit);
}

/// From where on a tip that moves says nothing of errors, over the arm's length.
constexpr double far = 1e-3;
/// How far from a shape whose error is known it is taken for known, over that shape's size, while nothing
/// tells how it changes.
constexpr double first_reach = 0.04;
/// How much farther than it was last followed, and how far at most.
constexpr double reach_growth = 3, most_reach = 0.5;
/// What is taken of the fastest change of the error that was seen, and what is kept of it at each check.
constexpr double slope_safety = 1.3, slope_kept = 0.5;

/// Of coordinates, or of what they differ by; over √(EI/L), so about radians.
struct Size {
  double all, varying;  ///< varying: of bending and torsion, what is not constant on a stretch
};
/// @param from may be empty
Size size_of(const strain::RodModel& model, std::span<const double> y, std::span<const double> from) {
  double all = 0, varying = 0;
  const auto square = [&](int i) {
    const double value = y[at(i)] - (from.empty() ? 0.0 : from[at(i)]);
    return value * value;
  };
  for (int i = 0; i < model.size; ++i) all += square(i);
  for (const strain::Piece& piece : model.pieces)
    for (std::size_t c = 3; c < 6; ++c) {
      const int modes = piece.modes[c] / piece.stretches, first = piece.first + piece.offset[c];
      for (int k = 0; k < piece.modes[c]; ++k)
        if (k % modes > 0) varying += square(first + k);
    }
  return {std::sqrt(all / model.energy_scale), std::sqrt(varying / model.energy_scale)};
}

}  // namespace

std::span<const Resolution> resolutions_of(const ArmOptions& options) {
  if (options.order >= 0 || options.elements > 0 || options.balance != ArmBalance::energy) return {};
  if (options.model == ArmModel::rod) return along_sections;
  if (options.model == ArmModel::subsegment_rod) return between_discs;
  return {};
}

int level_count(const ArmOptions& options) {
  return std::max(1, 2 * static_cast<int>(resolutions_of(options).size()) - 1);
}

Resolution resolution_at(const ArmOptions& options, int level) {
  const auto resolutions = resolutions_of(options);
  const Resolution& finer = resolutions[at((level + 1) / 2)];
  return {level % 2 == 0 ? finer.order : resolutions[at(level / 2)].order, finer.elements};
}

void report_coarse(double error, double accuracy, double length, std::string_view what, Report& report) {
  const double wanted = accuracy * length;
  if (!(error > reported_multiple * wanted)) return;
  report.status = Status::stalled;
  report.message = FixedText<240>(fmt::format(
      "{} move the {} by {:.1e} m, accuracy: {:.1g} asks for {:.1e} m: give accuracy: {:.0e} or more, "
      "or smaller loads and tensions",
      coarse_words, what, error, accuracy, wanted, enough_for(error / length)));
}

bool is_coarse(const Report& report) {
  return report.status == Status::stalled && report.message.view().starts_with(coarse_words);
}

double size_of_variation(const strain::RodModel& model, const std::vector<double>& y) {
  return size_of(model, y, {}).varying;
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
  if (!warm || !refines_) {  // nothing of questions before
    rung_->told = rung_->checked = rung_->checked_size = 0;
    rung_->power = full_power;
    rung_->checked_level = -1;
  }
  last_move_ = move_before_ = {};
  const int last = rung_->level, coarser = coarser_than(last);
  knows_ = warm;
  if (warm && refines_ && coarser >= 0) {  // what came before may have been harder to resolve
    const double shrunk = std::min(1.0, size / rung_->checked_size);
    knows_ = !(rung_->checked * shrunk * shrunk <=
               0.7 * wanted_ * error_share(options_, coarser, last, rung_->power));
    if (!knows_) rung_->level = coarser;
  }
  return aim(Aim::answer, rung_->level, last);
}

ResolutionLadder::Step ResolutionLadder::after_solve(const Solved& solved) {
  stands_ = false;
  switch (aim_) {
    case Aim::answer:
      stand(solved);
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
  watch(moved);
  const double off = moved * ratio_ / (ratio_ - 1);
  if (solved.converged && off <= wanted_) {  // the coarse one does
    know(difference(solved.tip, tip_, ratio_ / (ratio_ - 1)), off);
    return answer();
  }
  left_by_ = difference(solved.tip, tip_, 1 / (ratio_ - 1));
  stand(solved);
  rung_->level = next_;
  know(left_by_, moved / (ratio_ - 1));
  if (!solved.converged) return answer();
  if (rung_->checked > wanted_ || moved >= far * length_) return go_on();
  off_ = rung_->checked;
  reference_ = tip_;
  return aim(Aim::leaner_at_last, next_ - 1, next_);
}

/// The tip moves by so much from the level of the rung to the next one. Two such moves one after the other
/// tell with which power of the elements' length errors fall; where that is clearly less than their order,
/// errors are taken to go on so.
void ResolutionLadder::watch(double moved) {
  const Move now{elements_at(options_, rung_->level), elements_at(options_, next_), moved};
  if (now.fewer != last_move_.fewer || now.more != last_move_.more) move_before_ = last_move_;
  last_move_ = now;
  const auto part = [](const Move& move, double power) {
    return std::pow(move.fewer, -power) - std::pow(move.more, -power);
  };
  const auto expected = [&](double power) { return part(move_before_, power) / part(now, power); };
  if (move_before_.size > 0 && moved > 0) {
    const double fallen = move_before_.size / moved;
    double low = least_power, high = full_power;
    if (fallen >= 0.5 * expected(high)) low = high;
    while (high - low > 0.01) {
      const double middle = 0.5 * (low + high);
      (expected(middle) > fallen ? high : low) = middle;
    }
    rung_->power = low;
  }
  ratio_ = 1 / error_share(options_, rung_->level, next_, rung_->power);
}

void ResolutionLadder::stand(const Solved& solved) {
  stands_ = true;
  model_ = &solved.model;
  y_ = solved.y;
  tip_ = solved.tip;
}

/// After an equilibrium that stands for an answer.
ResolutionLadder::Step ResolutionLadder::go_on() {
  if (!refines_) return answer();
  const bool is_first = knows_;
  if (knows_ && is_near()) return answer();
  knows_ = false;
  next_ = finer_than(rung_->level);
  if (next_ >= count_) {  // nothing has more elements: back to where the last step began, or it ends here
    if (rung_->level % 2 == 0 && !is_first) return answer();
    const int from = rung_->level;
    rung_->level = from % 2 == 0 ? coarser_than(from) : from - 1;
    return aim(Aim::answer, rung_->level, from);
  }
  return {Step::Kind::compare, next_, rung_->level};
}

/// Whether the answer is so near to the one that was checked last that its error is small enough as well.
bool ResolutionLadder::is_near() {
  if (rung_->checked_level != rung_->level || rung_->checked_y.size() != y_.size()) return false;
  const double way = way_from_checked();
  if (!(way <= rung_->reach)) return false;
  rung_->told = rung_->checked + slope_safety * rung_->slope * way;
  return rung_->told <= wanted_;
}

double ResolutionLadder::way_from_checked() const {
  const Size by = size_of(*model_, y_, rung_->checked_y);
  return by.all + rung_->weight * by.varying;
}

/// What stands has this error.
/// @param size of it at most [m]
void ResolutionLadder::know(const strain::Three& error, double size) {
  Rung& rung = *rung_;
  const Size now = size_of(*model_, y_, {});
  rung.told = size;
  const bool is_same = rung.checked_level == rung.level && rung.checked_y.size() == y_.size();
  const double way = is_same ? way_from_checked() : 0;
  if (!is_same) {
    rung.slope = 2 * size / now.all;
    rung.reach = first_reach * now.all;
  } else if (way > 0.01 * first_reach * now.all) {
    rung.slope = std::max(distance(error, rung.error) / way, slope_kept * rung.slope);
    rung.reach = std::clamp(reach_growth * way, first_reach * now.all, most_reach * now.all);
  }
  rung.checked = size;
  rung.checked_size = now.varying;
  rung.checked_level = rung.level;
  rung.error = error;
  rung.weight = now.varying > 0 ? now.all / now.varying : 0;
  rung.checked_y.assign(y_.begin(), y_.end());
}

ResolutionLadder::Step ResolutionLadder::after_comparison(const strain::Approach& near) {
  if (!near.close) return aim(Aim::finer, next_, rung_->level);
  watch(near.moved);
  if (const double off = near.moved * ratio_ / (ratio_ - 1); off <= wanted_) {
    know(difference(near.tip, tip_, ratio_ / (ratio_ - 1)), off);
    return answer();
  }
  left_ = near.moved / (ratio_ - 1);
  left_by_ = difference(near.tip, tip_, 1 / (ratio_ - 1));
  if (left_ <= wanted_ && near.moved < far * length_) {
    off_ = left_ + near.rest;
    reference_ = near.tip;
    return aim(Aim::leaner, next_ - 1, next_);
  }
  return beyond();
}

/// After a comparison that told the finer one is needed, or one beyond it.
ResolutionLadder::Step ResolutionLadder::beyond() {
  const int to = level_for(options_, next_, left_, 0.5 * wanted_, rung_->power);
  if (to == next_) return aim(Aim::finer, next_, next_);
  rung_->level = to;
  rung_->checked = rung_->told = left_;
  rung_->checked_level = -1;
  return aim(Aim::answer, to, next_);
}

/// Whether the order before does with the elements of a level; then that is the answer.
bool ResolutionLadder::leaner_does(const Solved& solved) {
  const double all = off_ + distance(solved.tip, reference_);
  if (!solved.converged || all > wanted_) return false;
  stand(solved);
  rung_->level = next_ - 1;
  strain::Three error = difference(reference_, solved.tip, 1);
  for (std::size_t i = 0; i < 3; ++i) error[i] += left_by_[i];
  know(error, all);
  return true;
}

}  // namespace sinew::inline v1
