#include "study/samplers/query_entries.hpp"

#include <algorithm>

#include "io/quantity.hpp"
#include "study/samplers/placeholders.hpp"

namespace sinew::inline v1 {

std::optional<QueryEntry> query_entry(const Node& node, const Study& study) {
  if (node.kind == Node::Kind::number) return QueryEntry{node.number};
  Node copy = node;
  const auto place = placeholder(copy, study);
  if (place && place->axis) return QueryEntry{0, static_cast<std::ptrdiff_t>(*place->axis)};
  if (place || node.kind != Node::Kind::string) return {};
  const auto quantity = parse_any_quantity(node.text);  // of the right unit: a query was put on trial with it
  return quantity ? std::optional(QueryEntry{quantity->value}) : std::nullopt;
}

std::optional<std::vector<QueryEntry>> query_entries(const Node& list, const Study& study) {
  if (list.kind != Node::Kind::list) return {};
  std::vector<QueryEntry> entries;
  for (const Node& item : list.items) {
    const auto entry = query_entry(item, study);
    if (!entry) return {};
    entries.push_back(*entry);
  }
  return entries;
}

std::optional<std::vector<double>> constant_entries(const Node& list, const Study& study) {
  const auto entries = query_entries(list, study);
  if (!entries || std::ranges::any_of(*entries, [](const QueryEntry& entry) { return entry.axis >= 0; }))
    return {};
  std::vector<double> values;
  for (const QueryEntry& entry : *entries) values.push_back(entry.value);
  return values;
}

}  // namespace sinew::inline v1
