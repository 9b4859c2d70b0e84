#include "study/samplers/query_entries.hpp"

#include <algorithm>

namespace sinew::inline v0 {

std::optional<QueryEntry> query_entry(const Node& node, const Study& study) {
  if (node.kind == Node::Kind::number) return QueryEntry{node.number};
  if (node.kind != Node::Kind::string || !node.text.starts_with('$')) return {};
  const auto axis = std::ranges::find(study.axes, std::string_view(node.text).substr(1), &StudyAxis::name);
  if (axis == study.axes.end()) return {};
  return QueryEntry{0, axis - study.axes.begin()};
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

}  // namespace sinew::inline v0
