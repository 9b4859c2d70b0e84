#include "query/batch/row_places.hpp"

#include <algorithm>

#include "query/batch/placeholders.hpp"

namespace sinew::inline v1 {
namespace {

/// @param use(node, place) of each name
template <class Use>
void each_name(const Node& node, const std::string& place, const Use& use) {
  if (is_name(node)) use(node, place);
  for (std::size_t i = 0; i < node.items.size(); ++i) each_name(node.items[i], joined(place, i), use);
  for (const Member& member : node.members) each_name(member.value, joined(place, member.key), use);
}

bool is_at_or_within(std::string_view place, std::string_view whole) {
  return place.starts_with(whole) &&
         (place.size() == whole.size() || place[whole.size()] == '.' || place[whole.size()] == '[');
}

}  // namespace

bool is_name(const Node& node) { return node.kind == Node::Kind::string && node.text.starts_with('$'); }

void put_some_numbers(Node& node) {
  constexpr double some = 0.1;
  if (is_name(node)) {
    node.kind = Node::Kind::number;
    node.number = some;
  }
  for (Node& item : node.items) put_some_numbers(item);
  for (Member& member : node.members) put_some_numbers(member.value);
}

std::vector<std::string> places_of_names(const Node& query) {
  std::vector<std::string> places;
  each_name(query, "", [&](const Node&, const std::string& place) { places.push_back(place); });
  return places;
}

bool is_at_or_around(std::string_view place, std::span<const std::string> places) {
  return std::ranges::any_of(
      places, [&](std::string_view one) { return place.empty() || is_at_or_within(one, place); });
}

RowPlaces::RowPlaces(const BatchQuestion& question) : question_(&question), trial_(question.query) {
  each_name(question.query.root, "", [&](const Node& node, const std::string& place) {
    const auto input = std::ranges::find(question.inputs, std::string_view(node.text).substr(1));
    has_unknown_ = has_unknown_ || input == question.inputs.end();
    columns_.emplace_back(place, static_cast<std::size_t>(input - question.inputs.begin()));
  });
  put_some_numbers(trial_.root);
}

bool RowPlaces::are_within(std::initializer_list<std::string_view> places) const {
  return !has_unknown_ && std::ranges::all_of(columns_, [&](const auto& column) {
    return std::ranges::any_of(places,
                               [&](std::string_view whole) { return is_at_or_within(column.first, whole); });
  });
}

std::vector<RowNumber> RowPlaces::numbers(std::string_view place, std::span<const double> read,
                                          Range range) const {
  std::vector<RowNumber> all;
  for (std::size_t k = 0; k < read.size(); ++k) all.push_back(number(joined(place, k), read[k], range));
  return all;
}

std::ptrdiff_t RowPlaces::input_at(std::string_view place) const {
  const auto found =
      std::ranges::find(columns_, place, [](const auto& column) -> std::string_view { return column.first; });
  return found == columns_.end() ? -1 : static_cast<std::ptrdiff_t>(found->second);
}

}  // namespace sinew::inline v1
