#include "strain/capstan.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::inline v1::strain {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

/// Least Σ c e^τ − e τ over τ = ln T with |τ₋ − τ₊| ≤ b, span after span from the fixed end: what the spans
/// passed want of the next one's T is a polyline, which a guide cuts where it is 0 and moves apart.
void CapstanTensions::find(const CapstanSpans& spans) {
  const int n = static_cast<int>(spans.stretch.size());
  tension.assign(at(n), 0.0);
  grips.assign(at(std::max(0, n - 1)), Grip::outward);
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
  // The same of each run of spans that slip, from its sums: free of the rounding of the search.
  for (int first = 0, last; first < n; first = last) {
    double stretch = 0, compliance = 0, factor = 1;
    for (last = first; last < n; ++last) {
      if (last > first) {
        if (grips[at(last - 1)] == Grip::sticks) break;
        factor *= std::exp(-static_cast<double>(grips[at(last - 1)]) * spans.grip[at(last - 1)]);
      }
      stretch += spans.stretch[at(last)];
      compliance += spans.compliance[at(last)] * factor;
    }
    double T = first == 0 && spans.held ? spans.tension : std::max(0.0, stretch / compliance);
    for (int k = first; k < last; ++k) {
      if (k > first) T *= std::exp(-static_cast<double>(grips[at(k - 1)]) * spans.grip[at(k - 1)]);
      tension[at(k)] = T;
    }
  }
}

void CapstanTensions::derivatives(const CapstanSpans& spans, std::vector<double>& by_stretch,
                                  std::vector<double>& by_grip) const {
  const int n = static_cast<int>(tension.size()), guides = n - 1;
  by_stretch.assign(at(n * n), 0.0);
  by_grip.assign(at(n * std::max(guides, 0)), 0.0);
  for (int first = 0, last; first < n; first = last) {
    for (last = first + 1; last < n && grips[at(last - 1)] != Grip::sticks;) ++last;
    if (!(tension[at(first)] > 0)) continue;
    // T_k = T f_k with ln f_k = −Σ ±b, and T Σ c f = Σ e
    const bool held = first == 0 && spans.held;
    double sum = 0;
    for (int k = first; k < last; ++k) sum += spans.compliance[at(k)] * tension[at(k)] / tension[at(first)];
    if (!held)
      for (int k = first; k < last; ++k)
        for (int j = first; j < last; ++j)
          by_stretch[at(k * n + j)] = tension[at(k)] / tension[at(first)] / sum;
    double after = 0;  // Σ c T of the spans after a guide
    for (int g = last - 2; g >= first; --g) {
      after += spans.compliance[at(g + 1)] * tension[at(g + 1)];
      const double sign = -static_cast<double>(grips[at(g)]);
      for (int k = first; k < last; ++k) {
        double rate = k > g ? sign * tension[at(k)] : 0;
        if (!held) rate -= sign * after / sum * tension[at(k)] / tension[at(first)];
        by_grip[at(k * guides + g)] = rate;
      }
    }
  }
}

}  // namespace sinew::inline v1::strain
