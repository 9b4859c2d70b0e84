/// @file placeholders.hpp
/// The places of a study's query where values of axes and derived values go: texts `$name`.
#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "sinew/study/study.hpp"

namespace sinew::inline v1 {

struct Placeholder {
  std::string_view name;            ///< without the `$`; a view into the study or the node
  std::optional<std::size_t> axis;  ///< or derived value; nothing where the study has none of that name
  Node* node;
};

/// What a node stands for, if it is a placeholder.
std::optional<Placeholder> placeholder(Node& node, const Study& study);

/// All of a tree; they point into it, and its shape must stay.
std::vector<Placeholder> placeholders(Node& query, const Study& study);

/// Makes the node this number ...
void put(Node& node, double value);
/// ... or a text with its unit, which the query's reader then checks.
void put(Node& node, double value, std::string_view unit);

}  // namespace sinew::inline v1
