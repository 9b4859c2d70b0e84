#include "sinew/plan/insertion.hpp"

#include <algorithm>
#include <cmath>

#include "math/shape_preserving.hpp"

namespace sinew::inline v1 {

std::vector<InsertionStep> interpolated(std::span<const InsertionStep> steps, double max_stage) {
  if (steps.size() < 2) return {steps.begin(), steps.end()};
  const std::size_t sections = steps.front().bends.size();
  std::vector<double> stages, bends;
  for (const InsertionStep& step : steps) {
    stages.push_back(step.stage);
    for (const Bend& bend : step.bends) bends.insert(bends.end(), {bend[0], bend[1]});
  }
  const ShapePreservingCurve curve(stages, bends);
  std::vector<InsertionStep> dense;
  for (std::size_t k = 0; k + 1 < steps.size(); ++k) {
    const double h = stages[k + 1] - stages[k];
    const int count = std::max(1, static_cast<int>(std::ceil(h / max_stage - 1e-9)));
    dense.push_back(steps[k]);
    for (int i = 1; i < count; ++i) {
      InsertionStep step;
      step.stage = stages[k] + h * i / count;
      step.bends.resize(sections);
      for (std::size_t c = 0; c < 2 * sections; ++c) {
        const double a = bends[2 * sections * k + c], b = bends[2 * sections * (k + 1) + c];
        step.bends[c / 2][static_cast<int>(c % 2)] =
            std::clamp(curve.value(k, c, step.stage), std::min(a, b), std::max(a, b));  // rounding
      }
      dense.push_back(std::move(step));
    }
  }
  dense.push_back(steps.back());
  return dense;
}

}  // namespace sinew::inline v1
