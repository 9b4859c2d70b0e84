/// @file numbers.hpp
/// A read-only view of numbers that also binds to a braced list: `forward(robot, {0.19, 0.19, 0.18}, ...)`;
/// and what stands for a number that there is not.
#pragma once
#include <initializer_list>
#include <limits>
#include <span>
#include <vector>

#include "sinew/base/export.hpp"

namespace sinew::inline v1 {

/// NaN. In results, of whatever unit: not solved, not asked for, or not defined there. An empty cell of a
/// table.
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// For parameters only: a braced list lives until the call returns.
struct Numbers : std::span<const double> {
  using span::span;
  /// View of numbers, which have to outlive it, in the unit that the function says.
  Numbers(std::span<const double> view) : span(view) {}
  /// The same of those of a vector: the unit is the function's.
  Numbers(const std::vector<double>& values) : span(values) {}
  /// The same of a braced list: the unit is the function's.
  Numbers(std::initializer_list<double> values) : span(values.begin(), values.size()) {}
};

}  // namespace sinew::inline v1
