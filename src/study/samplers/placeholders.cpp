#include "study/samplers/placeholders.hpp"

#include <algorithm>

#include "sinew/io/quantity.hpp"

namespace sinew::inline v0 {
namespace {

void collect(Node& node, const std::vector<StudyAxis>& axes, std::vector<Placeholder>& found) {
  if (const auto place = placeholder(node, axes)) found.push_back(*place);
  for (Node& item : node.items) collect(item, axes, found);
  for (Member& member : node.members) collect(member.value, axes, found);
}

}  // namespace

std::optional<Placeholder> placeholder(Node& node, const std::vector<StudyAxis>& axes) {
  if (node.kind != Node::Kind::string || !node.text.starts_with('$')) return {};
  Placeholder found{std::string_view(node.text).substr(1), {}, &node};
  const auto axis = std::ranges::find(axes, found.name, &StudyAxis::name);
  if (axis == axes.end()) return found;
  found.axis = static_cast<std::size_t>(axis - axes.begin());
  found.name = axis->name;
  return found;
}

std::vector<Placeholder> placeholders(Node& query, const std::vector<StudyAxis>& axes) {
  std::vector<Placeholder> found;
  collect(query, axes, found);
  return found;
}

void put(Node& node, double value) {
  node.kind = Node::Kind::number;
  node.number = value;
  node.text = si_text(value);
}

void put(Node& node, double value, std::string_view unit) {
  put(node, value);
  if (unit.empty()) return;
  node.kind = Node::Kind::string;
  node.text += ' ' + std::string(unit);
}

}  // namespace sinew::inline v0
