/// @file query_entries.hpp
/// Numbers of a query that stay or are a column's: what the quick samplers read in place of questions.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "query/batch/sampler.hpp"

namespace sinew::inline v1 {

struct QueryEntry {
  double value = 0;
  std::ptrdiff_t input = -1;  ///< −1: `value`

  double at(const SampleBlock& block, std::size_t k) const {
    return input < 0 ? value : block.input(static_cast<std::size_t>(input), k);
  }
};

/// A number, a text that is one with its unit, or `$name`; anything else is left to the query.
std::optional<QueryEntry> query_entry(const Node& node, const BatchQuestion& question);

/// All of a list; nothing where one is something else.
std::optional<std::vector<QueryEntry>> query_entries(const Node& list, const BatchQuestion& question);

/// All of a list, none of them a column.
std::optional<std::vector<double>> constant_entries(const Node& list, const BatchQuestion& question);

}  // namespace sinew::inline v1
