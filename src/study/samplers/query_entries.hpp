/// @file query_entries.hpp
/// Numbers of a study's query that stay or are an axis: what the quick samplers read in place of questions.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "study/samplers/sampler.hpp"

namespace sinew::inline v1 {

struct QueryEntry {
  double value = 0;
  std::ptrdiff_t axis = -1;  ///< −1: `value`

  double at(const SampleBlock& block, std::size_t k) const {
    return axis < 0 ? value : block.axis(static_cast<std::size_t>(axis), k);
  }
};

/// A number, a text that is one with its unit, or `$axis`; anything else is left to the query.
std::optional<QueryEntry> query_entry(const Node& node, const Study& study);

/// All of a list; nothing where one is something else.
std::optional<std::vector<QueryEntry>> query_entries(const Node& list, const Study& study);

/// All of a list, none of them an axis.
std::optional<std::vector<double>> constant_entries(const Node& list, const Study& study);

}  // namespace sinew::inline v1
