/// @file columns.hpp
/// How many bits the numbers of a table take, each column by itself.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "robot/controller.hpp"

namespace sinew::inline v1::verilog {

using Rows = std::vector<std::array<double, 2>>;

/// Bits with the sign that hold a number.
inline int bits_of(std::int64_t value) {
  return 1 + static_cast<int>(std::bit_width(static_cast<std::uint64_t>(value < 0 ? -value - 1 : value)));
}

template <class Value>
int max_bits(const ControllerTable& table, Value value) {
  int most = 1;
  for (const ControllerSection& section : table.sections) most = std::max(most, bits_of(value(section)));
  return most;
}

/// Of each tendon in turn, what its column of an axis takes.
inline std::vector<int> column_bits(const ControllerTable& table, Rows ControllerSection::*rows, int places,
                                    std::size_t axis) {
  std::vector<int> bits;
  for (std::size_t i = 0; i < (table.sections[0].*rows).size(); ++i)
    bits.push_back(max_bits(table, [&](const ControllerSection& section) {
      return fixed_point((section.*rows)[i][axis], places);
    }));
  return bits;
}

template <class Value>
int share_bits(const ControllerTable& table, Value value) {
  return max_bits(table, [&](const ControllerSection& section) {
    return fixed_point(value(section.share), ShortBits::share);
  });
}

}  // namespace sinew::inline v1::verilog
