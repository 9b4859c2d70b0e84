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

/// In results: not solved, not asked for, or not defined there. An empty cell of a table.
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// For parameters only: a braced list lives until the call returns.
struct Numbers : std::span<const double> {
  using span::span;
  Numbers(std::span<const double> view) : span(view) {}
  Numbers(const std::vector<double>& values) : span(values) {}
  Numbers(std::initializer_list<double> values) : span(values.begin(), values.size()) {}
};

}  // namespace sinew::inline v1
