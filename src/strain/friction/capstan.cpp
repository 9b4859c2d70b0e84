#include "strain/friction/capstan.hpp"

#include <algorithm>
#include <cmath>

#include "base/at.hpp"

namespace sinew::inline v1::strain {
namespace {}  // namespace

/// Least Σ c e^τ − e τ over τ = ln T with |τ₋ − τ₊| ≤ b, span after span from the fixed end: what the spans
/// passed want of the next one's T is a polyline, which a guide cuts where it is 0 and moves apart.
void CapstanTensions::find(const CapstanSpans& spans) {
  const int n = static_cast<int>(spans.stretch.size());
  tension.assign(at(n), 0.0);
  grips.assign(at(std::max(0, n - 1)), Grip::outward);
  slip.assign(at(std::max(0, n - 1)), 0.0);
  wanted_.assign(at(n), 0.0);
  force_.assign(1, {0, 0, 0});
  for (int k = n - 1;; --k) {
    const auto span = at(k);
    if (k == 0 && spans.held) break;
    for (Segment& s : force_) {
      s.slope += spans.compliance[span];
      s.offset += spans.stretch[span];
    }
    // where it is 0
    std::size_t cut = 0;
    while (cut + 1 < force_.size() && force_[cut + 1].from * force_[cut].slope < force_[cut].offset) ++cut;
    const double zero = std::max(force_[cut].from, force_[cut].offset / force_[cut].slope);
    wanted_[span] = zero;
    if (k == 0) break;
    const double f = std::exp(spans.grip[span - 1]);
    next_.clear();
    for (std::size_t s = 0; s <= cut && zero > 0; ++s)
      next_.push_back({force_[s].from / f, force_[s].slope * f, force_[s].offset});
    if (f > 1) next_.push_back({zero / f, 0, 0});
    for (std::size_t s = cut; s < force_.size(); ++s)
      next_.push_back({std::max(zero, force_[s].from) * f, force_[s].slope / f, force_[s].offset});
    std::swap(force_, next_);
  }
  tension[0] = spans.held ? spans.tension : wanted_[0];
  for (std::size_t k = 1; k < at(n); ++k) {
    const double f = std::exp(spans.grip[k - 1]), low = tension[k - 1] / f, high = tension[k - 1] * f;
    tension[k] = std::clamp(wanted_[k], low, high);
    grips[k - 1] = spans.grip[k - 1] <= 0 || wanted_[k] <= low ? Grip::outward
                   : wanted_[k] >= high                        ? Grip::inward
                                                               : Grip::sticks;
  }
  follow(spans);  // free of the rounding of the search
  for (double& T : tension) T = std::max(0.0, T);
  double moved = 0;
  for (std::size_t k = at(n); k-- > 1;) {
    moved -= spans.stretch[k] - spans.compliance[k] * tension[k];
    slip[k - 1] = moved;
  }
}

double CapstanTensions::ratio(const CapstanSpans& spans, std::size_t guide) const {
  return std::exp(-static_cast<double>(grips[guide]) * spans.grip[guide]);
}

void CapstanTensions::follow(const CapstanSpans& spans) {
  const int n = static_cast<int>(spans.stretch.size());
  for (int first = 0, last; first < n; first = last) {
    double stretch = 0, compliance = 0, factor = 1;
    for (last = first; last < n && (last == first || grips[at(last - 1)] != Grip::sticks); ++last) {
      if (last > first) factor *= ratio(spans, at(last - 1));
      stretch += spans.stretch[at(last)];
      compliance += spans.compliance[at(last)] * factor;
    }
    tension[at(first)] = first == 0 && spans.held ? spans.tension : stretch / compliance;
    for (int k = first + 1; k < last; ++k) tension[at(k)] = tension[at(k - 1)] * ratio(spans, at(k - 1));
  }
}

void CapstanTensions::loosen(const CapstanSpans& spans, double least) {
  for (std::size_t k = 0; k < grips.size(); ++k)
    if (spans.grip[k] > 0 && std::abs(slip[k]) < least) grips[k] = Grip::sticks;
}

void CapstanTensions::derivatives(const CapstanSpans& spans, std::vector<double>& by_stretch,
                                  std::vector<double>& by_grip) const {
  const std::size_t n = tension.size(), guides = n - 1;
  by_stretch.assign(n * n, 0.0);
  by_grip.assign(n * guides, 0.0);
  std::vector<double> factor(n);
  for (std::size_t first = 0, last; first < n; first = last) {
    // T_k = T f_k with ln f_k = −Σ ±b, and T Σ c f = Σ e
    const bool held = first == 0 && spans.held;
    double sum = 0;
    for (last = first; last < n && (last == first || grips[last - 1] != Grip::sticks); ++last) {
      factor[last] = last == first ? 1 : factor[last - 1] * ratio(spans, last - 1);
      sum += spans.compliance[last] * factor[last];
    }
    if (!held)
      for (std::size_t k = first; k < last; ++k)
        for (std::size_t j = first; j < last; ++j) by_stretch[k * n + j] = factor[k] / sum;
    double after = 0;  // Σ c T of the spans after a guide
    for (std::size_t g = last - 1; g-- > first;) {
      after += spans.compliance[g + 1] * tension[g + 1];
      const double sign = -static_cast<double>(grips[g]);
      for (std::size_t k = first; k < last; ++k) {
        double rate = k > g ? sign * tension[k] : 0;
        if (!held) rate -= sign * after / sum * factor[k];
        by_grip[k * guides + g] = rate;
      }
    }
  }
}

}  // namespace sinew::inline v1::strain
