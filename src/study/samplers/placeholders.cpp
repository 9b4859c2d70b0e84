#include "study/samplers/placeholders.hpp"

#include <algorithm>

#include "sinew/io/quantity.hpp"

namespace sinew::inline v0 {
namespace {

void collect(Node& node, const Study& study, std::vector<Placeholder>& found) {
  if (node.kind == Node::Kind::string && node.text.starts_with('$')) {
    const auto axis = std::ranges::find(study.axes, std::string_view(node.text).substr(1), &StudyAxis::name);
    if (axis != study.axes.end())
      found.push_back({static_cast<std::size_t>(axis - study.axes.begin()), &node});
  }
  for (Node& item : node.items) collect(item, study, found);
  for (Member& member : node.members) collect(member.value, study, found);
}

}  // namespace

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

}  // namespace sinew::inline v0
