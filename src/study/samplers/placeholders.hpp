/// @file placeholders.hpp
/// The places of a study's query where values of axes go.
#pragma once
#include <vector>

#include "sinew/study/study.hpp"

namespace sinew::inline v0 {

struct Placeholder {
  std::size_t axis;
  Node* node;
};

/// All of them; they point into the tree, whose shape must stay.
std::vector<Placeholder> placeholders(Node& query, const Study& study);

/// Makes the node this number ...
void put(Node& node, double value);
/// ... or a text with its unit, which the query's reader then checks.
void put(Node& node, double value, std::string_view unit);

}  // namespace sinew::inline v0
