/// @file steps.hpp
/// How a measure of tripods changes from one value of a dimension to the next: where a rule holds, and its
/// exceptions.
#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "study/tripod/design/measures.hpp"

namespace sinew::inline v1::tripod {

/// How much a measure rises in one step, over its value.
struct Step {
  std::size_t radius, height, angle;  ///< before the step
  double rise;
};

enum class Along { radius, height, angle };

/// All steps to the next wider base, higher home or wider pair.
std::vector<Step> steps(const Designs& made, Along along, Measure measure);

/// Largest rise where `within(step)`, 0 where nothing rises; of `sign` −1: largest fall.
template <class F>
double largest_rise(const std::vector<Step>& all, double sign, const F& within) {
  double most = 0;
  for (const Step& step : all)
    if (within(step)) most = worse(most, excess(sign * step.rise));
  return most;
}

/// How many steps do not rise, or of `sign` −1 fall, and which do: each, or of many the pair angles.
std::string exceptions(const Designs& made, const std::vector<Step>& all, double sign);

inline std::size_t least(const std::vector<double>& values) {
  return static_cast<std::size_t>(std::ranges::min_element(values) - values.begin());
}

inline std::size_t largest(const std::vector<double>& values) {
  return static_cast<std::size_t>(std::ranges::max_element(values) - values.begin());
}

}  // namespace sinew::inline v1::tripod
