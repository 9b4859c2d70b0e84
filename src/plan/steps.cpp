#include "sinew/plan/steps.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::inline v0 {
namespace {

/// Slope of a monotone interpolation by weighted harmonic means: F. N. Fritsch, J. Butland, SIAM J. Sci.
/// Stat. Comput. 5 (1984) 300.
double slope(double h0, double h1, double d0, double d1) {
  if (!(d0 * d1 > 0)) return 0;
  const double w0 = 2 * h1 + h0, w1 = h1 + 2 * h0;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

}  // namespace

std::vector<InsertionStep> interpolated(std::span<const InsertionStep> steps, double most_stage) {
  if (steps.size() < 2) return {steps.begin(), steps.end()};
  const std::size_t sections = steps.front().bends.size();
  const auto bend = [&](std::size_t k, std::size_t c) {
    return steps[k].bends[c / 2][static_cast<int>(c % 2)];
  };
  const auto width = [&](std::size_t k) { return steps[k + 1].stage - steps[k].stage; };
  std::vector<std::vector<double>> slopes(steps.size(), std::vector<double>(2 * sections, 0.0));
  for (std::size_t k = 1; k + 1 < steps.size(); ++k)
    for (std::size_t c = 0; c < 2 * sections; ++c)
      slopes[k][c] = slope(width(k - 1), width(k), (bend(k, c) - bend(k - 1, c)) / width(k - 1),
                           (bend(k + 1, c) - bend(k, c)) / width(k));
  std::vector<InsertionStep> dense;
  for (std::size_t k = 0; k + 1 < steps.size(); ++k) {
    const double h = width(k);
    const int count = std::max(1, static_cast<int>(std::ceil(h / most_stage - 1e-9)));
    dense.push_back(steps[k]);
    for (int i = 1; i < count; ++i) {
      const double t = static_cast<double>(i) / count;
      InsertionStep step;
      step.stage = steps[k].stage + t * h;
      step.bends.resize(sections);
      for (std::size_t c = 0; c < 2 * sections; ++c) {
        const double a = bend(k, c), b = bend(k + 1, c), u = 1 - t;
        const double value = a * (1 + 2 * t) * u * u + b * (3 - 2 * t) * t * t +
                             h * (slopes[k][c] * t * u * u - slopes[k + 1][c] * t * t * u);
        step.bends[c / 2][static_cast<int>(c % 2)] = std::clamp(value, std::min(a, b), std::max(a, b));
      }
      dense.push_back(std::move(step));
    }
  }
  dense.push_back(steps.back());
  return dense;
}

}  // namespace sinew::inline v0
