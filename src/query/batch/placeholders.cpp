#include "query/batch/placeholders.hpp"

#include <algorithm>

#include "io/document/quantity.hpp"

namespace sinew::inline v1 {
namespace {

void collect(Node& node, std::span<const std::string> names, std::vector<Placeholder>& found) {
  if (const auto place = placeholder(node, names)) found.push_back(*place);
  for (Node& item : node.items) collect(item, names, found);
  for (Member& member : node.members) collect(member.value, names, found);
}

}  // namespace

std::optional<Placeholder> placeholder(Node& node, std::span<const std::string> names) {
  if (node.kind != Node::Kind::string || !node.text.starts_with('$')) return {};
  Placeholder found{node.text.substr(1), {}, &node};
  const auto name = std::ranges::find(names, found.name);
  if (name != names.end()) found.input = static_cast<std::size_t>(name - names.begin());
  return found;
}

std::vector<Placeholder> placeholders(Node& query, std::span<const std::string> names) {
  std::vector<Placeholder> found;
  collect(query, names, found);
  return found;
}

void put(Node& node, double value) {
  node.kind = Node::Kind::number;
  node.number = value;
  node.text = si_text(value);
}

void put(Node& node, double value, std::span<const std::string> words) {
  put(node, value);
  if (words.empty()) return;
  node.kind = Node::Kind::string;
  node.text = words[std::min(static_cast<std::size_t>(value), words.size() - 1)];
}

void put(Node& node, double value, std::string_view unit) {
  put(node, value);
  if (unit.empty()) return;
  node.kind = Node::Kind::string;
  node.text += ' ' + std::string(unit);
}

}  // namespace sinew::inline v1
