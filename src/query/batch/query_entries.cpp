#include "query/batch/query_entries.hpp"

#include <algorithm>

#include "io/quantity.hpp"
#include "query/batch/placeholders.hpp"

namespace sinew::inline v1 {

std::optional<QueryEntry> query_entry(const Node& node, const BatchQuestion& question) {
  if (node.kind == Node::Kind::number) return QueryEntry{node.number};
  Node copy = node;
  const auto place = placeholder(copy, question.inputs);
  if (place && place->input) return QueryEntry{0, static_cast<std::ptrdiff_t>(*place->input)};
  if (place || node.kind != Node::Kind::string) return {};
  const auto quantity = parse_any_quantity(node.text);  // of the right unit: a query was put on trial with it
  return quantity ? std::optional(QueryEntry{quantity->value}) : std::nullopt;
}

std::optional<std::vector<QueryEntry>> query_entries(const Node& list, const BatchQuestion& question) {
  if (list.kind != Node::Kind::list) return {};
  std::vector<QueryEntry> entries;
  for (const Node& item : list.items) {
    const auto entry = query_entry(item, question);
    if (!entry) return {};
    entries.push_back(*entry);
  }
  return entries;
}

std::optional<std::vector<double>> constant_entries(const Node& list, const BatchQuestion& question) {
  const auto entries = query_entries(list, question);
  if (!entries || std::ranges::any_of(*entries, [](const QueryEntry& entry) { return entry.input >= 0; }))
    return {};
  std::vector<double> values;
  for (const QueryEntry& entry : *entries) values.push_back(entry.value);
  return values;
}

}  // namespace sinew::inline v1
