#include "study/samplers/placeholders.hpp"

#include "io/quantity.hpp"

namespace sinew::inline v1 {
namespace {

void collect(Node& node, const Study& study, std::vector<Placeholder>& found) {
  if (const auto place = placeholder(node, study)) found.push_back(*place);
  for (Node& item : node.items) collect(item, study, found);
  for (Member& member : node.members) collect(member.value, study, found);
}

}  // namespace

std::optional<Placeholder> placeholder(Node& node, const Study& study) {
  if (node.kind != Node::Kind::string || !node.text.starts_with('$')) return {};
  Placeholder found{std::string_view(node.text).substr(1), {}, &node};
  found.axis = study.find_variable(found.name);
  if (found.axis) found.name = study.column_name(*found.axis);
  return found;
}

std::vector<Placeholder> placeholders(Node& query, const Study& study) {
  std::vector<Placeholder> found;
  collect(query, study, found);
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

}  // namespace sinew::inline v1
