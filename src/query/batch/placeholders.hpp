/// @file placeholders.hpp
/// The places of a query where the numbers of columns go: texts `$name`.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sinew/io/node.hpp"

namespace sinew::inline v1 {

struct Placeholder {
  std::string name;                  ///< without the `$`
  std::optional<std::size_t> input;  ///< which of the names; nothing where there is none of that name
  Node* node;
};

/// What a node stands for, if it is a placeholder.
std::optional<Placeholder> placeholder(Node& node, std::span<const std::string> names);

/// All of a tree; they point into it, and its shape must stay.
std::vector<Placeholder> placeholders(Node& query, std::span<const std::string> names);

/// Makes the node this number ...
void put(Node& node, double value);
/// ... or the word that it counts, from 0; the number where there are no words ...
void put(Node& node, double value, std::span<const std::string> words);
/// ... or a text with its unit, which the query's reader then checks.
void put(Node& node, double value, std::string_view unit);

}  // namespace sinew::inline v1
